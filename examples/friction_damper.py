"""
Friction damper
===============

A spring in series with a dry slider on a resonance: too little friction does not damp, too much locks.
"""

import periodic as per
import symbolic as sym

damper = sym.scene("jenkins-damper")
branch = per.trace(damper, "Omega", (0.5, 1.6), start=0.5)
axes = per.plot(branch)
key = branch.peak_to_peak("x").max()
print(f"largest motion {key:.6f}")
