"""Folders of tests whose systems have the kernels that a user gets: in C where there is a compiler."""

from __future__ import annotations

from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent

IN_C = (TESTS / "problems", TESTS / "reports" / "studies")
"""Known answers and studies: always."""

ROOMS = ("bifurcations", "collocation", "condensed", "correction", "linear")
"""Those of tests/periodic that `make test` runs in C (`--in-c`) and `make kernels` in NumPy."""

ROOMS_IN_C = tuple(TESTS / "periodic" / room for room in ROOMS)
