"""When a motion comes back: its period, from its states at equal times."""

from __future__ import annotations

import numpy as np
import scipy

from periodic.orbit.scheme import Array


def apart(sections: Array, lag: int, unit: Array) -> float:
    """Return how far a motion is from coming back after `lag` sections (K, n), over its last two returns."""
    last = sections[-min(len(sections) - lag, 2 * lag + 2) :]
    before = sections[-lag - len(last) : -lag]
    return float(np.abs((last - before) / unit).max())


def period(sections: Array, most: int, unit: Array, near: float) -> int:
    """Return after how many sections a motion comes back, up to `most`; 0 where it does not.

    Small distances of slowly settling motions shrink with the lag's multiples no further: the least lag whose
    distance is near, and not much larger than that of any longer one, is taken.
    """
    lags = [lag for lag in range(1, most + 1) if 3 * lag + 2 < len(sections)]
    found = np.array([apart(sections, lag, unit) for lag in lags])
    if not len(found) or not found.min() < near:
        return 0
    return lags[int(np.argmax(found < max(10 * found.min(), near / 100)))]


def same(first: Array, second: Array, unit: Array, near: float) -> bool:
    """Return whether two motions, by their sections (p, n) over a period, are one but for a shift."""
    if len(first) != len(second):
        return False
    shifts = (np.roll(second, shift, axis=0) for shift in range(len(second)))
    return any(float(np.abs((first - other) / unit).max()) < near for other in shifts)


def return_time(samples: Array, unit: Array, near: float) -> float:
    """Return after how many samples (K, n) of equal times a motion comes back; NaN where it does not.

    The lag at which the mean distance between the motion and itself later is least, after the first time that
    it has been far, with the least multiples of it left out; between samples by a parabola through squares.
    """
    squares = _squares(samples / unit)
    size = squares.max()
    away = int(np.argmax(squares > 0.25 * size))
    before, at, after = squares[away:-2], squares[away + 1 : -1], squares[away + 2 :]
    bend = before - 2 * at + after
    with np.errstate(invalid="ignore", divide="ignore"):
        lowest = np.where(bend > 0, at - (before - after) ** 2 / (8 * bend), at)
        shift = np.where(bend > 0, 0.5 * (before - after) / bend, 0.0)
    good = np.flatnonzero((before >= at) & (at <= after) & (lowest < near**2 * size))
    if not len(good):
        return float("nan")
    enough = max(4 * float(lowest[good].min()), (near / 10) ** 2 * size)
    k = int(good[np.argmax(lowest[good] < enough)])
    return float(away + k + 2 + shift[k])


def _squares(scaled: Array) -> Array:
    """Mean squared distances of the last half of a motion (K, n) from itself 1, 2, ... samples before."""
    half = len(scaled) // 2
    last = scaled[-half:]
    both = sum(scipy.signal.correlate(x, y, "valid") for x, y in zip(scaled.T, last.T, strict=True))
    cumulated = np.append(0.0, np.cumsum((scaled**2).sum(axis=1)))
    own = cumulated[half:] - cumulated[:-half]
    found = own + own[-1] - 2 * both  # by where the earlier stretch begins
    return np.asarray(np.maximum(found[-2::-1], 0.0) / half)
