"""
Whirl of a rotor with internal damping
======================================

Above its critical speed damping inside the shaft drives the rotor round: the orbit loses stability
to a torus.
"""

import periodic as per
import symbolic as sym

rotor = sym.scene("jeffcott-internal-damping")
branch = per.trace(rotor, "n", (1.2, 2.2), start=1.2)
axes = per.plot(branch)
key = branch.labelled("NS")[0].parameter  # speed over the critical one
print(f"torus from {key:.8f} on")
