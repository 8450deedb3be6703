"""What was measured of a response: points along it, and single numbers such as the place of a fold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from typing import Any

import numpy as np

from periodic.checks import named, number, positive, shown, whole
from periodic.conditions.functionals import Component, Smooth
from periodic.conditions.levels import smooth
from periodic.decisions.responses.quantity import Quantity
from periodic.decisions.responses.response import Response
from periodic.orbit.scheme import Array

PLACE_SIGMA = 1e-4
"""Standard deviation of a place along a response, as a frequency, in parts of it, if none is given."""

SIGMA = 1e-2
"""The same of measured numbers, in parts of the largest: weights, as the scatter is estimated then."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Points measured along a response, on whatever sheet of it, stable or not.

    Parameters
    ----------
    response : Response
        The branch that they are of, with what else was given in the test.
    at : sequence of float
        Where: the response's parameter (SI).
    numbers : mapping of functional to sequence of float
        What was measured there (SI; angles in rad), by what it is of a motion: {Amplitude("x"): [...]}.
    sigma : mapping of functional to float or sequence of float, optional
        Standard deviations of the numbers (SI). Without it they are estimated from what the fit leaves.
    place_sigma : float, optional
        Standard deviation of the places (SI); by default 1e-4 of each.
    gain, offset : bool
        Whether the sensors' scale (1) and zero (0) are unknown too: one for each functional.
    name : str
        What the test is called.

    Raises
    ------
    ValueError
        In one sentence, for numbers that are not finite or not as many as places.
    """

    response: Response
    at: Sequence[float]
    numbers: Mapping[Smooth, Sequence[float]]
    _: KW_ONLY
    sigma: Mapping[Smooth, float | Sequence[float]] | None = None
    place_sigma: float | None = None
    gain: bool = False
    offset: bool = False
    name: str = "measured"
    places: Array = field(init=False, repr=False)
    values: dict[Smooth, Array] = field(init=False, repr=False)
    sigmas: dict[Smooth, Array] = field(init=False, repr=False)
    place_sigmas: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.response, Response):
            raise ValueError(f"response is {shown(self.response)}; it must be a Response(parameter, bounds)")
        places = _numbers("at", self.at)
        low, high = sorted(self.response.bounds)
        for place in places:
            if not low <= place <= high:
                raise ValueError(
                    f"at has {place:g}; it must lie within the response's bounds {low:g} to {high:g}"
                )
        if not (isinstance(self.numbers, Mapping) and self.numbers):
            raise ValueError(f"numbers is {shown(self.numbers)}; it must give numbers by functionals")
        values = {
            smooth(f): _numbers(f"numbers of {f}", given, len(places)) for f, given in self.numbers.items()
        }
        object.__setattr__(self, "places", places)
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "sigmas", {f: self._sigma(f, given) for f, given in values.items()})
        object.__setattr__(self, "place_sigmas", self._place_sigma(places))

    @property
    def scaled(self) -> bool:
        """Whether the scatter is to be estimated."""
        return self.sigma is None

    def loosened(self, part: float) -> Measured:
        """Return the same points with further standard deviations, a part of what all of them span.

        Parameters
        ----------
        part : float
            The part.

        Returns
        -------
        Measured
            The points.
        """
        low, high = sorted(self.response.bounds)
        wide = {f: np.hypot(self.sigmas[f], part * np.ptp(values)) for f, values in self.values.items()}
        found = replace(self, sigma={f: each.tolist() for f, each in wide.items()})
        object.__setattr__(found, "place_sigmas", np.hypot(self.place_sigmas, part * (high - low)))
        return found

    def _sigma(self, functional: Smooth, values: Array) -> Array:
        if self.sigma is None:
            size = 1.0 if getattr(functional, "angle", False) else float(np.abs(values).max())
            return np.full(len(values), SIGMA * (size or 1.0))
        if not isinstance(self.sigma, Mapping) or functional not in self.sigma:
            raise ValueError(
                f"sigma is {shown(self.sigma)}; it must give those of all numbers, by functionals"
            )
        found = np.broadcast_to(np.asarray(self.sigma[functional], dtype=float), values.shape)
        for each in found:
            positive(f"sigma of {functional}", float(each))
        return found

    def _place_sigma(self, places: Array) -> Array:
        if self.place_sigma is not None:
            return np.full(len(places), positive("place_sigma", self.place_sigma))
        low, high = sorted(self.response.bounds)
        return PLACE_SIGMA * np.where(places == 0, high - low, np.abs(places))


@dataclass(frozen=True, eq=False)
class MeasuredQuantity:
    """A single number that was measured of a response: the place of a fold, the height of a peak.

    Parameters
    ----------
    quantity : Quantity
        What it is, as response.place("LP").
    value : float
        What was measured (SI).
    sigma : float
        Its standard deviation (SI).
    """

    quantity: Quantity
    value: float
    sigma: float

    def __post_init__(self) -> None:
        if not isinstance(self.quantity, Quantity):
            raise ValueError(
                f'quantity is {shown(self.quantity)}; it must be one, as response.place("LP") is'
            )
        _numbers("value", [self.value])
        positive("sigma", self.sigma)


def recorded(
    response: Response,
    at: float,
    time: Sequence[float],
    signals: Mapping[str, Sequence[float]],
    *,
    sigma: float,
    orders: int = 5,
    name: str = "recorded",
) -> Measured:
    """Return steady time histories as what was measured at one place: means and harmonics by least squares.

    Parameters
    ----------
    response : Response
        The branch that the motion is of, in the angular frequency of the excitation.
    at : float
        That frequency (rad/s).
    time : sequence of float
        Times in s, from a zero of the phase tau = Omega t of the model's excitation.
    signals : mapping of str to sequence of float
        What was recorded, by the names of outputs (SI).
    sigma : float
        Standard deviation of each value (SI).
    orders : int
        Number of harmonics.
    name : str
        What the test is called.

    Returns
    -------
    Measured
        With a mean and cosine and sine parts of each harmonic as numbers.

    Raises
    ------
    ValueError
        For too few values.
    """
    tau = number("at", at) * _numbers("time", time)
    whole("orders", orders)
    positive("sigma", sigma)
    if len(tau) <= 2 * orders + 1:
        raise ValueError(
            f"time has {len(tau)} values; it must have more than the {2 * orders + 1} numbers sought"
        )
    columns = [np.ones_like(tau)]
    parts: list[tuple[float, float]] = [(0.0, 0.0)]
    for k in range(1, orders + 1):
        columns += [np.cos(k * tau), np.sin(k * tau)]
        parts += [(float(k), 0.0), (float(k), np.pi / 2)]
    matrix = np.stack(columns, axis=1)
    deviations = float(sigma) * np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix)))
    numbers: dict[Any, list[float]] = {}
    sigmas: dict[Any, float] = {}
    for output, values in named("signals", signals, "values").items():
        found = np.linalg.lstsq(matrix, _numbers(f"signal {output}", values, len(tau)))[0]
        for (order, phase), value, deviation in zip(parts, found, deviations, strict=True):
            component = Component(output, order, phase)
            numbers[component], sigmas[component] = [float(value)], float(deviation)
    return Measured(response, [float(at)], numbers, sigma=sigmas, name=name)


def _numbers(name: str, given: Any, count: int | None = None) -> Array:
    """A row of finite numbers. Raises ValueError."""
    try:
        found = np.asarray(given, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} is {shown(given)}; it must be numbers") from None
    if found.ndim != 1 or not len(found):
        raise ValueError(f"{name} is {shown(given)}; it must be a row of numbers")
    if count is not None and len(found) != count:
        raise ValueError(f"{name} has {len(found)} values; it must have {count}, one for each place")
    if not np.isfinite(found).all():
        raise ValueError(f"{name} has {found[~np.isfinite(found)][0]}; all of it must be finite")
    return found
