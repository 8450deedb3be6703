"""
Elastic stop
============

A mass that strikes a stop: the resonance stiffens, and the branch folds.
"""

import periodic as per
import symbolic as sym

stop = sym.scene("stop")
branch = per.trace(stop, "Omega", (0.7, 1.8), start=0.7)
axes = per.plot(branch)
key = branch.labelled("LP")[0].parameter
print(f"fold at {key:.8f}")
