"""Mathieu's equation, by hand in NumPy."""

from __future__ import annotations

import numpy as np

from support.numpy_systems import Array, LinearOscillator


class Mathieu(LinearOscillator):
    """Omega^2 x'' + (1 - 2 depth cos tau) x = 0: Mathieu with a = 4/Omega^2, q = 4 depth/Omega^2."""

    def __init__(self, depth: float) -> None:
        super().__init__(zeta=0.0, F=0.0)
        self.depth = depth

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """r, dr/dx, dr/dtau."""
        stiffness = 1 - 2 * self.depth * np.cos(phase)
        return stiffness * x, stiffness, 2 * self.depth * np.sin(phase) * x
