"""Models with contact drawn at random, each as parts and in closed form; a seed is a case.

One to three masses between springs, with 1 to 5 clearances of stiffness 1 to 1e5, gears with backlash under
load, masses that strike a rigid stop, dry friction beside a clearance, chains of 2 to 10 masses, each before
a stop, and contacts whose force jumps. Masses are near 1, the springs between 0.3 and 1.5, forces and gaps
such that contact is made somewhere near a resonance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import NDArray
from reference.contact import Contact, Element, Friction, Stop, Wall

import symbolic as sym

Array = NDArray[np.float64]
Random = np.random.Generator


@dataclass
class Drawn:
    """Masses, stiffness and damping matrices, forces, and what touches; parts beside the same numbers.

    pitch: a natural frequency about which the model is traced, by default the lowest out of contact.
    """

    count: int
    parts: list[sym.Part] = field(default_factory=list)
    elements: list[Element] = field(default_factory=list)
    told: list[str] = field(default_factory=list)
    names: Iterator[int] = field(default_factory=count)

    def __post_init__(self) -> None:
        n = self.count
        self.coordinates = [sym.coordinate(f"q{k}") for k in range(n)]
        self.mass, self.load, self.force = np.ones(n), np.zeros(n), np.zeros(n)
        self.pitch: float | None = None
        self.stiffness, self.damping = np.zeros((n, n)), np.zeros((n, n))

    def value(self, name: str, number: float) -> sym.Parameter:
        """A parameter of a name of its own."""
        return sym.parameter(f"{name}{next(self.names)}", float(number))

    def between(self, i: int, to: int | None) -> Array:
        """u = q_i - q_to as a row."""
        row = np.eye(self.count)[i]
        return row if to is None else row - np.eye(self.count)[to]

    def spring(self, i: int, to: int | None, k: float, c: float) -> None:
        """A spring and a damper, to the ground or another mass."""
        u, q = self.between(i, to), self.coordinates
        self.stiffness += k * np.outer(u, u)
        self.damping += c * np.outer(u, u)
        if to is None:
            self.parts += [sym.Spring(q[i], self.value("k", k)), sym.Damper(q[i], self.value("c", c))]
        else:
            self.parts += [sym.Coupling(q[i], q[to], self.value("k", k), self.value("c", c))]

    def stop(self, i: int, to: int | None, k: float, gap: float, below: bool) -> None:
        """A one-sided spring beyond a gap."""
        ends = {"to": None if to is None else self.coordinates[to], "below": below}
        self.parts.append(
            sym.OneSidedSpring(self.coordinates[i], self.value("s", k), self.value("gap", gap), **ends)
        )
        self.elements.append(self._stop(self.between(i, to) * (-1 if below else 1), k, gap))
        self.told.append(f"stop {i} {to} k {k:.4g} gap {gap:.4g} {'below' if below else ''}")

    def step(self, i: int, to: int | None, law: tuple[float, float, float], gap: float, below: bool) -> None:
        """A force k d + c d' + P where the depth d is positive: it jumps there."""
        q, u = self.coordinates, self.between(i, to) * (-1 if below else 1)
        taken = {"k": law[0], "c": law[1], "P": law[2], "gap": gap}
        values = {name: self.value(name, number) for name, number in taken.items()}
        ends = [q[k] for k in np.flatnonzero(u)]

        def forces(x: Any, p: Any) -> dict[str, Any]:
            depth = sum(u[j] * x[q[j].name] for j in np.flatnonzero(u)) - p.gap
            rate = sum(u[j] * x[f"{q[j].name}_dot"] for j in np.flatnonzero(u))
            force = sym.functions.if_else(depth > 0, p.k * depth + p.c * rate + p.P, 0)
            return {q[j].name: -u[j] * force for j in np.flatnonzero(u)}

        self.parts.append(sym.Equations(forces, {}, values, coordinates=ends))
        n = self.count
        row, column = self._row(u, n * [0.0], -gap), self._row(n * [0.0], -u / self.mass)
        self.elements.append(Stop(row, column, self._row(law[0] * u, law[1] * u, law[2] - law[0] * gap)))
        self.told.append(f"step {i} {to} k, c, P {law} gap {gap:.4g} {'below' if below else ''}")

    def backlash(self, i: int, to: int | None, k: float, b: float) -> None:
        """A spring with backlash."""
        ends = None if to is None else self.coordinates[to]
        self.parts.append(sym.Backlash(self.coordinates[i], self.value("s", k), self.value("b", b), to=ends))
        u = self.between(i, to)
        self.elements += [self._stop(u, k, b), self._stop(-u, k, b)]
        self.told.append(f"backlash {i} {to} k {k:.4g} b {b:.4g}")

    def friction(self, i: int, to: int | None, force: float) -> None:
        """Dry friction."""
        ends = None if to is None else self.coordinates[to]
        self.parts.append(sym.CoulombFriction(self.coordinates[i], self.value("R", force), to=ends))
        n, u = self.count, self.between(i, to)
        self.elements.append(Friction(self._row(n * [0.0], u), self._row(n * [0.0], -force * u / self.mass)))
        self.told.append(f"friction {i} {to} F {force:.4g}")

    def wall(self, i: int, gap: float, restitution: float, below: bool) -> None:
        """A rigid stop."""
        values = self.value("gap", gap), self.value("e", restitution)
        self.parts.append(sym.RigidStop(self.coordinates[i], *values, below=below))
        still, away = self.count * [0.0], (1 if below else -1) * self.between(i, None)
        row, push = self._row(away, still, gap), self._row(still, away / self.mass)
        reset = np.eye(len(row))
        reset[self.count + i, self.count + i] = -restitution
        self.elements.append(Wall(row, reset, push))
        self.told.append(f"wall {i} gap {gap:.4g} e {restitution:.3g} {'below' if below else ''}")

    def _stop(self, u: Array, k: float, gap: float) -> Stop:
        n = self.count
        return Stop(self._row(u, n * [0.0], -gap), self._row(n * [0.0], -k * u / self.mass))

    def _row(self, q: Array | list[float], v: Array | list[float], one: float = 0.0) -> Array:
        return np.concatenate([q, v, [one, 0.0, 0.0]])

    def compiled(self) -> sym.CompiledSystem:
        """The model of its parts."""
        q = self.coordinates
        masses = [sym.Mass(x, self.value("m", m)) for x, m in zip(q, self.mass, strict=True)]
        forces = [sym.HarmonicForce(x, self.value("F", f)) for x, f in zip(q, self.force, strict=True) if f]
        loads = [sym.ConstantForce(x, self.value("P", p)) for x, p in zip(q, self.load, strict=True) if p]
        return sym.compile(sym.combine([*masses, *forces, *loads, *self.parts]))

    def exact(self) -> Contact:
        """The same in closed form."""
        n, m = self.count, self.mass[:, None]
        matrix = np.block([[np.zeros((n, n)), np.eye(n)], [-self.stiffness / m, -self.damping / m]])
        still = np.zeros(n)
        constant, force = (np.concatenate([still, f / self.mass]) for f in (self.load, self.force))
        return Contact(matrix, constant, force, self.elements)

    def frequencies(self) -> Array:
        """Natural frequencies out of contact."""
        values = np.linalg.eigvals(self.stiffness / self.mass[:, None]).real
        return np.sqrt(np.sort(np.maximum(values, 0)))

    def swing(self, Omega: float) -> Array:
        """Complex amplitudes out of contact."""
        dynamic = self.stiffness + 1j * Omega * self.damping - Omega**2 * np.diag(self.mass)
        return np.asarray(np.linalg.solve(dynamic, self.force))


@dataclass(frozen=True)
class Case:
    """What is traced in Omega, from where, and its closed form; `told` says it in words."""

    system: sym.CompiledSystem
    exact: Contact
    bounds: tuple[float, float]
    start: float
    names: list[str]
    told: str


def drawn(kind: str, seed: int) -> Case:
    """Return the case of a seed."""
    random = np.random.default_rng([7, list(KINDS).index(kind), seed])
    model = KINDS[kind](random)
    mode = float(model.frequencies()[0]) if model.pitch is None else model.pitch
    low, high = mode * random.uniform(0.5, 0.8), mode * random.uniform(1.5, 2.5)
    start = low if random.random() < 0.5 else high
    names = [q.name for q in model.coordinates]
    told = f"{kind} {seed}: {'; '.join(model.told)}; Omega {low:.4f} to {high:.4f} from {start:.4f}"
    return Case(model.compiled(), model.exact(), (low, high), start, names, told)


def _log(random: Random, low: float, high: float) -> float:
    return float(np.exp(random.uniform(math.log(low), math.log(high))))


def _frame(random: Random, count: int) -> Drawn:
    """Masses on springs, forced at one."""
    model = Drawn(count)
    model.mass = random.uniform(0.5, 2, count)
    zeta = _log(random, 0.01, 0.1)
    for i in range(count):
        if i == 0 or random.random() < 0.7:
            k = random.uniform(0.3, 1.5)
            model.spring(i, None, k, 2 * zeta * math.sqrt(k))
    for i in range(count - 1):
        k = random.uniform(0.3, 1.5)
        model.spring(i + 1, i, k, 2 * zeta * math.sqrt(k))
    model.force[random.integers(count)] = 1.0
    return model


def _reach(random: Random, model: Drawn, row: Array) -> float:
    """A gap that is reached near the first resonance: a part of what the free response is there."""
    return float(random.uniform(0.1, 0.9) * abs(row @ model.swing(float(model.frequencies()[0]))))


def _clearances(random: Random, model: Drawn, count: int) -> None:
    for _ in range(count):
        i = int(random.integers(model.count))
        to = int(random.integers(model.count)) if random.random() < 0.3 else None
        to = None if to == i else to
        gap = _reach(random, model, model.between(i, to))
        model.stop(i, to, _log(random, 1, 1e5), gap, bool(random.random() < 0.5))


def clearances(random: Random) -> Drawn:
    """One to three masses with one to five clearances."""
    model = _frame(random, int(random.integers(1, 4)))
    _clearances(random, model, int(random.integers(1, 6)))
    return model


def gears(random: Random) -> Drawn:
    """The relative motion of a pair of gears under load with backlash, or of two meshes in a row."""
    count = int(random.integers(1, 3))
    model = Drawn(count)
    k, zeta, b = _log(random, 1, 1e3), _log(random, 0.02, 0.1), random.uniform(0.3, 1.5)
    for i in range(count):
        model.spring(i, None if i == 0 else i - 1, 0.02 * k, 2 * zeta * math.sqrt(k))  # shaft
        model.backlash(i, None if i == 0 else i - 1, k * random.uniform(0.5, 1), b)
    model.load[-1] = k * random.uniform(0.05, 0.5)
    model.force[-1] = model.load[-1] * random.uniform(0.3, 2)
    model.pitch = math.sqrt(k)
    return model


def impacts(random: Random) -> Drawn:
    """One or two masses, of which one strikes a rigid stop, perhaps another a clearance."""
    model = _frame(random, int(random.integers(1, 3)))
    i = int(random.integers(model.count))
    gap = _reach(random, model, model.between(i, None))
    model.wall(i, gap, random.uniform(0.3, 0.95), bool(random.random() < 0.5))
    if random.random() < 0.4:
        _clearances(random, model, 1)
    return model


def friction(random: Random) -> Drawn:
    """One or two masses with dry friction, most of them before a clearance."""
    model = _frame(random, int(random.integers(1, 3)))
    i = int(random.integers(model.count))
    to = None if model.count == 1 or random.random() < 0.5 else 1 - i
    model.friction(i, to, _log(random, 0.02, 0.6))
    if random.random() < 0.7:
        _clearances(random, model, int(random.integers(1, 3)))
    return model


def chains(random: Random) -> Drawn:
    """Two to ten masses in a row, each before a stop."""
    count = int(random.integers(2, 11))
    model = Drawn(count)
    zeta, k, stop = _log(random, 0.01, 0.1), random.uniform(0.3, 1.5), _log(random, 1, 1e5)
    for i in range(count):
        model.spring(i, None, 1.0, 2 * zeta)
    for i in range(count - 1):
        model.spring(i + 1, i, k, 2 * zeta)
    model.force[random.integers(count)] = 1.0
    for i in range(count):
        gap = _reach(random, model, model.between(i, None))
        model.stop(i, None, stop, gap, bool(random.random() < 0.5))
    return model


def jumps(random: Random) -> Drawn:
    """One to three masses with one to three contacts whose force jumps: damped, preloaded or both."""
    model = _frame(random, int(random.integers(1, 4)))
    for _ in range(int(random.integers(1, 4))):
        i = int(random.integers(model.count))
        to = int(random.integers(model.count)) if random.random() < 0.3 else None
        to = None if to == i else to
        gap = _reach(random, model, model.between(i, to))
        k = _log(random, 1, 1e4)
        c, preload = 2 * _log(random, 0.01, 0.5) * math.sqrt(k), _log(random, 0.01, 1)
        law = [(k, c, 0.0), (k, 0.0, preload), (k, c, preload)][int(random.integers(3))]
        model.step(i, to, law, gap, bool(random.random() < 0.5))
    return model


KINDS: dict[str, Callable[[Random], Drawn]] = {
    "clearances": clearances,
    "gears": gears,
    "impacts": impacts,
    "friction": friction,
    "chains": chains,
    "jumps": jumps,
}
"""Models drawn at random."""
