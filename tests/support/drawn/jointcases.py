"""The models of `support.drawn.joints` as parts, and what is traced of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

import numpy as np
from reference.joints.model import Jointed

import periodic as per
import symbolic as sym
from periodic.orbit.layout import layout_of
from support.drawn.joints import Array, Attached, JointModel, joint_model

UP, DOWN = "joints", "joints down"
"""What the survey calls the models traced from the lower and from the upper end of their ranges."""

CREEP: float | None = None
"""Of sliders: they are exact."""


@dataclass(frozen=True)
class JointCase:
    """What is traced in Omega, from where, and the same in numbers for the judge; `told` says it in words."""

    system: sym.CompiledSystem
    exact: Jointed
    bounds: tuple[float, float]
    start: float
    model: JointModel

    @property
    def told(self) -> str:
        """The model in words."""
        return f"{self.model.told} from {self.start:.4f}"

    def states(self, orbit: per.Orbit, taus: Array) -> Array:
        """(q, q', places of sliders) at phases, shape (len(taus), states), in SI."""
        orbit = orbit.expressed_in(layout_of(self.system))
        times = taus / orbit.omega
        if self.model.beam:
            found = list(per.motion(self.system, orbit, None, taus))
        else:
            names = [f"q{k}" for k in self.model.places]
            found = [np.array([orbit[f"{name}{dot}"](times) for name in names]).T for dot in ("", "'")]
        places = [orbit[name](times) for name in self.model.sliders]
        return np.column_stack([*found, *places])


def drawn_joints(kind: str, seed: int) -> JointCase:
    """Return the case of a seed: from the lower end of its range, or from the upper one ("joints down")."""
    model = joint_model(seed)
    start = model.bounds[kind == DOWN]
    return JointCase(compiled(model), model.record(), model.bounds, start, model)


def compiled(model: JointModel) -> sym.CompiledSystem:
    """The model of parts."""
    names, parts = count(), list[sym.Part]()
    coordinates = _coordinates(model, parts, names)
    for a in model.attached:
        q, to = coordinates[a.i], None if a.to is None else coordinates[a.to]
        parts.append(_part(a, q, to, names))
    parts.append(sym.HarmonicForce(coordinates[model.forced], _value(names, "f", model.force)))
    return sym.compile(sym.combine(parts))


def _value(names: Iterator[int], name: str, number: float) -> sym.Parameter:
    """A parameter of a name of its own."""
    return sym.parameter(f"{name}{next(names)}", float(number))


def _coordinates(model: JointModel, parts: list[sym.Part], names: Iterator[int]) -> list[sym.Coordinate]:
    """The places' coordinates; masses and links, or the structure, are added to the parts."""
    if model.beam:
        at = {f"q{k}": place for k, place in enumerate(model.places)}
        structure = sym.Structure(model.mass, model.damping, model.stiffness, at=at)
        parts.append(structure)
        return [structure[name] for name in at]
    found = [sym.coordinate(f"q{k}") for k in range(len(model.places))]
    parts += [sym.Mass(q, _value(names, "m", m)) for q, m in zip(found, np.diag(model.mass), strict=True)]
    for i, to, k, c in model.links:
        values = _value(names, "k", k), _value(names, "c", c)
        if to is None:
            parts += [sym.Spring(found[i], values[0]), sym.Damper(found[i], values[1])]
        else:
            parts.append(sym.Coupling(found[i], found[to], *values))
    return found


def _part(a: Attached, q: sym.Coordinate, to: sym.Coordinate | None, names: Iterator[int]) -> sym.Part:
    limits = [_value(names, "F", limit) for limit in a.limits]
    if a.kind == "coulomb":
        return sym.CoulombFriction(q, limits[0], to=to)
    k = _value(names, "s", a.stiffness)
    if a.kind == "stop":
        return sym.OneSidedSpring(q, k, _value(names, "gap", a.gap), to=to, below=a.below)
    if a.kind == "cubic":
        return sym.CubicSpring(q, k, to=to)
    if a.kind == "jenkins":
        return sym.Jenkins(q, k, limits[0], to=to, creep=CREEP)
    return sym.Iwan(q, k, limits, to=to, creep=CREEP)
