"""
Gear pair
=========

Backlash, a mesh stiffness that varies and a transmission error: below resonance the teeth part, and two
motions are stable.
"""

import periodic as per
import symbolic as sym

gears = sym.scene("gear-pair")
branch = per.trace(gears, "Omega", (0.4, 1.2), start=1.2)
axes = per.plot(branch)
key = branch.labelled("LP")[0].parameter  # mesh frequency over the natural one
print(f"the jump down comes at {key:.9f}")
