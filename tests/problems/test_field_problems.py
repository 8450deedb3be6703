"""Demos of AUTO, COCO, MatCont and NLvib, against their published values and DOP853 shooting.

Values of ten digits or more are of shooting: Newton on the orbit and the special point's condition with the
variational equations, integrated to 1e-13.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from reference.integration import over_period, path
from support.field_models import (
    absorber,
    catalyst,
    circuit,
    enzyme,
    forced_van_der_pol,
    pendula,
    peroxidase,
    predator,
    reactions,
    spiral,
    two_springs,
    ueda,
)
from support.kept import kept

import periodic as per
import symbolic as sym

ORBIT = {"omega": per.PhaseCondition()}
LP, PD, NS, BP, HB = per.Label.FOLD, per.Label.DOUBLING, per.Label.TORUS, per.Label.BRANCH, per.Label.HOPF


def trace(*arguments: Any, **options: Any) -> per.Branch:
    """Trace to 1e-9 unless told otherwise."""
    return per.trace(*arguments, **{"tol": 1e-9, **options})


def places(branch: per.Branch) -> list[tuple[str, float]]:
    """Label and parameter of the special points between the ends."""
    return [(p.label.value, p.parameter) for p in branch.special_points if p.label is not per.Label.END]


def expected(*found: tuple[str, float], rel: float = 1e-9) -> list[tuple[str, Any]]:
    """Labels with parameters to so many digits."""
    return [(label, pytest.approx(value, rel=rel)) for label, value in found]


def shorter_than(period: float) -> dict[str, tuple[float, float]]:
    """Limits that end a branch of orbits at a period."""
    return {"omega": (2 * np.pi / period, 100.0)}


def period(point: per.Point, branch: per.Branch) -> float:
    """T of an autonomous orbit."""
    omega = [q.name for q in branch.layout.parameters].index("omega")
    return float(point.orbit.periods * 2 * np.pi / point.orbit.parameter[omega])


def born(
    system: sym.CompiledSystem, point: per.Point, parameter: str, bounds: tuple[float, float], **more: Any
) -> per.Branch:
    """The branch of orbits from a Hopf point."""
    guess = per.hopf(system, point.orbit, parameter)
    return trace(system, parameter, bounds, guess=guess, determined=ORBIT, **more)


def settled(field: Any, begin: list[float], until: float, period: float, parameter: list[float]) -> per.Orbit:
    """An orbit sampled from a simulation over one period."""
    phase, state = over_period(field, path(field, begin, until, rtol=1e-11)[:, -1], period)
    return per.sampled(phase, state, np.zeros((len(phase), 0)), np.array(parameter))


@kept
def circuit_orbits() -> per.Branch:
    """AUTO tor, second run: symmetric orbits from the Hopf point, up to a period of 31."""
    (point,) = per.trace(circuit(), "nu", (-0.9, -0.55), method=per.Equilibrium()).labelled(HB)
    assert point.parameter == pytest.approx(-0.589336, abs=1e-6)
    return born(circuit(), point, "nu", (-0.9, -0.4), watch=per.Watch(limits=shorter_than(31)))


def test_electronic_oscillator() -> None:
    """Assert folds and branch points of AUTO's tor towards a homoclinic orbit, those beside folds too."""
    found = circuit_orbits().special_points[2:-1]
    known = [
        (LP, -0.584334771866, 1e-10),
        (BP, -0.587028974269, 1e-9),  # a pitchfork: Newton does not converge at the place itself
        (LP, -0.832514145383, 1e-10),
        (BP, -0.832437931267, 2e-11),
        (BP, -0.787592846208, 2e-11),
        (LP, -0.787590311031, 1e-10),
    ]
    assert [p.label for p in found] == [label for label, _, _ in known]
    for point, (_, place, accuracy) in zip(found, known, strict=True):
        assert point.parameter == pytest.approx(place, rel=accuracy)
    assert circuit_orbits().stop == per.Stop(per.Reason.BOUND, "lower limit of omega")


@kept
def lopsided() -> per.Branch:
    """AUTO tor, third run: the orbits without the symmetry."""
    point = circuit_orbits().labelled(BP)[0]
    guess = per.branched(circuit(), point.orbit, "nu", determined=ORBIT)
    return trace(
        circuit(), "nu", (-0.9, -0.5), guess=guess, determined=ORBIT, watch=per.Watch(limits=shorter_than(15))
    )


def test_torus_of_the_electronic_oscillator() -> None:
    """Assert torus bifurcation, doublings and fold, the same on both mirror images, and the period."""
    side = [("NS", -0.591650195032), ("PD", -0.614955221), ("PD", -0.760404469), ("LP", -0.760406919)]
    both = [*reversed(side), ("BP", -0.587028974269), *side]
    assert places(lopsided()) == expected(*both, rel=2e-9)
    assert [period(p, lopsided()) for p in lopsided().labelled(NS)] == pytest.approx(
        [8.7941517464] * 2, rel=1e-9
    )


@kept
def enzyme_orbits() -> per.Branch:
    """AUTO plp: the orbits from the first Hopf point, and one of them at rho = 4."""
    points = per.trace(enzyme(), "rho", (2, 6), method=per.Equilibrium()).labelled(HB)
    assert [p.parameter for p in points] == pytest.approx([3.4999538280, 4.6504578126], rel=1e-9)
    return born(enzyme(), points[0], "rho", (2, 6), at=4.0)


def test_enzyme() -> None:
    """Assert AUTO's plp: folds of the orbits between both Hopf points, at which they end."""
    branch = enzyme_orbits()
    assert [p.parameter for p in branch.labelled(LP)] == pytest.approx(
        [5.00783976076, 2.7596874555], rel=1e-9
    )
    assert [p.parameter for p in branch.labelled(HB)] == pytest.approx([4.6504578126, 3.4999538280], rel=1e-7)
    for stop in (branch.stop, branch.stop_backwards):
        assert stop is not None and stop.reason is per.Reason.EQUILIBRIUM


def test_isola_of_the_enzyme() -> None:
    """Assert that orbits at s0 = 111 form an isola, whose folds lie on the curve of folds."""
    orbits = enzyme_orbits()
    (inside,) = orbits.labelled(per.Label.USER)
    raised = trace(enzyme(), "s0", (110, 111), guess=inside.orbit, determined=ORBIT)
    isola = trace(enzyme(), "rho", (2, 6), guess=raised[-1].orbit, determined=ORBIT)
    assert isola.stop.reason is per.Reason.CLOSED
    assert places(isola) == expected(("LP", 2.98629481), ("LP", 4.722125236))
    determined = {**ORBIT, "rho": per.FoldCondition()}
    begin = orbits.labelled(LP)[0].orbit
    curve = trace(enzyme(), "s0", (109, 125), guess=begin, determined=determined, at=111)
    met = [rho for rho, p in zip(curve.column("rho"), curve, strict=True) if p.label is per.Label.USER]
    assert sorted(met) == pytest.approx([p.parameter for p in isola.labelled(LP)], rel=1e-11)


def test_reactions() -> None:
    """Assert AUTO's abc: orbits from the first Hopf point to the last and from the second to the third."""
    points = per.trace(reactions(), "D", (0, 0.4), method=per.Equilibrium()).labelled(HB)
    hopfs = [0.2041845357, 0.2298390376, 0.2599578542, 0.3462085216]
    assert [p.parameter for p in points] == pytest.approx(hopfs, rel=1e-9)
    first, second = (born(reactions(), p, "D", (0.1, 0.4)) for p in points[:2])
    assert [p.parameter for p in first.labelled(LP)] == pytest.approx(
        [0.213697369219, 0.211903277123], rel=1e-9
    )
    assert [p.parameter for p in second.labelled(LP)] == pytest.approx([0.224962065539], rel=1e-9)
    assert [p.parameter for p in first.labelled(HB)] == pytest.approx([hopfs[0], hopfs[3]], rel=1e-7)
    assert sorted(p.parameter for p in second.labelled(HB)) == pytest.approx(hopfs[1:3], rel=1e-7)


def test_fishing() -> None:
    """Assert AUTO's pp2 in closed form: fold and branch point of the fish alone, Hopf point with sharks."""
    alone = per.trace(
        predator(),
        "quota",
        (0.65, 1),
        start=0.7,
        guess={"fish": 0.7, "sharks": 0.0},
        method=per.Equilibrium(),
    )
    u = alone.labelled(LP)[0].maximum["fish"]
    assert (1 - 2 * u) * (np.exp(5 * u) - 1) == pytest.approx(5 * u * (1 - u), rel=1e-11)
    point = alone.labelled(BP)[0]
    assert point.parameter == pytest.approx((2 / 3) / (1 - np.exp(-5 / 3)), rel=1e-11)
    guess = per.branched(predator(), point.orbit, "quota", leaving=alone[1].orbit)
    both = per.trace(predator(), "quota", (0, 1), guess=guess, method=per.Equilibrium())
    (hopf,) = both.labelled(HB)
    share = np.exp(-5 / 3)
    assert hopf.parameter == pytest.approx(1 / (3 * (1 - share) - 5 * share), rel=1e-11)
    orbits = born(predator(), hopf, "quota", (0, 1), watch=per.Watch(limits=shorter_than(36)))
    assert orbits[-1].stable and period(orbits[-1], orbits) == pytest.approx(36, rel=1e-9)


def test_catalyst() -> None:
    """Assert Hopf points, folds and Lyapunov coefficients (ours times omega) of MatCont's manual."""
    branch = per.trace(catalyst(), "q2", (0.9, 1.2), start=1.2, method=per.Equilibrium())
    known = [("HB", 1.051558), ("LP", 1.042049), ("LP", 1.052200), ("HB", 1.040991)]
    assert places(branch) == expected(*known, rel=6e-7)
    for point, coefficient in zip(branch.labelled(HB), [10.70259, 4.332247], strict=True):
        found = per.first_lyapunov(catalyst(), point.orbit) * abs(point.multipliers[0].imag)
        assert found == pytest.approx(coefficient, rel=3e-4)


@pytest.mark.long
def test_peroxidase() -> None:
    """Assert both tori and the fold of the orbits of Steinmetz and Larter, which end at both Hopf points."""
    hopfs = per.trace(peroxidase(), "k7", (0.6, 5), start=4.235322, method=per.Equilibrium()).labelled(HB)
    branch = born(peroxidase(), hopfs[0], "k7", (0.6, 5))
    ends = [p.parameter for p in hopfs]
    middle = [("NS", 0.71643356438), ("NS", 0.818565885283), ("LP", 4.74838433992)]
    assert places(branch)[1:-1] == expected(*middle)
    assert [p.parameter for p in branch.labelled(HB)] == pytest.approx(ends, rel=1e-8)
    assert period(branch.labelled(NS)[0], branch) == pytest.approx(10.912126878, rel=1e-9)


def test_doublings_of_the_spiral() -> None:
    """Assert the first three doublings of Rossler's orbits and their periods."""

    def field(t: float, x: np.ndarray) -> list[float]:
        return [-x[1] - x[2], x[0] + 0.2 * x[1], 0.2 + x[2] * (x[0] - 2.5)]

    near = 5.74899118
    guess = settled(field, [1, 1, 0], 600, near, [0.2, 0.2, 2.5, 2 * np.pi / near])
    known = [(2.83244502786, 5.7698200165), (3.83735816841, 11.572688804), (4.12421473207, 23.202611202)]
    for place, duration in known:
        branch = trace(
            spiral(), "c", (2.4, 4.5), guess=guess, determined=ORBIT, watch=per.Watch(stop={"PD": 1})
        )
        (point, *_) = (p for p in branch.labelled(PD) if p.nontrivial.real.min() < -0.5)
        assert point.parameter == pytest.approx(place, rel=1e-9)
        assert period(point, branch) == pytest.approx(duration, rel=1e-9)
        guess = per.doubled(spiral(), point.orbit, "c", determined=ORBIT)

    alone = (
        r"the system is not excited, and determined={'omega': PhaseCondition\(\)} alone determines the period"
    )
    with pytest.raises(ValueError, match=f"^determined has no phase condition: {alone} of its orbits$"):
        per.doubled(spiral(), point.orbit, "c")
    loose = trace(spiral(), "c", (3.9, 4.5), guess=replace(guess, parameter=guess.parameter * [1, 1, 1, 1.1]))
    assert loose.stop.reason is per.Reason.NO_START
    assert re.search(f"; {alone} of its orbits$", loose.stop.detail)


@kept
def entrained() -> per.Branch:
    """Van der Pol's oscillator forced near resonance."""
    return trace(forced_van_der_pol(), "Omega", (0.8, 1.3), start=1.0)


def test_entrainment() -> None:
    """Assert where entrained orbits lose stability."""
    known = [0.945256432749, 0.945430712111, 0.944207876272, 1.04903441732, 1.04582097854]
    labels = ["NS", "LP", "LP", "LP", "LP"]
    assert places(entrained()) == expected(*zip(labels, known, strict=True), rel=1e-11)


def test_curves_of_entrainment() -> None:
    """Assert that the curves of folds and of tori meet in two 1:1 resonances, beside two cusps."""
    system, near = forced_van_der_pol(), {"F": (0.01, 0.25)}
    folds, tori = (
        trace(
            system,
            "Omega",
            (0.9, 1.1),
            guess=entrained().labelled(label)[0].orbit,
            determined={"F": condition},
            watch=per.Watch(limits=near),
        )
        for label, condition in ((LP, per.FoldCondition()), (NS, per.TorusCondition()))
    )
    meeting = [
        sorted((p.parameter, float(p.orbit.parameter[1])) for p in curve.labelled(per.Label.RESONANCE_1))
        for curve in (folds, tori)
    ]
    assert len(meeting[0]) == 2
    for a, b in zip(*meeting, strict=True):
        assert a == pytest.approx(b, rel=1e-9)
    assert len(folds.labelled(per.Label.CUSP)) == 2


def test_ueda() -> None:
    """Assert folds of Ueda's symmetric orbits, and folds and doubling of those that leave them."""

    def field(t: float, x: np.ndarray) -> list[float]:
        return [x[1], -0.1 * x[1] - x[0] ** 3 + 0.2 * np.cos(t)]

    guess = settled(field, [0, 0], 600 * np.pi, 2 * np.pi, [0.1, 0.2, 1.0])
    # At 1e-9 Newton's increments beside the pitchfork are rounding, magnified by 1/(1 - mu).
    branch = trace(ueda(), "B", (0.1, 5), guess=guess, tol=1e-8)
    assert places(branch)[:2] == expected(("LP", 0.446437077048), ("LP", 0.114639389052))
    (point,) = branch.labelled(BP)
    assert point.parameter == pytest.approx(2.28638171, rel=5e-7)
    lopsided = trace(ueda(), "B", (2.29, 5), start=2.29, guess=per.branched(ueda(), point.orbit, "B"))
    known = [("LP", 3.56585349679), ("LP", 3.0850826389), ("PD", 4.87609115004)]
    assert places(lopsided) == expected(*known)


@pytest.mark.parametrize("method", [per.Collocation(), per.HarmonicBalance()])
def test_two_springs(method: Any) -> None:
    """Assert folds and doublings of NLvib's mass on two springs through its 1:2 internal resonance."""
    branch = trace(two_springs(), "Omega", (1.05, 1.2), start=1.2, method=method)
    known = [("PD", 1.09889178332), ("LP", 1.08792661835), ("PD", 1.09450652656), ("LP", 1.12299180655)]
    assert places(branch) == expected(*known)


def test_absorber() -> None:
    """Assert tori and folds of NLvib's two masses on cubic springs, by two methods."""
    branches = [
        trace(absorber(), "Omega", (1.0, 1.4), method=method)
        for method in (per.Collocation(), per.HarmonicBalance())
    ]
    known = [("NS", 1.11271123928), ("NS", 1.19573666912), ("LP", 1.21462622516), ("LP", 1.20621945737)]
    for branch in branches:
        assert places(branch) == expected(*known)


def test_pendula() -> None:
    """Assert AUTO's pen: where rotations in step double, and the curve of it; known from Hill's equation."""

    def field(t: float, x: np.ndarray) -> list[float]:
        return [x[1], -0.1 * x[1] - np.sin(x[0]) + 0.4]

    duration = 1.5738797  # AUTO's period
    phase, state = over_period(field, path(field, [0.0, 4.0], 300, rtol=1e-11)[:, -1], duration)
    angle, speed = state.T
    ahead = angle - phase
    state = np.stack([ahead, ahead, speed, speed], axis=1)
    parameter = np.array([0.175, 0.1, 0.4, 2 * np.pi / duration])
    guess = per.sampled(phase, state, np.zeros((len(phase), 0)), parameter)
    rotating = {"rate": per.PhaseCondition()}
    branch = trace(pendula(), "torque", (0.17, 0.4), guess=guess, determined=rotating)
    ((label, torque),) = places(branch)
    assert label == "PD" and torque == pytest.approx(0.17916377626865, rel=1e-10)
    curve = trace(
        pendula(),
        "gamma",
        (0.1, 1.0),
        guess=branch.labelled(PD)[0].orbit,
        determined={**rotating, "torque": per.DoublingCondition()},
    )
    assert curve.column("torque")[-1] == pytest.approx(0.31382985295369, rel=1e-10)
    (remark,) = curve.remarks
    assert remark == "generalised period doublings (GPD) are not looked for on orbits of an autonomous system"
