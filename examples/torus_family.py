"""
A family of tori
================

The whirl of a rotor with damping in its shaft, traced down to the speed at which it is born.
"""

import periodic as per
import symbolic as sym

rotor = sym.scene("jeffcott-internal-damping")
whirl = per.settled_torus(rotor, {"n": 2.0})
family = per.trace(rotor, "n", (1.6, 2.2), guess=whirl)
axes = family.plot()
print(family)
key = per.tori.average(rotor, whirl, lambda s: s["x"] ** 2 + s["y"] ** 2)
print(f"mean square of the whirl at n = 2: {key:.9g}")
