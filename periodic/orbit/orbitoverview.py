"""What a notebook shows of an orbit: sizes of its signals, and a small picture of the first over a period."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from periodic.display.htmltables import beside, paragraph, table, with_unit
from periodic.display.sketch import Line, sketch
from periodic.orbit.signal import Signal

SAMPLES = 400
"""Times at which the signals are read."""

MOST_SIGNALS = 12
"""Largest number of signals in the table."""


def orbit_html(said: str, signals: Sequence[Signal], period: float) -> str:
    """Return an orbit as HTML.

    Parameters
    ----------
    said : str
        A line about the orbit.
    signals : sequence of Signal
        Its states and unknowns.
    period : float
        Its period in s.

    Returns
    -------
    str
        The line, a table of least and largest values, and a picture.
    """
    times = np.linspace(0.0, period, SAMPLES)
    read = [(signal, signal(times)) for signal in signals[:MOST_SIGNALS]]
    rows = [
        [with_unit(signal.name, signal.unit), *(f"{v:.6g}" for v in (y.min(), y.max(), np.ptp(y)))]
        for signal, y in read
    ]
    first, values = read[0]
    picture = sketch([Line(times, values)], [], "t (s)", with_unit(first.name, first.unit))
    return paragraph(said) + beside(table(["", "least", "largest", "p-p"], rows), picture)
