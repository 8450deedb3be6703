"""
A proof
=======

A gear pair's orbits at one frequency, among them one that no simulation finds, and both folds between which
they all exist, are shown to be there: see :doc:`../explanation/proof`.
"""

import periodic as per
import symbolic as sym

system = sym.scene("gear-pair")
branch = per.trace(system, "Omega", (0.55, 1.4), start=1.4)
axes = per.plot(branch)
for point in branch.at(Omega=0.7):
    print(per.proved(system, point))
low, high = sorted(per.proved(system, point, "Omega").parameter for point in branch.labelled("LP"))
axes.axvspan(low[1], high[0], alpha=0.2, label="three orbits, proven at its ends")
axes.legend()
key = low[0]  # rad/s
print(f"folds within {low} and {high} rad/s")
