"""
Where the jump begins
=====================

The fold of Duffing's oscillator in the plane of frequency and force ends in a cusp: below that force the
response has one value at every frequency.
"""

import matplotlib.pyplot as plt

import periodic as per
import symbolic as sym

system = sym.scene("duffing")
fold = per.trace(system, "Omega", (0.8, 2.5), start=0.8).labelled("LP")[0]
border = per.trace(system, "Omega", (0.9, 3.0), guess=fold.orbit, determined={"F": per.FoldCondition()})
cusp = border.labelled("CP")[0]

_, axes = plt.subplots(layout="constrained")
axes.plot(border.values, border.column("F"))
axes.plot(cusp.parameter, border.column("F").min(), "o")
axes.set(xlabel="Omega (rad/s)", ylabel="F (N)", title="two stable motions above the curve")
key = border.column("F").min()  # N
print(f"cusp at {cusp.parameter:.7f} rad/s, {key:.7f} N")
