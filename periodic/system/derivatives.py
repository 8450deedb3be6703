"""Second derivatives, which curves of special points ask for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, cast

from periodic.system.arrays import Array
from periodic.system.equations import LinearisationLike, System


class GradientLike(Protocol):
    """A gradient at N points: rate, state (N, n), algebraic (N, m), phase (N,), parameter (N, p)."""

    @property
    def rate(self) -> Array: ...
    @property
    def state(self) -> Array: ...
    @property
    def algebraic(self) -> Array: ...
    @property
    def phase(self) -> Array: ...
    @property
    def parameter(self) -> Array: ...


class Differentiable(System, Protocol):
    """A system with derivatives of its outputs and second derivatives: asked for by curves of special points.

    `curvature` gives gradients of w . (R_x' v_x' + R_x v_x + R_z v_z + R_p v_p), at fixed weights w (N, n+m)
    and directions v; v_p has shape (p,).
    """

    def output_gradient(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> LinearisationLike:
        """Outputs in SI units as `residual`, and their derivatives."""

    @property
    def curvature(self) -> Callable[..., GradientLike]:
        """(x', x, z, tau, p, w, v_x', v_x, v_z, v_p) -> gradient."""


def differentiable(system: System) -> Differentiable:
    """Return the system as one with second derivatives. Raises ValueError if it has none."""
    missing = [n for n in ("output_gradient", "curvature") if not hasattr(system, n)]
    if missing:
        raise ValueError(
            f"system is a {type(system).__name__} without {', '.join(missing)}; this needs a Differentiable "
            f"one (symbolic.compile makes one of a model)"
        )
    return cast(Differentiable, system)
