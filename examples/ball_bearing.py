"""
Ball bearing
============

Each ball that passes under the load makes the shaft fall and rise. The period is the passage of one ball, so
that a period doubling is one.
"""

import math

import periodic as per
import symbolic as sym

krpm = 1000 * math.pi / 30
bearing = sym.scene("ball-bearing")
branch = per.trace(bearing, "speed", (5 * krpm, 8 * krpm), start=8 * krpm, at=[7 * krpm])
axes = per.plot(branch, "y", units={"speed": "rev/min"})
(seven,) = [point for point in branch if point.label == "UZ"]
key = 1e6 * seven.peak_to_peak("x")  # um
print(f"x moves by {key:.6f} um at 7000 rev/min")
