"""Stops that are grazed, by methods whose meshes are not tied to contacts: nothing wrong in silence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from reference.piecewise import periodic
from support.stops import exactly, stopped

import periodic as per
import symbolic as sym
from periodic.shooting.flow import segment_maps
from periodic.system import index_of

GRAZING = 0.7106873691
F = sym.functions
SHORT = per.ArclengthControl(max_points=40)


def check(stiffness: float, point: per.Point, tol: float) -> None:
    """Assert orbit and multipliers of a point in closed form, to its tolerance or what it claims."""
    omega, orbit = point.parameter, point.orbit
    start = np.array([orbit["q"](0.0), orbit["q'"](0.0)])
    truth = periodic(exactly(stiffness), omega, start)
    largest = max(1.0, float(np.abs(truth.multipliers).max()))
    apart = np.abs(np.poly(truth.monodromy) - np.poly(point.multipliers)).max() / largest
    assert np.abs(truth.start - start).max() < max(tol, 3 * point.error.orbit) * orbit.span()
    assert apart < max(tol, 3 * point.error.multiplier)


def past(stiffness: float) -> per.Orbit:
    """An orbit that is 6e-5 past grazing."""
    return per.trace(stopped(stiffness), "Omega", (0.7, 0.71075), tol=1e-8)[-1].orbit


@pytest.mark.parametrize("stiffness", [1e2, 1e4])
def test_short_contacts_by_shooting(stiffness: float) -> None:
    """Assert orbits just past grazing, where contacts last .05 to .002 of a period, by single shooting."""
    bounds, few = (0.71075, 0.7108), per.ArclengthControl(max_points=2)
    method = per.Shooting(tolerance=1e-11)
    branch = per.trace(
        stopped(stiffness), "Omega", bounds, guess=past(stiffness), method=method, tol=1e-6, control=few
    )
    assert len(branch) == 2
    assert abs(branch[0].multipliers[0]) > 2
    for point in branch:
        check(stiffness, point, 1e-6)


def test_an_orbit_through_a_stop_is_none() -> None:
    """Assert that the trajectory of the orbit without contact meets the stop where it lies 1e-6 past it."""
    system = stopped(1e4)
    before = per.trace(system, "Omega", (0.7, 0.7106), tol=1e-8)[-1].orbit
    parameter = before.parameter.copy()
    parameter[index_of(system, "Omega")] = 0.710688
    through = replace(before, parameter=parameter)
    assert segment_maps(system, before, (), 1, 1e-11).residual < 1e-7
    assert segment_maps(system, through, (), 1, 1e-11).residual > 1e-5


def test_harmonics_beside_grazing() -> None:
    """Assert that a branch of few harmonics ends at a hard stop, and each of its points is what it claims."""
    branch = per.trace(
        stopped(1e4), "Omega", (0.7, 0.72), tol=1e-3, method=per.HarmonicBalance(), control=SHORT
    )
    assert branch.stop.reason is not per.Reason.BOUND
    assert abs(branch[-1].parameter - GRAZING) < 1e-4
    assert sum(point.error.multiplier < 1e-3 for point in branch) > 4
    for point in branch:
        if point.error.multiplier < 1e-2:  # an estimate of first order
            check(1e4, point, 1e-3)


@pytest.mark.parametrize("method", [per.Shooting(), per.HarmonicBalance()])
def test_equations_that_jump_are_refused(method: per.extend.Discretisation) -> None:
    """Assert that friction by sign, whose multipliers these methods would miss, is refused; a wave is not."""

    def compiled(force: object) -> sym.CompiledSystem:
        return sym.compile(
            sym.Equations(
                lambda x, p, wave: {"x": x.v, "v": force(x, wave) - 0.1 * x.v - x.x},  # type: ignore[operator]
                {"x": 0.0, "v": 0.0},
                {"w": 1.2},
                frequency="w",
            )
        )

    with pytest.raises(ValueError, match="for a system whose equations jump it must be Collocation"):
        per.trace(compiled(lambda x, wave: wave.cos - 0.1 * F.sign(x.v)), "w", (1.2, 1.3), method=method)
    wave = per.trace(
        compiled(lambda x, wave: F.sign(wave.cos)), "w", (1.2, 1.21), method=method, tol=per.Accuracy.DRAFT
    )
    assert len(wave) > 1 or wave.stop.reason is per.Reason.INACCURATE
