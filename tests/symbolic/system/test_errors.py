"""Models that are refused, each in one sentence that names what is wrong."""

import math
from collections.abc import Callable

import pytest
from support.models import Disc

import symbolic as sym

X = sym.coordinate("x")
PAIR = sym.ContactPair(X)


def sentence(make: Callable[[], object]) -> str:
    """The message with which something is refused: one line without a full stop inside."""
    with pytest.raises(ValueError) as caught:
        make()
    text = str(caught.value)
    assert "\n" not in text
    assert ". " not in text
    return text


def compiled(*parts: sym.Part) -> Callable[[], object]:
    """The compilation of parts, to be called later."""
    return lambda: sym.compile(sym.combine(parts))


def test_parameter_defined_twice() -> None:
    """Assert that two parameters of one name are refused, with both values and the way out."""
    first, second = sym.parameter("m", 1.0), sym.parameter("m", 1.0)
    text = sentence(compiled(sym.Mass(X, first), sym.Mass(sym.coordinate("y"), second)))
    assert text.startswith("parameter 'm' is defined twice (1.0 and ")
    assert "share one symbolic.parameter" in text


def test_coordinate_without_mass() -> None:
    """Assert that a coordinate with a spring but no inertia is named."""
    text = sentence(compiled(sym.Spring(X, 1.0), sym.HarmonicForce(X, 1.0)))
    assert text == "coordinate 'x' has no mass; add a Mass on it"


def test_second_coordinate_of_a_contact_without_mass() -> None:
    """Assert that of two coordinates the one without inertia is named."""
    x2 = sym.coordinate("x2")
    pair = sym.ContactPair(X, x2)
    parts = [sym.Mass(X, 1.0), sym.Preload(pair, 810.0), sym.Hertz(pair, 28e9)]
    text = sentence(compiled(*parts, sym.ContactDamping(pair, 0.01), sym.Waviness(pair, 1e-6, 120, 37.7)))
    assert text.startswith("coordinate 'x2' has no mass")


def test_mass_of_zero() -> None:
    """Assert that a mass of zero is no mass, and not compiled to rows that are no numbers."""
    text = sentence(compiled(sym.Mass(X, 0.0), sym.Spring(X, 1.0), sym.HarmonicForce(X, 1.0)))
    assert text.startswith("coordinate 'x' has no mass")


@pytest.mark.parametrize("missing", [0, 1], ids=["preload", "hertz"])
def test_contact_without_preload_or_hertz(missing: int) -> None:
    """Assert that a contact that lacks one of its two necessary parts is named, and both of them."""
    parts: list[sym.Part] = [sym.Preload(PAIR, 810.0), sym.Hertz(PAIR, 28e9)]
    del parts[missing]
    text = sentence(compiled(sym.Mass(X, 1.0), *parts, sym.Waviness(PAIR, 1e-6, 120, 37.7)))
    assert text == "contact 'contact' lacks a part; it needs both Preload and Hertz"


def test_film_without_hertz() -> None:
    """Assert that a film alone is no contact, and that a contact is called by its own name."""
    pair = sym.ContactPair(X, name="rollers")
    law = sym.films.CalibratedThickness(37.7, 0.051, 0.890, 25.9e-9)
    text = sentence(
        compiled(sym.Mass(X, 1.0), sym.Preload(pair, 810.0), sym.films.QuasistaticFilm(pair, law))
    )
    assert text.startswith("contact 'rollers' lacks a part")


@pytest.mark.parametrize("preload", [0.0, -810.0])
def test_contact_without_a_static_deflection(preload: float) -> None:
    """Assert that a preload that leaves no positive finite delta0 is refused."""
    parts = [sym.Preload(PAIR, preload), sym.Hertz(PAIR, 28e9)]
    text = sentence(compiled(sym.Mass(X, 1.0), *parts, sym.Waviness(PAIR, 1e-6, 120, 37.7)))
    assert "'contact'" in text


def test_contact_pair_of_nothing() -> None:
    """Assert that a contact needs a coordinate."""
    assert sentence(sym.ContactPair) == "a contact pair has 0 coordinates; it needs at least one"


def test_two_excitation_frequencies() -> None:
    """Assert that waviness and a force at a frequency of its own are refused."""
    y = sym.coordinate("y")
    parts = [*Disc(film=None).parts(), sym.Mass(y, 1.0), sym.HarmonicForce(y, 1.0, 30.0)]
    assert sentence(compiled(*parts)) == (
        "parts excite the model at two frequencies, (waves*speed) = 4523.89 rad/s and Omega = 30 rad/s (y); "
        "all must share one, a symbolic.parameter, to which `order` may be given"
    )


def test_one_frequency_shared_by_two_excitations() -> None:
    """Assert that two forces at one parameter are one excitation."""
    omega = sym.parameter("Omega", 0.8, "rad/s")
    y = sym.coordinate("y")
    forces = sym.HarmonicForce(X, 0.5, omega) + sym.HarmonicForce(y, 0.5, omega)
    system = sym.compile(sym.Mass(X, 1.0) + sym.Mass(y, 1.0) + forces)
    assert [v.name for v in system.parameters] == ["m", "F", "Omega"]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_parameter_that_is_not_finite(value: float) -> None:
    """Assert that a parameter or a part's bare number must be finite, and is shown."""
    expected = f"parameter 'm' is {value}; it must be a finite number"
    assert sentence(lambda: sym.parameter("m", value)) == expected
    assert sentence(compiled(sym.Mass(X, value), sym.HarmonicForce(X, 1.0))) == expected


@pytest.mark.parametrize("scale", [0.0, -1.0, math.nan, math.inf])
def test_scale_that_is_not_positive(scale: float) -> None:
    """Assert that a coordinate's scale must be positive and finite."""
    expected = f"scale of coordinate 'x' is {scale}; it must be a positive number"
    assert sentence(lambda: sym.coordinate("x", scale=scale)) == expected


@pytest.mark.parametrize("scale", [0.0, -1.0, math.nan, math.inf])
def test_scale_is_checked_by_the_class_itself(scale: float) -> None:
    """Assert that Coordinate refuses the same scales in the same words as coordinate."""
    expected = f"scale of coordinate 'x' is {scale}; it must be a positive number"
    assert sentence(lambda: sym.Coordinate("x", scale=scale)) == expected


def test_state_defined_twice() -> None:
    """Assert that two coordinates of one name are refused."""
    text = sentence(compiled(sym.Mass(X, 1.0), sym.Mass(sym.coordinate("x"), 1.0), sym.HarmonicForce(X, 1.0)))
    assert text == (
        "two coordinates are called 'x'; each needs a name of its own "
        "(places of a structure have theirs from at={name: index})"
    )


def test_sum_with_something_else() -> None:
    """Assert that a part adds to parts and models only."""
    with pytest.raises(TypeError, match="unsupported operand"):
        sym.Mass(X, 1.0) + sym.Spring(X, 1.0) + 3.0  # type: ignore[operator]


def equations(function: object, **given: object) -> Callable[[], object]:
    """The compilation of equations of one state, to be called later."""
    states, parameters = given.pop("states", {"x": 0.0}), given.pop("parameters", {"a": 1.0})
    return lambda: sym.compile(sym.Equations(function, states, parameters, **given))  # type: ignore[arg-type]


NAN = "returned an expression with NaN in it for 'x'; it must use the functions of symbolic.functions, not "
MODEL = "it must be a Model or a Part, as the sum of symbolic.Mass(x, 1.0) and others is"
NAME = "it must be one line of text that is not empty"
WRONG: list[tuple[Callable[[], object], str]] = [
    (lambda: sym.compile("a"), f"model is 'a'; {MODEL}"),  # type: ignore[arg-type]
    (lambda: sym.compile(sym.Mass), f"model is <class 'symbolic.parts.mechanics.inertia.Mass'>; {MODEL}"),  # type: ignore[arg-type]
    (lambda: sym.combine(["a"]), "part is 'a'; it must be a Part, as symbolic.Mass(x, 1.0) is"),  # type: ignore[list-item]
    (lambda: sym.combine(3), "parts is 3; it must be a sequence, each a Part, as symbolic.Mass(x, 1.0) is"),  # type: ignore[arg-type]
    (
        compiled(sym.Mass("x", 1.0)),  # type: ignore[arg-type]
        "coordinate is 'x'; it must be a Coordinate, as symbolic.coordinate returns it",
    ),
    (compiled(sym.Mass(X, "a")), "parameter 'm' is 'a'; it must be a finite number"),  # type: ignore[arg-type]
    (
        compiled(sym.Preload("p", 1.0)),  # type: ignore[arg-type]
        "pair is 'p'; it must be a ContactPair, as symbolic.ContactPair(x) is",
    ),
    (lambda: sym.coordinate(3), f"name of a coordinate is 3; {NAME}"),  # type: ignore[arg-type]
    (lambda: sym.coordinate(""), f"name of a coordinate is ''; {NAME}"),
    (
        lambda: sym.coordinate("x'"),
        "name of a coordinate is \"x'\"; it must be without ', which marks velocities",
    ),
    (lambda: sym.parameter("", 1.0), f"name of a parameter is ''; {NAME}"),
    (lambda: sym.parameter("m", "a"), "parameter 'm' is 'a'; it must be a finite number"),  # type: ignore[arg-type]
    (
        compiled(sym.Mass(X, sym.parameter("x", 1.0)), sym.HarmonicForce(X, 1.0)),
        "'x' is the name of a state and of a parameter; every variable needs its own",
    ),
    (
        equations(lambda x, p: {"x": x.x}, parameters={"x": 1.0}),
        "'x' is the name of two variables; every one needs its own",
    ),
    (equations(3), "function is 3; it must be a function of x and p"),
    (equations(max, states=["x"]), "states is ['x']; it must be a mapping of names to numbers"),
    (equations(max, states={"x": "a"}), "rest value of x is 'a'; it must be a finite number"),
    (
        equations(lambda x, p: {"x": x.x if x.x > 0 else 0}),
        "function decides by a symbol in `x.x > 0`; it must use symbolic.functions.if_else",
    ),
    (
        equations(lambda x, p: {"x": -x.x}, outputs=lambda x, p: {"y": max(x.x, 0)}),
        "outputs decides by a symbol in `max(x.x, 0)`; it must use symbolic.functions.fmax",
    ),
    (equations(lambda x, p: {"x": 1 + math.sin(x.x)}), f"function {NAN}those of math"),
]


@pytest.mark.parametrize(("make", "said"), WRONG, ids=[said for _, said in WRONG])
def test_refused_with_field_value_and_what_is_allowed(make: Callable[[], object], said: str) -> None:
    """Assert the whole sentence of what is no model, no number, no name or no expression."""
    assert sentence(make) == said
