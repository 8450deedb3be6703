"""The spectrum of a motion on a torus: lines at the combinations of both frequencies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from periodic.checks import one_of, whole
from periodic.display.htmltables import with_unit
from periodic.orbit.scheme import Array
from periodic.results.plots.frame import dressed, fresh
from periodic.system import System
from periodic.tori.averages import SAMPLES, surface
from periodic.tori.family import resampled
from periodic.tori.section import Section

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINES = 40
"""Lines that are given."""

DENSER = 4
"""Equispaced angles at which a section in pieces is taken, for each of its own."""

NAMED = 6
"""Lines that a picture names."""


@dataclass(frozen=True, eq=False, repr=False)
class Combinations:
    """The strongest lines of a state, the mean among them, the strongest first.

    Parameters
    ----------
    name, unit : str
        The state and its unit in SI.
    orders : ndarray of int, shape (K, 2)
        k and j: how often both frequencies are in a line's.
    frequencies : ndarray, shape (K,)
        |k omega_1 + j omega_2| in rad/s, both as in `Torus.frequencies`.
    amplitudes : ndarray, shape (K,)
        Amplitudes in SI; of the mean its size.
    """

    name: str
    unit: str
    orders: Array
    frequencies: Array
    amplitudes: Array

    def __repr__(self) -> str:
        strongest = f"{self.amplitudes[0]:.4g} at {self.frequencies[0]:.6g} rad/s"
        return f"Combinations({len(self.orders)} of {self.name}, the strongest {strongest})"

    def plot(self, axes: Axes | None = None) -> Axes:
        """Plot amplitudes over frequency, the strongest lines named by k and j.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Where to plot; by default in a figure of its own.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        axes = fresh(axes)
        least = float(self.amplitudes[self.amplitudes > 0].min())
        axes.vlines(self.frequencies, least / 2, np.maximum(self.amplitudes, least), color="C0")
        axes.set_yscale("log")
        strongest = zip(self.orders[:NAMED], self.frequencies, self.amplitudes, strict=False)
        for (k, j), at, size in strongest:
            axes.annotate(f"{k}, {j}", (at, size), (0, 3), textcoords="offset points", ha="center")
        axes.set_ylim(least / 2, 3 * self.amplitudes.max())
        return dressed(axes, "frequency (rad/s)", with_unit(f"amplitude of {self.name}", self.unit))


def combinations(
    system: System, torus: Section, name: str, *, lines: int = LINES, samples: int = SAMPLES
) -> Combinations:
    """Return the spectrum of a state along the motion on a torus.

    With phi = omega_1 t and theta the angle at t = 0 the state is a sum of c_kj exp(i (k phi + j (theta +
    omega_2 t))), whose coefficients are the Fourier transform over the torus.

    Parameters
    ----------
    system : System
        The equations.
    torus : Section
        The torus.
    name : str
        A state; its velocity x' is dx/dt.
    lines : int
        How many lines, the strongest.
    samples : int
        Phases in a period.

    Returns
    -------
    Combinations
        Frequencies and amplitudes.

    Raises
    ------
    ValueError
        For a name that is no state.
    TorusError
        Where a motion cannot be followed.
    """
    one_of("name", name, [q.name for q in torus.layout.states])
    column = torus.layout.column(name)
    even = torus if not len(torus.breaks) else resampled(torus, DENSER * len(torus.states) + 1, np.zeros(0))
    states = torus.units[name] * surface(system, even, whole("samples", samples, 2))[:, :-1, column.index]
    count = len(states)
    own = np.fft.fftfreq(count, 1 / count)
    along = np.fft.fft(states, axis=0) / count
    turned = along * np.exp(-1j * np.outer(own, torus.rotation * np.arange(samples) / samples))
    found = np.fft.fft(turned, axis=1) / samples
    k, j = np.meshgrid(np.fft.fftfreq(samples, 1 / samples), own)
    first = torus.frequencies[0]
    at = k * first + j * torus.rotation * first / (2 * np.pi)
    once = (j > 0) | ((j == 0) & (k >= 0))
    sizes = np.where((j == 0) & (k == 0), 1.0, 2.0) * np.abs(found)
    order = np.argsort(-sizes[once])[: whole("lines", lines, 1)]
    orders = np.column_stack([k[once][order], j[once][order]]).astype(int)
    return Combinations(name, column.unit, orders, np.abs(at[once][order]), sizes[once][order])
