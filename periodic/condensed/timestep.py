"""One time step of the modes under forces that are constant in it, and what holds sticking joints in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.condensed.modal.moments import Complex
from periodic.orbit.scheme import Array
from periodic.system import ModesLike


@dataclass(frozen=True)
class Step:
    """A time step of modes z under forces f: z+ = grown z + kicked f, x+ = Re(output grown z) + local f."""

    width: float
    grown: Complex
    kicked: Complex
    local: Array

    @classmethod
    def over(cls, width: float, modes: ModesLike) -> Step:
        """Return the step of a width."""
        turned = modes.exponents * width
        with np.errstate(all="ignore"):
            mean = np.where(turned == 0, 1.0, np.expm1(turned) / turned)
        kicked = (width * mean)[:, None] * modes.inputs
        return cls(width, np.exp(turned), kicked, (modes.outputs @ kicked).real + modes.direct)


@dataclass(frozen=True)
class Holding:
    """Fractions of their jumps that hold sticking joints, means over a step of a width; NaN for others."""

    width: float
    parts: Array

    def gives_way(self, before: Holding) -> bool:
        """Whether a fraction, extrapolated from the step before, exceeds 1 at the end of the step."""
        rate = (self.parts - before.parts) / (self.width + before.width)
        return bool((np.abs(self.parts + rate * self.width) > 1).any())
