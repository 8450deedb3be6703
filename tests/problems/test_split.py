"""A chain of oscillators whose linear part is found in its equations, against all of its states."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import periodic as per
import symbolic as sym


@cache
def chain(count: int, cubic: float = 0.5) -> sym.CompiledSystem:
    """Oscillators coupled to their neighbours, a cubic spring at the first, driven at the last."""
    q = [sym.coordinate(f"q{i}") for i in range(count)]
    parts: list[sym.Part] = []
    for x in q:
        parts += [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.05)]
    parts += [sym.Coupling(a, b, 0.2) for a, b in zip(q[:-1], q[1:], strict=True)]
    parts += [sym.CubicSpring(q[0], cubic)] if cubic else []
    return sym.compile(sym.combine([*parts, sym.HarmonicForce(q[-1], 0.2, 1.6)]))


@cache
def branch(split: bool) -> per.Branch:
    """Past the last resonance of three."""
    system = sym.condensed(chain(3)) if split else chain(3)
    return per.trace(system, "Omega", (1.3, 1.0), at=1.1, tol=1e-8)


def test_structure_is_stated() -> None:
    """Assert how much of the model is linear, in words."""
    assert str(sym.structure_of(chain(3))) == "6 states, 5 linear, 1 place"
    assert sym.structure_of(chain(3)).nonlinear == ("q0",)


def test_folds_are_those_of_all_states() -> None:
    """Assert both folds to 9 digits, and the multipliers between them to 7."""
    ours, full = branch(True), branch(False)
    places = [[p.parameter for p in of.points if p.label is per.Label.FOLD] for of in (ours, full)]
    assert len(places[0]) == 2
    assert places[0] == pytest.approx(places[1], rel=1e-9)
    at = [next(p for p in of.points if p.parameter == 1.1) for of in (ours, full)]
    assert at[0].maximum["q0"] == pytest.approx(at[1].maximum["q0"], rel=1e-8)
    assert np.allclose(*(np.sort_complex(p.multipliers) for p in at), rtol=0, atol=1e-7)


def test_motion_of_every_state() -> None:
    """Assert positions and velocities of all masses to 7 digits."""
    ours, full = (next(p.orbit for p in branch(s).points if p.parameter == 1.1) for s in (True, False))
    phases = np.linspace(0, 6, 7)
    value, rate = per.motion(sym.condensed(chain(3)), ours, [0, 2, 4], phases)
    for k in range(3):
        assert np.allclose(value[:, k], full[f"q{k}"](phases / 1.1), rtol=0, atol=1e-7)
        assert np.allclose(rate[:, k], full[f"q{k}'"](phases / 1.1), rtol=0, atol=1e-7)


def test_branch_is_written_and_read(tmp_path: Path) -> None:
    """Assert that a file has the multipliers, more than the states that are left."""
    branch(True).save(tmp_path / "chain.nc")
    read = per.Branch.load(tmp_path / "chain.nc")
    assert len(read.points[0].multipliers) == 6
    assert np.array_equal(read.points[-1].multipliers, branch(True).points[-1].multipliers)


def test_linear_model_is_refused() -> None:
    """Assert one sentence."""
    with pytest.raises(ValueError, match="no state enters the equations nonlinearly"):
        sym.condensed(chain(2, cubic=0.0))
