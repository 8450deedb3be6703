"""Models as sums of parts: a scene holds what its parts need, in any order, and nothing else."""

import itertools

import numpy as np
import pytest
from support.models import PARTS, RPM, WAVES, Disc, Relaxation, draw, duffing_parts, residual_in_order, scene

import symbolic as sym

SIZES = {
    "dry": (2, 0),
    "quasistatic": (2, 1),
    "squeeze": (3, 1),
    "two discs, dry": (4, 0),
    "two discs, squeeze": (5, 1),
    "duffing": (2, 0),
    "relaxation": (1, 0),
}
"""States and algebraic unknowns."""

OUTPUTS = {
    "dry": ["x", "deflection", "load"],
    "quasistatic": ["x", "film", "deflection", "load"],
    "squeeze": ["x", "film", "deflection", "load"],
    "two discs, dry": ["x1", "x2", "deflection", "load"],
    "two discs, squeeze": ["x1", "x2", "film", "deflection", "load"],
    "duffing": ["x"],
    "relaxation": ["T"],
}


def assert_same_equations(a: sym.CompiledSystem, b: sym.CompiledSystem) -> None:
    """Compare the residuals of two systems with the same states and parameters, in whatever order."""
    assert {v.name for v in a.parameters} == {v.name for v in b.parameters}
    points = draw(a)
    expected = a.residual(*points.arguments)
    np.testing.assert_allclose(residual_in_order(points, a, b), expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", PARTS)
def test_scene_has_only_what_its_parts_need(name: str) -> None:
    """Assert that a scene has the states and algebraic unknowns of its parts and no more."""
    system = scene(name)
    assert (len(system.states), len(system.algebraics)) == SIZES[name]


@pytest.mark.parametrize("name", PARTS)
def test_scene_has_the_outputs_of_its_parts(name: str) -> None:
    """Assert that coordinates and contact bring their outputs, a film only where there is one."""
    assert [v.name for v in scene(name).outputs] == OUTPUTS[name]


@pytest.mark.parametrize("name", [n for n in PARTS if n != "relaxation"])
def test_parts_add_in_any_order(name: str) -> None:
    """Assert that the order of the parts does not change the equations."""
    parts = PARTS[name]()
    rng = np.random.default_rng(1)
    for order in [parts[::-1], *(list(rng.permutation(np.array(parts, dtype=object))) for _ in range(3))]:
        assert_same_equations(sym.compile(sym.combine(parts)), sym.compile(sym.combine(order)))


def test_parts_add_in_any_grouping() -> None:
    """Assert that + of parts and of models is associative and the same as combine."""
    a, b, c, d, *rest = Disc().parts()
    reference = sym.combine([a, b, c, d, *rest])
    tail = sym.combine(rest)
    groupings = [a + b + c + d + tail, a + (b + (c + (d + tail))), (a + b) + (c + d) + tail]
    for model in groupings:
        assert model.parts == reference.parts
        assert_same_equations(sym.compile(reference), sym.compile(model))


def test_single_part_compiles_without_a_model() -> None:
    """Assert that one part is compiled as the model of that part alone."""
    alone, model = sym.compile(Relaxation()), sym.compile(sym.combine([Relaxation()]))
    assert_same_equations(alone, model)


def test_forces_on_one_coordinate_add_up() -> None:
    """Assert that two springs are one of the sum of their stiffnesses."""
    x = sym.coordinate("x")
    rest = sym.Mass(x, 2.0) + sym.HarmonicForce(x, 0.5, 0.8)
    ka, kb = sym.parameter("ka", 1.25), sym.parameter("kb", 0.5)
    two = sym.compile(rest + sym.Spring(x, ka) + sym.Spring(x, kb))
    one = sym.compile(rest + sym.Spring(x, 1.75))
    points = draw(one)
    p = one.nominal
    names = [v.name for v in two.parameters]
    split = np.array([dict(zip([v.name for v in one.parameters], p, strict=True)).get(n, 0.0) for n in names])
    split[names.index("ka")], split[names.index("kb")] = 1.25, 0.5
    arguments = points.arguments[:-1]
    np.testing.assert_allclose(two.residual(*arguments, split), one.residual(*arguments, p), rtol=1e-14)


def without(system: sym.CompiledSystem, smaller: sym.CompiledSystem, gone: str, value: float) -> None:
    """Assert that a parameter at a value gives the residual of the system without the part."""
    points = draw(system)
    names = [v.name for v in system.parameters]
    parameter = points.parameter.copy()
    parameter[names.index(gone)] = value
    less = np.array([parameter[names.index(v.name)] for v in smaller.parameters])
    assert gone not in [v.name for v in smaller.parameters]
    arguments = points.arguments[:-1]
    expected = smaller.residual(*arguments, less)
    np.testing.assert_allclose(system.residual(*arguments, parameter), expected, rtol=1e-13, atol=1e-14)


@pytest.mark.parametrize("film", [None, "quasistatic", "squeeze"])
def test_damping_ratio_zero_is_no_damping_part(film: str | None) -> None:
    """Assert that damping ratio 0 gives the equations of the scene without a ContactDamping."""
    without(Disc(film=film, zeta=0.3).compile(), Disc(film=film).compile(), "damping_ratio", 0.0)


def test_cubic_spring_zero_is_no_cubic_spring() -> None:
    """Assert that k3 = 0 gives the equations of the oscillator without a CubicSpring."""
    full, linear = (sym.compile(sym.combine(duffing_parts(cubic=k))) for k in (1.0, None))
    without(full, linear, "k3", 0.0)


def test_damper_zero_is_no_damper() -> None:
    """Assert that c = 0 gives the equations of the oscillator without a Damper."""
    full, free = (sym.compile(sym.combine(duffing_parts(damping=c))) for c in (0.1, None))
    without(full, free, "c", 0.0)


def test_waviness_zero_is_no_waviness() -> None:
    """Assert that amplitude 0 gives the equations of the unexcited discs at the same frequency."""
    wavy, smooth = Disc().compile(), Disc(amplitude=None).compile()
    points = draw(wavy)
    values = dict(zip([v.name for v in wavy.parameters], points.parameter, strict=True)) | {"amplitude": 0.0}
    values["omega"] = values["waves"] * values["speed"]
    a, b = (np.array([values[v.name] for v in s.parameters]) for s in (wavy, smooth))
    arguments = points.arguments[:-1]
    expected, found = wavy.residual(*arguments, a), smooth.residual(*arguments, b)
    found[:, 1] /= (WAVES * 360 * RPM) ** 2  # each model scales its equation of motion by its own frequency
    np.testing.assert_allclose(found, expected, rtol=1e-10)


def test_model_without_excitation_keeps_its_frequency() -> None:
    """Assert that an unexcited oscillator compiles, with omega = 2 pi / period as a parameter of its own."""
    x = sym.coordinate("x")
    system = sym.compile(sym.Mass(x, 2.0) + sym.Spring(x, 3.0))
    assert [v.name for v in system.parameters] == ["m", "k", "omega"]


def test_spring_alone_makes_no_state_beyond_its_coordinate() -> None:
    """Assert that a support adds a force to its coordinate and no state."""
    supported, free = (Disc(film=None, two=True, support=s).compile() for s in (1e4, None))
    assert [v.name for v in supported.states] == [v.name for v in free.states]


@pytest.mark.parametrize("order", list(itertools.permutations(range(2))))
def test_number_equal_to_a_parameter_is_that_parameter(order: tuple[int, int]) -> None:
    """Assert that a bare number shares the parameter of its name and value, whichever part comes first."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    masses = [sym.Mass(x, sym.parameter("m", 2.0, "kg")), sym.Mass(y, 2.0)]
    system = sym.compile(sym.combine([*(masses[i] for i in order), sym.HarmonicForce(x, 1.0, 0.8)]))
    assert [v.name for v in system.parameters] == ["m", "F", "Omega"]


def test_coordinate_scale_is_kept() -> None:
    """Assert that a contact does not override the scale the user gave its coordinate."""
    x = sym.coordinate("x", scale=2e-6)
    pair = sym.ContactPair(x)
    parts = [sym.Mass(x, 10.2), sym.Preload(pair, 810.0), sym.Hertz(pair, 28e9)]
    system = sym.compile(sym.combine([*parts, sym.Waviness(pair, 1e-6, 120, 37.7)]))
    assert [v.scale for v in system.states] == [2e-6, 2e-6]


def test_scale_does_not_change_the_equations() -> None:
    """Assert that the rows are the same physical equations in whatever length they are written."""

    def oscillator(scale: float) -> sym.CompiledSystem:
        x = sym.coordinate("x", scale=scale)
        parts = [sym.Mass(x, 2.0), sym.Spring(x, 3.0), sym.CubicSpring(x, 5.0), sym.Damper(x, 0.7)]
        return sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 0.5, 0.8)]))

    unit, small = oscillator(1.0), oscillator(1e-3)
    rate, state, algebraic, phase, parameter = draw(unit).arguments
    expected = unit.residual(rate, state, algebraic, phase, parameter)
    found = small.residual(rate / 1e-3, state / 1e-3, algebraic, phase, parameter)
    np.testing.assert_allclose(found * 1e-3, expected, rtol=1e-12, atol=1e-15)
