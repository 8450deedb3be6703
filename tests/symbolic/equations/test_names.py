"""Names that numbers of parts get by themselves."""

import itertools

import pytest

import symbolic as sym

X, Y, Z = (sym.coordinate(name) for name in "xyz")


def values(*parts: sym.Part) -> dict[str, float]:
    """The parameters of a model, nominal values by name."""
    return {p.name: p.value for p in sym.compile(sym.combine(parts)).parameters}


@pytest.mark.parametrize("order", list(itertools.permutations(range(4))))
def test_numbers_that_differ_are_named_by_their_coordinates(order: tuple[int, ...]) -> None:
    """Assert that m of x and m of y get names of their own, in whatever order the parts stand."""
    parts = [sym.Mass(X, 1.0), sym.Mass(Y, 2.0), sym.Spring(X, 3.0), sym.Spring(Y, 3.0)]
    found = values(*(parts[i] for i in order))
    assert found == {"m_x": 1.0, "m_y": 2.0, "k": 3.0, "omega": 1.0}


def test_all_numbers_of_a_name_are_qualified_where_two_differ() -> None:
    """Assert that of three masses, two alike, each has its own name."""
    assert values(sym.Mass(X, 1.0), sym.Mass(Y, 1.0), sym.Mass(Z, 2.0)) == {
        "m_x": 1.0,
        "m_y": 1.0,
        "m_z": 2.0,
        "omega": 1.0,
    }


def test_numbers_of_couplings_are_named_by_both_coordinates() -> None:
    """Assert that a coupling's numbers belong to its two coordinates."""
    masses = [sym.Mass(q, 1.0) for q in (X, Y, Z)]
    found = values(*masses, sym.Coupling(X, Y, 2.0), sym.Coupling(Y, Z, 3.0))
    assert {name: v for name, v in found.items() if "stiffness" in name} == {
        "coupling_stiffness_x_y": 2.0,
        "coupling_stiffness_y_z": 3.0,
    }


def test_several_numbers_of_one_coordinate_are_counted() -> None:
    """Assert that two springs on one coordinate are k_x_1 and k_x_2, or called by the parts' names."""
    soft, hard = sym.Spring(X, 1.0), sym.Spring(X, 2.0)
    assert values(sym.Mass(X, 1.0), soft, hard) == {"m": 1.0, "k_x_1": 1.0, "k_x_2": 2.0, "omega": 1.0}
    named = values(sym.Mass(X, 1.0), soft.named("left"), hard.named("right"))
    assert named == {"m": 1.0, "k_left": 1.0, "k_right": 2.0, "omega": 1.0}


def test_users_parameter_keeps_its_name() -> None:
    """Assert that a bare number beside a parameter of the same name and another value gives way."""
    m = sym.parameter("m", 1.0, "kg")
    assert values(sym.Mass(X, m), sym.Mass(Y, 2.0)) == {"m": 1.0, "m_y": 2.0, "omega": 1.0}
    assert values(sym.Mass(X, m), sym.Mass(Y, m)) == {"m": 1.0, "omega": 1.0}


def test_name_taken_by_a_parameter_of_the_users() -> None:
    """Assert that a number that would come to a name that is taken is refused."""
    taken = sym.parameter("m_y", 5.0)
    with pytest.raises(ValueError, match="parameter 'm_y' is defined twice"):
        values(sym.Mass(X, 1.0), sym.Mass(Y, 2.0), sym.Spring(X, taken))


def test_frequency_is_shared() -> None:
    """Assert that forces on two coordinates share the bare Omega, and that two frequencies are refused."""
    masses = [sym.Mass(q, 1.0) for q in (X, Y)]
    found = values(*masses, sym.HarmonicForce(X, 0.1, 2.0), sym.HarmonicForce(Y, 0.2, 2.0))
    assert found == {"m": 1.0, "F_x": 0.1, "F_y": 0.2, "Omega": 2.0}
    with pytest.raises(ValueError, match=r"two frequencies, Omega = 2 rad/s and Omega = 3 rad/s \(y\)"):
        values(*masses, sym.HarmonicForce(X, 0.1, 2.0), sym.HarmonicForce(Y, 0.2, 3.0))


def test_coordinates_are_numbered_and_begin_at_zero() -> None:
    """Assert names and values of a start of a vector of coordinates."""
    assert [(q.name, q.start) for q in sym.coordinates("x", 2)] == [("x1", 0.0), ("x2", 0.0)]
