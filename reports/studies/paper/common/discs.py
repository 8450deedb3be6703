"""The discs of the paper by the names of their scenes, and units."""

from __future__ import annotations

OIL_A, HEAVY, OIL_B, OIL_B_HEAVY = "vitrea79-810N", "vitrea79-2100N", "turbo33-810N", "turbo33-2100N"

TITLES = {
    OIL_A: "Vitrea 79, 810 N",
    HEAVY: "Vitrea 79, 2100 N",
    OIL_B: "Turbo 33, 810 N",
    OIL_B_HEAVY: "Turbo 33, 2100 N",
}

LUBRICATED = tuple(TITLES)
"""The paper's lubricants and preloads."""

MICRO = 1e-6

LOST = 1e-3
"""Contact counts as lost where the load falls below this part of the preload."""

RPM_SHOWN = 360.0
"""rev/min of all time histories of the paper."""
