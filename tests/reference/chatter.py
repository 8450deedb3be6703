"""A mass that bounces on a wall under a load, and comes to rest there, by closed-form flights.

y'' + k y = F cos(tau) - g, y >= 0, y' becomes -e y' at 0. Impacts without number end in finite time, and the
mass rests while F cos(tau) < g. Shares nothing with `periodic` and `symbolic`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from reference.integration import TWO_PI, Array

SLOW = 1e-6
"""Speed below which the rest of a sequence is its geometric limit."""

SAMPLES = 2000
"""Places of a period at which a flight is looked at; a short one is looked at as closely."""


@dataclass(frozen=True)
class Chatter:
    """The machine: spring k, load g, force F, restitution e."""

    k: float
    g: float
    force: float
    e: float

    @property
    def release(self) -> float:
        """The phase at which what rests leaves the wall: there F cos(tau) rises to g."""
        return TWO_PI - float(np.arccos(self.g / self.force))

    def flight(self, begin: float, speed: float, at: Array) -> Array:
        """Return (y, y') of a flight that begins on the wall with a speed."""
        w, big = np.sqrt(self.k), self.force / (self.k - 1)
        y0 = -(big * np.cos(begin) - self.g / self.k)
        v0 = speed + big * np.sin(begin)
        free = y0 * np.cos(w * (at - begin)) + v0 / w * np.sin(w * (at - begin))
        rate = -y0 * w * np.sin(w * (at - begin)) + v0 * np.cos(w * (at - begin))
        return np.array([free + big * np.cos(at) - self.g / self.k, rate - big * np.sin(at)])

    def landing(self, begin: float, speed: float) -> tuple[float, float]:
        """Return when a flight ends, and the speed with which it does."""
        pressed = self.g - self.force * np.cos(begin)
        brief = 2 * speed / pressed if pressed > 0 and speed > 0 else np.inf
        span = min(TWO_PI, 2 * brief)
        at = begin + span * np.linspace(0, 1, SAMPLES + 1)[1:]
        down = self.flight(begin, speed, at)[0] < 0
        early = at < begin + (brief / 2 if brief < span else 0.0)  # a slow flight begins within rounding
        below = np.flatnonzero(down & ~early)
        first = below[0] if speed > 0 else below[below > 0][0]
        when = brentq(lambda t: float(self.flight(begin, speed, np.array(t))[0]), at[first - 1], at[first])
        return when, -float(self.flight(begin, speed, np.array(when))[1])

    def impacts(self) -> tuple[list[float], float]:
        """Return the phases of the impacts after the release, and that at which the mass is at rest."""
        at, speed, found = self.release, 0.0, list[float]()
        while True:
            at, arriving = self.landing(at, speed)
            speed = self.e * arriving
            found.append(at)
            if speed < SLOW:
                return found, at + 2 * speed / ((self.g - self.force * np.cos(at)) * (1 - self.e))
