"""Parts add up to a model with `+`; a model is nothing but its parts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from symbolic.equations.assembly import Assembly


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
    """

    parts: tuple[Part, ...]

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
    """
    return Model(tuple(parts))
