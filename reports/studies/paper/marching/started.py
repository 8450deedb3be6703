"""The paper's discs as a step-by-step calculation starts them (its section 5), in several forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache

import numpy as np
from numpy.typing import NDArray

import symbolic as sym
from symbolic.arrays import Array
from symbolic.integration.flow import Flow, Trajectory
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import disc_model
from symbolic.scenes.reading import load
from symbolic.scenes.schema import DiscScene
from symbolic.system.compiled import with_values

RAMP = 20.0
"""s of the ramp exp(t) that are integrated before the sinusoid; it begins at 2e-9 of its end."""


class Form(Enum):
    """The forms of one set of equations."""

    THIRD_ORDER = "third order in h (the paper's eq. 17)"
    THREE_STATE = "three states X, X', h"
    UNKNOWN = "three states and an algebraic unknown"


@cache
def started(form: Form, name: str = "vitrea79-810N") -> sym.CompiledSystem:
    """Return the system of a built-in disc scene whose waviness starts with the ramp, in one of the forms.

    UNKNOWN is for the trusted integrator `symbolic.integration.flow.Flow`, the other two are explicit.
    """
    scene = load(name)
    assert isinstance(scene, DiscScene)
    model = sym.combine(_with_start(part, form) for part in disc_model(scene).parts)
    return sym.compile(sym.films.ThirdOrder(model) if form is Form.THIRD_ORDER else model)


def _with_start(part: sym.Part, form: Form) -> sym.Part:
    if isinstance(part, sym.Waviness):
        return sym.RampedWaviness(part.pair, part.amplitude, part.waves, part.speed)
    if isinstance(part, sym.SqueezeFilm) and form is Form.THREE_STATE:
        return sym.films.ExplicitSqueezeFilm(
            part.pair, part.law, part.speed, part.radius, part.beta, part.squeeze
        )
    return part


@dataclass(frozen=True, kw_only=True)
class Runs:
    """N runs of one system: parameter (p, N), omega (N,) in rad/s; phase (N,), state (N, n) at the start."""

    form: Form
    system: sym.CompiledSystem
    parameter: Array
    omega: Array
    phase: Array
    state: Array

    @property
    def named(self) -> dict[str, Array]:
        """The parameters (SI) by name, each (N,)."""
        return dict(zip([p.name for p in self.system.parameters], self.parameter, strict=True))

    def chosen(self, which: NDArray[np.int64]) -> Runs:
        """Return some of the runs."""
        return replace(
            self,
            parameter=self.parameter[:, which],
            omega=self.omega[which],
            phase=self.phase[which],
            state=self.state[which],
        )

    def outputs(self, phase: Array, state: Array) -> dict[str, Array]:
        """Return the outputs (SI) at phases (..., N) and states (..., N, n), by name, each (..., N)."""
        n, count = state.shape[-1], state[..., 0].size
        flat = state.reshape(-1, n)
        parameter = np.tile(self.parameter, (1, count // len(self.omega)))
        none = np.zeros((count, len(self.system.algebraics)))
        values = self.system.output(np.zeros_like(flat), flat, none, phase.ravel(), parameter)
        names = [output.name for output in self.system.outputs]
        return {name: values[:, i].reshape(phase.shape) for i, name in enumerate(names)}


def runs(form: Form, cases: Sequence[tuple[str, float]]) -> Runs:
    """Return runs of scenes at speeds in rev/min, at rest on top of the ramp.

    The ramp of the paper takes 1 s for a factor e, thousands of vibrations: at its end the discs rest, lifted
    by its height (`ramped` checks that).
    """
    system = started(form)
    columns = [with_values(started(form, name), {"speed": rpm * RPM}) for name, rpm in cases]
    parameter = np.array(columns).T
    named = dict(zip([p.name for p in system.parameters], parameter, strict=True))
    omega = named["waves"] * named["speed"]
    joint = np.arctan(omega / named["ramp_rate"])
    state = np.array([system.rest(column)[0] for column in columns])
    if form is not Form.THIRD_ORDER:
        state[:, 0] = named["amplitude"] * np.sin(joint) / system.states[0].scale
    return Runs(form=form, system=system, parameter=parameter, omega=omega, phase=joint, state=state)


def ramped(name: str, rpm: float, tolerance: float = 1e-9) -> tuple[Flow, Array, Trajectory]:
    """Return the trusted integrator, its parameters and the motion to the end of the ramp."""
    system = started(Form.UNKNOWN, name)
    parameter = with_values(system, {"speed": rpm * RPM})
    case = runs(Form.UNKNOWN, [(name, rpm)])
    end = case.phase[0]
    flow = Flow(system, tolerance)
    state, algebraic = system.rest(parameter)
    return flow, parameter, flow.run(state, algebraic, parameter, np.array([end - RAMP * case.omega[0], end]))
