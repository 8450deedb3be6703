"""What parts lay in an assembly, evaluated at numbers: sliders, relays, impacts, rates and frequencies."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import casadi as ca
import pytest

import symbolic as sym
from symbolic.equations.assembly import Assembly
from symbolic.equations.terms import Motion, mobility, struck


def at(expression: ca.SX, *given: tuple[ca.SX, float]) -> float:
    """An expression at numbers for symbols."""
    symbols, numbers = ca.vertcat(*(s for s, _ in given)), [number for _, number in given]
    return float(ca.Function("f", [symbols], [ca.SX(expression)])(numbers))


def moving(scale: float = 0.5) -> tuple[Assembly, Motion]:
    """An assembly with one coordinate."""
    assembly = Assembly()
    return assembly, assembly.motion(sym.coordinate("x", scale=scale))


def test_slider() -> None:
    """Assert its row in each mode, its switches, guard and place: e = 3 x, l = x, z in units of 0.25."""
    assembly, motion = moving()
    assembly.switch("other", motion.position.symbol, 0)
    assembly.differential_rows.append(ca.SX(0))
    z = assembly.state("z", "m", 0.25, ca.SX(0))
    x, v = motion.position.symbol, motion.velocity.symbol
    assembly.slider("joint", z, ca.SX(7), 3 * x, x)
    (index, slider), known = next(iter(assembly.sliders.items())), ((x, 0.5), (v, 2.0), (z.symbol, 1.0))
    rate = (z.derivative, 4.0)
    assert (index, slider.row, slider.releases, slider.state) == (1, 1, (2, 3), z)
    assert at(assembly.differential_rows[1], *known) == 7.0
    assert at(slider.held, rate) == 16.0
    assert [at(s, *known) for s in slider.speeds] == [(6 - 2) / 0.25, (6 + 2) / 0.25]
    assert [at(s, rate, *known) for s in slider.slipping] == [16.0 - 16.0, 16.0 - 32.0]
    infos, switches = zip(*assembly.switches[1:], strict=True)
    assert [(i.name, i.direction) for i in infos] == [
        ("joint: strained", 0),
        ("joint: slips up", 1),
        ("joint: slips down", -1),
    ]
    assert [at(s, *known) for s in switches] == [6 / 0.25, (1.5 - 1.0 - 0.5) / 0.25, (1.5 - 1.0 + 0.5) / 0.25]
    place = assembly.numbers.named()["place of z"][1]
    symbol = ca.symvar(slider.place)[-1]
    assert assembly.parameters["place of z"].value == 0.0 and place is not None
    assert at(slider.place, (z.symbol, 1.0), (symbol, 0.5)) == 2.0
    assert list(assembly.places_held) == [1]


def test_places_where_joints_are_held() -> None:
    """Assert how far a deflection is from the place, scaled, and a number for the second of a name."""
    assembly, motion = moving()
    names = []
    for k in range(3):
        found = assembly.holds("joint", 2 * motion.position.symbol, 0.25, "m")
        (place,) = [s for s in ca.symvar(found) if s.name() != "x"]
        assert at(found, (motion.position.symbol, 1.5), (place, 1.0)) == 8.0
        names.append(assembly.places_held[k][0])
        assembly.switch(f"s{k}", motion.velocity.symbol, 0)
    assert names == ["place of joint", "place of joint (2)", "place of joint (3)"]
    assert {p.unit for p in assembly.parameters.values()} == {"m"}


def test_relays_that_are_the_same() -> None:
    """Assert one symbol for one pair of thresholds, another where either differs."""
    assembly, motion = moving()
    x = motion.position.symbol
    given = [(1.0, 0.5), (1.0, 0.5), (2.0, 0.5), (1.0, 0.25), (2.0, 0.5)]
    names = [assembly.relay(2 * x, ca.SX(on), ca.SX(off)).name() for on, off in given]
    assert names == ["relay_1", "relay_1", "relay_2", "relay_3", "relay_2"]
    assert [info.name for info, _ in assembly.switches] == ["relay 1", "relay 2", "relay 3"]
    assert [info.direction for info, _ in assembly.switches] == [0, 0, 0]
    assert [at(s, (x, 3.0)) for _, s in assembly.switches] == [5.0, 4.0, 5.0]
    assert [at(r.under, (x, 3.0)) for r in assembly.relays.values()] == [5.5, 5.5, 5.75]
    assert list(assembly.relays) == [0, 1, 2]


def test_switches_of_impacts() -> None:
    """Assert that they mark falls, at the indices by which resets and impacts are known."""
    assembly, motion = moving()
    assembly.switch("first", motion.position.symbol, 1, (0.0, -1.0))
    assembly.reset("reset", motion.position.symbol, {motion.position: ca.SX(2)})
    assembly.impact("impact", motion.velocity.symbol, motion, ca.SX(3))
    infos = [info for info, _ in assembly.switches]
    assert [(i.name, i.direction, i.levels) for i in infos] == [
        ("first", 1, (0.0, -1.0)),
        ("reset", -1, (0.0,)),
        ("impact", -1, (0.0,)),
    ]
    assert list(assembly.resets) == [1] and list(assembly.impacts) == [2]
    assembly.smooth_at(motion.position.symbol)
    assert len(assembly.smooth) == 1
    with pytest.raises(ValueError, match="^name of a switch is "):
        assembly.switch("a\nb", motion.position.symbol, 0)


def coupled() -> tuple[Assembly, list[Motion]]:
    """Three coordinates of 2, 3 and 5 kg; -x2'' on the first and -x1'' on the second, in omega^2."""
    assembly = Assembly()
    motions = [assembly.motion(sym.coordinate(f"x{k}", scale=1.0)) for k in (1, 2, 3)]
    for motion, mass in zip(motions, (2.0, 3.0, 5.0), strict=True):
        motion.mass = ca.SX(mass)
    one, two, _ = motions
    one.force = -(assembly.omega**2) * two.velocity.derivative
    two.force = -(assembly.omega**2) * one.velocity.derivative
    return assembly, motions


def test_mobility_of_coupled_coordinates() -> None:
    """Assert M^-1 e of [[2, 1], [1, 3]], and of a mass that nothing is coupled to."""
    assembly, motions = coupled()
    found = mobility(motions, motions[1], assembly.omega)
    assert {k: float(ca.DM(v)) for k, v in found.items()} == pytest.approx({0: -0.2, 1: 0.4})
    alone = mobility(motions, motions[2], assembly.omega)
    assert {k: float(ca.DM(v)) for k, v in alone.items()} == {2: 0.2}


def test_velocities_after_an_impulse() -> None:
    """Assert v + M^-1 e (v+ - v-) / (e^T M^-1 e); the one that is struck alone where nothing is coupled."""
    assembly, motions = coupled()
    v1, v2 = (m.velocity.symbol for m in motions[:2])
    after = struck(motions, motions[1], -0.5 * v2, assembly.omega)
    assert list(after) == [motions[0].velocity, motions[1].velocity]
    assert at(after[motions[0].velocity], (v1, 1.0), (v2, 2.0)) == pytest.approx(1.0 - 0.2 * (-3.0 / 0.4))
    assert at(after[motions[1].velocity], (v1, 1.0), (v2, 2.0)) == -1.0
    assert list(struck(motions, motions[2], ca.SX(4), assembly.omega)) == [motions[2].velocity]
    assembly.impact("hit", motions[1].position.symbol, motions[1], -v2)
    assembly.close()
    assert list(assembly.resets) == [0] and len(assembly.resets[0]) == 2


def test_rates_and_speeds() -> None:
    """Assert d/dtau of coordinates, other states and the excitation, and dq/dt = omega dq/dtau."""
    assembly, motion = moving()
    z = assembly.state("z", "m", 1.0, ca.SX(0))
    x, v = motion.position.symbol, motion.velocity.symbol
    rate = assembly.rate(x**2 + 3 * z.symbol)
    assert at(rate, (x, 2.0), (v, 5.0), (z.derivative, 7.0)) == 41.0
    coordinate = next(iter(assembly.motions))
    assert at(assembly.speed_of(coordinate), (assembly.omega, 3.0), (v, 2.0)) == 6.0


@pytest.mark.parametrize(("unit", "factor"), [("rad/s", 1.0), ("", 1.0), ("Hz", 6.283185307179586)])
def test_angular_frequencies(unit: str, factor: float) -> None:
    """Assert rad/s of a parameter in its unit where rad/s is asked for, and the number itself elsewhere."""
    assembly = Assembly()
    given = sym.parameter("f", 2.0, unit)
    assert assembly.nominal(assembly.parameter(given, "Omega", "rad/s")) == pytest.approx(2.0 * factor)
    assert assembly.nominal(assembly.parameter(given, "f", unit)) == 2.0


def test_one_frequency_of_excitation() -> None:
    """Assert the sentence for another one, and that the same is taken again; omega is the one by default."""
    assembly = Assembly()
    assembly.excite(assembly.parameter(2.0, "Omega", "rad/s"))
    assembly.excite(assembly.parameter(2.0, "Omega", "rad/s"))
    with assembly.owned("part"), pytest.raises(ValueError, match=r"two frequencies, .* = 2 rad/s and .*part"):
        assembly.excite(assembly.parameter(3.0, "Omega", "rad/s"))
    assert assembly.owner == ""
    assert assembly.nominal(3 * assembly.omega + 1) == 7.0
    assert Assembly().nominal(ca.SX(4.5)) == 4.5


def test_names_that_are_taken() -> None:
    """Assert the sentences of states, coordinates and outputs."""
    assembly, motion = moving()
    x = motion.position.symbol
    assembly.output("force", "N", 2 * x)
    assert [(v.name, v.unit) for v, _ in assembly.described] == [("x", motion.position.unit), ("force", "N")]
    for act, said in (
        (lambda: assembly.state("x'", "m", 1.0, ca.SX(0)), 'state "x\'" is defined twice'),
        (lambda: assembly.output("force", "N", x), "output 'force' is defined twice"),
        (lambda: assembly.motion(sym.coordinate("x")), "two coordinates are called 'x'"),
        (lambda: assembly.motion("x"), "coordinate is 'x'; it must be a Coordinate"),
    ):
        with pytest.raises((ValueError, TypeError), match=f"^{said}"):
            act()


def test_scales_of_coordinates() -> None:
    """Assert that a suggested one counts where the user has set none."""
    assembly = Assembly()
    own, free = sym.coordinate("own", scale=0.5), sym.coordinate("free")
    for coordinate in (own, free):
        assert assembly.motion(coordinate).position.scale == (0.5 if coordinate is own else 1.0)
        assembly.suggest_scale(coordinate, 0.1)
    found = [(m.position.scale, m.velocity.scale) for m in assembly.motions.values()]
    assert found == [(0.5, 0.5), (0.1, 0.1)]


@pytest.mark.parametrize(("order", "phase"), [(1, 0.0), (2, 0.7), ("1/2", -0.4)])
def test_harmonics(order: Any, phase: float) -> None:
    """Assert cos(k theta + phase) = cos(k theta) cos(phase) - sin(k theta) sin(phase)."""
    assembly = Assembly()
    wave, (sine, cosine) = assembly.harmonic(order, phase), assembly.excitation.wave(order)
    expected = 0.8 * math.cos(phase) - 0.6 * math.sin(phase)
    assert at(wave, (sine, 0.6), (cosine, 0.8)) == pytest.approx(expected)
    pace, ratio = assembly.excitation.pace, float(Fraction(order))
    rate = ratio * 0.25 * (0.8 * -math.sin(phase) - 0.6 * math.cos(phase))
    assert at(assembly.rate(wave), (sine, 0.6), (cosine, 0.8), (pace, 0.25)) == pytest.approx(rate)
