"""Units of angular frequencies: what a parameter may be given in where a part asks for rad/s."""

import math

ANGULAR = {"rev/min": 2 * math.pi / 60, "Hz": 2 * math.pi, "rad/s": 1.0}
"""rad/s in one of each."""
