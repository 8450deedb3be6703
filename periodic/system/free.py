"""Systems that can be let go: without excitation, their free vibrations kept up by a negative damping."""

from __future__ import annotations

from typing import Protocol

from periodic.system.equations import System

DAMPING = "xi"
"""Name of the parameter xi (1/s): inertia M brings the force xi M q' besides."""

SIZE = "amplitude"
"""Name of the parameter that no equation has, for a condition to compare an amplitude with."""

KINETIC = "twice the kinetic energy"
"""Name of the output q' M q' (J): times xi it is the power of that force."""


class Releasable(System, Protocol):
    """A system that has masses."""

    def let_go(self) -> System:
        """Return the system without excitation, with the parameters xi and amplitude and q' M q'."""
