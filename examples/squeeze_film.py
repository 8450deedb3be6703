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
branch = per.trace(rotor, "speed", (2000 * rpm, 12000 * rpm), start=2000 * rpm)
axes = per.plot(branch)
top = branch[int(branch.peak_to_peak("x").argmax())]
key = top.parameter / rpm  # rev/min
print(f"largest motion at {key:.2f} rev/min")
