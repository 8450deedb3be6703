"""What is no orbit and traces itself, as a torus does: `trace` takes it as a guess."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, TypeVar, runtime_checkable

from periodic.checks import shown
from periodic.correction.tolerance import Accuracy
from periodic.system import System

R_co = TypeVar("R_co", covariant=True)


@runtime_checkable
class Traceable(Protocol[R_co]):
    """A motion that is no orbit."""

    def traced(
        self,
        system: System,
        parameter: str,
        bounds: tuple[float, float],
        *,
        start: float | None = None,
        at: float | Sequence[float] = (),
        values: Mapping[str, float] | None = None,
    ) -> R_co:
        """Return what `trace` returns for it, of the arguments that it takes."""


def alone(guess: Traceable[object], **settings: object) -> None:
    """Refuse settings that are for orbits. Raises ValueError."""
    for name, value in settings.items():
        if value is not None and not (name == "tol" and value == Accuracy.STANDARD):
            raise ValueError(
                f"{name} is {shown(value)}; with a {type(guess).__name__} as a guess it must be left out"
            )
