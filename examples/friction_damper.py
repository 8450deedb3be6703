"""
Friction damper
===============

A spring in series with a dry slider on a resonance: too little friction does not damp, too much locks.
"""

import periodic as per
import symbolic as sym

damper = sym.scene("jenkins-damper")
branch = per.trace(damper, "Omega", (0.5, 1.6), start=0.5, at=[1.07])
axes = per.plot(branch)
(there,) = [point for point in branch if point.label == "UZ"]
key = there.peak_to_peak("x")
print(f"x moves by {key:.6f} at Omega = 1.07, near its resonance")
