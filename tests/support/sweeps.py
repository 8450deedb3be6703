"""A made-up sweep of an oscillator, integrated by SciPy, and how it is fitted."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

import periodic as per

AMPLITUDE = per.Amplitude("x")
TRUTH = {"k": 1.05, "k3": 0.9, "c": 0.12}
FREE = {"k": (0.5, 2.0), "k3": (0.2, 3.0), "c": (0.02, 0.4)}
RESPONSE = per.Response("Omega", (0.4, 2.8))


def settled(omega: float, upper: bool, force: float = 0.5) -> complex:
    """First harmonic of the oscillator of TRUTH, integrated from a large or small motion until it repeats."""
    k, k3, c = TRUTH.values()

    def rate(t: float, y: np.ndarray) -> list[float]:
        return [y[1], force * math.cos(omega * t) - c * y[1] - k * y[0] - k3 * y[0] ** 3]

    period = 2 * math.pi / omega
    begin = [2.2, 0.0] if upper else [0.0, 0.0]
    last = solve_ivp(rate, (0, 120 * period), begin, method="DOP853", rtol=1e-9, atol=1e-11).y[:, -1]
    t = np.linspace(0, period, 257)
    motion = solve_ivp(rate, (0, period), last, method="DOP853", rtol=1e-10, atol=1e-12, t_eval=t).y[0]
    wave = np.exp(-1j * omega * t)
    return complex(2 * np.trapezoid(motion * wave, t) / period)


def swept(noise: float, seed: int) -> tuple[list[float], list[float]]:
    """Frequencies and amplitudes of a sweep up along the upper sheet and one down along the lower."""
    rng = np.random.default_rng(seed)
    omegas = [*np.linspace(0.6, 1.8, 9), *np.linspace(2.4, 1.7, 5)]
    found = [abs(settled(w, upper=k < 9)) for k, w in enumerate(omegas)]
    return omegas, (np.array(found) * (1 + noise * rng.standard_normal(len(found)))).tolist()
