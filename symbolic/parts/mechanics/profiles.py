"""Periodic functions of the angle theta = Omega t: what forces, bases and stiffnesses follow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, Protocol

import casadi as ca
import numpy as np

from symbolic.checks import refusal, sequence
from symbolic.equations.assembly import Assembly
from symbolic.equations.excitation import Order, order_of
from symbolic.equations.variables import Value, several


@dataclass(frozen=True)
class Terms:
    """mean + sum of a cos(r theta) + b sin(r theta) over (r, a, b), laid on a workbench."""

    assembly: Assembly
    mean: ca.SX
    waves: tuple[tuple[Fraction, ca.SX, ca.SX], ...]

    @property
    def value(self) -> ca.SX:
        """The function; its mean in the unexcited system."""
        pairs = [(self.assembly.excitation.wave(r), a, b) for r, a, b in self.waves]
        return sum((a * cosine + b * sine for (sine, cosine), a, b in pairs), self.mean)

    @property
    def slope(self) -> ca.SX:
        """Its derivative in theta."""
        pairs = [(self.assembly.excitation.wave(r), float(r), a, b) for r, a, b in self.waves]
        return sum((r * (b * cosine - a * sine) for (sine, cosine), r, a, b in pairs), ca.SX(0))


class Profile(Protocol):
    """A periodic function of theta: a frozen dataclass of numbers that says its harmonics."""

    def terms(self, assembly: Assembly) -> Terms:
        """Return its mean and harmonics.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.

        Returns
        -------
        Terms
            The mean and the harmonics, which can be evaluated and differentiated.
        """
        ...


@dataclass(frozen=True)
class Harmonic(Profile):
    """One harmonic: a cos(r theta + phi).

    Parameters
    ----------
    amplitude : float or Parameter
        a, in the unit of what it stands for.
    order : int, float, str or Fraction
        r, a positive rational number; text as "1/2".
    phase : float or Parameter
        phi in rad.
    """

    amplitude: Value
    order: Order = 1
    phase: Value = 0.0

    def terms(self, assembly: Assembly) -> Terms:
        """Return a cos(phi) and -a sin(phi)."""
        a = assembly.parameter(self.amplitude, "a")
        phi = assembly.parameter(self.phase, "phi", "rad")
        return Terms(assembly, ca.SX(0), ((order_of(self.order), a * ca.cos(phi), -a * ca.sin(phi)),))


@dataclass(frozen=True)
class FourierSeries(Profile):
    """Fourier series: mean + sum over j = 1, 2, ... of a_j cos(j theta) + b_j sin(j theta).

    Parameters
    ----------
    cosines : tuple of float or Parameter
        a_1, a_2, ..., in the unit of what it stands for.
    sines : tuple of float or Parameter
        b_1, b_2, ...; zero where there are none.
    mean : float
        The mean, which stays in the unexcited system.

    Raises
    ------
    ValueError
        For a series without harmonics.
    """

    EXAMPLE: ClassVar[Mapping[str, object]] = {"cosines": [0.1, 0.05]}
    cosines: tuple[Value, ...] = ()
    sines: tuple[Value, ...] = ()
    mean: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "cosines", several("cosines of a FourierSeries", self.cosines))
        object.__setattr__(self, "sines", several("sines of a FourierSeries", self.sines))
        if not self.cosines and not self.sines:
            raise refusal("cosines of a FourierSeries", self.cosines, "at least one number, or sines given")

    def terms(self, assembly: Assembly) -> Terms:
        """Return the harmonics; numbers that are 0 become no parameters."""
        waves = []
        for j in range(max(len(self.cosines), len(self.sines))):
            a = _coefficient(assembly, self.cosines, j, f"a_{j + 1}")
            b = _coefficient(assembly, self.sines, j, f"b_{j + 1}")
            if not (a.is_zero() and b.is_zero()):
                waves.append((Fraction(j + 1), a, b))
        return Terms(assembly, ca.SX(self.mean), tuple(waves))


@dataclass(frozen=True)
class Samples(Profile):
    """Samples of a period: a factor times the trigonometric polynomial through n values at theta = 2 pi i/n.

    Parameters
    ----------
    values : tuple of float
        As measured, evenly over the period, its end left out.
    harmonics : int, optional
        Highest order that is kept; by default all that n values determine, (n - 1)/2.
    factor : float or Parameter
        What the values are multiplied by.

    Raises
    ------
    ValueError
        For fewer than three values, and for more harmonics than they determine.
    """

    EXAMPLE: ClassVar[Mapping[str, object]] = {"values": [0.0, 0.1, -0.1]}
    values: tuple[float, ...]
    harmonics: int | None = None
    factor: Value = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", tuple(sequence("values of Samples", self.values)))
        most = (len(self.values) - 1) // 2
        if most < 1:
            raise refusal("values of Samples", self.values, "at least three numbers")
        if self.harmonics is not None and not 1 <= self.harmonics <= most:
            raise refusal("harmonics of Samples", self.harmonics, f"a whole number from 1 to {most}")

    def terms(self, assembly: Assembly) -> Terms:
        """Return the discrete Fourier transform of the values."""
        factor = assembly.parameter(self.factor, "factor")
        n, kept = len(self.values), self.harmonics or (len(self.values) - 1) // 2
        found = np.fft.rfft(self.values) / n
        least = 1e-15 * float(np.abs(found).max())
        waves = [
            (Fraction(j), factor * 2 * float(found[j].real), -factor * 2 * float(found[j].imag))
            for j in range(1, kept + 1)
            if abs(found[j]) > least
        ]
        return Terms(assembly, factor * float(found[0].real), tuple(waves))


def excited_by(assembly: Assembly, profile: Profile, frequency: Value) -> Terms:
    """Return the terms of a profile, with the frequency of the excitation set to `frequency`, Omega.

    Raises ValueError for what is no profile.
    """
    if not callable(getattr(profile, "terms", None)):
        raise refusal("profile", profile, "a Profile, as Harmonic(1.0) or FourierSeries((1.0, 0.5)) is")
    assembly.excite(assembly.parameter(frequency, "Omega", "rad/s"))
    return profile.terms(assembly)


def _coefficient(assembly: Assembly, given: Sequence[Value], j: int, name: str) -> ca.SX:
    value = given[j] if j < len(given) else 0.0
    return ca.SX(0) if value == 0.0 else assembly.parameter(value, name)
