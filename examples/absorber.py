"""
An absorber of least peak
=========================

Stiffness and damping of an absorber, a twentieth of the mass that it calms, so that the highest peak of a
cubic oscillator is least: two peaks of one height, and what each would gain from a softer or harder
absorber.
"""

import periodic as per
import symbolic as sym

x, y = sym.coordinate("x"), sym.coordinate("y")
model = sym.Mass(x, 1.0) + sym.Spring(x, sym.Parameter("k1", 1.0)) + sym.Damper(x, sym.Parameter("c1", 0.002))
model += sym.CubicSpring(x, sym.Parameter("knl1", 1.0)) + sym.HarmonicForce(
    x, 0.05, sym.Parameter("Omega", 0.6)
)
model += sym.Mass(y, 0.05) + sym.Spring(y, sym.Parameter("k2", 0.045), to=x)
model += sym.Damper(y, sym.Parameter("c2", 0.013), to=x) + sym.CubicSpring(
    y, sym.Parameter("knl2", 0.004), to=x
)
system, response = sym.compile(model), per.Response("Omega", (0.6, 1.8))
free = {"k2": (0.03, 0.06), "c2": (0.004, 0.03), "knl2": (0.0, 0.01)}
best = per.optimise(system, free, minimise=response.highest(per.PeakToPeak("x")))
print(best)
axes = per.plot(best.branches[0], "x")
key = best.objective  # m
