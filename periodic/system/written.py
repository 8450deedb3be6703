"""Equations as text, which proofs ask for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from periodic.system.equations import System


class WrittenLike(Protocol):
    """Rates dx/dtau and outputs (SI) as lines of text: see `symbolic.system.written`.

    lines: one for each operation. rates, outputs: names of lines. values: names of the parameters, p0..,
    that occur in them, with their indices. constraint: the line that vanishes, of a system with an unknown.
    """

    @property
    def lines(self) -> Sequence[str]: ...
    @property
    def rates(self) -> Sequence[str]: ...
    @property
    def outputs(self) -> Sequence[str]: ...
    @property
    def constraint(self) -> str | None: ...
    @property
    def values(self) -> Mapping[str, int]: ...


class Writing(System, Protocol):
    """A system that has its equations as text."""

    @property
    def written(self) -> WrittenLike:
        """The text. Raises ValueError where there is none, in one sentence."""
