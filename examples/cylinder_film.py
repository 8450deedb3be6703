"""
Two cylinders and their film
============================

The disc as a cylinder: contact along a line, with its own laws of deflection, film and squeeze.
"""

import math

import periodic as per
import symbolic as sym

rpm = 2 * math.pi / 60
cylinders = sym.scene("line-contact-810N")
branch = per.trace(cylinders, "speed", (200 * rpm, 900 * rpm), start=900 * rpm, at=[450 * rpm])
axes = per.plot(branch, units={"speed": "rev/min"})
(there,) = [point for point in branch if point.label == "UZ"]
key = 1e6 * there.peak_to_peak("x")  # um
print(f"x moves by {key:.5f} um at 450 rev/min")
