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


LEAST = 1e-6
"""Weakest line that is one, in units of the states."""


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
    return float(lines(sections, unit, 1)[0])


def lines(states: Array, unit: Array, count: int) -> list[float]:
    """Return the strongest lines of a motion (K, n) at equal times, in turns from one to the next, (0, 1/2].

    Each is subtracted before the next is looked for, in the state that has it most.
    """
    window = weights(len(states))
    values = (states - window @ states) / unit
    turns, found = np.arange(float(len(states))), list[float]()
    for _ in range(count):
        spectrum = np.abs(np.fft.rfft(values * window[:, None], 4 * len(values), axis=0))[1:]
        place, column = np.unravel_index(int(spectrum.argmax()), spectrum.shape)
        if not spectrum[place, column] > LEAST:
            break
        near = place / (4 * len(values)), (place + 2) / (4 * len(values))
        line = _refined(values[:, column] * window, turns, near)
        wave = np.exp(2j * np.pi * line * turns)
        amplitude = (window * wave.conj()) @ values
        values = values - 2 * np.real(np.multiply.outer(wave, amplitude))
        found.append(min(line, 1 - line))
    return found


def _refined(weighted: Array, turns: Array, near: tuple[float, float]) -> float:
    """The frequency in a range at which a weighted signal's amplitude is largest."""

    def weaker(frequency: float) -> float:
        return -float(np.abs(weighted @ np.exp(-2j * np.pi * frequency * turns)))

    found = scipy.optimize.minimize_scalar(weaker, bounds=near, method="bounded", options={"xatol": 1e-13})
    return float(found.x)
