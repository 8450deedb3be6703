"""
A rotor from ROSS
=================

Mass, damping, stiffness and gyroscopic matrices of a rotor of the program ROSS, one disc on two bearings:
``sym.ross_matrices(rotor)`` takes them from it; here they come from a file. The Campbell diagram shows where
unbalance meets its natural frequencies, a branch how a hardening bearing answers there.
"""

import numpy as np

import periodic as per
import symbolic as sym

matrices = sym.read_matrices("ross_rotor.npz")
diagram = sym.campbell(matrices, np.linspace(1, 400, 400), count=4)
axes = per.plots.campbell(diagram)
rotor = sym.Structure(matrices, at={"disc": (8, 9), "left": (0, 1)}, damping=0.02)
bearing = sym.CubicSpring(rotor["left"][0], 1e11) + sym.CubicSpring(rotor["left"][1], 1e11)
system = sym.compile(rotor + bearing + sym.Unbalance(*rotor["disc"], m=32.0, eccentricity=2e-5))
branch = per.trace(system, "speed", (90.0, 180.0), start=90.0)
highest = max(branch, key=lambda point: point.peak_to_peak("disc 1"))
print(f"largest motion at {highest.parameter:.1f} rad/s")
key = diagram.critical()[0]  # rad/s
print(f"critical speeds {diagram.critical()} rad/s")
