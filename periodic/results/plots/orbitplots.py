"""An orbit over time, in its phase plane, and as a spectrum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.scheme import Array
from periodic.results.plots.frame import dressed, fresh, plain
from periodic.results.plots.units import Shown, Units, quantities
from periodic.results.point import Point
from periodic.system.precision import SMALLEST

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SAMPLES = 1024
"""Values of a signal over a period."""


def plot_orbit(
    orbit: Orbit | Point,
    names: str | Sequence[str] | None = None,
    axes: Axes | None = None,
    *,
    units: Units | None = None,
) -> Axes:
    """Plot signals of an orbit over one period, thin vertical lines where its equations bend or jump.

    Parameters
    ----------
    orbit : Orbit or Point
        The orbit.
    names : str or list of str, optional
        States, their velocities x', unknowns, all in one unit; by default the first state and those in its
        unit.
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own.
    units : dict, optional
        Units by names, "time" among them, as for `plot`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For an equilibrium, names that the orbit has not, and signals in different units.
    """
    found = moving(orbit)
    shown = shown_of(found, units)
    chosen = [names] if isinstance(names, str) else list(names or _alike(found))
    times = np.linspace(0, found.period, SAMPLES + 1)
    signals = {name: found[name](times) for name in chosen}
    unit = shown.unit(chosen[0], np.concatenate(list(signals.values())))
    for name in chosen[1:]:
        other = shown.unit(name, np.concatenate(list(signals.values())))
        if other != unit:
            raise ValueError(
                f"names has {chosen[0]} ({unit.text or '-'}) and {name} ({other.text or '-'}); "
                f"signals in one picture must share their unit"
            )
    clock, axes = shown.unit("time", found.period), fresh(axes)
    for name, values in signals.items():
        axes.plot(times / clock.size, values / unit.size, linewidth=1.8, label=plain(name))
    for phase in np.unique(np.mod(found.phases, found.mesh.period)):
        axes.axvline(
            phase / found.omega / clock.size, color="black", alpha=0.35, linewidth=0.7, linestyle=":"
        )
    axes.set_xlim(0, found.period / clock.size)
    return dressed(axes, clock.label("time"), unit.label(", ".join(chosen)), least=2)


def plot_phase(
    orbit: Orbit | Point,
    across: str | None = None,
    up: str | None = None,
    axes: Axes | None = None,
    *,
    units: Units | None = None,
) -> Axes:
    """Plot an orbit in a phase plane, a dot at the beginning of each period of the excitation.

    Parameters
    ----------
    orbit : Orbit or Point
        The orbit.
    across, up : str, optional
        Any two signals; by default the first state and its velocity in SI units (m/s, not m/rad).
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own.
    units : dict, optional
        Units by names, as for `plot`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For an equilibrium, and names that the orbit has not.
    """
    found = moving(orbit)
    shown = shown_of(found, units)
    first = across or found.names[0]
    second = up or f"{first}'"
    times = np.linspace(0, found.period, SAMPLES + 1)
    x, y = found[first](times), found[second](times)
    horizontal, vertical = shown.unit(first, x), shown.unit(second, y)
    axes = fresh(axes, (5.5, 4.5))
    (line,) = axes.plot(x / horizontal.size, y / vertical.size, linewidth=1.8)
    begun = np.arange(found.periods) * FORCED / found.omega
    at = found[first](begun) / horizontal.size, found[second](begun) / vertical.size
    axes.plot(*at, "o", color=line.get_color(), markersize=6)
    return dressed(axes, horizontal.label(first), vertical.label(second), least=2)


def plot_spectrum(
    orbit: Orbit | Point,
    name: str | None = None,
    axes: Axes | None = None,
    *,
    harmonics: int = 20,
    units: Units | None = None,
) -> Axes:
    """Plot the amplitudes of an orbit's harmonics, on a logarithmic scale.

    An orbit of k periods of the excitation has lines at multiples of 1/k.

    Parameters
    ----------
    orbit : Orbit or Point
        The orbit.
    name : str, optional
        A state, its velocity x', or an unknown; by default the first state.
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own.
    harmonics : int
        Up to which multiple of the excitation's frequency.
    units : dict, optional
        Units by names, as for `plot`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For an equilibrium, a name that the orbit has not, and no harmonics.
    """
    found = moving(orbit)
    shown = shown_of(found, units)
    signal = name or found.names[0]
    orders, amplitudes = spectrum(found, signal, harmonics)
    unit, axes = shown.unit(signal, amplitudes), fresh(axes)
    heights = amplitudes / unit.size
    floor = max(heights.max(initial=0.0) * 1e-9, SMALLEST)
    axes.vlines(orders, floor, np.maximum(heights, floor), color="C0", linewidth=2.5)
    axes.plot(orders, np.maximum(heights, floor), "o", color="C0", markersize=4)
    axes.locator_params("x", integer=True)
    axes.set_yscale("log")
    axes.set_ylim(floor, None)
    return dressed(
        axes, "frequency / frequency of the excitation", unit.label(f"amplitude of {signal}"), least=2
    )


def spectrum(orbit: Orbit, name: str, harmonics: int) -> tuple[Array, Array]:
    """Return multiples of the excitation's frequency up to `harmonics`, and the amplitudes there (SI)."""
    if not isinstance(harmonics, int | np.integer) or harmonics < 1:
        raise ValueError(f"harmonics is {harmonics!r}; it must be a whole number of at least 1")
    periods = max(orbit.periods, 1)
    count = harmonics * periods
    samples = max(SAMPLES, 8 * count)
    values = orbit[name](np.arange(samples) / samples * orbit.period)
    return np.arange(1, count + 1) / periods, 2 * np.abs(np.fft.rfft(values))[1 : count + 1] / samples


def moving(source: Orbit | Point) -> Orbit:
    """Return the orbit that is meant. Raises ValueError for an equilibrium, which has no motion."""
    orbit = source.orbit if isinstance(source, Point) else source
    if not isinstance(orbit, Orbit):
        raise ValueError(f"orbit is {source!r}; it must be an Orbit or a Point of a branch")
    if orbit.equilibrium:
        raise ValueError("orbit is an equilibrium; it has no motion to show")
    return orbit


def shown_of(orbit: Orbit, units: Units | None) -> Shown:
    """Return the units that an orbit's quantities are shown in."""
    if orbit.layout is None:
        raise ValueError("orbit has no names; it must have been traced, or sampled for a system")
    return Shown(quantities(orbit.layout), units)


def _alike(orbit: Orbit) -> list[str]:
    """The first state, and the other displacements in its unit."""
    first = orbit[orbit.names[0]].unit
    names = [name for name in orbit.names if not name.endswith("'") and orbit[name].unit == first]
    return [name for name in names if f"{name}'" in orbit.names] or names[:1]
