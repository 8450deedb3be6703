"""Linearised motions of a split system about an orbit that are multiplied by a number over the period.

With G_mu the map from forces with f(T) = mu f(0) to the places, its modes closed by 1/(mu - exp(lambda T)),

    K_mu (f, s) = f - F'(G_mu f, s),  s' - S'(G_mu f, s),

is singular just where mu is a Floquet multiplier. Its gradient in the orbit is exact, from derivatives of G
and second derivatives of the system's rows, but for differences of G in parameters that the motion changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.condensed.coupled import Coupled, folded
from periodic.condensed.linearised import SplitLinearisation, answer
from periodic.condensed.modal.flexibility import Flexibility
from periodic.condensed.modal.moments import Complex
from periodic.condensed.modal.slopes import slopes
from periodic.linear.variation import Tangent
from periodic.orbit.gradients import Points, Slopes, collocation_points, gathered, solved
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import LinearisationLike, System, differentiable
from periodic.system.precision import difference_step

PARAMETER_STEP = difference_step(order=2)
"""Relative step in parameters for central differences of the linear part."""


@dataclass(frozen=True)
class CondensedRepeating:
    """See `periodic.linear.variation.Repeating`; u holds active forces and own states as in `Coupled`.

    Parameters
    ----------
    system : System
        The equations.
    given : SplitLinearisation
        The system about the orbit, with all modes.
    free : tuple of int
        Parameters that the motions may change; only where the multiplier is 1.
    mu : complex
        The multiplier.
    """

    system: System
    given: SplitLinearisation
    free: tuple[int, ...]
    mu: complex

    @cached_property
    def coupled(self) -> Coupled:
        """The equations of forces and own states."""
        given = self.given
        flexibility = Flexibility.repeating(given.response, self.mu)
        return Coupled(given, flexibility, wraps=1.0 if self.mu == 1.0 else 1 / self.mu)

    @property
    def matrix(self) -> Array:
        """K_mu, with the columns of the free parameters."""
        if not self.free:
            return self.coupled.matrix
        first = 1 + len(self.given.orbit.phases)
        return np.concatenate([self.coupled.matrix, -self.coupled.right[:, first:]], axis=1)

    @property
    def slope(self) -> Complex:
        """The derivative of K_mu in mu."""
        response = self.given.response
        still = Coupled(self.given, Flexibility(response, past=False), wraps=0.0).matrix
        change = Flexibility.by_multiplier(response, self.mu)
        found = Coupled(self.given, change, wraps=-1 / self.mu**2).matrix - still
        return found.astype(np.complex128)

    def functional(self, row: Row) -> Array:
        """Return a row as a functional of (u, v_y)."""
        orbit = self.given.orbit
        inner, outer = self.coupled.restricted([folded(orbit, row, (1 / self.mu).real)])
        return np.concatenate([inner[0], outer[0, 1 + len(orbit.phases) :]])

    def tangent(self, unknown: Array) -> Tangent:
        """Return the motion of (u, v_y)."""
        orbit, size = self.given.orbit, self.coupled.size
        head = np.zeros(1 + len(orbit.phases))
        given = np.concatenate([head, unknown[size:]])
        stages = self.coupled.stages(unknown[:size, None], given[:, None]).reshape(orbit.stages.shape)
        nodes = np.concatenate([stages[-1:, -1] / self.mu, stages[:, -1]])
        parameter = np.zeros_like(orbit.parameter)
        parameter[list(self.free)] = unknown[size:].real
        points, n = self.coupled.points, self.coupled.n
        columns = [np.zeros((points, 1)), self._rates(nodes, stages), stages.reshape(points, n)]
        columns.append(np.tile(np.concatenate([head[1:], unknown[size:]]), (points, 1)))
        unknowns = np.einsum("pmw,pw->pm", self.given.local.unknowns, np.concatenate(columns, axis=1))
        return Tangent(nodes, stages, unknowns.reshape(orbit.algebraic.shape), parameter)

    def _rates(self, nodes: Array, stages: Array) -> Array:
        """Rates at the points, (P, n)."""
        orbit = self.given.orbit
        knots = np.concatenate([nodes[:-1, None], stages], axis=1)
        rates = orbit.mesh.scheme.stage_rates @ knots / orbit.grid.width[:, None, None]
        return np.asarray(rates.reshape(-1, nodes.shape[1]))

    def gradient(self, unknown: Array, left: Array, source: Row | None, free: tuple[int, ...]) -> Row:
        """Return the real part of the gradient of left . K_mu (u, v_y) + source . v."""
        orbit, tangent = self.given.orbit, self.tangent(unknown)
        points = collocation_points(orbit)
        line = self.system.linearise(*points.arguments(orbit), ())
        weights, pull = self._adjoint(line, left, source)
        rates = self._rates(tangent.nodes, tangent.stages)
        row = self._bent(points, weights, rates, tangent, pull, free)
        outer, k = row.outer, len(orbit.phases)
        slow = np.einsum("pr,prn,pn->p", weights, line.d_rate, rates).real
        relative = orbit.grid.width_gradient / orbit.grid.width[:, None]
        outer[:k] -= slow @ relative[points.index]
        outer += self._softer(tangent, pull, free)
        return Row(row.value, row.nodes, outer, row.stages)

    def _adjoint(self, line: LinearisationLike, left: Array, source: Row | None) -> tuple[Array, Array]:
        """Weights of all rows (P, n+m), and of the linear part's states (P, s)."""
        given, coupled = self.given, self.coupled
        n, forces = coupled.n, np.array(given.part.forces)
        own = np.zeros((coupled.points, n), dtype=left.dtype)
        own[:, given.local.rows] = left[coupled.count : coupled.size].reshape(coupled.points, -1)
        onto = np.einsum("pr,prm->pm", own, line.d_algebraic[:, :n])
        onto[coupled.at[:, None], forces[coupled.active]] -= left[: coupled.count].reshape(
            len(coupled.at), -1
        )
        weights = _solved(line, onto)
        pull = np.einsum("pr,prn->pn", own, line.d_state[:, :n])
        pull += np.einsum("pm,pmn->pn", weights, line.d_state[:, n:])
        if source is not None:
            pull = pull + folded(given.orbit, source, (1 / self.mu).real)[0]
        pull = pull[:, coupled.places]
        by_force = coupled.flexibility.pulled(self._by_interval(pull))
        driven = np.where(coupled.passive, by_force.reshape(coupled.points, -1), 0.0)
        onto = np.zeros_like(onto, dtype=driven.dtype)
        onto[:, forces] = driven
        return np.concatenate([own, weights + _solved(line, onto)], axis=1), pull

    def _bent(
        self,
        points: Points,
        weights: Array,
        rates: Array,
        tangent: Tangent,
        pull: Array,
        free: tuple[int, ...],
    ) -> Row:
        """Second derivatives of the system's own rows and, where v_y is not 0, `_stiffer` for its forces."""
        orbit, m = self.given.orbit, self.given.orbit.algebraic.shape[2]
        stages, algebraic = tangent.stages.reshape(rates.shape), tangent.algebraic.reshape(-1, m)
        parts = []
        for part in ("real", "imag") if np.iscomplexobj(weights) or np.iscomplexobj(rates) else ("real",):
            along = [np.ascontiguousarray(getattr(a, part)) for a in (weights, rates, stages, algebraic)]
            parameter = tangent.parameter if part == "real" else np.zeros_like(tangent.parameter)
            found = differentiable(self.system).curvature(*points.arguments(orbit), *along, parameter)
            parts.append(Slopes.of(found, free))
        slopes = parts[0] if len(parts) == 1 else _difference(*parts)
        if tangent.parameter.any():
            slopes.algebraic[:, list(self.given.part.forces)] += self._stiffer(tangent, pull)
        return gathered(self.system, orbit, points, slopes, free)

    def _softer(self, tangent: Tangent, pull: Array, free: tuple[int, ...]) -> Array:
        """Derivatives of `pull` . the response to the tangent's forces, in phases and parameters, (k+q,)."""
        given, orbit = self.given, self.given.orbit
        stretch = orbit.grid.width_gradient
        forces = np.ascontiguousarray(tangent.algebraic[:, :, list(given.part.forces)])
        response, changes = answer(self.system, orbit, orbit.parameter, free)
        found = slopes(response, forces, stretch, changes, self.mu)[0]
        weights = pull.reshape(found.shape[:3])
        total = np.einsum("nas,nasq->q", weights, found).real
        if tangent.parameter.any():
            size, ends = self._step(tangent), []
            for step in (size, -size):
                beside, changed = answer(self.system, orbit, orbit.parameter + step * tangent.parameter, free)
                ends.append(
                    np.einsum("nas,nasq->q", weights, slopes(beside, given.forces, stretch, changed)[0])
                )
            total = total + (ends[0] - ends[1]) / (2 * size)
        return np.asarray(total)

    def _stiffer(self, tangent: Tangent, pull: Array) -> Array:
        """Derivative along v_y of the flexibility's adjoint times `pull`: weights of forces, (P, k)."""
        orbit = self.given.orbit
        size, ends = self._step(tangent), []
        for step in (size, -size):
            beside, _ = answer(self.system, orbit, orbit.parameter + step * tangent.parameter, ())
            ends.append(Flexibility.repeating(beside).pulled(self._by_interval(pull)))
        found: Array = np.asarray((ends[0] - ends[1]) / (2 * size)).reshape(len(pull), -1)
        return found

    def _by_interval(self, pull: Array) -> Array:
        """Weights of states at the points (P, s) as (N, a, s, 1)."""
        return pull.reshape(*self.given.orbit.stages.shape[:2], -1, 1)

    def _step(self, tangent: Tangent) -> float:
        parameter = self.given.orbit.parameter
        moved = tangent.parameter != 0
        return float(
            PARAMETER_STEP
            * (np.maximum(np.abs(parameter), PARAMETER_STEP)[moved] / np.abs(tangent.parameter[moved])).min()
        )


def _solved(line: LinearisationLike, onto: Array) -> Array:
    """-onto R_z^-1 of the algebraic rows, real or complex."""
    if np.iscomplexobj(onto):
        return -(solved(line, onto.real) + 1j * solved(line, onto.imag))
    return -solved(line, onto)


def _difference(real: Slopes, imag: Slopes) -> Slopes:
    """The real part of a product of complex weights and motions, from those of their parts."""
    names = ("rate", "state", "algebraic", "phase", "parameter")
    return Slopes(*(getattr(real, name) - getattr(imag, name) for name in names))
