"""The root of a function between two places where its signs differ.

Bisection and inverse parabolas: Chandrupatla, Adv. Eng. Softw. 28 (1997) 145.
"""

from __future__ import annotations

from collections.abc import Callable

RELATIVE = 1e-12
"""Relative precision of a root, added to the absolute one that is given."""


def root(function: Callable[[float], float], begin: float, end: float, precision: float) -> float:
    """Return a place where a function is 0, at which it was evaluated.

    Parameters
    ----------
    function : callable
        The function; its signs at both ends differ, or one of them is 0.
    begin, end : float
        The ends.
    precision : float
        How near to the root the place is to be.

    Returns
    -------
    float
        The place, from begin to end.
    """
    a, b = begin, end
    at_a, at_b = function(a), function(b)
    if at_a == 0 or at_b == 0:
        return a if at_a == 0 else b
    part = at_a / (at_a - at_b)
    while True:
        place = a + part * (b - a)
        value = function(place)
        if (value > 0) == (at_a > 0):
            c, at_c = a, at_a
        else:
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = place, value
        best, least = (a, at_a) if abs(at_a) < abs(at_b) else (b, at_b)
        limit = (RELATIVE * abs(best) + precision) / abs(b - a)
        if limit > 0.5 or least == 0:
            return best
        xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        if phi**2 < xi and (1 - phi) ** 2 < 1 - xi:  # the inverse parabola is safe
            part = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            part += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        else:
            part = 0.5
        part = min(1 - limit, max(limit, part))
