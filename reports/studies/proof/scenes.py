"""Scenes whose orbits are proven, at some values and at their folds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.proof.proving import proven, shown


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A scene, its branch, where orbits of that are proven, and whether its folds and doublings are."""

    key: str
    parameter: str
    range: tuple[float, float]
    at: tuple[float, ...] = ()
    folds: bool = False
    words: str = ""

    @cached_property
    def section(self) -> Section:
        """The section of the page."""
        return Section(
            title=f"`{self.key}`", compute=self._compute, context=self._context, template="proven.md.j2"
        )

    def _compute(self, tell: Tell) -> Found:
        system = sym.scene(self.key)
        begin, end = self.range
        tell("tracing")
        branch = per.trace(
            system, self.parameter, (min(begin, end), max(begin, end)), start=begin, at=list(self.at)
        )
        orbits = [(point, None) for value in self.at for point in branch.at(**{self.parameter: value})]
        special = [(point, self.parameter) for point in branch if point.label in ("LP", "PD")]
        return proven(system, [*orbits, *(special if self.folds else [])], tell)

    def _context(self, kept: Kept) -> Mapping[str, Any]:
        return {"words": self.words, "axis": self.parameter, "table": shown(kept.rows)}


SCENES = (
    Scene(
        key="duffing", parameter="Omega", range=(0.3, 3.0), at=(1.0, 2.0), folds=True, words="Three sheets."
    ),
    Scene(
        key="stop",
        parameter="Omega",
        range=(0.8, 1.6),
        at=(0.85, 1.1),
        words="An elastic stop, struck or not.",
    ),
    Scene(
        key="gear-pair",
        parameter="Omega",
        range=(1.4, 0.55),
        at=(0.7, 1.3),
        folds=True,
        words="Teeth part and meet again: the folds are folds of motions with two events.",
    ),
    Scene(
        key="jeffcott-rub",
        parameter="speed",
        range=(0.2, 1.5),
        at=(0.5, 1.3),
        words="A rotor within its clearance, and in lasting contact with the ring.",
    ),
    Scene(
        key="dry-810N",
        parameter="speed",
        range=(15.0, 50.0),
        at=(23.0, 40.0),
        folds=True,
        words="The disc of 1990 without oil. At 23 rad/s it leaves the ground: a Hertzian contact ends and "
        "begins. At the lower fold it does so too, and the curvature of the force, which a fold needs, "
        "has no bound there.",
    ),
    Scene(
        key="vitrea79-810N",
        parameter="speed",
        range=(15.0, 50.0),
        at=(20.0, 45.0),
        folds=True,
        words="The disc of 1990 in oil, an unknown of its own, the load, beside the states. In contact it is "
        "proven, and so is the fold at which the resonance ends; where contact is lost, and the load falls "
        "by more than ten decades, it is not.",
    ),
    Scene(key="cavitating-film-810N", parameter="speed", range=(52.0, 54.0), at=(52.0,)),
    Scene(key="third-order-810N", parameter="speed", range=(52.0, 54.0), at=(52.0,)),
    Scene(
        key="ball-bearing",
        parameter="speed",
        range=(1047.0, 1060.0),
        at=(1047.0,),
        words="Balls are loaded and unloaded: a Hertzian contact ends, another begins.",
    ),
    Scene(
        key="friction-damper",
        parameter="Omega",
        range=(0.5, 0.6),
        at=(0.5,),
        words="Friction smoothed by tanh.",
    ),
    Scene(key="jeffcott-internal-damping", parameter="n", range=(1.2, 1.25), at=(1.2,)),
    Scene(
        key="journal-bearing",
        parameter="speed",
        range=(314.0, 320.0),
        at=(314.0,),
        words="Oil damps the journal's motion so fast that a turn would take thousands of steps.",
    ),
    Scene(
        key="impact-oscillator",
        parameter="A",
        range=(1.0, 0.5),
        at=(0.9, 0.6),
        words="Impacts on a rigid wall, with Newton's coefficient of restitution.",
    ),
    Scene(key="jenkins-damper", parameter="Omega", range=(0.5, 0.55), at=(0.5,)),
)
"""In the order of the page."""
