"""Condensation in C against the same in NumPy, for equations of every structure."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from support import traces
from support.numpy_systems import LinearOscillator, Lines

import periodic as per
import symbolic as sym
from periodic.collocation.elimination import EliminatedStages, eliminated
from periodic.collocation.native import elimination
from periodic.collocation.native.elimination import LARGE as FULL
from periodic.collocation.native.elimination import routines
from periodic.correction.newton import correct
from periodic.correction.outcome import Outcome
from periodic.linear.bordering import chain
from periodic.orbit.construction import at_rest, transfer
from periodic.orbit.mesh import EventNode, Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Family, Scheme
from periodic.system import linear_of
from symbolic.kernels import native
from symbolic.scenes.building import build
from symbolic.scenes.names import scene_names
from symbolic.scenes.reading import load

Array = NDArray[np.float64]
FREE = (0,)

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)


@pytest.fixture(scope="module", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory):  # noqa: ANN202
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


@dataclass
class Rows:
    """Equations of which only their derivatives at the collocation points are known.

    `kinematic` (row, position, velocity): rows of those two entries alone.
    """

    n: int
    m: int
    kinematic: tuple[tuple[int, int, int], ...] = ()
    spoil: str = ""
    compiled: bool = True
    seed: int = 1
    switches: tuple[()] = ()

    @property
    def states(self) -> range:
        """As many as there are."""
        return range(self.n)

    def library(self, source: str) -> ctypes.CDLL | None:
        """The compiled source, if C is to run."""
        return native.library(source) if self.compiled else None

    def linearise(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...],
    ) -> Lines:
        """Random rows, the same each time."""
        rng = np.random.default_rng(self.seed)
        n, rows = self.n, self.n + self.m
        sizes = ((rows,), (rows, n), (rows, n), (rows, self.m), (rows,), (rows, len(free)))
        arrays = [rng.normal(size=(len(phase), *size)) for size in sizes]
        arrays[1][:, n:] = 0.0
        arrays[1][:, :n] += 2 * np.eye(n)
        for row, position, velocity in self.kinematic:
            slopes, couplings = 1 + rng.uniform(size=len(phase)), rng.normal(size=len(phase))
            for a in arrays[1:4]:
                a[:, row] = 0.0
            arrays[1][:, :, position] = 0.0
            arrays[1][:, row, position] = slopes
            arrays[2][:, row, velocity] = couplings
        if self.spoil == "residual":
            arrays[0][5, 0] = np.inf
        if self.spoil == "derivative":
            arrays[2][-1, -1, -1] = np.nan
        if self.spoil == "unknown":
            arrays[3][3, n:] = 0.0
        if self.spoil == "stages":
            arrays[1][3:9, 0], arrays[2][3:9, 0] = 0.0, 0.0
        return Lines(*arrays)


def orbit_of(system: Rows, scheme: Scheme, events: int) -> Orbit:
    """A random orbit on a random mesh."""
    rng = np.random.default_rng(7)
    breaks = tuple(np.append(0, np.cumsum(w / w.sum())) for w in rng.uniform(0.1, 1, (max(events, 1), 5)))
    mesh = Mesh(scheme, breaks, tuple(EventNode(0, 1) for _ in range(events)))
    count = mesh.ntst
    return Orbit(
        mesh,
        rng.normal(size=(count + 1, system.n)),
        rng.normal(size=(count, scheme.ncol, system.n)),
        rng.normal(size=(count, scheme.ncol, system.m)),
        np.sort(rng.uniform(0, 6, events)),
        np.ones(3),
    )


def close(found: Array, expected: Array, tolerance: float = 1e-11) -> None:
    """Assert equality to a tolerance relative to the largest entry."""
    assert found.shape == expected.shape
    assert np.abs(found - expected).max(initial=0.0) <= tolerance * np.abs(expected).max(initial=1.0)


def compare(found: EliminatedStages, expected: EliminatedStages, tolerance: float = 1e-11) -> None:
    """Assert that two condensations are the same in all that they offer."""
    assert found.compiled is not None and expected.compiled is None
    assert found.residual == pytest.approx(expected.residual, rel=1e-9, abs=1e-12)
    for name in ("step", "stages", "algebraic"):
        close(getattr(found, name), getattr(expected, name), tolerance)
    close(chain(found), chain(expected), tolerance)
    rng = np.random.default_rng(5)
    nodes, outer = rng.normal(size=found.orbit.nodes.shape), rng.normal(size=found.orbit.phases.size + 1)
    for constant in (0.0, 1.0):
        both = zip(
            found.recover(nodes, outer, constant), expected.recover(nodes, outer, constant), strict=True
        )
        for a, b in both:
            close(a, b, tolerance)


CHAINED = ((0, 0, 1), (1, 1, 2))
STRUCTURES = {
    "one state": Rows(1, 0),
    "two states": Rows(2, 0),
    "oscillator": Rows(2, 0, ((0, 0, 1),)),
    "velocity first": Rows(2, 0, ((1, 1, 0),)),
    "disc": Rows(3, 1, ((0, 0, 1),)),
    "two oscillators": Rows(4, 0, ((0, 0, 1), (2, 2, 3))),
    "one velocity of two positions": Rows(4, 2, ((0, 0, 3), (1, 1, 3))),
    "integrators in a row": Rows(4, 1, CHAINED),
    "circle of integrators": Rows(3, 0, ((0, 0, 1), (1, 1, 0))),
    "a row of one state": Rows(3, 0, ((0, 1, 1),)),
    "seven states, three unknowns": Rows(7, 3, ((2, 4, 6), (3, 5, 0))),
}


@pytest.mark.parametrize("events", [0, 1, 3])
@pytest.mark.parametrize("name", STRUCTURES)
def test_random_equations(name: str, events: int) -> None:
    """Assert equal maps for every structure of kinematic rows, with and without unknowns and event nodes."""
    system = STRUCTURES[name]
    orbit = orbit_of(system, Scheme(), events)
    compare(eliminated(system, orbit, FREE), eliminated(replace(system, compiled=False), orbit, FREE), 1e-10)


@pytest.mark.parametrize("ncol", range(2, 8))
@pytest.mark.parametrize("family", Family)
def test_schemes(family: Family, ncol: int) -> None:
    """Assert equal maps for both families of points, from two to seven of them."""
    system = STRUCTURES["disc"]
    orbit = orbit_of(system, Scheme(family, ncol), 2)
    compare(eliminated(system, orbit, FREE), eliminated(replace(system, compiled=False), orbit, FREE), 1e-10)


@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize(
    ("spoil", "error"),
    [
        ("residual", FloatingPointError),
        ("derivative", FloatingPointError),
        ("unknown", np.linalg.LinAlgError),
        ("stages", np.linalg.LinAlgError),
    ],
)
def test_failures_are_named(spoil: str, error: type[Exception], compiled: bool) -> None:
    """Assert the same exception from C and NumPy where equations are not finite or singular."""
    system = replace(STRUCTURES["disc"], spoil=spoil, compiled=compiled)
    with pytest.raises(error):
        eliminated(system, orbit_of(system, Scheme(), 1), FREE)


def test_wrong_shape_is_refused() -> None:
    """Assert that C is not given equations of fewer rows than there are states."""
    system = STRUCTURES["disc"]
    orbit = orbit_of(replace(system, n=2), Scheme(), 1)
    with pytest.raises(ValueError, match=r"^residual of the .* has shape \(20, 4\); it must be \(20, 3\)$"):
        eliminated(system, orbit, FREE)


@cache
def both(name: str) -> tuple[sym.CompiledSystem, sym.CompiledSystem]:
    """A scene of the package, in NumPy and in C."""
    made = []
    with pytest.MonkeyPatch.context() as patch:
        for kernels in ("numpy", "c"):
            patch.setenv("ORBITRACE_KERNELS", kernels)
            made.append(build(load(name)))
    return made[0], made[1]


@pytest.mark.backends
@pytest.mark.parametrize("name", scene_names())
def test_orbits_of_scenes(name: str) -> None:
    """Assert the same orbit, multipliers and number of iterations of every scene, from a state near rest."""
    by_numpy, by_c = both(name)
    mesh = uniform(Scheme(), 20)
    guess = at_rest(by_numpy, mesh, by_numpy.nominal)
    expected, found = (correct(per.Collocation().linearise, s, guess) for s in (by_numpy, by_c))
    assert expected.outcome is found.outcome
    if expected.outcome is Outcome.CONVERGED:
        close(found.orbit.knots, expected.orbit.knots, 1e-9)
        close(found.monodromy, expected.monodromy, 1e-8)
        assert found.iterations == expected.iterations
    if linear_of(by_numpy) is not None:
        return  # the equations of a structure's places are not those of intervals
    orbit = transfer(expected.orbit, mesh, guess.phases)
    compare(eliminated(by_c, orbit, FREE), eliminated(by_numpy, orbit, FREE), 1e-8)


@pytest.mark.backends
def test_branch_is_the_same() -> None:
    """Assert the folds of problem A to 1e-10 with C, and that its branch has as many points."""
    x = sym.coordinate("x")
    model = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.CubicSpring(x, 1.0)
    model = model + sym.HarmonicForce(x, 0.5)
    branches = [per.trace(sym.compile(model, kernels=k), "Omega", (0.3, 3.0)) for k in ("numpy", "c")]
    folds = [[p.parameter for p in branch.special_points if p.label is per.Label.FOLD] for branch in branches]
    assert folds[0] == pytest.approx(folds[1], rel=1e-10) and len(folds[0]) == 2
    assert len(branches[0].points) == len(branches[1].points)


def test_who_runs_in_numpy() -> None:
    """Assert that systems without a compiler, with one that is not to be used, or large full ones, do."""

    def chosen(system: Any, full: bool = True) -> bool:
        n = len(system.states)
        slopes = np.ones((3, n, n)) if full else np.broadcast_to(np.eye(n), (3, n, n))
        none = np.zeros((3, n, 0))
        return routines(system, Lines(slopes[:, 0], slopes, slopes, none, slopes[:, 0], none)) is not None

    assert not chosen(LinearOscillator())
    assert not chosen(Rows(2, 0, compiled=False))
    assert not chosen(Rows(FULL, 0))
    assert chosen(Rows(FULL - 1, 0)) and chosen(Rows(FULL, 0), full=False)
    assert not chosen(both("duffing")[0]) and chosen(both("duffing")[1])


def test_disc_with_events() -> None:
    """Assert equal maps on a tied, adapted mesh of the disc where it loses contact, to 1e-8."""
    by_numpy, by_c = both("vitrea79-810N")
    orbit = max((p.orbit for p in traces.disc().points), key=lambda o: len(o.phases))
    assert len(orbit.phases) > 0
    compare(eliminated(by_c, orbit, FREE), eliminated(by_numpy, orbit, FREE), 1e-8)


def test_intervals_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the same maps, bit for bit, from a few intervals at a time, kinks at their ends or not."""
    by_numpy, by_c = both("vitrea79-810N")
    orbit = max((p.orbit for p in traces.disc().points), key=lambda o: len(o.phases))
    whole = eliminated(by_c, orbit, FREE)
    monkeypatch.setattr(elimination, "MEMORY", 2e4)
    parts = eliminated(by_c, orbit, FREE)
    for name in ("step", "stages", "algebraic", "residual"):
        assert np.array_equal(getattr(parts, name), getattr(whole, name))
    compare(parts, eliminated(by_numpy, orbit, FREE), 1e-6)
