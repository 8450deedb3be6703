"""Parts add up to a model with `+`; a model is nothing but its parts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from symbolic.checks import refusal, text, typed
from symbolic.equations.assembly import Assembly
from symbolic.equations.tex.rows import equations
from symbolic.equations.variables import Parameter
from symbolic.tables import listed

PART = "Part, as symbolic.Mass(x, 1.0) is"


class Part:
    """One term of the equations of motion; its method `contribute` adds it.

    A class may have `EXAMPLE`: values of its fields, as in a text scene, where 1.0 is none to begin with.
    """

    EXAMPLE: ClassVar[Mapping[str, object]] = {}

    @property
    def owner(self) -> str:
        """Suffix of the parameters made of its bare numbers: names of its coordinates or contact."""
        values = [getattr(self, name) for name in getattr(self, "__dataclass_fields__", {})]
        places = [item for value in values for item in (value if isinstance(value, tuple) else (value,))]
        named = [p for p in places if not isinstance(p, Parameter)]
        return "_".join(p.name for p in named if isinstance(getattr(p, "name", None), str))

    def named(self, name: str) -> Named:
        """Return the part with a name by which its numbers are called where that is needed.

        Parameters
        ----------
        name : str
            As "left", for k_left.

        Returns
        -------
        Named
            The same part.
        """
        return Named(self, text("name of a part", name))

    def contribute(self, assembly: Assembly) -> None:
        """Add this part's forces, states, unknowns, outputs and switches to the assembly."""
        raise NotImplementedError

    def __add__(self, other: Part | Model) -> Model:
        return Model((self,)) + other

    def __radd__(self, other: object) -> Model:
        return Model((self,)) if other == 0 else NotImplemented  # sum() begins with 0


@dataclass(frozen=True)
class Named(Part):
    """A part with a name, which distinguishes the parameters of several parts of one kind.

    Parameters
    ----------
    part : Part
        The part.
    name : str
        Its name.
    """

    part: Part
    name: str

    @property
    def owner(self) -> str:
        """The name."""
        return self.name

    def contribute(self, assembly: Assembly) -> None:
        """Add what the part adds."""
        self.part.contribute(assembly)


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
        For what is no part, and for none at all.
    """

    parts: tuple[Part, ...]

    def __post_init__(self) -> None:
        if not isinstance(self.parts, Iterable) or not (parts := tuple(self.parts)):
            raise refusal("parts", self.parts, f"a sequence of at least one {PART}")
        for part in parts:
            typed("part", part, Part, f"a {PART}")
        object.__setattr__(self, "parts", parts)

    def __repr__(self) -> str:
        return f"Model({listed(type(part).__name__ for part in self.parts)})"

    @property
    def latex(self) -> str:
        """The equations of motion, in SI units and time, as LaTeX for a mathematical display."""
        return equations(self.parts)

    def _repr_latex_(self) -> str:
        return f"$$\n{self.latex}\n$$"

    def __add__(self, other: Part | Model) -> Model:
        if isinstance(other, Model):
            return Model(self.parts + other.parts)
        if isinstance(other, Part):
            return Model((*self.parts, other))
        return NotImplemented

    def __radd__(self, other: object) -> Model:
        return self if other == 0 else NotImplemented


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
