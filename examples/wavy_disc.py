"""
A wavy disc with an oil film
============================

The scene of Mehdigoli, Rahnejat & Gohar (1990): below 288 rev/min the discs lose contact in every cycle.
"""

import math

import periodic as per
import symbolic as sym

rpm = 2 * math.pi / 60
disc = sym.scene("vitrea79-810N")
branch = per.trace(disc, "speed", (100 * rpm, 500 * rpm), start=500 * rpm)
axes = per.plot(branch, units={"speed": "rev/min"})
key = branch.labelled("LP")[0].parameter / rpm  # rev/min: the upper sheet's end
print(f"upper fold at {key:.4f} rev/min")
