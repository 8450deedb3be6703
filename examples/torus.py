"""
A torus
=======

Beyond the speed at which damping inside the shaft drives a rotor round, its motion has two frequencies: that
of the shaft, and that of the whirl. Once in every turn of the shaft the rotor is on a closed curve.
"""

import matplotlib.pyplot as plt
import numpy as np

import periodic as per
import symbolic as sym

rotor = sym.scene("jeffcott-internal-damping")
branch = per.trace(rotor, "n", (1.2, 2.2), start=1.2)
born = branch.labelled("NS")[0]
whirl = per.torus(rotor, born, "n", 2.0)
angles = np.linspace(0, 2 * np.pi, 400)
axes = plt.subplots(layout="constrained")[1]
axes.plot(whirl.section("x", angles), whirl.section("y", angles))
axes.plot(whirl.section("x"), whirl.section("y"), "o")
axes.set(xlabel="x", ylabel="y", aspect="equal", title="once in every turn of the shaft, n = 2")
key = whirl.rotation_number  # turns of the whirl in one of the shaft
print(f"{whirl}, error about {whirl.tail:.0e}")
