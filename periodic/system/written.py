"""Equations as text, which proofs ask for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from periodic.system.equations import System


class WrittenLike(Protocol):
    """Rates dx/dtau and outputs (SI) as lines of text: see `symbolic.system.written`.

    lines: one for each operation. rates, outputs: names of lines. values: names of the parameters, p0..,
    that occur in them, with their indices. constraint: the line that vanishes, of a system with an unknown.
    resets: by the line max(s, 0) of a wall, which a motion stays before, the names of the states after an
    impact. impacts: the indices of the walls' switches by these lines.
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
    def resets(self) -> Mapping[str, Sequence[str]]: ...
    @property
    def impacts(self) -> Mapping[str, int]: ...
    @property
    def values(self) -> Mapping[str, int]: ...


class Writing(System, Protocol):
    """A system that has its equations as text."""

    @property
    def written(self) -> WrittenLike:
        """The text. Raises ValueError where there is none, in one sentence."""
