"""
All motions at a speed
======================

Below its resonance a gear pair has two stable motions, and a saddle between them. Which one comes depends on
how it starts.
"""

import periodic as per
import symbolic as sym

gears = sym.scene("gear-pair")
box = {"x": (-3, 3), "x'": (-2, 2)}  # where motions start
found = per.motions(gears, {"Omega": 0.7}, box=box, starts=64, periods=2)
print(found)
basins = per.basins(gears, {"Omega": 0.7}, box=box, plane=("x", "x'"), grid=(150, 100), motions=found)
axes = basins.plot()
key = max(abs(motion.point.multipliers[0]) for motion in found.unstable)
print(f"the saddle between them has a multiplier of {key:.6f}")
