"""Folders of tests whose systems have the kernels that a user gets: in C where there is a compiler."""

from __future__ import annotations

from pathlib import Path

ROOMS = ("bifurcations", "collocation", "condensed", "correction", "linear")
"""Those of tests/periodic; `make kernels` runs them once more with kernels in NumPy."""

TESTS = Path(__file__).resolve().parent.parent

IN_C = (*(TESTS / "periodic" / room for room in ROOMS), TESTS / "problems", TESTS / "reports" / "studies")
