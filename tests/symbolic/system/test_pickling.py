"""Systems travel to other processes as what they are made from."""

from __future__ import annotations

import pickle
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import cloudpickle
import numpy as np
import pytest

import symbolic as sym


def van_der_pol(x: Any, p: Any) -> Mapping[str, Any]:
    """The equations of van der Pol's oscillator, as a user's module has them."""
    return {"x": x.y, "y": p.mu * (1 - x.x**2) * x.y - x.x}


def same(a: sym.CompiledSystem, b: sym.CompiledSystem) -> bool:
    """Whether two systems agree bit for bit: names, values, residual and Jacobian at a few points."""
    random = np.random.default_rng(5)
    shape = (4, len(a.states))
    at = (
        0.1 * random.standard_normal(shape),
        0.1 * random.standard_normal(shape),
        0.1 + 0.01 * random.standard_normal((4, len(a.algebraics))),
        random.uniform(0, 2 * np.pi, 4),
        a.nominal,
    )
    first, second = a.linearise(*at, (0,)), b.linearise(*at, (0,))
    described = [(s.states, s.algebraics, s.parameters, s.outputs, s.switches, s.kernels) for s in (a, b)]
    return repr(described[0]) == repr(described[1]) and all(
        np.array_equal(getattr(first, name), getattr(second, name), equal_nan=True)
        for name in ("residual", "d_state", "d_rate", "d_algebraic", "d_phase", "d_parameter")
    )


@pytest.mark.parametrize("name", sym.scene_names())
def test_every_scene_travels(name: str) -> None:
    """Assert that a scene's system read back from its pickle is the same bit for bit."""
    system = sym.scene(name)
    assert same(system, pickle.loads(pickle.dumps(system)))


def test_shared_parameter_stays_one() -> None:
    """Assert that a parameter and a coordinate that two parts share are one after the way."""
    x, stiffness = sym.coordinate("x"), sym.parameter("k", 2.0, "N/m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, stiffness) + sym.CubicSpring(x, stiffness)
    system = sym.compile(model + sym.HarmonicForce(x, 1.0))
    back = pickle.loads(pickle.dumps(system))
    assert [p.name for p in back.parameters].count("k") == 1 and same(system, back)


def test_functions_travel_by_name_and_by_value() -> None:
    """Assert that pickle takes a module's function, refuses a lambda, and cloudpickle takes both."""
    given = {"states": {"x": 1.0, "y": 0.0}, "parameters": {"mu": 1.0}}
    named = sym.compile(sym.Equations(van_der_pol, **given))
    unnamed = sym.compile(sym.Equations(lambda x, p: van_der_pol(x, p), **given))
    assert same(named, pickle.loads(pickle.dumps(named)))
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(unnamed)
    assert same(unnamed, pickle.loads(cloudpickle.dumps(unnamed)))


def test_system_without_a_model_says_so() -> None:
    """Assert that a system put together by hand is refused in one sentence."""
    system = replace(sym.scene("duffing"), recipe=None)
    with pytest.raises(pickle.PicklingError, match=r"system has no model .*; it must come from symbolic"):
        pickle.dumps(system)


def test_another_process_compiles_it() -> None:
    """Assert that a fresh interpreter makes the same residual out of the bytes."""
    system = sym.scene("vitrea79-810N")
    code = (
        "import pickle, sys, numpy as np; s = pickle.loads(sys.stdin.buffer.read()); "
        "print(s.residual(np.ones((1, 3)), np.ones((1, 3)), np.ones((1, 1)), np.ones(1), s.nominal).tolist())"
    )
    done = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(system), capture_output=True)
    ones = (np.ones((1, 3)), np.ones((1, 3)), np.ones((1, 1)), np.ones(1), system.nominal)
    assert done.stdout.decode().strip() == str(system.residual(*ones).tolist()), done.stderr.decode()
