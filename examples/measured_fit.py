"""
A fit to measured amplitudes
============================

Stiffness, cubic stiffness and damping of Duffing's oscillator from 14 noisy amplitudes on both of its sheets,
which nobody has told apart, and from the speed at which it was seen to jump down: nothing else would tell the
damping, as nothing was measured near the top of the resonance.
"""

import numpy as np

import periodic as per
import symbolic as sym

system, size = sym.scene("duffing"), per.Amplitude("x")
response = per.Response("Omega", (0.4, 2.8))
omegas = [*np.linspace(0.8, 1.9, 9), *np.linspace(2.6, 2.3, 5)]
branch = response.traced(system, {}, at=omegas)
truth = np.array([next(size(system, p.orbit) for p in branch if p.parameter == w) for w in omegas])
noisy = truth * (1 + 0.01 * np.random.default_rng(1).standard_normal(len(truth)))
data = per.Measured(response, omegas, {size: noisy}, sigma={size: 0.01 * truth})
jump = per.MeasuredQuantity(response.place("LP"), 2.21, 0.01)
free = {"k": (0.5, 2.0), "k3": (0.2, 3.0), "c": (0.02, 0.4)}
found = per.fit(system, [data, jump], free, start={"k": 1.2, "k3": 0.8})
print(found)
axes = found.plot()
key = found["k"]  # N/m
