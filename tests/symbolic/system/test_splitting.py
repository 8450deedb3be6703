"""What is condensed of systems with unknowns of their own: places, forces, rest and loads."""

from __future__ import annotations

import numpy as np
import pytest
from support.models import PARTS

import symbolic as sym
from symbolic.system.splitting import CondensedRecipe, condensed

LEFT = {
    "dry": (["x"], ["force on row 2"]),
    "quasistatic": (["x"], ["xi", "force on row 2"]),
    "squeeze": (["x", "h"], ["xi", "force on row 2", "force on row 3"]),
    "two discs, dry": (["x1", "x2"], ["force on row 2", "force on row 4"]),
    "two discs, squeeze": (
        ["x1", "x2", "h"],
        ["xi", "force on row 2", "force on row 4", "force on row 5"],
    ),
    "duffing": (["x"], ["force on row 2"]),
}
"""States and unknowns that are left: displacements that enter nonlinearly, and a force for each row there."""


def whole(name: str) -> sym.CompiledSystem:
    """A model with all its states."""
    return sym.compile(sym.combine(PARTS[name]()))


@pytest.mark.parametrize("name", LEFT)
def test_what_is_left_of_a_system(name: str) -> None:
    """Assert states and unknowns, that parameters and outputs stay, and that rest is the same there."""
    before = whole(name)
    system = condensed(before)
    assert ([q.name for q in system.states], [q.name for q in system.algebraics]) == LEFT[name]
    assert [q.name for q in system.parameters] == [q.name for q in before.parameters]
    assert {q.name for q in before.outputs} <= {q.name for q in system.outputs}
    state, unknown = system.rest(system.nominal)
    every, others = before.rest(before.nominal)
    names = [q.name for q in before.states]
    assert state == pytest.approx([every[names.index(q.name)] for q in system.states], abs=1e-9)
    own = [q.name for q in before.algebraics]
    for quantity, value in zip(system.algebraics, unknown, strict=True):
        if quantity.name in own:
            assert value == pytest.approx(others[own.index(quantity.name)], abs=1e-9)
    assert system.linear is not None and before.linear is None


def test_what_is_condensed_stays_as_it_is() -> None:
    """Assert the system itself, and the recipe of what is condensed."""
    system = condensed(whole("duffing"))
    assert condensed(system) is system
    again = CondensedRecipe(lambda: whole("duffing"))()
    assert [q.name for q in again.states] == ["x"] and again.linear is not None


def test_what_cannot_be_condensed_is_refused() -> None:
    """Assert the sentences: rates that enter nonlinearly, and what is no system."""
    with pytest.raises(
        ValueError, match="^rates enter the equations nonlinearly; no linear part can be split"
    ):
        condensed(whole("relaxation"))
    with pytest.raises(ValueError, match="^system is 1; it must be a CompiledSystem$"):
        condensed(1)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", LEFT)
def test_residual_on_sides_is_that_of_what_is_left(name: str) -> None:
    """Assert that without jumps it is the residual itself, of the symbols that are left."""
    system = condensed(whole(name))
    state, unknown = system.rest(system.nominal)
    rate = np.linspace(0.1, 0.4, len(state))
    point = rate[None], state[None] + 0.2, unknown[None] + 0.3, np.array([0.7]), system.nominal
    plain = system.linearise(*point)
    beside = system.linearise_beside(*point, np.zeros((1, 0)))
    np.testing.assert_array_equal(beside.residual, plain.residual)
    np.testing.assert_array_equal(beside.d_state, plain.d_state)
