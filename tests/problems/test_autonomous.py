"""Autonomous orbits: their period is unknown, a phase condition determines it. Known answers of the field."""

from __future__ import annotations

import numpy as np
import pytest
from support.flows import AUTONOMOUS, feedback, lorenz, period, stuart_landau, van_der_pol
from support.kept import kept
from support.traces import FINE

import periodic as per

VAN_DER_POL = {1.0: 6.6632868593, 5.0: 11.6122306677, 10.0: 19.0783695669}
"""Period at mu."""

CASCADE = ((229.406709, 0.4808668), (218.21013, 0.987949), (215.9659, 1.986752))
"""rho and T of the period doublings of Lorenz's symmetric cycle (AUTO-07p)."""


@kept
def van_der_pol_branch(tol: float) -> per.Branch:
    """Orbits from mu = 1 to 10."""
    guess = van_der_pol(1.0).simulated([2.0, 0.0], 100.0, crossing=0)
    return per.trace(
        van_der_pol(1.0), "mu", (1, 10), at=(1, 5, 10), guess=guess, determined=AUTONOMOUS, tol=tol
    )


@pytest.mark.parametrize("tol, digits", [(1e-8, 1e-9), (1e-9, 5e-12)])
def test_van_der_pol(tol: float, digits: float) -> None:
    """Assert periods and amplitude of van der Pol's oscillator, and its exact trivial multiplier."""
    branch = van_der_pol_branch(tol)
    assert branch.stop.reason is per.Reason.BOUND
    found = {point.parameter: point for point in branch.labelled(per.Label.USER)}
    # The table has eleven digits.
    assert {mu: period(p) for mu, p in found.items()} == pytest.approx(VAN_DER_POL, rel=max(digits, 5e-12))
    assert found[1.0].maximum["x1"] == pytest.approx(2.0086198609, rel=3e-11)
    assert all(point.trivial is not None and point.trivial < 100 * digits for point in branch)
    assert branch.stable.all()


def test_liouville() -> None:
    """Assert that the product of the multipliers is exp of the integrated trace of the Jacobian."""
    point = van_der_pol_branch(1e-9).labelled(per.Label.USER)[0]
    tau = np.linspace(0, 2 * np.pi, 20001)[:-1]
    x = point.orbit.state(tau)[:, 0]
    trace = 1.0 * (1 - x**2)
    assert np.log(np.prod(np.abs(point.multipliers))) == pytest.approx(trace.mean() * period(point), rel=1e-8)


def test_stuart_landau() -> None:
    """Assert period, amplitude and multiplier where they are known in closed form."""
    guess = stuart_landau(0.5).simulated([0.5, 0.1], 60.0, crossing=0)
    branch = per.trace(
        stuart_landau(0.5), "mu", (0.01, 0.5), start=0.5, guess=guess, determined=AUTONOMOUS, tol=FINE
    )
    for point in branch:
        mu = point.parameter
        assert period(point) == pytest.approx(2 * np.pi, rel=1e-12)
        assert point.maximum["x1"] == pytest.approx(np.sqrt(mu), rel=1e-9)
        assert point.nontrivial == pytest.approx([np.exp(-4 * np.pi * mu)], rel=1e-10)


def test_feedback_control() -> None:
    """Assert place and period of the doubling of the feedback control system, to the digits of the table."""
    guess = feedback(0.9).simulated([0.3, 0.0, 0.0], 1000.0, crossing=0)
    branch = per.trace(
        feedback(0.9), "alpha", (0.55, 0.9), start=0.9, guess=guess, determined=AUTONOMOUS, tol=FINE
    )
    (doubling,) = branch.labelled(per.Label.DOUBLING)
    assert doubling.parameter == pytest.approx(0.630302006160, rel=1e-11)
    assert period(doubling) == pytest.approx(6.364071339441, rel=1e-12)
    assert branch.special_points == (branch[0], doubling, branch[-1])


def test_lorenz_cascade() -> None:
    """Assert the first doublings of Lorenz's cycle, each branch started from the doubling before it."""
    system, guess = lorenz(250.0), lorenz(250.0).simulated([0.01, 0.01, 2.0], 100.0, crossing=0)
    found, start = [], 250.0
    for _ in CASCADE:
        branch = per.trace(system, "rho", (205, start), start=start, guess=guess, determined=AUTONOMOUS)
        (doubling,) = branch.labelled(per.Label.DOUBLING)
        found.append((doubling.parameter, period(doubling)))
        guess = per.doubled(system, doubling.orbit, "rho", determined=AUTONOMOUS)
        start = float(guess.parameter[1])
        assert guess.periods == 2 * doubling.orbit.periods
    assert [rho for rho, _ in found] == pytest.approx([rho for rho, _ in CASCADE], rel=2e-7)
    assert [T for _, T in found] == pytest.approx([T for _, T in CASCADE], rel=3e-7)


def test_trivial_multiplier_is_kept_on_disk(tmp_path: object) -> None:
    """Assert that a saved autonomous branch is as stable as before."""
    branch = van_der_pol_branch(1e-8)
    path = f"{tmp_path}/branch.nc"
    branch.save(path)
    again = per.Branch.load(path)
    assert [p.trivial for p in again] == [p.trivial for p in branch]
    assert again.stable.all()
