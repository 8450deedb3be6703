"""Units in which a frequency is read: what a scene's range and the axis of a figure are in."""

from __future__ import annotations

from symbolic.equations.variables import ANGULAR

RPM = ANGULAR["rev/min"]
"""rad/s in one rev/min."""

AXES = ANGULAR
"""rad/s in one of each unit."""

SHORT = {"rev/min": "rpm", "Hz": "hz", "rad/s": "rad_s"}
"""What the units are called in the names of columns."""
