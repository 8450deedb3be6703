"""
Everything over a parameter
===========================

All branches that the motions of a gear pair lie on, and how likely each is: between the jumps the share
of one in which the teeth part falls from all to nothing.
"""

import periodic as per
import symbolic as sym

gears = sym.scene("gear-pair")
box = {"x": (-3, 3), "x'": (-2, 2)}
atlas = per.atlas(gears, "Omega", (0.56, 0.96), box=box, count=5, diagram=40, starts=40, periods=2, places=8)
axes = atlas.plot().axes[0]
print(atlas)
key = atlas.sheets[0].branch.labelled("LP")[1].parameter
print(f"below {key:.9g} there is one motion alone")
