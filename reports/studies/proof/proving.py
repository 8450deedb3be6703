"""Orbits proven one by one, each with its certificate checked by an interpreter of its own."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import periodic as per
from periodic.proof import check
from reports.studies.pages.content import Found, Tell
from symbolic import CompiledSystem

Asked = tuple[per.Point, str | None]
"""A point, and of a fold or doubling the parameter of its branch."""


def proven(system: CompiledSystem, asked: Iterable[Asked], tell: Tell) -> Found:
    """Return the rows of a section: what is proven of some points, and how far the engine was from it."""
    rows = []
    for point, parameter in asked:
        tell(f"at {point.parameter:.6g}")
        rows.append(row(system, point, parameter))
    return Found(numbers={"proven": sum(each["proven"] for each in rows)}, rows=rows)


def row(
    system: CompiledSystem,
    point: per.Point,
    parameter: str | None,
    between: tuple[float, float] | None = None,
) -> dict[str, Any]:
    """Prove a point, or a stretch through it, check the certificate, and return what came of it."""
    begun = time.process_time()
    proof = per.proved(system, point, parameter, between)
    seconds = time.process_time() - begun
    bounds = {name: proof.peak_to_peak(name) for name in list(proof.minimum)[:1]}
    accepted, checked = _checked(proof) if proof.certificate else (False, 0.0)
    return {
        "label": point.label.value if parameter and between is None else "",
        "place": point.parameter,
        "proven": bool(proof),
        "says": proof.reason or proof.says,
        "stable": proof.stable,
        "largest": max((abs(disc.centre) + disc.radius for disc in proof.multipliers), default=None),
        "pieces": len(proof.certificate.get("pieces", ())),
        "ranges": len(proof.certificate.get("tiles", ())),
        "radius": proof.radius if proof else 0.0,
        "widest": proof.radius if proof.certificate else 0.0,
        "distance": proof.distance if proof and between is None else 0.0,
        "estimate": point.error.orbit,
        "peak": bounds,
        "accepted": accepted,
        "seconds": round(seconds, 1),
        "checked": round(checked, 1),
    }


def _checked(proof: per.Proof) -> tuple[bool, float]:
    """Whether the checker accepts a certificate, alone, and in how many seconds."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "proof.json"
        proof.save(path)
        begun = time.perf_counter()
        run = subprocess.run(
            [sys.executable, "-I", check.__file__, str(path)], capture_output=True, check=False
        )
        return run.returncode == 0, time.perf_counter() - begun


def shown(rows: Iterable[Mapping[str, Any]]) -> list[list[str]]:
    """Return the rows of a section as its table has them."""
    kinds = {True: "stable", False: "unstable", None: ""}
    return [
        [
            each["label"],
            f"{each['place']:.9g}",
            (kinds[each["stable"]] or "proven") if each["proven"] else f"not decided: {each['says']}",
            str(each["pieces"] or ""),
            f"{each['radius']:.0e}" if each["proven"] else "",
            f"{each['distance']:.1e}" if each["proven"] else "",
            f"{each['estimate']:.1e}",
            "" if each["largest"] is None else f"{each['largest']:.2g}",
            f"{each['seconds']:.1f}",
            f"{each['checked']:.1f}" if each["proven"] else "",
        ]
        for each in rows
    ]
