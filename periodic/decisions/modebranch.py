"""Nonlinear modes with damping: frequency, damping ratio and dissipated energy over the amplitude.

Free vibrations of a damped system decay. With the force xi M q' on all inertia they are periodic, at one xi
for each amplitude (extended periodic motion concept),

    M q'' - xi M q' + f(q', q) = 0,   D = xi / (2 omega),

and near resonance the forced motion of that amplitude is the same. Of conservative systems xi is 0: their
backbones.

References
----------
M. Krack, Nonlinear modal analysis of nonconservative systems: extension of the periodic motion concept,
Computers and Structures 154 (2015) 59-71.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, cast

import numpy as np

from periodic.bifurcations.hopf import oscillating
from periodic.checks import named, number, one_of, shown, whole
from periodic.collocation.collocation import Collocation
from periodic.conditions.functionals import Amplitude, Component, Functional, Value, mean, output_index
from periodic.conditions.levels import Level
from periodic.conditions.phase import PhaseCondition
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.meanequilibrium import resting
from periodic.correction.newton import moved
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.equilibrium.linearise import rows_at
from periodic.orbit.construction import constant
from periodic.orbit.layout import layout_of
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.results.branch import Branch
from periodic.system import System, check_system, check_value, index_of
from periodic.system.free import DAMPING, KINETIC, SIZE, Releasable
from periodic.system.precision import MOST_ITERATIONS
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.trace import trace
from periodic.tracing.watch import Watch

NTST = 24
"""Intervals of the first guess."""

SETTLED = 1e-10
"""Relative change of a linear mode's frequency at which it is taken for its own."""

STILL = 1e-9
"""Amplitude of an output, in parts of the largest scaled state, below which a mode does not move it."""

RATIO, LOSS = "damping ratio", "energy per period"
"""Names of the columns."""


@dataclass(frozen=True)
class FreeVibration(PhaseCondition):
    """The phase condition of free vibrations kept up by xi.

    Besides a shift of phase a change of amplitude is no disturbance: the branch itself leads there. The two
    multipliers nearest 1 are theirs.
    """

    trivial: ClassVar[int] = 2


@dataclass(frozen=True)
class DampingRatio:
    """D = xi / (2 omega) of an orbit of a system that was let go."""

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the ratio."""
        return Value(DAMPING)(system, orbit) / (2 * orbit.omega)


@dataclass(frozen=True)
class EnergyPerPeriod:
    """What the system dissipates over a period (J), and xi puts in."""

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the energy (J)."""
        return Value(DAMPING)(system, orbit) * mean(KINETIC)(system, orbit) * orbit.period


def mode_branch(
    system: System,
    output: str,
    amplitudes: tuple[float, float],
    *,
    which: int = 0,
    frequency: str | None = None,
    values: Mapping[str, float] | None = None,
    at: float | Sequence[float] = (),
    tol: float | Tolerance = Accuracy.STANDARD,
    guess: Orbit | None = None,
    method: Discretisation | None = None,
    control: ArclengthControl | None = None,
    columns: Mapping[str, Functional] | None = None,
) -> Branch:
    """Trace a nonlinear mode with its damping over the amplitude.

    Parameters
    ----------
    system : System
        A compiled model, whatever excites it: here nothing does.
    output : str
        Output whose first harmonic is the amplitude.
    amplitudes : tuple of float
        Range of the amplitude (SI), positive; the branch begins at the first.
    which : int
        The linear mode that it begins at, counted from 0 at the lowest frequency.
    frequency : str, optional
        The parameter that becomes the mode's frequency, where that is a product of several.
    values : mapping of str to float, optional
        Parameters (SI) by name.
    at : float or sequence of float
        Amplitudes that get points of their own.
    tol
        As in `trace`.
    guess : Orbit, optional
        An orbit of the system that was let go, as a point of another mode branch has it, to begin with.
    method, control
        As in `trace`; by default collocation of all states, as xi is in all of the linear part.
    columns : mapping of str to functional, optional
        Further functionals kept at each point.

    Returns
    -------
    Branch
        Over the parameter "modal amplitude"; the frequency is a parameter of its orbits, xi
        (1/s, "modal damping") another. Its
        columns "damping ratio" and "energy per period" (J) are xi / (2 omega) and what is dissipated.

    Raises
    ------
    ValueError
        In one sentence, for a system that is no compiled model, an unknown output, amplitudes that are no
        range of positive numbers, and a mode that there is not.
    """
    check_system(system)
    if not hasattr(system, "let_go"):
        raise ValueError("system has no masses that are known; it must be one that symbolic.compile returned")
    free = cast(Releasable, system).let_go()
    output_index(free, output)
    low, high = _amplitudes(amplitudes)
    known = layout_of(free).frequency
    if frequency is None and len(known) != 1:
        raise ValueError(
            f"frequency is None, and that of the system is a product; it must be one of {', '.join(known)}"
        )
    paced = known[0] if frequency is None else one_of("frequency", frequency, known)
    named("values", values or {}, "numbers")
    first = guess or linear_mode(free, output, low, paced, whole("which", which, 0), values or {})
    determined: dict[str, Condition] = {
        paced: FreeVibration(),
        DAMPING: Level(Amplitude(output), SIZE),
    }
    return trace(
        free,
        SIZE,
        (low, high),
        start=low,
        at=at,
        tol=tol,
        guess=first,
        determined=determined,
        method=method or Collocation(condense=False),
        control=control,
        watch=Watch(columns={RATIO: DampingRatio(), LOSS: EnergyPerPeriod(), **(columns or {})}, peaks={}),
    )


def shape(system: System, orbit: Orbit, order: float = 1.0) -> dict[str, complex]:
    """Return the modal shape of an orbit: the complex amplitude of each coordinate in a harmonic.

    Parameters
    ----------
    system : System
        The system that was let go or, if it has the orbit's states, the one that was traced.
    orbit : Orbit
        The orbit.
    order : float
        The harmonic.

    Returns
    -------
    dict of str to complex
        a - i b of q = a cos(order tau) + b sin(order tau) (SI), by the names of the outputs that are states.
    """
    states = {state.name for state in system.states}
    found = {}
    for name in (o.name for o in system.outputs if o.name in states):
        cosine, sine = (Component(name, order, phase)(system, orbit) for phase in (0.0, np.pi / 2))
        found[name] = complex(cosine, -sine)
    return found


def synthesised(
    system: System, modes: Branch, output: str, forces: Mapping[str, complex]
) -> dict[str, Array]:
    """Return the response to harmonic forces near a resonance, as the mode alone gives it.

    With the amplitude a, omega and D of each point, phi the shape per unit of a and m the modal mass, forces
    Re(f exp(i Omega t)) need

        |omega^2 - Omega^2 + 2 i D omega Omega| m a = |phi^H f|.

    Parameters
    ----------
    system : System
        The system of the branch.
    modes : Branch
        What `mode_branch` returned.
    output : str
        The output that its amplitude is of.
    forces : mapping of str to complex
        Amplitudes f (N) by the outputs, coordinates of the model, on which they act.

    Returns
    -------
    dict of str to Array
        "amplitude" (SI), and "below" and "above", the frequencies (rad/s) at which the response has it, below
        and above resonance; NaN where there is none.

    Raises
    ------
    ValueError
        For an output that is none.
    """
    free = cast(Releasable, system).let_go()
    rows = []
    for point in modes:
        orbit, a = point.orbit, point.parameter
        omega, ratio = orbit.omega, DampingRatio()(free, orbit)
        form = shape(free, orbit)
        for name in (output, *forces):
            one_of("output", name, form)
        along = sum(np.conj(form[name] / form[output]) * force for name, force in forces.items())
        mass = 2 * mean(KINETIC)(free, orbit) / (omega * a) ** 2
        middle = 1 - 2 * ratio**2
        left = middle**2 - 1 + (abs(along) / (mass * a * omega**2)) ** 2
        root = np.sqrt(left) if left >= 0 else np.nan
        ends = [omega * np.sqrt(w) if (w := middle + sign * root) >= 0 else np.nan for sign in (-1.0, 1.0)]
        rows.append((a, *ends))
    return dict(zip(("amplitude", "below", "above"), np.array(rows).reshape(-1, 3).T, strict=True))


def linear_mode(
    free: System, output: str, amplitude: float, frequency: str, which: int, values: Mapping[str, float]
) -> Orbit:
    """Return the motion of a linear mode about rest, of an amplitude: a guess.

    Parameters
    ----------
    free : System
        A system that was let go.
    output : str
        The output whose first harmonic has the amplitude (SI).
    amplitude : float
        The amplitude.
    frequency : str
        Name of the parameter that is the frequency.
    which : int
        The mode.
    values : mapping of str to float
        Parameters (SI).

    Returns
    -------
    Orbit
        The guess.

    Raises
    ------
    ValueError
        For a mode that there is not, and one in which the output does not move.
    """
    parameter = np.array(free.nominal, dtype=float)
    for name, value in values.items():
        index = index_of(free, name)
        if not np.isfinite(number(f"value of {name}", value)):
            raise ValueError(f"value of {name} is {value!r}; it must be a finite number")
        check_value(free.parameters[index], value)
        parameter[index] = value
    paced = index_of(free, frequency)
    for _ in range(MOST_ITERATIONS):  # a film, say, has another thickness at the mode's own speed
        rest, turn = _linear(free, parameter, which)
        parameter[paced] *= turn.imag
        if abs(turn.imag - 1) < SETTLED:
            break
    origin = replace(rest, parameter=parameter)
    parameter[index_of(free, DAMPING)] = -2 * origin.omega * turn.real
    parameter[index_of(free, SIZE)] = amplitude
    way = replace(oscillating(free, rest, rest, turn), parameters=np.zeros(0))
    unit = Amplitude(output)(free, moved(free, (), origin, way))
    if not unit > STILL * float(np.abs(way.nodes).max()):
        raise ValueError(
            f"output is {output!r}, which does not move in mode {which}; it must be one that does"
        )
    return moved(free, (), origin, way, amplitude / unit)


def _linear(free: System, parameter: Array, which: int) -> tuple[Orbit, complex]:
    """Rest, and the eigenvalue (per unit of tau) of a mode there. Raises ValueError."""
    state, algebraic = free.rest(parameter)
    rest = constant(uniform(Scheme(), NTST), state, algebraic, parameter.copy(), layout_of(free))
    rest = resting(free, rest) or rest
    try:
        values = np.linalg.eigvals(rows_at(free, rest, ()).jacobian)
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        raise ValueError(f"the system at rest has no linear modes ({error}); guess must be given") from None
    vibrating = sorted((complex(v) for v in values if v.imag > 0), key=lambda value: value.imag)
    if which >= len(vibrating):
        raise ValueError(f"which is {which}; the system at rest has {len(vibrating)} modes that vibrate")
    return rest, vibrating[which]


def _amplitudes(given: Any) -> tuple[float, float]:
    if not (isinstance(given, Sequence) and len(given) == 2):
        raise ValueError(
            f"amplitudes is {shown(given)}; it must be two positive numbers, where the branch begins first"
        )
    first, last = (number("amplitude", value) for value in given)
    if not (np.isfinite([first, last]).all() and min(first, last) > 0 and first != last):
        raise ValueError(f"amplitudes is {shown(given)}; it must be two different positive numbers")
    return first, last
