"""Dynamic flexibility, reductions, rotor shafts and Campbell diagrams of linear structures."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy

import symbolic as sym


def damped(elements: int, left: Any = "clamped") -> sym.Matrices:
    """A beam of unit numbers with stiffness- and mass-proportional damping."""
    bare = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=elements, left=left)
    return sym.Matrices(bare.M, 1e-3 * bare.K + 1e-2 * bare.M, bare.K, at=bare.at)


def test_flexibility_is_the_sum_of_the_modes() -> None:
    """Assert H against its modal series, arrays and sparse matrices alike, and its static value 1/3."""
    full = damped(6)
    squares, shapes = scipy.linalg.eigh(full.K, full.M)
    omega = np.array([0.5, 3.5, 22.0, 60.0])
    tip, middle = shapes[full["tip"]], shapes[full["w3"]]
    below = squares - omega[:, None] ** 2 + 1j * omega[:, None] * (1e-3 * squares + 1e-2)
    found = sym.flexibility(full, ["tip", "w3"], omega.tolist())
    np.testing.assert_allclose(found[:, 0, 1], (tip * middle / below).sum(axis=1), rtol=1e-8)
    light = sym.Matrices(*(scipy.sparse.csr_array(m) for m in (full.M, full.C, full.K)), at=full.at)
    np.testing.assert_allclose(sym.flexibility(light, ["tip", "w3"], omega.tolist()), found, rtol=1e-10)
    assert sym.flexibility(full, ["tip"], [0.0])[0, 0, 0].real == pytest.approx(1 / 3, rel=1e-11)


@pytest.mark.parametrize("sparse", [False, True])
def test_reductions_converge(sparse: bool) -> None:
    """Assert the error over the first four modes: its size, that it falls, and static loads exactly."""
    full = damped(60)
    if sparse:
        full = sym.Matrices(*(scipy.sparse.csr_array(m) for m in (full.M, full.C, full.K)), at=full.at)
    held = [sym.craig_bampton(full, ["tip", "w20"], modes).error(0, 130, points=15) for modes in (4, 8, 16)]
    assert held[0] > 4 * held[1] > 16 * held[2] and held[2] < 5e-4
    free = [sym.residual_modes(full, ["tip", "w20"], modes) for modes in (4, 8)]
    assert free[0].error(0, 130, points=15) < 0.02 and free[1].error(0, 130, points=15) < 1e-4
    static = [sym.flexibility(m, ["tip", "w20"], [0.0]) for m in (full, free[0].matrices)]
    np.testing.assert_allclose(static[1], static[0], rtol=1e-8)


def test_motion_comes_back_from_the_reduced_structure() -> None:
    """Assert the answer of a degree of freedom that is not kept, and that kept ones are the first."""
    full = damped(40)
    reduced = sym.craig_bampton(full, ["tip"], 12)
    assert dict(reduced.matrices.at) == {"tip": 0, "w40": 0}
    answer = np.linalg.solve(
        reduced.matrices.K + 10j * reduced.matrices.C - 100 * reduced.matrices.M,
        np.eye(reduced.matrices.size)[0],
    )
    load = np.eye(full.size)[full["tip"]]
    exact = np.linalg.solve(full.K + 10j * full.C - 100 * full.M, load)
    np.testing.assert_allclose(reduced.recovery @ answer, exact, atol=3e-4 * np.abs(exact).max())


def test_rigid_body_modes_are_carried() -> None:
    """Assert a free beam with its rigid-body modes; Craig-Bampton refuses what stays free."""
    full = damped(40, left="free")
    assert sym.residual_modes(full, ["w0", "tip"], 10).error(1, 130) < 1e-3
    bare = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=4, left="free")
    loose = sym.Matrices(np.diag(np.ones(3)), None, np.diag([1.0, 0.0, 0.0]))
    with pytest.raises(
        ValueError, match="^the structure moves freely while the places are held; hold it or add"
    ):
        sym.craig_bampton(loose, [0], 1)
    with pytest.raises(
        ValueError, match="^modes is 9; it must be at most 8, the degrees of freedom less the pl"
    ):
        sym.residual_modes(bare, ["w0", "tip"], 9)


ROSS = [121.684, 122.079, 423.355, 441.973, 788.675, 829.368]
"""Undamped natural frequencies (rad/s) at 200 rad/s that ROSS 2.3.0 prints for the shaft below."""


def rotor() -> sym.Matrices:
    """A steel shaft with a disc in two soft bearings."""
    outer, inner, width, density = 0.28, 0.05, 0.07, 7810.0
    mass = density * np.pi * (outer**2 - inner**2) / 4 * width
    polar = mass * (outer**2 + inner**2) / 8
    disc = sym.ShaftDisc(2, mass, polar, polar / 2 + mass * width**2 / 12)
    bare = sym.shaft(length=1.5, diameter=0.05, elements=6, modulus=211e9, density=density, discs=[disc])
    bearings = [bare[name] for name in ("x0", "y0", "x6", "y6")]
    supports = np.zeros(bare.size)
    supports[bearings] = 1.0
    return sym.Matrices(bare.M, np.diag(1e3 * supports), bare.K + np.diag(1e6 * supports), bare.G, at=bare.at)


def test_shaft_has_the_frequencies_of_ross() -> None:
    """Assert |lambda| at 200 rad/s to the digits printed, forward whirl rising with speed, backward not."""
    diagram = sym.campbell(rotor(), [0.0, 200.0, 400.0])
    undamped = diagram.frequencies / np.sqrt(1 - diagram.damping**2)
    np.testing.assert_allclose(undamped[1], ROSS, atol=6e-4)
    np.testing.assert_allclose(undamped[0, ::2], undamped[0, 1::2], rtol=1e-6)
    assert (np.diff(undamped[:, ::2], axis=0) < 0).all() and (np.diff(undamped[:, 1::2], axis=0) > 0).all()


def test_critical_speed_is_where_the_frequency_meets_the_speed() -> None:
    """Assert the forward and the backward crossing: an eigenvalue is i Omega there, to the interpolation."""
    structure = rotor()
    critical = sym.campbell(structure, np.linspace(100, 150, 26).tolist(), 2).critical()
    assert len(critical) == 2
    for speed in critical:
        at = sym.campbell(structure, [float(speed)], 2).frequencies[0]
        assert np.abs(at - speed).min() < 1e-6 * speed


class Rotor:
    """What is used of a ROSS rotor; its bearings stiffen with speed by `slope`."""

    number_dof = 4

    def __init__(self, slope: float) -> None:
        self.structure, self.slope = rotor(), slope

    def M(self) -> Any:
        """Mass."""
        return self.structure.M

    def C(self, frequency: float) -> Any:
        """Damping."""
        return self.structure.C

    def K(self, frequency: float) -> Any:
        """Stiffness."""
        return self.structure.K * (1 + self.slope * frequency)

    def G(self) -> Any:
        """Gyroscopic matrix."""
        return self.structure.G


def test_rotor_of_ross() -> None:
    """Assert its matrices and places, at the speed asked for; a rotor in need of one says so."""
    taken = sym.ross_matrices(Rotor(0.0))
    np.testing.assert_array_equal(taken.K, rotor().K)
    assert taken["x1"] == 4 and taken["beta6"] == 27
    np.testing.assert_allclose(sym.ross_matrices(Rotor(1e-3), 100.0).K, 1.1 * rotor().K, rtol=1e-15)
    with pytest.raises(
        ValueError, match="^the stiffness of the rotor's bearings depends on the speed; give spe"
    ):
        sym.ross_matrices(Rotor(1e-3))
    nothing: Any = object()
    with pytest.raises(ValueError, match="^rotor is no ross.Rotor: "):
        sym.ross_matrices(nothing)


class WholeRotor(Rotor):
    """The same with axial motion and torsion, free as ROSS leaves them, to which `pitch` couples bending."""

    number_dof = 6

    def __init__(self, pitch: float) -> None:
        super().__init__(0.0)
        self.pitch = pitch

    def _whole(self, bending: Any, along: Any) -> Any:
        """A matrix of all six freedoms of nodes from that of bending and that of z, or theta."""
        count = len(along)
        found = np.zeros((6 * count, 6 * count))
        for kinds, each in (((0, 1, 3, 4), bending), ((2,), along), ((5,), along)):
            own = [6 * node + kind for node in range(count) for kind in kinds]
            found[np.ix_(own, own)] = each
        return found

    def _chain(self, size: float) -> Any:
        """Springs from node to node, held nowhere."""
        count = len(self.structure.M) // 4
        ends = np.r_[1.0, np.full(count - 2, 2.0), 1.0]
        return size * (np.diag(ends) - np.eye(count, k=1) - np.eye(count, k=-1))

    def M(self) -> Any:
        """Mass."""
        return self._whole(self.structure.M, 3.0 * np.eye(len(self.structure.M) // 4))

    def C(self, frequency: float) -> Any:
        """Damping, none but in bending."""
        found = self._whole(self.structure.C, self._chain(0.0))
        found[0, 2] = self.pitch
        return found

    def K(self, frequency: float) -> Any:
        """Stiffness."""
        return self._whole(self.structure.K, self._chain(1e6))

    def G(self) -> Any:
        """Gyroscopic matrix."""
        return self._whole(self.structure.G, self._chain(0.0))


def test_rotor_of_ross_with_axial_motion_and_torsion() -> None:
    """Assert that what is loose is named, that bending alone is that of the lateral rotor, or is refused."""
    whole = sym.Structure(sym.ross_matrices(WholeRotor(0.0)), at={"disc": ("x3", "y3")})
    with pytest.raises(
        ValueError, match="rigid-body modes .* of degrees of freedom z0, theta0, z1, theta1, z2, "
    ):
        whole.modal(100.0)
    bending = sym.ross_matrices(WholeRotor(0.0), lateral=True)
    for name in "MCKG":
        np.testing.assert_array_equal(getattr(bending, name), getattr(rotor(), name))
    assert bending["x1"] == 4 and bending["beta6"] == 27
    assert sym.Structure(bending, at={"disc": ("x3", "y3")}).modal(100.0).exponents.imag.max() > 0
    with pytest.raises(
        ValueError, match="^lateral is True, but C couples bending to axial motion or torsion$"
    ):
        sym.ross_matrices(WholeRotor(1.0), lateral=True)


def test_bad_input_is_refused() -> None:
    """Assert one sentence for each."""
    full = damped(3)
    undamped = sym.Matrices(np.eye(1), None, np.eye(1))
    large = sym.Matrices(scipy.sparse.eye_array(600), None, scipy.sparse.eye_array(600))
    disc = sym.ShaftDisc(11, 1.0, 1.0, 1.0)
    text: Any = "tip"
    calls: list[tuple[Any, str]] = [
        (
            lambda: sym.flexibility(full, text, [1.0]),
            "^places is 'tip'; it must be a sequence of at least one",
        ),
        (lambda: sym.flexibility(full, ["tip", 4], [1.0]), "must be different degrees of freedom$"),
        (
            lambda: sym.flexibility(undamped, [0], [1.0]),
            "^omega is 1; it must not be that of an undamped res",
        ),
        (lambda: sym.craig_bampton(full, ["tip"], 9), "^modes is 9; it must be a whole number from 1 to 5"),
        (
            lambda: sym.craig_bampton(full, ["tip"], 2).error(3, 2),
            "^low is 3; it must be at least 0 and less",
        ),
        (lambda: sym.campbell(full, [2.0, 1.0]), "must be ascending$"),
        (lambda: sym.campbell(large, [1.0]), "^the structure has 600 freedoms; a Campbell diagram"),
        (
            lambda: sym.shaft(length=1.0, diameter=0.1, bore=0.1),
            "^bore is 0.1; it must be at least 0 and less",
        ),
        (
            lambda: sym.shaft(length=1.0, diameter=0.1, discs=[disc]),
            "^node of a disc is 11; it must be a whole",
        ),
        (lambda: sym.ShaftDisc(1, 0.0, 1.0, 1.0), "^mass of a disc is 0.0; it must be a positive number$"),
    ]
    for call, said in calls:
        with pytest.raises(ValueError, match=said):
            call()


def chain(size: int) -> sym.Matrices:
    """Masses of 1, 2, ... kg between springs, the first and the last held, with some damping."""
    stiffness = np.diag(np.full(size, 6.0)) - 2 * (np.eye(size, k=1) + np.eye(size, k=-1))
    skew = np.eye(size, k=1) - np.eye(size, k=-1)
    return sym.Matrices(
        np.diag(np.arange(1.0, size + 1)),
        0.1 * stiffness,
        stiffness,
        G=0.2 * skew,
        at={"a": 3, "b": 1, "c": 0},
    )


def test_all_modes_are_the_whole_structure() -> None:
    """Assert the flexibility of either reduction with every mode, at a speed, in the order of the places."""
    full = chain(5)
    for reduced in (sym.craig_bampton(full, ["a", "b"], 3), sym.residual_modes(full, ["a", "b"], 3)):
        assert reduced.matrices.size == 5 and dict(reduced.matrices.at) == {"a": 0, "b": 1}
        assert reduced.places.tolist() == [3, 1]
        exact = sym.flexibility(full, ["a", "b"], [0.0, 1.3], speed=2.0)
        found = sym.flexibility(reduced.matrices, ["a", "b"], [0.0, 1.3], speed=2.0)
        assert found == pytest.approx(exact, rel=1e-9, abs=1e-12)
        assert reduced.error(0, 3, speed=2.0) < 1e-9
        assert reduced.recovery[[3, 1]] == pytest.approx(np.eye(2, 5), abs=1e-12)


@pytest.mark.parametrize("modes", [1, 2])
def test_static_answers_are_exact(modes: int) -> None:
    """Assert those of few modes by either method; the error elsewhere is the 2-norm's."""
    full = chain(6)
    for reduced in (sym.craig_bampton(full, [3, 0], modes), sym.residual_modes(full, [3, 0], modes)):
        band = [0.0, 2.0, *np.sqrt(scipy.linalg.eigh(reduced.matrices.K, reduced.matrices.M)[0])]
        exact = sym.flexibility(full, [3, 0], band, speed=1.0)
        found = sym.flexibility(reduced.matrices, [0, 1], band, speed=1.0)
        assert found[0] == pytest.approx(exact[0], rel=1e-9, abs=1e-12)
        norms = [np.linalg.norm(a - b, 2) / np.linalg.norm(b, 2) for a, b in zip(found, exact, strict=True)]
        inside = [e for e, w in zip(norms, band, strict=True) if w <= 2.0]
        assert reduced.error(0, 2.0, points=2, speed=1.0) == pytest.approx(max(inside), rel=1e-8)


def test_kept_places_without_any_modes() -> None:
    """Assert Guyan's reduction, the whole structure where all of it is kept, and bands that are empty."""
    full = chain(4)
    static = sym.craig_bampton(full, ["a"], 0)
    stiffness, flexible = static.matrices.K, np.linalg.inv(full.K)[3:, 3:]
    assert stiffness == pytest.approx(1 / flexible, rel=1e-12)
    whole = sym.craig_bampton(full, [2, 0, 1, 3], 0)
    assert whole.matrices.M.tolist() == np.diag([3.0, 1.0, 2.0, 4.0]).tolist()
    for low, high in ((2.0, 2.0), (-1.0, 2.0), (3.0, 2.0)):
        with pytest.raises(ValueError, match="^low is .*; it must be at least 0 and less than high = 2$"):
            static.error(low, high)
