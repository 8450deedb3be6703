"""Units in which a frequency is read: what a scene's range and the axis of a figure are in."""

from __future__ import annotations

import math

RPM = 2 * math.pi / 60
"""rad/s in one rev/min."""

AXES = {"rev/min": RPM, "Hz": 2 * math.pi, "rad/s": 1.0}
"""rad/s in one of each unit."""

SHORT = {"rev/min": "rpm", "Hz": "hz", "rad/s": "rad_s"}
"""What the units are called in the names of columns."""
