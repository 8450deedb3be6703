"""
A mode with a joint
===================

Frequency and damping of free vibrations over their amplitude, of a mass with a Jenkins joint: the joint
holds up to an amplitude of 0.8, and then slips.
"""

import matplotlib.pyplot as plt

import periodic as per
import symbolic as sym

x = sym.coordinate("x")
joint = sym.Jenkins(x, 0.25, 0.2)
system = sym.compile(
    sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.01) + joint + sym.HarmonicForce(x, 0.1)
)
mode = per.mode_branch(system, "x", (0.5, 4.0))
figure, (axes, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
axes.plot(mode.values, [point.orbit.omega for point in mode])
below.plot(*mode.curve("damping ratio"))
axes.set(ylabel="frequency (rad/s)")
below.set(xlabel="amplitude of x", ylabel="damping ratio")
key = max(point.columns["damping ratio"] for point in mode)
print(f"highest damping ratio {key:.4f}")
