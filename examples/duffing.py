"""
Duffing's oscillator
====================

A hardening spring bends the resonance until two motions are stable at one frequency.
"""

import periodic as per
import symbolic as sym

x = sym.coordinate("x", unit="m")
system = sym.compile(
    sym.Mass(x, 1.0)
    + sym.Damper(x, 0.1)
    + sym.Spring(x, 1.0)
    + sym.CubicSpring(x, 1.0)
    + sym.HarmonicForce(x, 0.5)
)
branch = per.trace(system, "Omega", (0.3, 3.0))
axes = per.plot(branch)
key = branch.labelled("LP")[0].parameter  # rad/s: the jump of a rising frequency
print(f"jump at {key:.7f} rad/s")
