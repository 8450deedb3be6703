"""A linear structure of any size in a model: M q'' + (C + Omega G) q' + K q = forces at its places."""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.checks import mapping, positive, refusal, text, whole
from symbolic.equations.assembly import Assembly
from symbolic.equations.branches import jumps_with
from symbolic.equations.interval import NOT_NEGATIVE
from symbolic.equations.model import Part
from symbolic.equations.terms import Place
from symbolic.equations.variables import Coordinate
from symbolic.parts.stiffness import stiffness
from symbolic.structures.damping import ModalDamping
from symbolic.structures.matrices import DENSE, RELATIVE_STEP, Matrices, dense
from symbolic.structures.modal import LooseError, ModalForm, holding, modal_form, refuse_inexact
from symbolic.structures.modalslope import ModalSlope, modal_slope

WHOLE = 40
"""Most degrees of freedom of a structure that keeps all its states unasked, beside impacts."""

Freedoms = int | str | Sequence[int | str]
Given = Any
"""A matrix, a function of the speed Omega (rad/s) that returns one, or None."""


@dataclass(frozen=True, eq=False)
class Structure(Part):
    """A linear structure M q'' + (C + Omega G) q' + K q = f of n degrees of freedom, from any program.

    `structure["tip"]` is the coordinate of a place, to which springs, stops, films and forces attach as to
    any other. A model is compiled with its places alone, the rest of the structure condensed exactly
    (`symbolic.compile`); with ``condense=False``, or beside a `RigidStop`, every degree of freedom brings its
    two states.

    Parameters
    ----------
    M, C, K : array_like, scipy.sparse or callable
        Mass (kg), damping (N s/m; None for none) and stiffness (N/m), shape (n, n); or a function of the
        speed Omega in rad/s that returns one. The speed is the frequency of the excitation. In the place of
        M a `Matrices` may be given, and nothing else then.
    G : array_like, scipy.sparse or callable, optional
        Gyroscopic matrix; it is multiplied by Omega.
    at : mapping of str to int, str or sequence of them
        Places by the index of a degree of freedom, counted from 0, or by the name of a place of `Matrices`,
        as ``{"left": ("x0", "y0")}``; a sequence makes a tuple of coordinates.
    damping : float or sequence of float
        Damping ratio of all modes, or of the lowest ones, the last counting for all above. Structural
        damping eta, which has no meaning in time but in a harmonic motion, is that of a ratio eta/2 there.
    rayleigh : tuple of float
        (a, b) of C = a M + b K in 1/s and s.
    modes : int, optional
        How many of the lowest modes are integrated in time; the others follow with their static
        flexibility. By default all up to 500 degrees of freedom, else 200.
    name : str
        What its degrees of freedom are called by.
    scale : float
        Length (m) taken as one inside.

    Raises
    ------
    ValueError
        For matrices that are not square, of different sizes or not finite, a mass that is singular or not
        positive definite, places out of range, and damping that is negative.
    """

    M: Given
    C: Given = None
    K: Given = None
    G: Given = None
    at: Mapping[str, Freedoms] = field(default_factory=dict)
    damping: float | Sequence[float] = 0.0
    rayleigh: tuple[float, float] = (0.0, 0.0)
    modes: int | None = None
    name: str = "structure"
    scale: float = 1.0
    coordinates: dict[int, Coordinate] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        text("name of a structure", self.name)
        positive(f"scale of {self.name!r}", self.scale)
        if isinstance(self.M, Matrices):
            self._unpack(self.M)
        if self.K is None:
            raise refusal(
                "K", self.K, "a square matrix of numbers, or a function of the speed that returns one"
            )
        first = self.matrices(0.0)
        for place, where in mapping("at", self.at).items():
            self._checked(text("a place", place), where, first.size)
        if self.modes is not None and whole("modes", self.modes, 1) > first.size:
            raise refusal("modes", self.modes, f"a whole number from 1 to {first.size}")
        _ = self.modal_damping

    def _unpack(self, given: Matrices) -> None:
        if any(value is not None for value in (self.C, self.K, self.G)):
            raise refusal("M", given, "a matrix where C, K or G are given too; Matrices hold all of them")
        for name in ("M", "C", "K", "G"):
            object.__setattr__(self, name, getattr(given, name))
        own = {place: _indices(given.at, where) for place, where in mapping("at", self.at).items()}
        object.__setattr__(self, "at", {**given.at, **own})

    @property
    def size(self) -> int:
        """Number n of degrees of freedom."""
        return self.matrices(0.0).size

    @property
    def varying(self) -> bool:
        """Whether a matrix depends on the speed."""
        return self.G is not None or any(callable(given) for given in (self.M, self.C, self.K))

    @cached_property
    def modal_damping(self) -> ModalDamping:
        """What is damped mode by mode."""
        ratio = self.damping if isinstance(self.damping, int | float) else tuple(self.damping)
        try:
            mass, stiffness = self.rayleigh
        except (TypeError, ValueError):
            raise refusal("rayleigh", self.rayleigh, "two numbers (a, b)") from None
        found = ModalDamping(ratio, mass, stiffness)
        for name, given in (("damping", ratio), ("rayleigh", self.rayleigh)):
            for number in np.atleast_1d(given):
                NOT_NEGATIVE.check(name, float(number))
        return found

    @cached_property
    def _known(self) -> dict[float, Matrices]:
        return {}

    def matrices(self, speed: float) -> Matrices:
        """Return M, C, K and G at a speed Omega (rad/s).

        Parameters
        ----------
        speed : float
            Omega.

        Returns
        -------
        Matrices
            The matrices, without what is damped mode by mode.
        """
        given = (self.M, self.C, self.K, self.G)
        key = float(speed) if any(callable(g) for g in given) else 0.0
        if key not in self._known:
            self._known.clear()
            named = {place: where for place, where in self.at.items() if isinstance(where, int)}
            mass, damping, stiffness, gyroscopic = (_at(g, key) for g in given)
            self._known[key] = Matrices(mass, damping, stiffness, gyroscopic, at=named)
        return self._known[key]

    def __getitem__(self, place: str) -> Any:
        """Return the coordinate of a place; a tuple of them of one with several degrees of freedom."""
        if place not in self.at:
            raise refusal(
                "place", place, f"one of {', '.join(self.at) or 'none: the structure names no place'}"
            )
        where = self.at[place]
        if isinstance(where, int | np.integer):
            return self._coordinate(int(where), place)
        return tuple(self._coordinate(int(k), f"{place} {i + 1}") for i, k in enumerate(where))

    def freedom(self, index: int) -> Coordinate:
        """Return the coordinate of a degree of freedom.

        Parameters
        ----------
        index : int
            Its index, counted from 0.

        Returns
        -------
        Coordinate
            That of its place, where it has one.

        Raises
        ------
        ValueError
            For an index out of range.
        """
        self._checked(f"freedom {index}", index, self.size)
        return self._coordinate(index, self._place_of(index) or f"{self.name} {index + 1}")

    def _place_of(self, index: int) -> str | None:
        return next(
            (place for place, k in self.at.items() if isinstance(k, int | np.integer) and k == index), None
        )

    def _coordinate(self, index: int, name: str) -> Coordinate:
        return self.coordinates.setdefault(index, Coordinate(name, "m", self.scale))

    @staticmethod
    def _checked(place: str, where: Any, size: int) -> None:
        try:
            indices = [operator.index(k) for k in ([where] if np.ndim(where) == 0 else where)]
        except TypeError:
            indices = []
        if isinstance(where, bool) or not indices or not all(0 <= k < size for k in indices):
            raise refusal(f"the index of place {place!r}", where, f"a whole number from 0 to {size - 1}")

    def _used(self, assembly: Assembly) -> Iterator[tuple[int, Coordinate]]:
        """Yield the degrees of freedom at which other parts act, with their coordinates."""
        for index, coordinate in sorted(self.coordinates.items()):
            if coordinate in assembly.motions:
                yield index, coordinate

    def contribute(self, assembly: Assembly) -> None:
        """Take part in the model; what it adds follows when all parts have spoken."""
        assembly.structures.append(self)

    def modal(self, speed: float) -> ModalForm:
        """Return the modes at a speed.

        Parameters
        ----------
        speed : float
            Omega in rad/s.

        Returns
        -------
        ModalForm
            The modes, in SI.

        Raises
        ------
        ValueError
            Where modes do not span the motion of the structure.
        """
        key = float(speed) if self.varying else 0.0
        if key not in self._forms:
            if len(self._forms) > 8:
                self._forms.clear()
            given = self.matrices(speed), self.modal_damping, speed, self.modes
            self._forms[key] = modal_form(self.name, *given, self._held)
        return self._forms[key]

    def modal_slope(self, speed: float) -> ModalSlope | None:
        """Return how the modes change with the speed; None where that is not known in closed form.

        Parameters
        ----------
        speed : float
            Omega in rad/s.

        Returns
        -------
        ModalSlope or None
            Derivatives in SI.

        Raises
        ------
        ArithmeticError
            Where two modes meet.
        """
        form = self.modal(speed)
        if not form.own or not self.modal_damping.none and (callable(self.M) or callable(self.K)):
            return None  # with them modal damping changes
        mass, damping, stiffness, gyroscopic = (
            _steepness(given, speed, self.size) for given in (self.M, self.C, self.K, self.G)
        )
        if self.G is not None:
            damping = damping + dense(_at(self.G, speed)) + speed * gyroscopic
        return modal_slope(form, mass, damping, stiffness)

    @cached_property
    def _forms(self) -> dict[float, ModalForm]:
        return {}

    @cached_property
    def _held(self) -> dict[int, float]:
        return {}

    def _holding(self, speed: float, freedoms: list[int], others: Array) -> ModalForm:
        """The modes; of a structure that is not held by itself those with springs at places in use.

        The forces there are greater by those of the springs, so that all is as without them. `others` is how
        stiffly other parts hold the places, (k,): springs where they do are enough, if they hold it. Where a
        spring alone makes the force depend on the motion, there is one unknown more.
        """
        try:
            return self._with(speed, {})
        except LooseError:
            if self.size > DENSE:
                raise
        springs = holding(self.matrices(speed), speed, freedoms, others)
        try:
            return self._with(speed, {k: springs[k] for k in np.array(freedoms)[others > 0]})
        except LooseError:
            return self._with(speed, springs)

    def _with(self, speed: float, springs: Mapping[int, float]) -> ModalForm:
        """The modes with springs at some degrees of freedom."""
        self._held.clear()
        self._forms.clear()
        self._held.update(springs)
        return self.modal(speed)

    def condense(self, assembly: Assembly) -> None:
        """Leave two states at each place in use, the force there an unknown of its own."""
        used = list(self._used(assembly))
        if not used:
            raise ValueError(f"structure {self.name!r} has no place where another part acts; it needs one")
        self._draw(assembly, tuple(coordinate for _, coordinate in used))
        others = stiffness(assembly, [assembly.motion(coordinate) for _, coordinate in used])
        form = self._holding(assembly.nominal(assembly.omega), [k for k, _ in used], others)
        freedoms = [k for k, _ in used]
        refuse_inexact(self.name, form, freedoms)
        flexibility = np.diag(form.static(freedoms)[freedoms])
        sticking = self._sticking(assembly, form, [coordinate for _, coordinate in used])
        mobility = form.mobility(freedoms)
        for i, ((index, coordinate), softness) in enumerate(zip(used, flexibility, strict=True)):
            motion = assembly.motion(coordinate)
            if not motion.mass.is_zero():
                raise ValueError(
                    f"coordinate {coordinate.name!r} of structure {self.name!r} has a Mass; add it to the "
                    f"structure's M, or compile with condense=False"
                )
            unit = self.scale / softness if softness > 0 else 1.0
            name = f"force on {coordinate.name}"
            unknown = assembly.algebraic(name, ca.SX(0), unit="N", scale=unit)
            spring = self._held.get(index, 0.0) * motion.position.symbol
            motion.force += spring
            assembly.output(name, "N", unit * unknown - spring)
            place = Place(motion, self, index, unknown, unit)
            if sticking:
                name = f"acceleration of {coordinate.name} without force"
                size = float(mobility[i, i]) * unit / assembly.nominal(assembly.omega) ** 2
                place.coasting = assembly.state(name, coordinate.unit, size, ca.SX(0))
                place.mobility = mobility[i]
                assembly.differential_rows.append(ca.SX(0))
            assembly.places.append(place)

    def _sticking(self, assembly: Assembly, form: ModalForm, used: list[Coordinate]) -> bool:
        """Whether a force at the places jumps with a speed there, and all modes are there to answer it.

        A jump makes a coordinate without inertia jump, as those are whose modes are left out.
        """
        motions = [assembly.motion(coordinate) for coordinate in used]
        speeds = ca.vertcat(*[m.velocity.symbol for m in motions])
        forces = ca.vertcat(*[m.force for m in motions])
        return form.undamped is None and not callable(self.M) and jumps_with(forces, speeds)

    def _draw(self, assembly: Assembly, of: tuple[Coordinate, ...]) -> None:
        """Draw the deflections w0, w1, ... or x0, x1, ... of its nodes, where its places are called so."""
        places = {place: k for place, k in self.at.items() if isinstance(k, int | np.integer)}
        for letter in ("w", "x"):
            numbers = sorted(int(p[1:]) for p in places if p[0] == letter and p[1:].isdecimal())
            nodes = [(f"{letter}{n}", int(places[f"{letter}{n}"])) for n in numbers]
            if len(nodes) > 2:
                known = self.coordinates
                named = [(known[k].name if k in known else place, k) for place, k in nodes]
                assembly.sketch.structure(of, self.name, named)
                return

    def check_whole(self) -> None:
        """Refuse a structure that is too large to have all its states, or whose matrices are functions."""
        if any(callable(given) for given in (self.M, self.C, self.K)):
            raise ValueError(
                f"structure {self.name!r} has matrices that are functions of the speed; beside a RigidStop, "
                f"or resets, it must have numbers: give the stop a stiffness, as OneSidedSpring has"
            )
        if self.size > WHOLE:
            raise ValueError(
                f"structure {self.name!r} has {self.size} degrees of freedom; beside a RigidStop, or resets, "
                f"it keeps all its states and must have {WHOLE} at the most, as symbolic.craig_bampton leaves"
            )

    def expand(self, assembly: Assembly) -> None:
        """Add the two states of every degree of freedom, inertia and internal forces."""
        speed = assembly.nominal(assembly.omega)
        if any(callable(given) for given in (self.M, self.C, self.K)):
            raise ValueError(
                f"structure {self.name!r} has matrices that are functions of the speed; "
                f"it can be condensed only, condense=True"
            )
        matrices = self.matrices(speed)
        freedoms = [self.freedom(k) for k in range(matrices.size)]
        self._draw(assembly, tuple(freedoms))
        motions = [assembly.motion(freedom) for freedom in freedoms]
        position = ca.vertcat(*[m.position.symbol for m in motions])
        velocity = assembly.omega * ca.vertcat(*[m.velocity.symbol for m in motions])
        rates = assembly.omega**2 * ca.vertcat(*[m.velocity.derivative for m in motions])
        damping = dense(matrices.C)
        if not self.modal_damping.none:
            damping = damping + self.modal_damping.matrix(matrices)
        internal = _constant(matrices.K) @ position + _constant(damping) @ velocity
        if matrices.G is not None:
            internal += assembly.omega * (_constant(matrices.G) @ velocity)
        diagonal = matrices.M.diagonal()
        coupling = (_constant(matrices.M) - ca.diag(ca.DM(diagonal))) @ rates
        for k, motion in enumerate(motions):
            motion.mass += float(diagonal[k])
            motion.force -= internal[k] + coupling[k]


def _at(given: Given, speed: float) -> Given:
    return given(speed) if callable(given) else given


def _indices(places: Mapping[str, int], where: Freedoms) -> Freedoms:
    """Degrees of freedom by index, some of them given as names of places."""
    if isinstance(where, Sequence) and not isinstance(where, str):
        return tuple(places.get(k, k) if isinstance(k, str) else k for k in where)
    return places.get(where, where) if isinstance(where, str) else where


def _steepness(given: Given, speed: float, size: int) -> Array:
    """The derivative of a matrix in the speed, (n, n)."""
    if not callable(given):
        return np.zeros((size, size))
    step = RELATIVE_STEP * max(abs(speed), RELATIVE_STEP)
    after, before = (dense(given(speed + sign * step)) for sign in (1, -1))
    return np.asarray((after - before) / (2 * step))


def _constant(matrix: Any) -> ca.DM:
    """A matrix as CasADi takes it, zeros left out."""
    return ca.sparsify(ca.DM(dense(matrix)))
