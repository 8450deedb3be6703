"""
A fit to measured amplitudes
============================

Stiffness, cubic stiffness and damping from 10 noisy amplitudes of Duffing's oscillator, with the derivatives
of the orbits. The standard errors tell what the measurement does not: nothing was measured near the top of
the resonance, and so the damping stays unknown.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import least_squares

import periodic as per
import symbolic as sym

system, swing, names = sym.scene("duffing"), per.PeakToPeak("x"), ["k", "k3", "c"]
measured = np.linspace(0.8, 1.9, 10)


def modelled(values):
    free = dict(zip(names, values, strict=True))
    branch = per.trace(system, "Omega", (0.7, 2.1), start=0.7, values=free, at=list(measured))
    points = branch.labelled("UZ")[: len(measured)]
    slopes = [per.sensitivities(system, p.orbit, {"x": swing})["x"] for p in points]
    return np.array([p.peak_to_peak("x") for p in points]), np.array([[s[n] for n in names] for s in slopes])


truth = modelled([1.0, 1.0, 0.1])[0]
data = truth * (1 + 0.01 * np.random.default_rng(1).standard_normal(len(truth)))
found = least_squares(lambda v: modelled(v)[0] - data, [1.1, 0.9, 0.12], jac=lambda v: modelled(v)[1])
spread = np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)) * 2 * found.cost / (len(data) - len(names)))
for name, value, error in zip(names, found.x, spread, strict=True):
    print(f"{name} = {value:.4f} +- {error:.4f}")
axes = plt.subplots(layout="constrained")[1]
axes.plot(measured, data, "o", measured, modelled(found.x)[0], "-")
axes.set(xlabel="Omega (rad/s)", ylabel="x peak to peak (m)")
key = found.x[0]  # N/m
