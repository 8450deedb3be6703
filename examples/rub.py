"""
A rotor that rubs
=================

A Jeffcott rotor under its weight touches its stator, and is held back by friction.
"""

import periodic as per
import symbolic as sym

rotor = sym.scene("jeffcott-rub")
branch = per.trace(rotor, "speed", (0.2, 2.0), start=0.2)
axes = per.plot(branch)
key = branch.labelled("LP")[0].parameter
print(f"with contact all round up to a speed of {key:.8f}; {branch.stop}")
