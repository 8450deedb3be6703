"""Orbits with kinks: meshes tied to switches, against shooting and products of matrix exponentials."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from reference import piecewise
from reference.shooting import Motion, in_order, oscillator, periodic_orbit
from support.kept import kept
from support.numpy_systems import FORCE, OMEGA, ZETA, BilinearOscillator, MeissnerOscillator

import periodic as per
import symbolic as sym
from periodic.correction.error import ErrorEstimate
from periodic.correction.newton import Correction, NewtonSettings, correct
from periodic.correction.outcome import Outcome
from periodic.events import eventnodes as kinks
from periodic.events.eventnodes import Crossing, KinkSettings, match
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import Mesh, uniform

DAMPING = 0.1
CASES = {1.3: 2, 0.6: 4, 0.462: 6}
"""Frequencies of the bilinear oscillator and how often x passes zero in a period there."""

PHASES = np.linspace(0.0, 2 * np.pi, 1001)
TIGHT = NewtonSettings(tolerance=1e-10)
each_case = pytest.mark.parametrize("Omega, kinks", CASES.items())


@kept
def draft() -> per.Branch:
    """The bilinear oscillator from high frequencies down, through many changes of its kinks."""
    system = BilinearOscillator(zeta=DAMPING)
    return per.trace(system, "Omega", (3.0, 0.3), at=tuple(CASES), tol=per.Accuracy.DRAFT)


def rough(Omega: float) -> per.Point:
    """The (first) point of the rough branch at a frequency."""
    return next(p for p in draft().labelled(per.Label.USER) if p.parameter == Omega)


@kept
def standard(Omega: float) -> per.Point:
    """A point at standard accuracy."""
    system = BilinearOscillator(zeta=DAMPING)
    bounds = (Omega, Omega * 1.001)
    return per.trace(system, "Omega", bounds, guess=rough(Omega).orbit)[0]


@cache
def reference(Omega: float) -> Motion:
    """The same orbit by shooting."""
    omega, zeta, force = BilinearOscillator(Omega=Omega, zeta=DAMPING).nominal[[OMEGA, ZETA, FORCE]]

    def stiffness(side: float) -> float:
        return 1.0 if side > 0 else 4.0

    field = oscillator(
        acceleration=lambda t, x, v, side: (
            (force * np.cos(t) - stiffness(side) * x) / omega**2 - 2 * zeta / omega * v
        ),
        by_x=lambda t, x, v, side: -stiffness(side) / omega**2,
        by_v=lambda t, x, v, side: -2 * zeta / omega,
        switch=lambda t, x: x,
    )
    return periodic_orbit(field, rough(Omega).orbit.state(np.zeros(1))[0])


def on_even_segments(Omega: float, scheme: per.Scheme, count: int) -> Correction:
    """The orbit on a mesh of as many equal intervals in each segment."""
    tied = standard(Omega).orbit
    breaks = tuple(np.linspace(0.0, 1.0, count + 1) for _ in tied.mesh.events)
    start = transfer(tied, Mesh(scheme, breaks, tied.mesh.events), tied.phases)
    result = correct(per.Collocation().linearise, BilinearOscillator(zeta=DAMPING), start, settings=TIGHT)
    assert result.outcome is Outcome.CONVERGED
    return result


def order(counts: tuple[int, ...], errors: list[float]) -> float:
    """Slope of a straight line through the logarithms of errors and widths."""
    return float(-np.polyfit(np.log(counts), np.log(errors), 1)[0])


@each_case
def test_mesh_is_tied_to_every_kink(Omega: float, kinks: int) -> None:
    """Assert that each passage of x through zero has an event node, at its phase by shooting."""
    found = np.sort(np.mod(standard(Omega).orbit.phases, 2 * np.pi))
    assert len(found) == kinks
    assert found == pytest.approx(reference(Omega).kinks, abs=1e-7)


@each_case
def test_event_nodes_are_found_by_their_crossings(Omega: float, kinks: int) -> None:
    """Assert the node of each crossing, none for one that goes the other way or is elsewhere."""
    orbit = standard(Omega).orbit
    for j, (event, phase) in enumerate(zip(orbit.mesh.events, orbit.phases, strict=True)):
        assert match(Crossing(event, phase, 1.0), orbit) == j
        assert match(Crossing(replace(event, direction=-event.direction), phase, 1.0), orbit) is None
        assert match(Crossing(event, phase + 0.03, 1.0), orbit) is None


@each_case
def test_equal_switches_share_their_event_nodes(Omega: float, kinks: int) -> None:
    """Assert the sides of a switch whose nodes are those of another that is equal to it."""
    system, orbit = BilinearOscillator(zeta=DAMPING), standard(Omega).orbit
    switches = [*system.switches, *system.switches]
    both: Any = SimpleNamespace(
        switches=switches, switch=lambda *given: np.repeat(system.switch(*given), 2, axis=1)
    )
    own, other = (SwitchPolynomials(both, orbit)._directions(switch) for switch in (0, 1))
    assert own == other == [event.direction for event in orbit.mesh.events]


def test_levels_are_as_deep_as_the_orbit_is_accurate(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the shallowest level worth an event node: a tenth of the orbit's error, or what is set."""
    system, orbit, seen = BilinearOscillator(zeta=DAMPING), standard(1.3).orbit, list[float | None]()
    monkeypatch.setattr(kinks, "wanted", lambda *given: seen.append(given[2].deepest) or [])
    for deepest in (None, 1e-2, 1e-9):
        method = per.Collocation(kinks=KinkSettings(deepest=deepest))
        assert method.refine(system, orbit, ErrorEstimate(1e-5, 0.0)).fits is False
    assert seen == pytest.approx([1e-6, 1e-2, 1e-6])


@each_case
def test_orbit_agrees_with_shooting(Omega: float, kinks: int) -> None:
    """Assert that the orbit agrees with shooting all along."""
    point = standard(Omega)
    difference = np.abs(point.orbit.state(PHASES) - reference(Omega).state(PHASES)).max()
    assert difference < 1e-6 * point.orbit.span()


@each_case
def test_multipliers_agree_with_shooting(Omega: float, kinks: int) -> None:
    """Assert that both multipliers agree with shooting."""
    found = in_order(standard(Omega).multipliers)
    assert np.abs(found - reference(Omega).multipliers).max() < 1e-7


@each_case
def test_product_of_multipliers(Omega: float, kinks: int) -> None:
    """Assert that the product of the multipliers is exp of the integral of the trace."""
    exact = np.exp(-2 * DAMPING * 2 * np.pi / Omega)
    assert np.prod(standard(Omega).multipliers) == pytest.approx(exact, abs=1e-8)


@pytest.mark.parametrize("family", per.Family)
@pytest.mark.parametrize("ncol", [2, 3])
@pytest.mark.parametrize("Omega", [1.3, 0.6])
def test_events_recover_the_order(family: per.Family, ncol: int, Omega: float) -> None:
    """Assert that phases and velocities at the kinks converge as on a smooth problem."""
    exact = reference(Omega)
    phases = np.array(exact.kinks)
    velocities = exact.state(phases)[:, 1]
    counts, errors = (6, 8, 11, 15), []
    for count in counts:
        orbit = on_even_segments(Omega, per.Scheme(family, ncol), count).orbit
        each = np.argsort(np.mod(orbit.phases, 2 * np.pi))
        late = np.abs(np.mod(orbit.phases, 2 * np.pi)[each] - phases)
        fast = np.abs(orbit.nodes[orbit.mesh.starts][each, 1] - velocities)
        errors.append(max(late.max(), fast.max()))
    wanted = 2 * ncol if family is per.Family.GAUSS else 2 * ncol - 1
    assert order(counts, errors) == pytest.approx(wanted, abs=0.35)


@pytest.mark.parametrize("family", per.Family)
@pytest.mark.parametrize("ncol", [2, 3])
@pytest.mark.parametrize("Omega", [1.3, 0.6])
def test_events_recover_the_order_of_multipliers(family: per.Family, ncol: int, Omega: float) -> None:
    """Assert that the multipliers converge as on a smooth problem, Radau's last point on the kink or not."""
    exact = reference(Omega).multipliers
    counts, errors = (6, 8, 11, 15), []
    for count in counts:
        result = on_even_segments(Omega, per.Scheme(family, ncol), count)
        errors.append(float(np.abs(in_order(np.linalg.eigvals(result.monodromy)) - exact).max()))
    wanted = 2 * ncol if family is per.Family.GAUSS else 2 * ncol - 1
    assert order(counts, errors) == pytest.approx(wanted, abs=0.35)


def test_order_is_lost_without_events() -> None:
    """Assert that a system that does not tell of its switch converges no faster than order 3."""
    system, exact = BilinearOscillator(Omega=1.3, zeta=DAMPING, declared=False), reference(1.3)
    counts, errors = (20, 29, 42, 61, 88), []
    for count in counts:
        start = transfer(standard(1.3).orbit, uniform(per.Scheme(per.Family.GAUSS, 4), count), np.zeros(0))
        result = correct(per.Collocation().linearise, system, start, settings=TIGHT)
        assert result.outcome is Outcome.CONVERGED
        errors.append(float(np.abs(result.orbit.nodes[0] - exact.start).max()))
    assert order(counts, errors) < 3.5


def test_kinks_come_and_go_along_a_branch() -> None:
    """Assert that a rough branch gets through changes between two, four and six kinks to its bound."""
    assert draft().stop.reason is per.Reason.BOUND
    assert {len(point.orbit.phases) for point in draft()} == {2, 4, 6}


def test_kinks_come_and_go_at_standard_accuracy() -> None:
    """Assert that the same branch is traced to its bound at standard accuracy."""
    branch = per.trace(BilinearOscillator(zeta=DAMPING), "Omega", (3.0, 0.5))
    assert branch.stop.reason is per.Reason.BOUND
    assert {2, 4} <= {len(point.orbit.phases) for point in branch}


@cache
def late() -> sym.CompiledSystem:
    """x'' + .2 x' + x + 3 min(x, 0) = cos(Omega t + phi): phi is where the excitation is at tau = 0."""
    f = sym.functions

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        force = f.cos(p.phi) * wave.cos - f.sin(p.phi) * wave.sin
        return {"x": x.v, "v": force - 0.2 * x.v - x.x - 3 * f.fmin(x.x, 0)}

    values = {"Omega": 1.3, "phi": 0.0}
    return sym.compile(sym.Equations(rates, {"x": 0.0, "v": 0.0}, values, frequency="Omega"))


@pytest.mark.parametrize("kink", [0, 1])
@pytest.mark.parametrize("after", [0.0, 1e-14, 1e-10, 1e-6, 1e-3, -1e-14, -1e-10, -1e-6])
def test_kink_beside_the_start_of_the_period(after: float, kink: int) -> None:
    """Assert orbit and multipliers in closed form where a kink lies on tau = 0, or just beside it."""
    excitation = np.sort(np.mod(excited_at_zero().orbit.phases, 2 * np.pi))[kink]
    phi = excitation - after
    point = per.trace(late(), "phi", (phi, phi + 1e-3), tol=1e-8)[0]
    exact = piecewise.period(STIFF_BELOW, 1.3, point.orbit.state(np.zeros(1))[0], phase=phi)
    assert exact.end == pytest.approx(exact.start, abs=1e-9)
    assert in_order(point.multipliers) == pytest.approx(exact.multipliers, abs=1e-9)
    assert np.min(np.abs(np.exp(1j * point.orbit.phases) - np.exp(1j * after))) < 1e-9


@kept
def excited_at_zero() -> per.Point:
    """The orbit at phi = 0."""
    return per.trace(late(), "phi", (0.0, 1e-3), tol=1e-8)[0]


STIFF_BELOW = piecewise.Piecewise(
    matrix=np.array([[0.0, 1.0], [-4.0, -0.2]]),
    force=np.array([0.0, 1.0]),
    normals=np.array([[1.0, 0.0]]),
    gaps=np.zeros(1),
    columns=np.array([[0.0, 3.0]]),
)
"""The same above and below 0, x' and v' in t."""


@pytest.mark.parametrize("family", per.Family)
def test_meissner(family: per.Family) -> None:
    """Assert that a jumping stiffness gives the multipliers of two matrix exponentials."""
    values = (1.4, 1.6, 2.1)
    method = per.Collocation(scheme=per.Scheme(family, 4), kinks=per.KinkSettings(deepest=0.0))
    branch = per.trace(
        MeissnerOscillator(), "Omega", (1.3, 2.5), at=values, tol=per.Tolerance(), method=method
    )
    for point, value in zip(branch.labelled(per.Label.USER), values, strict=True):
        exact = in_order(MeissnerOscillator(Omega=value).exact_multipliers())
        assert np.abs(in_order(point.multipliers) - exact).max() < 1e-9
