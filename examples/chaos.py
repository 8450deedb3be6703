"""
Chaos by its exponents
======================

Two wells, forced: neighbouring motions part, by a factor of e in some eight seconds.
"""

import matplotlib.pyplot as plt

import periodic as per
import symbolic as sym

x = sym.coordinate("x")
wells = sym.Mass(x, 1.0) + sym.Damper(x, 0.25) + sym.Spring(x, -1.0) + sym.CubicSpring(x, 1.0)
system = sym.compile(wells + sym.HarmonicForce(x, 0.3, 1.0))
chaos = per.lyapunov(system, periods=2000)
(attractor,) = per.motions(system, starts=8, places=0).stable
axes = plt.subplots(layout="constrained")[1]
axes.plot(*attractor.sections.T, ",")
axes.set(xlabel="x", ylabel="x'", title="once in every period")
print(f"exponents {chaos.values} +- {chaos.errors} 1/s, dimension {chaos.dimension:.2f}")
key = chaos.values.sum()  # 1/s: by how much the plane of states shrinks, whatever the motion
print(f"their sum is {key:.9g}, the damping")
