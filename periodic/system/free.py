"""Systems that can be let go: without excitation, their free vibrations kept up by a negative damping."""

from __future__ import annotations

from typing import Protocol

from periodic.system.equations import System

DAMPING = "modal damping"
"""Name of the parameter xi (1/s): inertia M brings the force xi M q' besides."""

SIZE = "modal amplitude"
"""Name of the parameter that no equation has, for a condition to compare an amplitude with."""

KINETIC = "twice the kinetic energy"
"""Name of the output q' M q' (J): times xi it is the power of that force."""


class Releasable(System, Protocol):
    """A system that has masses."""

    def let_go(self) -> System:
        """Return it without excitation, with the parameters modal damping and modal amplitude."""
