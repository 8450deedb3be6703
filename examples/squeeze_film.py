"""
Squeeze-film damper
===================

A ring of oil round the bearing, without rotation, damps the rotor over its critical speed.
"""

import math

import periodic as per
import symbolic as sym

rpm = math.pi / 30
rotor = sym.scene("squeeze-film-damper")
branch = per.trace(rotor, "speed", (2000 * rpm, 12000 * rpm), start=2000 * rpm, at=[8000 * rpm])
axes = per.plot(branch, units={"speed": "rev/min"})
(there,) = [point for point in branch if point.label == "UZ"]
key = 1e6 * there.peak_to_peak("x")  # um
print(f"x moves by {key:.6f} um at 8000 rev/min")
