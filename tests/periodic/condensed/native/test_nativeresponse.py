"""The response of modes in C: that of NumPy, to rounding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.cantilevers import cantilever, cubic

import periodic as per
from periodic.condensed.linearised import answer
from periodic.condensed.modal.flexibility import Flexibility
from periodic.condensed.modal.quasistatic import Modes
from periodic.condensed.modal.response import Response
from periodic.condensed.modal.slopes import slopes, slopes_within
from periodic.condensed.native.nativeresponse import MANY, NativeResponse, response_of
from periodic.orbit.mesh import Mesh
from periodic.orbit.scheme import Array, Family, Scheme
from symbolic.kernels import native

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)

MESHES = {"even": np.linspace(0, 1, 7), "uneven": np.array([0, 0.1, 0.35, 0.4, 0.45, 0.7, 1])}


def drawn(points: int) -> Modes:
    """Modes slow and fast, damped and not oscillating, of four states and three forces."""
    random = np.random.default_rng(points)
    exponents = np.array([-1e-9 + 0j, -0.01 + 1j, -0.1 + 3j, -0.5, -2 + 40j, -90.0, -5e3 + 1e5j])
    inputs, outputs = (random.standard_normal((7, 2 * size)).view(complex) for size in (3, 4))
    return Modes(exponents, inputs, outputs.T, *random.standard_normal((2, 4, 3)))


@pytest.fixture(params=[*((name, points) for name in MESHES for points in (2, 4, 7))], ids=str)
def both(request: pytest.FixtureRequest) -> tuple[Response, Response]:
    """The response of modes on a mesh by NumPy and by C."""
    name, points = request.param
    mesh = Mesh(Scheme(Family.RADAU, points), (MESHES[name],))
    given = drawn(points), mesh.scheme, mesh.grid(np.zeros(0)), mesh.period
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", "c")
        found = response_of(cantilever(1, cubic), *given)
    assert isinstance(found, NativeResponse)
    return Response(*given), found


def close(found: Array, expected: Array) -> None:
    """Assert equality to rounding of the largest element."""
    assert found.shape == expected.shape
    assert found.dtype == expected.dtype
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()


def test_tables(both: tuple[Response, Response]) -> None:
    """Assert exponentials, moments and their derivatives element by element, and what is made of them.

    How modes grow in an interval is the exponential at its last point.
    In closed form those of seven points are differences of numbers a hundred times as large.
    """
    plain, fast = both
    rounding = 1e-13 if plain.scheme.ncol < 7 else 1e-11
    for name in ("growth", "moment", "slope"):
        expected, found = getattr(plain.table, name), getattr(fast.table, name)
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=rounding * np.abs(expected).max())
    for name in ("local", "impulse", "stage_outputs"):
        close(getattr(fast, name), getattr(plain, name))
    for response in both:
        assert np.array_equal(response.grown, response.table.growth[:, :, -1])


@pytest.mark.parametrize("columns", [(), (1,), (5,), (MANY + 1,)])
def test_motion_and_its_adjoint(both: tuple[Response, Response], columns: tuple[int, ...]) -> None:
    """Assert motion in a period, from rest and from anywhere, and the adjoint, of few columns and of many."""
    plain, fast = both
    (count, points, s, k), random = (*plain.local.shape[:3], plain.local.shape[4]), np.random.default_rng(1)
    forces = random.standard_normal((count, points, k, *columns))
    for closing in (None, plain.closings(0.5)[0]):
        close(fast.history(forces, closing), plain.history(forces, closing))
        close(fast.stages(forces, closing), plain.stages(forces, closing))
    close(fast.stages(forces, 0.0), plain.stages(forces, 0.0))
    if not columns:
        for response in both:
            history, states = response.motion(forces)
            close(history, plain.history(forces))
            close(states, plain.stages(forces))
    if columns:
        close(fast.driven(forces), plain.driven(forces))
        begun = random.standard_normal((len(plain.modes.exponents), 2 * columns[0])).view(complex)
        for found, expected in zip(fast.motions(forces, begun), plain.motions(forces, begun), strict=True):
            close(found, expected)
        weights = random.standard_normal((count, points, s, *columns))
        for ends in (plain.closing, 0.0):
            close(fast.pulled(weights, ends), plain.pulled(weights, ends))


def test_matrix(both: tuple[Response, Response]) -> None:
    """Assert what forces do everywhere, in periodic motion and from rest, in parts and of intervals."""
    plain, fast = both
    states, forces, held = np.array([1, 3]), np.array([2]), np.array([1, 2, 4])
    for make in (Flexibility.repeating, Flexibility):
        found, expected = make(fast), make(plain)
        close(found.whole, expected.whole)
        part, same = found.between(states, forces), expected.between(states, forces)
        close(part.whole, same.whole)
        close(part.block(held, everywhere=False), same.block(held, everywhere=False))
        for everywhere in (True, False):
            several = np.array([0, 2])
            asked = states, several, held
            other = expected.between(states, several).block(held, everywhere=everywhere)
            for flexibility in (found, expected):
                close(flexibility.part(*asked, everywhere=everywhere), other)


@pytest.mark.parametrize("multiplier", [1.0, 0.4, 0.3 + 0.6j])
def test_slopes(both: tuple[Response, Response], multiplier: complex) -> None:
    """Assert the change with widths, modes and both, of real forces and of complex ones."""
    plain, fast = both
    random, count, points = np.random.default_rng(2), len(plain.grid.width), plain.scheme.ncol
    forces = random.standard_normal((count, points, 6)).view(complex)
    forces = forces if multiplier.imag else forces.real.copy()
    change = replace(drawn(points), exponents=random.standard_normal(14).view(complex))
    for widths, changes in ((0, [change]), (2, []), (2, [None, change, change])):
        stretch = random.standard_normal((count, widths))
        both_ways = [slopes(given, forces, stretch, changes, multiplier) for given in (fast, plain)]
        for found, expected in zip(*both_ways, strict=True):
            close(found, expected)


@pytest.mark.parametrize("changed", [0, 1, 2])
def test_slopes_within_an_interval(both: tuple[Response, Response], changed: int) -> None:
    """Assert the change with an interval's own width and with modes, those at its beginning held.

    The slopes of the whole period are the same, joined from interval to interval.
    """
    plain, fast = both
    random, count, points = np.random.default_rng(3), len(plain.grid.width), plain.scheme.ncol
    forces = random.standard_normal((count, points, 3))
    change = replace(drawn(points), exponents=random.standard_normal(14).view(complex))
    changes = [None, change, change][:changed]
    history = plain.history(forces)
    found, expected = (slopes_within(given, forces, changes, history) for given in (fast, plain))
    for ours, theirs in zip(found, expected, strict=True):
        close(ours, theirs)
    widths = random.standard_normal((count, 1))
    whole, begun = slopes(plain, forces, widths, changes)
    left = np.concatenate([found[1][..., :1] * widths[:, None], found[1][..., 1:]], axis=2)
    history = plain.closed(left, plain.closing)
    close(history[0], begun)
    joined = (plain.stage_outputs @ history[:-1, None]).real
    joined += np.concatenate([found[0][..., :1] * widths[:, None, None], found[0][..., 1:]], axis=3)
    close(joined, whole)


def test_systems_choose() -> None:
    """Assert that C is taken where a system has it, and only there; and that branches are the same."""
    orbits = []
    for kernels, kind in (("c", NativeResponse), ("numpy", Response)):
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("ORBITRACE_KERNELS", kernels)
            system = cantilever(4, cubic)
        orbit = per.trace(system, "Omega", (3.0, 3.2), at=3.1).labelled("UZ")[0].orbit
        assert type(answer(system, orbit, orbit.parameter, (2,))[0]) is kind
        orbits.append(orbit.nodes)
    np.testing.assert_allclose(orbits[0], orbits[1], rtol=1e-9)
