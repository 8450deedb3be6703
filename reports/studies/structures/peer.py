"""The cantilever by pyHarm, where it is installed: harmonic balance of all degrees of freedom."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg as sl
from scipy import sparse

from periodic import Collocation, HarmonicBalance, Label
from reports.benchmarks.others import Case, MissingError, traced, version
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.structures.beams import CUBIC, DAMPING, FORCE, beam, cantilever, cubic
from reports.studies.structures.size import RANGE, branch, processor

HARMONICS = 7
"""pyHarm's; ours are chosen by their error."""

ELEMENTS = (2, 10, 25)

OURS = {
    "orbitrace, condensed collocation": Collocation(),
    "orbitrace, condensed harmonics": HarmonicBalance(),
}

PEER = f"pyHarm, {HARMONICS} harmonics, all states"


def matrices(elements: int) -> dict[str, Any]:
    """Return the beam as pyHarm takes it: dense matrices, damping in each mode, what is at the tip."""
    body = beam(elements)
    M, K = (sparse.csr_array(matrix).toarray() for matrix in (body.M, body.K))
    squares, modes = sl.eigh(K, M)
    C = M @ modes @ np.diag(2 * DAMPING * np.sqrt(squares)) @ modes.T @ M
    return {"M": M, "C": C, "K": K, "tip": body.at["tip"], "cubic": CUBIC, "force": FORCE, "range": RANGE}


def peer(elements: int) -> dict[str, Any]:
    """Return what pyHarm says of the branch, or why it says nothing."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "beam.npz"
        np.savez(file, **matrices(elements))
        try:
            found = traced(Case("pyHarm", "harm", (str(HARMONICS), str(file))))
        except MissingError as missing:
            return {"why": str(missing)}
    return {"s": found.seconds, "points": found.points, "folds": sorted(found.folds)}


def own(elements: int, method: str) -> dict[str, Any]:
    """Return points, seconds and folds of this program."""
    system = cantilever(elements, cubic)
    found, took = processor(lambda: branch(system, OURS[method]))
    folds = sorted(point.parameter for point in found.labelled(Label.FOLD))
    return {"s": took, "points": len(found), "folds": folds}


def compute(tell: Tell) -> Found:
    """Trace the branch at each size by this program and by pyHarm."""
    rows: list[dict[str, Any]] = []
    for elements in ELEMENTS:
        for method in (*OURS, PEER):
            tell(f"{method}, {2 * elements} degrees of freedom")
            found = peer(elements) if method == PEER else own(elements, method)
            rows.append({"method": method, "freedoms": 2 * elements} | found)
    numbers = {
        f"{row['method']}, fold {k} of {row['freedoms']} degrees of freedom": value
        for row in rows
        if row["freedoms"] == 20
        for k, value in enumerate(row.get("folds", ()))
    }
    return Found(numbers=numbers, rows=[*rows, {"method": "version", "is": version("pyHarm-os")}])


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the rows with each fold's distance from condensed collocation's."""
    rows = [row for row in kept.rows if row["method"] != "version"]
    truth = {row["freedoms"]: row["folds"] for row in rows if row["method"] == next(iter(OURS))}
    for row in rows:
        there = truth[row["freedoms"]]
        if len(row.get("folds", ())) == len(there):
            row["off"] = [abs(a - b) for a, b in zip(row["folds"], there, strict=True)]
    last = {row["method"]: row.get("s", math.nan) for row in rows[-1 - len(OURS) :]}
    return {
        "told": rows,
        "version": kept.rows[-1]["is"],
        "harmonics": HARMONICS,
        "largest": rows[-1]["freedoms"],
        "ratio": last[PEER] / last[next(iter(OURS))],
    }


BESIDE = Section(title="Beside pyHarm", compute=compute, context=context)
