"""
Two cylinders and their film
============================

The disc as a cylinder: along a line the film is thinner than under a point, yet damps more, and the resonance
bends without a fold.
"""

import math

import periodic as per
import symbolic as sym

rpm = 2 * math.pi / 60
cylinders = sym.scene("line-contact-810N")
branch = per.trace(cylinders, "speed", (200 * rpm, 900 * rpm), start=900 * rpm)
axes = per.plot(branch)
key = 1e6 * branch.peak_to_peak("x").max()  # um
print(f"largest x p-p {key:.4f} um")
