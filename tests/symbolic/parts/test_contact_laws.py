"""Laws of contact: one that gives its load only is what Hertz's closed forms are, in every film."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
import pytest

import symbolic as sym
from symbolic.equations.assembly import Assembly
from symbolic.parts.contact.pair import junction_of
from symbolic.scenes import laws
from symbolic.scenes.reading import load
from symbolic.scenes.schema import HertzDiscScene

DISCS = [name for name in sym.scene_names() if isinstance(load(name), HertzDiscScene)]


@dataclass(frozen=True)
class Power(sym.ContactLaw):
    """Hertz's law, of which only the load is said."""

    stiffness: float
    exponent: float

    def load(self, assembly: sym.Assembly, deflection: Any) -> Any:
        """Return K max(delta, 0)^n."""
        stiffness = assembly.parameter(self.stiffness, "stiffness", "N/m^n")
        exponent = assembly.parameter(self.exponent, "exponent")
        return stiffness * sym.functions.fmax(deflection, 1e-300) ** exponent


@dataclass(frozen=True)
class Hardening(sym.ContactLaw):
    """W = k delta + c delta^3."""

    linear: float
    cubic: float = 1e18

    def load(self, assembly: sym.Assembly, deflection: Any) -> Any:
        """Return W."""
        k, c = assembly.parameter(self.linear, "k"), assembly.parameter(self.cubic, "c")
        touching = sym.functions.fmax(deflection, 1e-300)
        return k * touching + c * touching**3


@pytest.fixture(autouse=True)
def registered(monkeypatch: pytest.MonkeyPatch) -> None:
    """The two laws beside Hertz's, forgotten afterwards."""
    monkeypatch.setattr(laws, "_laws", {"hertz": sym.HertzLaw})
    sym.register_contact_law("power", Power)
    sym.register_contact_law("hardening", Hardening)


@pytest.mark.parametrize("name", DISCS)
def test_load_alone_gives_what_the_closed_forms_give(name: str) -> None:
    """Assert residual, derivatives and outputs of every scene, at its own preload and at a tenth of it."""
    closed, solved = sym.scene(name), sym.scene(name, {"contact.law": "power"})
    assert [p.name for p in solved.parameters] == [p.name for p in closed.parameters]
    rng, count = np.random.default_rng(1), 9
    n, m = len(closed.states), len(closed.algebraics)
    parameter = closed.nominal
    for _ in range(2):
        rest = closed.rest(parameter)[0]
        scatter = rest * rng.uniform(0.9, 1.1, (count, n)) + (rest == 0) * rng.uniform(-0.2, 0.2, (count, n))
        algebraic, phase = rng.uniform(-40, 40, (count, m)), rng.uniform(0, 6, count)
        at = (rng.uniform(-0.1, 0.1, (count, n)), scatter, algebraic, phase, parameter)
        one, other = closed.linearise(*at, free=(1, 2)), solved.linearise(*at, free=(1, 2))
        for field in ("residual", "d_rate", "d_state", "d_algebraic", "d_phase", "d_parameter"):
            expected = getattr(one, field)
            size = 1e-9 * np.abs(expected).max(initial=1)
            np.testing.assert_allclose(getattr(other, field), expected, rtol=1e-9, atol=size)
        np.testing.assert_allclose(solved.output(*at), closed.output(*at), rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(solved.switch(*at[1::2], parameter), closed.switch(*at[1::2], parameter))
        parameter = parameter * np.where(np.array([p.name for p in closed.parameters]) == "preload", 0.1, 1)


@pytest.mark.parametrize("preload", [0.3, 810.0, 2e5])
def test_deflection_under_any_preload(preload: float) -> None:
    """Assert k delta0 + c delta0^3 = Q far from the nominal preload, by the linear frequency."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    parts = [sym.Mass(x, 2.0), sym.Preload(pair, 810.0), sym.ElasticContact(pair, Hardening(1e8))]
    system = sym.compile(sym.combine(parts))
    rest = sym.modes(system, {"preload": preload})
    (delta0,) = (r.real for r in np.roots([1e18, 0, 1e8, -preload]) if abs(r.imag) < 1e-12)
    assert rest.frequencies[0] == pytest.approx(np.sqrt((1e8 + 3e18 * delta0**2) / 2.0), rel=1e-11)


def test_scene_with_a_default_number() -> None:
    """Assert that a law's number may be left out where it has a default, and that keys are the law's."""
    law = {"contact.exponent": None, "contact.stiffness": None, "contact.law": "hardening"}
    system = sym.scene("dry-810N", {**law, "contact.linear": 1e8})
    assert {"k": 1e8, "c": 1e18}.items() <= {p.name: p.value for p in system.parameters}.items()
    with pytest.raises(sym.InputError, match="^contact.linear is missing; it must be a number$"):
        sym.scene("dry-810N", law)
    with pytest.raises(sym.InputError, match="^contact.stiffness is not a key of the scene"):
        sym.scene("dry-810N", {"contact.exponent": None, "contact.law": "hardening", "contact.linear": 1})
    with pytest.raises(sym.InputError, match='^contact.law is "soft"; it must be "hertz", "power" or "hard'):
        sym.scene("dry-810N", {"contact.law": "soft"})


@pytest.mark.parametrize(
    ("name", "law", "said"),
    [
        ("hertz", Power, "name of a contact law is 'hertz'; it must be small letters, digits and hyphens"),
        ("A b", Power, "name of a contact law is 'A b'; it must be small letters"),
        ("plain", int, "contact law 'plain' is <class 'int'>; it must be a dataclass"),
    ],
)
def test_registration_that_is_refused(name: str, law: Any, said: str) -> None:
    """Assert that a law needs a name of its own and fields."""
    with pytest.raises(ValueError, match=f"^{said}"):
        sym.register_contact_law(name, law)


def test_law_that_cannot_carry_the_preload() -> None:
    """Assert that a law that does not reach the preload is refused in one sentence."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    parts = [sym.Mass(x, 2.0), sym.Preload(pair, 810.0), sym.ElasticContact(pair, Hardening(0.0, 0.0))]
    with pytest.raises(ValueError, match="^contact 'contact' has no static deflection"):
        sym.compile(sym.combine(parts))


def test_damping_is_that_of_the_stiffness_under_the_preload() -> None:
    """Assert a damping ratio where the law's slope in logarithms changes with the deflection."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    parts = [
        sym.Mass(x, 2.0),
        sym.Preload(pair, 2e5),
        sym.ElasticContact(pair, Hardening(1e8)),
        sym.ContactDamping(pair, 0.05),
    ]
    assert sym.modes(sym.compile(sym.combine(parts))).damping_ratios[0] == pytest.approx(0.05, rel=1e-9)


@pytest.mark.parametrize("reduced", [False, True])
def test_waves_that_a_film_fills(reduced: bool) -> None:
    """Assert the compression: the waves, less what the film takes of them, less the displacement."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    parts = [
        sym.Mass(x, 2.0),
        sym.Preload(pair, 500.0),
        sym.Hertz(pair, 1e9, 1.5),
        sym.Waviness(pair, 1e-6, 12, 5.0),
    ]
    assembly = Assembly()
    assembly.lay(parts)
    junction = junction_of(assembly, pair)
    if reduced:
        object.__setattr__(junction, "ripple", lambda preload: preload / 2000.0)
    loaded = junction._loaded(assembly)
    symbols = ca.symvar(loaded.compression)
    values = {"x": 3e-7}
    numbers = {str(s): p.value for p, each in assembly.numbers.named().values() for s in each}
    waves = [str(s) for s in ca.symvar(junction.profile) if str(s) not in numbers]
    given = ca.vertcat(*[numbers.get(str(s), values["x"] if str(s) == "x" else 0.5) for s in symbols])
    found = float(ca.Function("f", [ca.vertcat(*symbols)], [loaded.compression])(given))
    assert len(waves) == 1
    part = 1 - 500.0 / 2000.0 if reduced else 1.0
    assert found == pytest.approx(1e-6 * 0.5 * part - 3e-7, rel=1e-9)
