"""Branches of equilibria: folds, Hopf and branch points at known places, and the orbits that begin there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from reference.integration import path
from support.equations import (
    F,
    brusselator,
    feedback,
    fitzhugh_nagumo,
    lorenz,
    reaction,
    stuart_landau,
)
from support.kept import kept
from support.traces import FINE, duffing, duffing_system, fold_speeds

import periodic as per
import symbolic as sym

ORBIT = {"omega": per.PhaseCondition()}
HOPF = 470 / 19


def labels(branch: per.Branch) -> list[str]:
    """Labels of the special points between the ends."""
    return [p.label.value for p in branch.special_points if p.label is not per.Label.END]


def places(branch: per.Branch) -> list[float]:
    """Their parameters."""
    return [p.parameter for p in branch.special_points if p.label is not per.Label.END]


def equations(function: Any, states: dict[str, float], **parameters: float) -> sym.CompiledSystem:
    """A system of the first order."""
    return sym.compile(sym.Equations(function, states=states, parameters=parameters))


@kept
def origin() -> per.Branch:
    """Lorenz's origin."""
    return per.trace(lorenz(), "rho", (0, 30), at=[28], method=per.Equilibrium())


@kept
def convection() -> per.Branch:
    """Lorenz's other equilibria, from the pitchfork."""
    guess = per.branched(lorenz(), origin().labelled(per.Label.BRANCH)[0].orbit, "rho")
    return per.trace(lorenz(), "rho", (float(guess.parameter[1]), 30), guess=guess, method=per.Equilibrium())


def test_pitchfork_of_lorenz() -> None:
    """Assert that the origin branches at rho = 1 and is stable up to there, with its known eigenvalues."""
    assert labels(origin()) == ["BP", "UZ"]
    assert origin().labelled(per.Label.BRANCH)[0].parameter == pytest.approx(1.0, abs=1e-12)
    assert all(p.stable == (p.parameter < 1) for p in origin() if p.label is per.Label.NONE)
    (point,) = origin().labelled(per.Label.USER)
    root = np.sqrt(11**2 + 4 * 10 * 27)
    assert point.multipliers == pytest.approx([(-11 + root) / 2, -8 / 3, (-11 - root) / 2], rel=1e-13)
    assert point.equilibrium and point.maximum == point.minimum == {"x": 0, "y": 0, "z": 0}


@pytest.mark.parametrize("side", [-0.02, 0.02])
def test_other_branch_of_the_pitchfork(side: float) -> None:
    """Assert that either side of the pitchfork is reached, and the way back to the origin."""
    point = origin().labelled(per.Label.BRANCH)[0]
    found = per.branched(lorenz(), point.orbit, "rho", distance=side)
    rho = float(found.parameter[1])
    x = np.sqrt(8 / 3 * (rho - 1))
    assert 10 * np.abs(found.nodes[0]) == pytest.approx([x, x, rho - 1], rel=1e-12)
    back = per.branched(lorenz(), point.orbit, "rho", leaving=found)
    assert np.abs(back.nodes).max() < 1e-12 and back.parameter[1] != pytest.approx(1)


def test_hopf_point_of_lorenz() -> None:
    """Assert the Hopf point at rho = 470/19, where omega^2 = beta (sigma + rho)."""
    assert labels(convection()) == ["HB"]
    (point,) = convection().labelled(per.Label.HOPF)
    assert point.parameter == pytest.approx(HOPF, rel=1e-11)
    omega = np.sqrt(8 / 3 * (10 + HOPF))
    assert point.multipliers == pytest.approx([1j * omega, -1j * omega, -41 / 3], rel=1e-10, abs=1e-9)
    assert not point.stable
    assert all(p.stable == (p.parameter < HOPF) for p in convection() if p is not point)


def test_pitchfork_seen_from_the_branch_that_turns() -> None:
    """Assert that the pitchfork is a BP, and no LP, on the branch that turns there."""
    branch = per.trace(
        lorenz(), "rho", (0, 30), start=28, guess={"x": 8.0, "y": 8.0, "z": 27.0}, method=per.Equilibrium()
    )
    assert labels(branch) == ["HB", "BP", "HB"]
    assert places(branch) == pytest.approx([HOPF, 1, HOPF], rel=1e-12)
    assert branch[0].maximum["x"] == pytest.approx(-branch[-1].maximum["x"], rel=1e-12)


def test_unstable_orbits_of_lorenz() -> None:
    """Assert that unstable orbits go down from the Hopf point, with Liouville's product of multipliers."""
    guess = per.hopf(lorenz(), convection().labelled(per.Label.HOPF)[0].orbit, "rho")
    begin = float(guess.parameter[1])
    assert HOPF - 0.01 < begin < HOPF
    branch = per.trace(lorenz(), "rho", (20, begin), guess=guess, determined=ORBIT, tol=FINE)
    assert branch.stop.reason is per.Reason.BOUND and not branch.stable.any() and labels(branch) == []
    assert [(abs(p.nontrivial) > 1).sum() for p in branch] == [1] * len(branch)
    end = branch[0]
    rho, omega = end.orbit.parameter[1], end.orbit.parameter[3]
    assert np.prod(end.nontrivial).real == pytest.approx(np.exp(-41 / 3 * 2 * np.pi / omega), rel=1e-10)

    def rates(t: float, x: Any) -> list[float]:
        return [10 * (x[1] - x[0]), x[0] * (rho - x[2]) - x[1], x[0] * x[1] - 8 / 3 * x[2]]

    start = 10 * end.orbit.state(np.zeros(1))[0]
    after = path(rates, start, 2 * np.pi / omega, rtol=1e-13, atol=1e-13)[:, -1]
    assert after == pytest.approx(start, rel=1e-11)


def test_feedback_control_from_rest_to_its_doubling() -> None:
    """Assert Hopf point, doubling and period of the feedback control system, without any simulation."""
    branch = per.trace(feedback(), "alpha", (2, 0.5), method=per.Equilibrium())
    (point,) = branch.labelled(per.Label.HOPF)
    assert point.parameter == pytest.approx(1.0, rel=1e-12)
    guess = per.hopf(feedback(), point.orbit, "alpha")
    ends = (0.6, guess.parameter[0])
    orbits = per.trace(feedback(), "alpha", ends, guess=guess, determined=ORBIT, tol=1e-10)
    (doubling,) = orbits.labelled(per.Label.DOUBLING)
    assert doubling.parameter == pytest.approx(0.630302006160, rel=1e-10)
    assert 2 * np.pi / doubling.orbit.parameter[1] == pytest.approx(6.364071339441, rel=1e-12)
    assert labels(orbits) == ["PD"]


def test_orbits_shrink_to_the_hopf_point() -> None:
    """Assert that orbits traced towards their Hopf point end there, and that it is found again."""
    (point,) = per.trace(feedback(), "alpha", (2, 0.5), method=per.Equilibrium()).labelled(per.Label.HOPF)
    guess = per.hopf(feedback(), point.orbit, "alpha", distance=0.2)
    orbits = per.trace(feedback(), "alpha", (0.9, 1.2), guess=guess, determined=ORBIT)
    assert orbits.stop.reason is per.Reason.EQUILIBRIUM
    assert labels(orbits) == ["HB"]
    assert orbits[-1].parameter == pytest.approx(1.0, abs=1e-7)
    assert orbits[-1].peak_to_peak("x") < 1e-2


def test_reaction_of_auto() -> None:
    """Assert the folds and the Hopf point of AUTO's demo ab, known in closed form, and no neutral saddle.

    There is one between the folds, at u1 = (17 - sqrt(65))/28, where the eigenvalues' sum vanishes too.
    """
    branch = per.trace(reaction(), "p1", (0, 0.15), method=per.Equilibrium())
    assert labels(branch) == ["LP", "LP", "HB"]
    u1 = np.array([(1 - np.sqrt(1 / 7)) / 2, (1 + np.sqrt(1 / 7)) / 2, (17 + np.sqrt(65)) / 28])
    assert [p.maximum["u1"] for p in branch.special_points[1:-1]] == pytest.approx(u1, rel=1e-12)
    assert places(branch) == pytest.approx(u1 / (1 - u1) * np.exp(-14 * u1 / 3), rel=1e-11)
    assert places(branch)[:2] == pytest.approx([1.05739e-1, 8.89318e-2], rel=1e-5)  # AUTO's manual


def test_orbits_of_the_brusselator() -> None:
    """Assert the Hopf point at B = 1 + A^2 and that stable orbits are born there."""
    (point,) = per.trace(brusselator(), "B", (1, 4), method=per.Equilibrium()).labelled(per.Label.HOPF)
    assert point.parameter == pytest.approx(2.69, rel=1e-12)
    assert point.multipliers == pytest.approx([1.3j, -1.3j], rel=1e-11, abs=1e-12)
    guess = per.hopf(brusselator(), point.orbit, "B")
    orbits = per.trace(brusselator(), "B", (guess.parameter[1], 3.5), guess=guess, determined=ORBIT)
    assert orbits.stop.reason is per.Reason.BOUND and orbits.stable.all()
    assert orbits[0].orbit.parameter[2] == pytest.approx(1.3, rel=1e-3)


def test_hopf_points_of_fitzhugh_and_nagumo() -> None:
    """Assert both Hopf points, v = -+ sqrt(1 - b e)."""
    branch = per.trace(fitzhugh_nagumo(), "I", (0, 2), method=per.Equilibrium())
    v = np.sqrt(1 - 0.08 * 0.8) * np.array([-1, 1])
    assert labels(branch) == ["HB", "HB"]
    assert places(branch) == pytest.approx((v + 0.7) / 0.8 - v + v**3 / 3, rel=1e-11)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_orbits_of_stuart_and_landau(sign: float) -> None:
    """Assert that the orbit from the Hopf point is the exact one, super- and subcritical, of any size."""
    system = stuart_landau(sign)
    (point,) = per.trace(system, "mu", (-1, 1), method=per.Equilibrium()).labelled(per.Label.HOPF)
    assert point.parameter == pytest.approx(0, abs=1e-12)
    for distance in (None, 0.3):
        orbit = per.hopf(system, point.orbit, "mu", distance=distance)
        mu, omega = orbit.parameter
        size = np.sqrt((orbit.nodes**2).sum(axis=1))
        assert size == pytest.approx(np.full(25, distance or 0.02), rel=1e-12)
        assert mu == pytest.approx(-sign * size[0] ** 2, rel=1e-6)
        assert omega == pytest.approx(1, rel=1e-9)


def hopf_point(system: sym.CompiledSystem, parameter: str, bounds: tuple[float, float]) -> per.Point:
    """The first Hopf point between two values."""
    return per.trace(system, parameter, bounds, method=per.Equilibrium()).labelled(per.Label.HOPF)[0]


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_lyapunov_coefficient_of_stuart_and_landau(sign: float) -> None:
    """Assert l1 = 2 sign: for z' = i z + sign |z|^2 z and <q, q> = 1, c1 = 2 sign, omega = 1."""
    point = hopf_point(stuart_landau(sign), "mu", (-1, 1))
    assert per.first_lyapunov(stuart_landau(sign), point.orbit) == pytest.approx(2 * sign, rel=1e-11)


@pytest.mark.parametrize(
    "make, parameter, bounds, growth",
    [(feedback, "alpha", (2, 0.5), -0.25), (brusselator, "B", (1, 4), 0.5)],
)
def test_lyapunov_coefficient_from_the_orbits(
    make: Any, parameter: str, bounds: tuple[float, float], growth: float
) -> None:
    """Assert p - p0 = -l1 omega a^2 / (2 d Re lambda/dp), a the root mean square distance of small orbits."""
    system = make()
    point = hopf_point(system, parameter, bounds)
    coefficient = per.first_lyapunov(system, point.orbit)
    orbit = per.hopf(system, point.orbit, parameter, distance=0.02)
    shift = orbit.parameter[[p.name for p in system.parameters].index(parameter)] - point.parameter
    omega = point.multipliers[0].imag
    assert shift / 0.02**2 == pytest.approx(-coefficient * omega / (2 * growth), rel=1e-3)


def test_known_lyapunov_coefficients() -> None:
    """Assert MatCont's -0.3 for the feedback system, and that Lorenz's orbits are born unstable."""
    point = hopf_point(feedback(), "alpha", (2, 0.5))
    assert per.first_lyapunov(feedback(), point.orbit) == pytest.approx(-0.3, rel=1e-11)
    assert per.first_lyapunov(lorenz(), convection().labelled(per.Label.HOPF)[0].orbit) > 0


def circle() -> sym.CompiledSystem:
    """x' = 1 - x^2 - mu^2: a closed branch."""
    return equations(lambda x, p: {"x": 1 - x.x**2 - p.mu**2}, {"x": 1.0}, mu=0.0)


@pytest.mark.parametrize("start, x", [(0.0, 1.0), (0.5, 1.0), (1.0, 0.0)])
def test_closed_branch(start: float, x: float) -> None:
    """Assert that a circle of equilibria closes, from anywhere on it, a fold included."""
    branch = per.trace(circle(), "mu", (-2, 2), start=start, guess={"x": x}, method=per.Equilibrium())
    assert branch.stop.reason is per.Reason.CLOSED
    # The branch that begins at a fold has it as its ends.
    assert {round(p.parameter, 9) for p in branch.labelled(per.Label.FOLD)} == {-1.0, 1.0}
    assert all(p.maximum["x"] ** 2 + p.parameter**2 == pytest.approx(1, rel=1e-12) for p in branch)
    assert all(p.stable == (p.maximum["x"] > 0) for p in branch if p.label is per.Label.NONE)


@pytest.mark.parametrize("label", ["HB", "BP"])
def test_two_changes_within_a_step(label: str) -> None:
    """Assert that stability that is lost and regained within one step is seen, both changes in place."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        growth = (p.mu - 0.5) ** 2 - 1e-4
        turn = 1 if label == "HB" else 0
        return {"x": growth * x.x - turn * x.y, "y": turn * x.x + (growth if turn else -1) * x.y}

    branch = per.trace(equations(rates, {"x": 0.0, "y": 0.0}, mu=0.0), "mu", (0, 1), method=per.Equilibrium())
    assert labels(branch) == [label] * 2
    assert places(branch) == pytest.approx([0.49, 0.51], rel=1e-11)


def test_fold_and_branch_point_within_a_step() -> None:
    """Assert that a branch point close to a fold is told from it: (mu - x^2)(x - a), a = 0.01."""
    system = equations(lambda x, p: {"x": (p.mu - x.x**2) * (x.x - p.a)}, {"x": 0.0}, mu=0.0, a=0.01)
    branch = per.trace(system, "mu", (-1, 1), start=1.0, guess={"x": 1.0}, method=per.Equilibrium())
    assert labels(branch) == ["BP", "LP"]
    assert places(branch) == pytest.approx([1e-4, 0], abs=1e-9)


def test_pitchfork_of_one_state_seen_from_the_branch_that_turns() -> None:
    """Assert that x' = mu x - x^3 has a BP where mu = x^2 turns."""
    system = equations(lambda x, p: {"x": p.mu * x.x - x.x**3}, {"x": 0.0}, mu=0.0)
    branch = per.trace(system, "mu", (-1, 1), start=1.0, guess={"x": 1.0}, method=per.Equilibrium())
    assert labels(branch) == ["BP"]
    assert places(branch) == pytest.approx([0], abs=1e-12)


def test_branch_points_of_curved_branches() -> None:
    """Assert where a parabola and a line cross, and a circle and a line, to all digits of their roots."""
    curves = {
        "parabola": (lambda x, p: (x.x - p.mu**2) * (x.x - p.mu + 0.1), 0.5, np.sqrt(0.15)),
        "circle": (lambda x, p: (x.x**2 + p.mu**2 - 1) * (x.x - p.mu), 0.0, np.sqrt(0.5)),
    }
    for made, middle, apart in curves.values():
        rates = sym.Equations(lambda x, p, f=made: {"x": -f(x, p)}, {"x": 0.0}, {"mu": 0.0})
        branch = per.trace(
            sym.compile(rates),
            "mu",
            (-2, 2),
            start=0.0,
            guess={"x": 1.0 - 2 * middle},
            method=per.Equilibrium(),
        )
        places = sorted(point.parameter for point in branch.labelled("BP"))
        assert places == pytest.approx([middle - apart, middle + apart], rel=1e-10)


def test_transcritical_branches() -> None:
    """Assert that of two crossing branches the one that is not left is returned, either way."""
    system = equations(lambda x, p: {"x": (p.mu - x.x) * (x.x + 2 * p.mu)}, {"x": 0.0}, mu=-1.0)
    lines = {1.0: 1.0, -2.0: -2.0}
    for slope in lines:
        branch = per.trace(system, "mu", (-1, 1), guess={"x": -slope}, method=per.Equilibrium())
        (point,) = branch.labelled(per.Label.BRANCH)
        assert point.parameter == pytest.approx(0, abs=1e-9)
        other = per.branched(system, point.orbit, "mu", leaving=branch[2].orbit)
        assert other.nodes[0, 0] / other.parameter[0] == pytest.approx(-1.0 - slope, rel=1e-7)


def test_equilibria_with_unknowns_and_any_omega() -> None:
    """Assert eigenvalues in 1/s with an algebraic unknown, whatever omega is: x'' + 0.2 x' + sinh z = F."""
    system = sym.compile(
        sym.Equations(
            lambda x, p: {"x": x.v, "v": p.F - 0.2 * x.v - F.sinh(x.z), "z": F.sinh(x.z) - x.x - x.x**3},
            states={"x": 0.0, "v": 0.0},
            unknowns={"z": 0.0},
            parameters={"F": 0.0},
        )
    )
    for omega in (1.0, 37.0):
        end = per.trace(system, "F", (0, 2), values={"omega": omega}, method=per.Equilibrium())[-1]
        assert end.maximum["x"] == pytest.approx(1, rel=1e-12)
        pair = -0.1 + 1j * np.sqrt(4 - 0.01)
        assert end.multipliers == pytest.approx([pair, pair.conjugate()], rel=1e-11)


def test_lyapunov_coefficient_with_an_unknown() -> None:
    """Assert that the Brusselator has the same coefficient with x^2 y as an algebraic unknown."""
    system = sym.compile(
        sym.Equations(
            lambda x, p: {
                "x": p.A + x.z - (p.B + 1) * x.x,
                "y": p.B * x.x - x.z,
                "z": x.z - x.x**2 * x.y,
            },
            states={"x": 1.0, "y": 1.0},
            unknowns={"z": 1.0},
            parameters={"A": 1.3, "B": 1.0},
        )
    )
    found, known = (per.first_lyapunov(s, hopf_point(s, "B", (1, 4)).orbit) for s in (system, brusselator()))
    assert found == pytest.approx(known, rel=1e-9)


def test_orbits_from_an_equilibrium() -> None:
    """Assert that an equilibrium of the unexcited system is a guess for its forced orbits."""
    still = per.trace(duffing_system(0.1, 1.0, 0.0), "k", (1, 2), method=per.Equilibrium(frequency="Omega"))
    omega = np.sqrt(1 - 0.05**2)
    assert still[0].multipliers == pytest.approx([-0.05 + 1j * omega, -0.05 - 1j * omega], rel=1e-12)
    forced = per.trace(
        duffing_system(0.1, 1.0, 0.0),
        "Omega",
        (0.3, 3),
        start=0.3,
        guess=still[0].orbit,
        values={"F": 0.5},
    )
    assert fold_speeds(forced) == pytest.approx(fold_speeds(duffing()), rel=1e-9)


def test_kept_on_disk(tmp_path: Path) -> None:
    """Assert that a saved branch of equilibria is one again, and its Hopf point a start of orbits."""
    convection().save(tmp_path / "branch.nc")
    again = per.Branch.load(tmp_path / "branch.nc")
    assert [p.label for p in again] == [p.label for p in convection()]
    assert all(p.equilibrium for p in again) and (again.stable == convection().stable).all()
    assert (
        again.labelled(per.Label.HOPF)[0].multipliers
        == per.eigenvalues(lorenz(), again.labelled(per.Label.HOPF)[0].orbit)
    ).all()
    guess = per.hopf(lorenz(), again.labelled(per.Label.HOPF)[0].orbit, "rho")
    assert guess.parameter[1] < HOPF


def test_table_and_plot_show_outputs() -> None:
    """Assert that tables and plots of equilibria show the outputs themselves."""
    assert convection().table().splitlines()[0].split()[:5] == ["label", "rho", "x", "y", "z"]
    axes = per.plot(convection(), "z")
    assert axes.get_ylabel() == "z"
    heights = np.concatenate([line.get_ydata() for line in axes.lines])
    assert heights.max() == pytest.approx(29)


@pytest.mark.parametrize(
    "make, sentence",
    [
        (
            lambda: per.trace(
                duffing_system(0.1, 1.0, 0.5), "F", (0.1, 1), method=per.Equilibrium(frequency="Omega")
            ),
            "the system is excited: its equations depend on the phase",
        ),
        (
            lambda: per.trace(duffing_system(0.1, 1.0, 0.5), "F", (0, 1), method=per.Equilibrium()),
            "frequency is 'omega'; it must be one of the parameters",
        ),
        (
            lambda: per.trace(lorenz(), "omega", (0, 1), method=per.Equilibrium()),
            "parameter is 'omega', the frequency; equilibria do not depend on it",
        ),
        (
            lambda: per.trace(lorenz(), "rho", (0, 1), guess={"u": 1.0}, method=per.Equilibrium()),
            "guess has 'u'; it must be one of x, y, z",
        ),
        (
            lambda: per.trace(lorenz(), "rho", (0, 1), guess={"x": np.nan}, method=per.Equilibrium()),
            "guess of x is nan; it must be a finite number",
        ),
        (
            lambda: per.hopf(stuart_landau(), per.hopf(stuart_landau(), _rest(), "mu"), "mu"),
            "orbit is no equilibrium; it must be one",
        ),
    ],
)
def test_refused(make: Any, sentence: str) -> None:
    """Assert that what makes no sense is refused in one sentence."""
    with pytest.raises(ValueError) as caught:
        make()
    assert str(caught.value).startswith(sentence)


def _rest() -> per.Orbit:
    """The Hopf point of Stuart and Landau."""
    return (
        per.trace(stuart_landau(), "mu", (-1, 1), method=per.Equilibrium()).labelled(per.Label.HOPF)[0].orbit
    )


def test_no_orbits_begin_elsewhere() -> None:
    """Assert that an equilibrium that is no Hopf or branch point is told."""
    with pytest.raises(per.SwitchError, match="no Hopf point"):
        per.hopf(lorenz(), convection()[-1].orbit, "rho")
    with pytest.raises(per.SwitchError, match="none of its eigenvalues is complex"):
        per.hopf(lorenz(), origin()[-1].orbit, "rho")
    with pytest.raises(per.SwitchError, match="no other branch of equilibria crosses there"):
        per.branched(lorenz(), convection()[-1].orbit, "rho")


def test_no_equilibrium() -> None:
    """Assert that a system without equilibria is a named stop and no traceback."""
    system = equations(lambda x, p: {"x": 1 + x.x**2 + p.a}, {"x": 0.3}, a=0.0)
    branch = per.trace(system, "a", (0, 1), method=per.Equilibrium())
    assert branch.stop.reason is per.Reason.NO_START and len(branch) == 0


@pytest.mark.parametrize("place", [0.08, 0.23, 0.47, 0.62, 0.86])
def test_long_steps_round_no_corner(place: float) -> None:
    """Assert that long steps along x = sin 3 mu keep to it where lopsided equilibria leave: a BP there."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        y = x.x - sym.functions.sin(3 * p.mu)
        return {"x": y * (p.mu - place - y**2)}

    system = sym.compile(sym.Equations(rates, {"x": 0.0}, {"mu": 0.0}))
    branch = per.trace(system, "mu", (0, 1), control=per.ArclengthControl(ds=0.2), method=per.Equilibrium())
    assert [point.parameter for point in branch.labelled("BP")] == [pytest.approx(place, abs=1e-9)]
    states = [point.maximum["x"] for point in branch]
    assert states == pytest.approx(np.sin(3 * branch.values), abs=1e-9)


def test_guess_is_where_an_orbit_begins() -> None:
    """Assert that of a motion that does not close its first state is the guess, with its own unknowns."""
    system = equations(lambda x, p: {"x": p.a - x.x}, {"x": 0.25}, a=1.0)
    method = per.Equilibrium()
    still = method.guess(system, system.nominal, None)
    assert still.equilibrium and still.nodes[:, 0].tolist() == [0.25, 0.25]
    moving = replace(still, nodes=np.array([[0.5], [0.75]]), equilibrium=False)
    assert method.guess(system, system.nominal, moving).nodes[:, 0].tolist() == [0.5, 0.5]
