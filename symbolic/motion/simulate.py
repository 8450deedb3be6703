"""Time integration from rest until the motion has settled."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symbolic.arrays import Array
from symbolic.checks import numbers, typed, whole
from symbolic.equations.surfaces import Kind
from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.flow import Flow, Trajectory
from symbolic.integration.modes import Event, Modes
from symbolic.meter import counted
from symbolic.motion.linear import NoRestError, RestFinder
from symbolic.system.compile import all_states
from symbolic.system.compiled import CompiledSystem, with_values

PERIOD = 2 * math.pi
"""Of the excitation, in tau = omega t."""

DIVERGED = 1e8
"""States so many times larger than their scales, and than where they began, have diverged."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Simulation:
    """A motion over a whole number of excitation periods, both ends included.

    ``motion["x"]`` is an output or a state in SI over ``motion.time``, ``motion["x'"]`` the velocity dx/dt.

    Parameters
    ----------
    system : CompiledSystem
        What was integrated.
    parameter : ndarray, shape (p,)
        Values of all parameters, SI.
    phase : ndarray, shape (N,)
        tau, rising; every impact is there twice, with the states before and after it.
    state : ndarray, shape (N, n)
        States, scaled as in the system.
    algebraic : ndarray, shape (N, m)
        Algebraic unknowns.
    events : tuple of Event
        What happens at the system's surfaces on the way, in order.
    modes : tuple of int
        Those of the surfaces at its end, where they are followed: relays go on in them.
    """

    system: CompiledSystem
    parameter: Array
    phase: Array
    state: Array
    algebraic: Array
    events: tuple[Event, ...] = ()
    modes: Modes = ()

    @property
    def time(self) -> Array:
        """Time t = tau/omega in s, shape (N,)."""
        return self.phase / self.system.omega(self.parameter)

    def __getitem__(self, name: str) -> Array:
        """Return an output or a state by name, SI, shape (N,)."""
        outputs, states = ([v.name for v in some] for some in (self.system.outputs, self.system.states))
        if name in outputs:
            n, followed = len(states), (self.events, self.modes)
            trajectory = Trajectory(self.phase, self.state, self.algebraic, *followed)
            rate = Flow(self.system).rates(trajectory, self.parameter)[:, :n]
            at = (rate, self.state, self.algebraic, self.phase, self.parameter)
            return self.system.output(*at)[:, outputs.index(name)]
        if name in states:
            i = states.index(name)
            return _units(self.system, self.parameter)[i] * self.state[:, i]
        names = dict.fromkeys((*outputs, *states))
        raise KeyError(f"the simulation has no {name!r}; it has {', '.join(names)}")


class SimulationInterrupted(KeyboardInterrupt):
    """Ctrl-C during a simulation.

    Parameters
    ----------
    motion : Simulation
        Where it stood after its last whole period: `simulate(start=...)` goes on from there.
    periods : int
        How many periods that were.
    """

    def __init__(self, motion: Simulation, periods: int) -> None:
        super().__init__(f"interrupted after {periods} periods; the `motion` of this exception goes on")
        self.motion, self.periods = motion, periods


def simulate(
    system: CompiledSystem,
    values: Mapping[str, float] | None = None,
    *,
    knock: Mapping[str, float] | None = None,
    start: Simulation | Mapping[str, float] | None = None,
    settle: int = 100,
    periods: int = 1,
    samples: int = 400,
    tolerance: float = 1e-8,
) -> Simulation:
    """Integrate a system in time until its motion has settled, and return the last periods of it.

    CVODES integrates, LSODA where it gives up. The result starts a branch, wherever the motion settles to one
    that repeats itself after `periods`:
    ``per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter)``.

    Parameters
    ----------
    system : CompiledSystem
        The system.
    values : mapping of str to float, optional
        Parameters (SI) that differ from their nominal values.
    knock : mapping of str to float, optional
        What is added to states (SI) at the beginning, by name; x' is the velocity dx/dt.
    start : Simulation or mapping of str to float, optional
        Motion from whose end the new one begins; or states (SI) by name, x' the velocity, all others where
        the search for a rest begins. By default the system begins at rest, one that jumps and has none where
        the search for it begins.
    settle : int
        Excitation periods before those that are returned.
    periods : int
        Excitation periods that are returned.
    samples : int
        Points in each of them.
    tolerance : float
        Relative and absolute tolerance of the integrator, in scaled variables; 1e-13 to 0.01.

    Returns
    -------
    Simulation
        ``samples * periods + 1`` points, and two for each impact.

    Raises
    ------
    ValueError
        For an unknown parameter or state, numbers out of range, and a start of another system.
    NoRestError
        Where no rest is found to begin at.
    SimulationInterrupted
        A KeyboardInterrupt (Ctrl-C) with what goes on as `motion`.
    IntegrationError
        Where both integrators fail or the motion diverges; the message says how far it could be followed.
    """
    for name, number, least in (("settle", settle, 0), ("periods", periods, 1), ("samples", samples, 3)):
        whole(name, number, least)
    system = all_states(system)
    parameter = with_values(system, {} if values is None else values)
    flow = Flow(system, tolerance)
    state, algebraic = _beginning(system, parameter, start)
    state = state + _knocked(system, parameter, {} if knock is None else knock)
    ends, phase = np.array([0.0, PERIOD]), np.linspace(0, PERIOD * periods, samples * periods + 1)
    modes: Modes | None = None
    earlier = _kept(system, start.modes) if isinstance(start, Simulation) else None
    done, largest = 0, DIVERGED * max(1.0, float(np.abs(state).max(initial=0.0)))
    try:
        for _ in counted(settle, "settling", "periods"):
            end = flow.run(state, algebraic, parameter, ends, modes, earlier)
            state, algebraic, modes, done = end.state[-1], end.algebraic[-1], end.modes, done + 1
            _check_bounded(system, state, largest, 0.0)
        found = flow.run(state, algebraic, parameter, phase, modes, earlier)
        for row, tau in zip(found.state, found.phase, strict=True):
            _check_bounded(system, row, largest, float(tau))
    except KeyboardInterrupt:
        last = Trajectory(np.zeros(1), state[None], algebraic[None], modes=modes or earlier or ())
        raise SimulationInterrupted(_simulation(system, parameter, last), done) from None
    except IntegrationError as error:
        time = (PERIOD * done + error.phase) / system.omega(parameter)
        raise IntegrationError(f"the motion could not be followed past {time:.6g} s; {error}") from None
    return _simulation(system, parameter, found)


def _simulation(system: CompiledSystem, parameter: Array, found: Trajectory) -> Simulation:
    return Simulation(
        system=system,
        parameter=parameter,
        phase=found.phase,
        state=found.state,
        algebraic=found.algebraic,
        events=found.events,
        modes=found.modes,
    )


def _kept(system: CompiledSystem, modes: Modes) -> Modes | None:
    """The modes of relays, in which a motion goes on whatever knocks it."""
    if not modes:
        return None
    both = zip(system.surfaces, modes, strict=True)
    return tuple(mode if surface.kind == Kind.RELAY else 0 for surface, mode in both)


def _check_bounded(system: CompiledSystem, state: Array, largest: float, phase: float) -> None:
    """Raise IntegrationError for states that are larger than any motion at rest or knocked from it."""
    k = int(np.abs(state).argmax())
    if not abs(state[k]) <= largest:
        raise IntegrationError(
            f"it diverges: {system.states[k].name} is {state[k]:.3g} times its scale", phase
        )


def _beginning(
    system: CompiledSystem, parameter: Array, start: Simulation | Mapping[str, float] | None
) -> tuple[Array, Array]:
    if isinstance(start, Mapping):
        state, algebraic = system.rest(parameter)
        chosen, values = _named(system, parameter, "start", start)
        return np.where(chosen, values, state), algebraic
    if start is not None:
        allowed = "a Simulation, as symbolic.simulate returns it, or states by name"
        given = typed("start", start, Simulation, allowed)
        return _in_scales(system, given), given.algebraic[-1]
    try:
        rest = RestFinder(system).modes(parameter)
    except NoRestError:
        if not system.jumps:  # equations that jump need not have one
            raise
        return system.rest(parameter)
    return rest.state, rest.algebraic


def _in_scales(system: CompiledSystem, start: Simulation) -> Array:
    """The end of a motion in the system's own scales. Raises ValueError for a motion of other variables."""
    theirs, ours = ([v.name for v in (*s.states, *s.algebraics)] for s in (start.system, system))
    if theirs != ours:
        raise ValueError(f"start is a motion of {', '.join(theirs)}; it must be one of {', '.join(ours)}")
    ratio = [a.scale / b.scale for a, b in zip(start.system.states, system.states, strict=True)]
    return start.state[-1] * np.array(ratio)


def _knocked(system: CompiledSystem, parameter: Array, knock: Mapping[str, float]) -> Array:
    """What a knock adds to the scaled states."""
    return _named(system, parameter, "knock", knock)[1]


def _named(
    system: CompiledSystem, parameter: Array, what: str, given: Mapping[str, float]
) -> tuple[NDArray[np.bool_], Array]:
    """Which states are given, and their scaled values, 0 for the others. Raises ValueError."""
    names = [state.name for state in system.states]
    chosen, values = np.zeros(len(names), dtype=bool), np.zeros(len(names))
    for name, value in numbers(what, given, what).items():
        if name not in names:
            raise ValueError(f"{what} has {name!r}; it must be one of {', '.join(names)}")
        chosen[names.index(name)], values[names.index(name)] = True, value
    return chosen, values / _units(system, parameter)


def _units(system: CompiledSystem, parameter: Array) -> Array:
    """SI values of one internal unit of each state; x' is dx/dtau inside, dx/dt = omega dx/dtau outside."""
    names, omega = [state.name for state in system.states], system.omega(parameter)
    stems = [name.rstrip("'") for name in names]
    orders = [len(n) - len(stem) if stem in names else 0 for n, stem in zip(names, stems, strict=True)]
    return np.array([v.scale * omega**k for v, k in zip(system.states, orders, strict=True)])
