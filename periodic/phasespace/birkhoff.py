"""Averages along a motion that tell whether it is quasi-periodic, and its rotation number.

Weighted Birkhoff averages (Das, Saiki, Sander & Yorke, Nonlinearity 30 (2017) 4111) of a quasi-periodic
motion converge faster than any power of its length, those of a chaotic one like the inverse square root: two
halves of a motion agree in many digits, or in few.
"""

from __future__ import annotations

import numpy as np
import scipy

from periodic.orbit.scheme import Array

DIGITS = 5.0
"""Digits to which two halves of a motion must agree on a torus."""


def weights(count: int) -> Array:
    """Return the weights of an average over `count` values, w(t) ~ exp(-1 / (t (1 - t)))."""
    t = np.arange(1, count + 1) / (count + 1)
    found = np.exp(-1 / (t * (1 - t)))
    return np.asarray(found / found.sum())


def averages(sections: Array, unit: Array) -> Array:
    """Return averages of cosines and sines of the states (K, n), whose phases one unit turns by a radian."""
    turned = np.exp(1j * sections / unit)
    found = weights(len(sections)) @ turned
    return np.concatenate([found.real, found.imag])


def digits(sections: Array, unit: Array) -> float:
    """Return to how many digits averages over both halves of a motion (K, n) agree."""
    half = len(sections) // 2
    off = np.abs(averages(sections[:half], unit) - averages(sections[half:], unit)).max()
    return float(-np.log10(max(off, 1e-16)))


def rotation_number(sections: Array, unit: Array) -> float:
    """Return the rotation number of a torus' section (K, n), in (0, 1/2]: turns in a period.

    Known but for its sign and whole turns, as a section at one phase tells no more. The strongest line of the
    spectrum, refined by maximising its weighted amplitude (Laskar, Physica D 67 (1993) 257).
    """
    count = len(sections)
    window = weights(count)[:, None]
    column = int(np.argmax((sections / unit).std(axis=0)))
    values = (sections[:, column] - (window[:, 0] @ sections[:, column])) / unit[column]
    spectrum = np.abs(np.fft.rfft(values * window[:, 0], 4 * count))
    peak = int(np.argmax(spectrum[1:])) + 1
    turns = np.arange(count)

    def weaker(frequency: float) -> float:
        return -float(np.abs((window[:, 0] * values) @ np.exp(-2j * np.pi * frequency * turns)))

    near = (peak - 1) / (4 * count), (peak + 1) / (4 * count)
    found = scipy.optimize.minimize_scalar(weaker, bounds=near, method="bounded", options={"xatol": 1e-13})
    return float(min(found.x, 1 - found.x))
