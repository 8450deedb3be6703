"""Basins: symmetry that they must have, single motions by another integrator, shares and integrity."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.kept import kept
from support.oscillators import X, oscillator

import periodic as per
import symbolic as sym

pytestmark = pytest.mark.usefixtures("users_kernels")

BOX = {"x": (-2.0, 2.0), "x'": (-2.0, 2.0)}


def wells(force: float) -> sym.CompiledSystem:
    """Two wells: x'' + 0.15 x' - x + x^3 = force cos(t)."""
    parts = sym.Mass(X, 1.0) + sym.Damper(X, 0.15) + sym.Spring(X, -1.0) + sym.CubicSpring(X, 1.0)
    return sym.compile(parts + sym.HarmonicForce(X, force, 1.0))


@kept
def picture() -> per.phasespace.Basins:
    """Basins of the forced wells on the plane of place and speed."""
    return per.basins(wells(0.1), box=BOX, plane=("x", "x'"), grid=(60, 50))


def test_single_motions_by_another_integrator() -> None:
    """Assert where some of the cells lead."""
    found = picture()
    assert found.labels.shape == (50, 60) and (found.labels >= 0).all()
    places = [motion.sections[0] for motion in found.motions]
    for k in np.random.default_rng(5).choice(3000, 24, replace=False):
        settled = solve_ivp(
            lambda t, x: [x[1], -0.15 * x[1] + x[0] - x[0] ** 3 + 0.1 * math.cos(t)],
            (0, 240 * math.pi),
            found.states[k],
            "DOP853",
            rtol=1e-9,
            atol=1e-9,
        )
        apart = [np.abs(place - settled.y[:, -1]).max() for place in places]
        assert int(np.argmin(apart)) == found.labels.ravel()[k]


def test_shares_on_a_grid_and_at_random() -> None:
    """Assert that random starts tell the shares that a fine grid has, within their intervals."""
    grid = per.basins(wells(0.1), box=BOX, plane=("x", "x'"), grid=(120, 120))
    random = per.basins(wells(0.1), box=BOX, starts=2000)
    for motion in grid.motions:
        like = min(
            random.motions, key=lambda other: float(np.abs(other.sections[0] - motion.sections[0]).max())
        )
        error = math.sqrt(motion.share * (1 - motion.share) / 2000)
        assert like.share == pytest.approx(motion.share, abs=4 * error)
    assert sum(motion.share for motion in random.motions) == pytest.approx(1.0)


def test_wells_without_force_are_alike() -> None:
    """Assert that turning the plane by half a turn changes one basin into the other, cell by cell."""
    still = sym.compile(
        sym.Equations(
            lambda s, p: {"x": s.v, "v": s.x - s.x**3 - p.c * s.v},
            states={"x": 1.0, "v": 0.0},
            parameters={"c": 0.3},
        )
    )
    found = per.basins(still, box={"x": (-2, 2), "v": (-2, 2)}, plane=("x", "v"), grid=(40, 40))
    assert [motion.sort for motion in found.motions if motion.stable] == 2 * [per.phasespace.Sort.EQUILIBRIUM]
    assert sorted(found.shares.values()) == [0.5, 0.5]
    assert (found.labels[::-1, ::-1] == 1 - found.labels).all()


def test_integrity_is_the_distance_to_the_edge() -> None:
    """Assert it in half widths, and that it is infinite where there is one motion alone."""
    found = picture()
    own = found.motions[0].sections[0]
    others = found.states[found.labels.ravel() != 0]
    assert found.integrity(0) == pytest.approx(np.linalg.norm((others - own) / 2, axis=1).min())
    alone = per.basins(oscillator(), box=BOX, starts=20, periods=1)
    assert alone.integrity() == math.inf and alone.shares == {0: 1.0}
    with pytest.raises(ValueError, match="which is 7; it must be below"):
        found.integrity(7)


def test_what_is_known_is_used() -> None:
    """Assert that motions found before are those that basins name, but for the unstable ones."""
    system = wells(0.1)
    known = per.motions(system, box=BOX, starts=64, periods=2, places=8)
    found = per.basins(system, box=BOX, starts=200, motions=known)
    assert {id(m.point) for m in found.motions} == {id(m.point) for m in known.stable}
    assert "Basins(200 starts" in repr(found)


def test_picture_is_drawn(tmp_path: Path) -> None:
    """Assert the axes, and a legend of shares; refused where there is no plane."""
    axes = picture().plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (m)", "x' (m/s)")
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert len(texts) == 4 and all(text[1:].startswith(": stable, periodic, ") for text in texts)
    axes.figure.savefig(tmp_path / "basins.png")
    with pytest.raises(ValueError, match="the starts are on no plane"):
        per.basins(oscillator(), box=BOX, starts=4, periods=1).plot()


def test_walls_are_seen() -> None:
    """Assert that cells behind a wall are not started from."""
    wall = oscillator(sym.RigidStop(X, gap=0.5, restitution=0.5))
    found = per.basins(wall, box=BOX, plane=("x", "x'"), grid=(20, 10), periods=2)
    across = found.states.reshape(10, 20, 2)[..., 0]
    assert ((found.labels == -3) == (across > 0.5)).all()


def test_refusals() -> None:
    """Assert the sentences for planes, grids and other states that are not allowed."""
    system = wells(0.1)
    for given, told in (
        ({"plane": ("x", "x")}, r"plane is \('x', 'x'\); it must be the names of two states"),
        ({"plane": ("x", "y")}, "a state of plane is 'y'; it must be one of x, x'"),
        ({"plane": ("x", "x'"), "grid": (1, 5)}, "grid is 1; it must be a whole number of at least 2"),
        ({"plane": ("x", "x'"), "grid": (5,)}, r"grid is \(5,\); it must be two numbers of cells"),
        ({"plane": ("x", "x'"), "at": {"x": 1.0}}, "at has 'x', which is a state of the plane"),
        ({"starts": 0}, "starts is 0; it must be a whole number of at least 1"),
    ):
        with pytest.raises(ValueError, match=told):
            per.basins(system, box=BOX, **given)
