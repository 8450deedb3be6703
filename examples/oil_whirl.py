"""
Oil whirl
=========

A rigid rotor in short journal bearings: at some speed the film begins to drive it round.
"""

import math

import periodic as per
import symbolic as sym

rpm = math.pi / 30
rotor = sym.scene("journal-bearing")
branch = per.trace(rotor, "speed", (3000 * rpm, 12000 * rpm), start=3000 * rpm)
axes = per.plot(branch, units={"speed": "rev/min"})
key = branch.labelled("NS")[0].parameter / rpm  # rev/min
print(f"whirl from {key:.3f} rev/min on")
