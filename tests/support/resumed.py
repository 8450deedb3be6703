"""Branches that are interrupted and resumed."""

from __future__ import annotations

from typing import Any

import periodic as per
from support.kept import kept
from support.traces import DUFFING_A, RPM, disc_system, duffing_system


def duffing_options(**watched: Any) -> dict[str, Any]:
    """A branch traced both ways, with user points, events and columns, and what else is `watched`."""
    return {
        "system": duffing_system(*DUFFING_A),
        "parameter": "Omega",
        "bounds": (0.3, 3.0),
        "start": 1.0,
        "at": [1.7],
        "watch": per.Watch(
            columns={"amplitude": per.Amplitude("x")},
            events={"three": per.Level(per.PeakToPeak("x"), 3.0)},
            **watched,
        ),
    }


def disc_options(**watched: Any) -> dict[str, Any]:
    """The disc through its folds, and what is `watched`."""
    return {
        "system": disc_system("vitrea79-810N"),
        "parameter": "speed",
        "bounds": (200 * RPM, 300 * RPM),
        "start": 300 * RPM,
        "watch": per.Watch(**watched),
    }


@kept
def whole(which: str) -> per.Branch:
    """The branch without an interrupt."""
    return per.trace(**OPTIONS[which]())


OPTIONS = {"duffing": duffing_options, "disc": disc_options}
