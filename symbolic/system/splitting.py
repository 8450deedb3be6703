"""The split of a compiled model into what is linear with constant coefficients and what is not.

CasADi tells which entries of the Jacobian depend on states, unknowns or the phase. Every differential row is

    (E x')_i + (A x)_i + f_i = 0,    f_i = r_i(w, z, tau, p),

with w the states that enter nonlinearly, few as a rule; f_i is 0 in most rows, and in others a combination
of a few.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.checks import typed
from symbolic.equations.expressions import Expressions
from symbolic.equations.variables import Variable
from symbolic.structures.rowspart import RowsPart
from symbolic.system.combinations import Combined, combined
from symbolic.system.compiled import CompiledSystem


@dataclass(frozen=True)
class Structure:
    """How much of a model is linear.

    Parameters
    ----------
    states : int
        Number of its states.
    nonlinear : tuple of str
        Names of the states that enter nonlinearly, or together with unknowns or the phase.
    rows : tuple of int
        Differential rows whose forces f_i make those of all rows.
    places : int
        How many of these forces depend on the motion.
    """

    states: int
    nonlinear: tuple[str, ...]
    rows: tuple[int, ...]
    places: int

    def __str__(self) -> str:
        linear = self.states - len(self.nonlinear)
        return f"{self.states} states, {linear} linear, {self.places} place{'s' * (self.places != 1)}"


def structure_of(system: CompiledSystem) -> Structure:
    """Return how much of a model is linear with constant coefficients.

    Parameters
    ----------
    system : CompiledSystem
        A compiled model.

    Returns
    -------
    Structure
        Its text says it: "200 states, 198 linear, 1 place".

    Raises
    ------
    ValueError
        For what is no compiled model, and where rates enter nonlinearly.
    """
    return _Split(typed("system", system, CompiledSystem, "a CompiledSystem")).structure


def condensed(system: CompiledSystem) -> CompiledSystem:
    """Return the system of a model's nonlinear places alone, its linear part given by its modes.

    It is traced with as many unknowns as it has places; `periodic.motion` gives all states.

    Parameters
    ----------
    system : CompiledSystem
        A compiled model, of states up to some hundreds.

    Returns
    -------
    CompiledSystem
        States: those that enter nonlinearly. Outputs: those that depend on no other states. A system whose
        structures are condensed already is returned as it is.

    Raises
    ------
    ValueError
        For what is no compiled model, where rates enter nonlinearly, equations jump or are reset, and where
        no state enters nonlinearly.
    """
    if typed("system", system, CompiledSystem, "a CompiledSystem").linear is not None:
        return system
    return _Split(system).system()


@dataclass(frozen=True)
class CondensedRecipe:
    """A recipe of what is condensed of a system."""

    recipe: Callable[[], CompiledSystem]

    def __call__(self) -> CompiledSystem:
        return condensed(self.recipe())


class _Split:
    def __init__(self, system: CompiledSystem) -> None:
        self.whole, self.e = system, system.expressions
        self.n = len(system.states)
        e, n = self.e, self.n
        if system.linear is not None:
            raise ValueError("the system's structures are condensed already; compile it with condense=False")
        moving = ca.vertcat(e.rate, e.state, e.algebraic)
        self.jacobian = ca.jacobian(e.residual, moving)
        rows, columns = (np.array(k) for k in self.jacobian.sparsity().get_triplet())
        entries = self.jacobian.nz[:]
        given = ca.vertcat(moving, e.phase)
        varies = np.array(
            [
                bool(entry.is_constant() is False and ca.depends_on(entry, given))
                for entry in ca.vertsplit(entries)
            ],
            dtype=bool,
        )
        if (varies & (columns < n)).any():
            raise ValueError("rates enter the equations nonlinearly; no linear part can be split off")
        special = np.unique(np.concatenate([rows[varies], rows[(columns >= 2 * n) & (rows < n)]]))
        state = (columns >= n) & (columns < 2 * n)
        named = state & ((rows >= n) | varies)
        switched = ca.jacobian(e.switches, e.state).sparsity().get_col()
        self.places = np.unique(np.concatenate([columns[named] - n, np.array(switched, dtype=int)])).astype(
            int
        )
        self.moved = special[special < n].astype(int)
        at_rest = ca.substitute(e.residual[:n], moving, ca.SX.zeros(moving.numel()))
        loaded = [i for i in range(n) if not ca.simplify(at_rest[i]).is_zero()]
        self._loaded = np.unique(np.concatenate([self.moved, np.array(loaded, dtype=int)])).astype(int)
        self.combined = self._combined()
        self.rows = self._loaded[list(self.combined.rows)]

    def _combined(self) -> Combined:
        """The forces f_i of all rows as combinations of a few: of residual, unexcited and waved rows."""
        e = self.e
        columns = [self._remainder(rows) for rows in (e.residual, e.unexcited, e.waved)]
        found = combined(columns, ca.vertcat(e.state, e.algebraic))
        if found is not None:
            return found
        count = len(self._loaded)
        moved = int(np.isin(self._loaded, self.moved).sum())
        return Combined(tuple(range(count)), moved, np.eye(count), tuple(columns))

    @property
    def structure(self) -> Structure:
        names = tuple(self.whole.states[k].name for k in self.places)
        return Structure(self.n, names, tuple(int(k) for k in self.rows), self.combined.moved)

    def _remainder(self, rows: ca.SX) -> ca.SX:
        """The forces f_i of the rows that have any, as functions of the places' states and the unknowns."""
        chosen = [int(k) for k in self._loaded]
        return self._still(rows)[chosen] - (self._linear[1] @ self._held_state)[chosen]

    @cached_property
    def _held_state(self) -> ca.SX:
        """All states, but for those of the places at 0."""
        found = ca.SX.zeros(self.n)
        for place in self.places:
            found[int(place)] = self.e.state[int(place)]
        return found

    def _still(self, rows: ca.SX) -> ca.SX:
        """Expressions with no rates, and with no states but those of the places."""
        e = self.e
        moving = ca.vertcat(e.rate, e.state)
        return ca.substitute(rows, moving, ca.vertcat(ca.SX.zeros(self.n), self._held_state))

    def system(self) -> CompiledSystem:
        whole, m = self.whole, len(self.whole.algebraics)
        if len(self.places) == 0:
            raise ValueError(
                "no state enters the equations nonlinearly; their response is known in closed form"
            )
        if whole.jumps or whole.resets:
            raise ValueError("the equations jump or are reset; a system that is split has neither")
        forces = tuple(range(m, m + len(self.rows)))
        unknowns = tuple(Variable(f"force on row {k + 1}") for k in self.rows)
        outputs = self._outputs()
        chosen = [whole.states[k] for k in self.places]
        return replace(
            whole,
            states=tuple(chosen),
            algebraics=(*whole.algebraics, *unknowns),
            outputs=tuple(whole.outputs[k] for k in outputs),
            expressions=self._expressions(outputs),
            recipe=None if whole.recipe is None else CondensedRecipe(whole.recipe),
            part=self._part(forces),
            origin=whole,
            splitting=None,
        )

    def _outputs(self) -> list[int]:
        """The outputs that are functions of the places alone."""
        e, other = self.e, np.setdiff1d(np.arange(self.n), self.places)
        elsewhere = ca.vertcat(ca.SX(0, 1), *[v[int(k)] for v in (e.rate, e.state) for k in other])
        if elsewhere.numel() == 0:
            return list(range(e.outputs.numel()))
        return [k for k in range(e.outputs.numel()) if not ca.depends_on(e.outputs[k], elsewhere)]

    @cached_property
    def _linear(self) -> tuple[ca.SX, ca.SX]:
        """E and A as functions of the parameters, in rows with a force about zero."""
        e, n = self.e, self.n
        zero = ca.vertcat(e.rate, e.state, e.algebraic, e.phase)
        about = ca.substitute(self.jacobian[:n, : 2 * n], zero, ca.SX.zeros(zero.numel()))
        values = ca.Function("about", [e.parameter], [about])(self.whole.nominal)
        finite = np.isfinite(np.array(ca.DM(values).full()))
        for i, j in np.argwhere(~finite):
            about[int(i), int(j)] = 0
        return about[:, :n], about[:, n:]

    def _part(self, forces: tuple[int, ...]) -> RowsPart:
        e, whole = self.e, self.whole
        inertia, stiffness = self._linear
        given = inertia, stiffness
        evaluate = ca.Function("linear", [e.parameter], [ca.vertcat(*(matrix.nz[:] for matrix in given))])
        places = [tuple(np.array(matrix.sparsity().get_triplet(), dtype=int)) for matrix in given]

        def matrices(parameter: Array) -> tuple[Array, Array]:
            """The nonzeros come as a list; of whole matrices CasADi makes lists too."""
            values = np.array(ca.DM(evaluate(parameter)).nonzeros())
            found = np.zeros((2, self.n, self.n))
            found[0][places[0]], found[1][places[1]] = np.split(values, [inertia.nnz()])
            return found[0], found[1]

        both = ca.vertcat(ca.vec(inertia), ca.vec(stiffness))
        varying = sorted(set(ca.jacobian(both, e.parameter).sparsity().get_col()))
        names = [whole.states[k].name for k in self.places]
        loads = np.zeros((self.n, len(self.rows)))
        loads[self._loaded] = self.combined.matrix
        return RowsPart(
            matrices=matrices,
            loads=loads,
            places=tuple(int(k) for k in self.places),
            forces=forces,
            varying=tuple(varying),
            scales=np.array([state.scale for state in whole.states]),
            rates=tuple(k for k, name in enumerate(names) if name.endswith("'")),
            moving=tuple(k for k, state in enumerate(whole.states) if state.name.endswith("'")),
            omega=whole.omega,
        )

    def _expressions(self, outputs: list[int]) -> Expressions:
        e, n, s = self.e, self.n, len(self.places)
        rate, state = ca.SX.sym("rate", s), ca.SX.sym("state", s)
        algebraic = ca.SX.sym("algebraic", e.algebraic.numel() + len(self.rows))
        increment = ca.SX.sym("increment", algebraic.numel())
        m = e.algebraic.numel()
        full_rate, full_state = ca.SX.zeros(n), ca.SX.zeros(n)
        for k, place in enumerate(self.places):
            full_rate[int(place)], full_state[int(place)] = rate[k], state[k]
        old = ca.vertcat(e.rate, e.state, e.algebraic)
        moving = ca.vertcat(full_rate, full_state, algebraic[:m, :])

        def reduced(rows: ca.SX, forces: ca.SX) -> ca.SX:
            unknowns, left = (ca.substitute(each, old, moving) for each in (self._still(rows)[n:], forces))
            return ca.vertcat(ca.SX.zeros(s), unknowns, algebraic[m:, :] - left)

        shown = ca.substitute(e.outputs[outputs], old, moving)
        whole = e.waved.numel() - e.outputs.numel()
        each = zip((e.residual, e.unexcited, e.waved[:whole]), self.combined.forces, strict=True)
        residual, unexcited, waved = (reduced(rows, forces) for rows, forces in each)
        waved = ca.vertcat(waved, ca.substitute(e.waved[whole:][outputs], old, moving))
        return replace(
            e,
            rate=rate,
            state=state,
            algebraic=algebraic,
            residual=residual,
            unexcited=unexcited,
            waved=waved,
            outputs=shown,
            sided=replace(e.sided, residual=residual),
            switches=ca.substitute(e.switches, e.state, full_state),
            guards=ca.substitute(e.guards, e.state, full_state),
            rest_state=e.rest_state[[int(k) for k in self.places]],
            rest_algebraic=ca.vertcat(e.rest_algebraic, ca.SX.zeros(len(self.rows))),
            increment=increment,
            moved=ca.vertcat(
                ca.substitute(
                    e.moved,
                    ca.vertcat(e.algebraic, e.increment),
                    ca.vertcat(algebraic[:m, :], increment[:m, :]),
                ),
                algebraic[m:, :] + increment[m:, :],
            ),
        )
