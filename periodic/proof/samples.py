"""The text of a system's equations, evaluated in floats along a computed orbit: where its events are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.proof.check import OF_TWO, Problem

PER_INTERVAL = 16
"""Samples in each interval of the mesh, between which comparisons are looked at for a change of sign."""

OPERATIONS: dict[str, Callable[..., Array]] = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "^": np.power,
    "sin": np.sin,
    "cos": np.cos,
    "exp": np.exp,
    "log": np.log,
    "sqrt": np.sqrt,
    "atan": np.arctan,
    "inv": np.reciprocal,
    "max": np.maximum,
    "min": np.minimum,
    "abs": np.abs,
    "sign": np.sign,
    "less": lambda a, b: (a < b) * 1.0,
}
"""The operations of the text in floats."""


@dataclass(frozen=True)
class Event:
    """A place tau where two values are equal that comparisons, with these names, compare."""

    phase: float
    names: tuple[str, ...]


def evaluated(problem: Problem, values: Mapping[str, float], state: Array, phase: Array) -> dict[str, Array]:
    """Return all values of the text at states (N, n) and phases (N,), by name, each of shape (N,).

    The difference that a branch compares with 0 has the branch's name with a question mark before it.
    """
    at: dict[str, Array] = {f"x{i}": state[:, i] for i in range(state.shape[1])}
    known = {name: float(value) for name, value in problem.values.items()} | dict(values)
    at |= {"t": phase} | {name: np.full(len(phase), value) for name, value in known.items()}
    with np.errstate(all="ignore"):
        for name, kind, operands in problem.lines:
            a = [at[o] if isinstance(o, str) else np.full(len(phase), float(o)) for o in operands]
            if name in problem.compared:
                at[f"?{name}"] = a[0] - a[1]
            at[name] = OPERATIONS[kind](*(a if kind in OF_TWO else a[:1]))
    return at


def along(problem: Problem, values: Mapping[str, float], orbit: Orbit, phase: Array) -> dict[str, Array]:
    """Return all values of the text along an orbit at phases (N,), by name."""
    both = np.concatenate([orbit.state(phase), orbit.algebraic_guess(phase)], axis=1)
    return evaluated(problem, values, both, phase)


def events(
    problem: Problem, values: Mapping[str, float], orbit: Orbit, impacts: Mapping[str, int]
) -> list[Event]:
    """Return the events along an orbit, in order; impacts, by the index of their switch, it has itself."""
    fractions = (np.arange(PER_INTERVAL) + 0.5) / PER_INTERVAL
    phase = (orbit.grid.left[:, None] + orbit.grid.width[:, None] * fractions).ravel()
    phase = np.sort(phase % orbit.mesh.period)
    at = along(problem, values, orbit, phase)
    edges: dict[frozenset[str], list[str]] = {}
    for name, edge in problem.compared.items():
        edges.setdefault(edge, []).append(name)
    found = [
        Event(float(place) % orbit.mesh.period, (name,))
        for name, switch in impacts.items()
        for place, event in zip(orbit.phases, orbit.mesh.events, strict=True)
        if event.switch == switch and event.level == 0
    ]
    for name in impacts:
        del edges[problem.compared[name]]
    for names in edges.values():
        argument = at[f"?{names[0]}"]

        def compared(tau: float, name: str = names[0]) -> float:
            return float(along(problem, values, orbit, np.array([tau]))[f"?{name}"][0])

        changes = np.flatnonzero(np.sign(argument[1:]) * np.sign(argument[:-1]) < 0)
        places = [brentq(compared, phase[k], phase[k + 1], xtol=1e-15) for k in changes]
        found += [Event(place, tuple(names)) for place in places]
    return sorted(found, key=lambda event: event.phase)
