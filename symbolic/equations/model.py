"""Parts add up to a model with `+`; a model is nothing but its parts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from symbolic.checks import refusal, typed
from symbolic.equations.assembly import Assembly

PART = "Part, as symbolic.Mass(x, 1.0) is"


class Part:
    """One term of the equations of motion; what it adds it says in `contribute`."""

    def contribute(self, assembly: Assembly) -> None:
        """Add this part's forces, states, unknowns, outputs and switches to the assembly."""
        raise NotImplementedError

    def __add__(self, other: Part | Model) -> Model:
        return Model((self,)) + other


@dataclass(frozen=True)
class Model:
    """An ordered collection of parts; the order does not change the equations.

    Parameters
    ----------
    parts : tuple of Part
        What the model is made of.

    Raises
    ------
    ValueError
        For what is no part.
    """

    parts: tuple[Part, ...]

    def __post_init__(self) -> None:
        for part in self.parts:
            typed("part", part, Part, f"a {PART}")

    def __add__(self, other: Part | Model) -> Model:
        if isinstance(other, Model):
            return Model(self.parts + other.parts)
        if isinstance(other, Part):
            return Model((*self.parts, other))
        return NotImplemented


def combine(parts: Iterable[Part]) -> Model:
    """Return the model of any number of parts: what `+` does, for a list.

    Parameters
    ----------
    parts : iterable of Part
        What the model is made of.

    Returns
    -------
    Model
        Their sum.

    Raises
    ------
    ValueError
        For what is no part.
    """
    if not isinstance(parts, Iterable):
        raise refusal("parts", parts, f"a sequence, each a {PART}")
    return Model(tuple(parts))
