"""The paper's disc: every motion over the speed, with the shares of their basins."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell

SPEEDS = (200, 300, 400, 500, 600, 700)
"""rev/min."""

SCENES = ("dry-810N", "vitrea79-810N")
"""The disc without oil, and with the paper's."""

BOX = {"x": (-30e-6, 30e-6)}
"""Where motions start: up to 30 um from rest; speeds as far as the motion from rest goes, three times."""

RPM = math.pi / 30


def disc(tell: Tell) -> Found:
    """Compute the motions at each speed."""
    rows: list[dict[str, Any]] = []
    for scene in SCENES:
        system = sym.scene(scene)
        for speed in SPEEDS:
            tell(f"{scene} at {speed} rev/min")
            found = per.motions(system, {"speed": speed * RPM}, box=BOX, starts=192, periods=4, places=32)
            rows += [
                {
                    "scene": scene,
                    "rpm": speed,
                    "periods": motion.periods,
                    "stable": motion.stable,
                    "sort": str(motion.sort),
                    "swing_um": 1e6 * motion.point.peak_to_peak("x") if motion.point else None,
                    "share": motion.share,
                    "low": motion.interval[0],
                    "high": motion.interval[1],
                }
                for motion in found
            ]
    at = [row for row in rows if row["rpm"] == 500 and row["scene"] == "vitrea79-810N" and row["stable"]]
    swings = sorted(row["swing_um"] for row in at if row["swing_um"])
    return Found(numbers={"least_um": swings[0], "largest_um": swings[-1]}, rows=rows)


def _context(kept: Kept) -> Mapping[str, Any]:
    table = []
    for row in kept.rows:
        name = row["sort"] if row["periods"] == 0 else f"{row['periods']}"
        swing = "" if row["swing_um"] is None else f"{row['swing_um']:.4g}"
        share = f"{100 * row['share']:.0f} ({100 * row['low']:.0f} to {100 * row['high']:.0f})"
        kind = "stable" if row["stable"] else "unstable"
        table.append([row["scene"], row["rpm"], name, kind, swing, share if row["share"] else ""])
    return {"table": table}


DISC = Section(title="The disc of 1990", compute=disc, context=_context)
