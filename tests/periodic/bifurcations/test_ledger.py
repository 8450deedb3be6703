"""The ledger: two special points of a kind in one step, and what is said where a change has no label."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.drawn.contact import drawn
from support.equations import growing

import periodic as per
import symbolic as sym
from periodic.bifurcations import turningpoint
from periodic.bifurcations.ledger import Entry, gaps
from periodic.correction.solution import Solution
from periodic.tracing.steps.stepper import Stepper

Label = per.Label


def places(branch: per.Branch, label: per.Label) -> list[float]:
    """Parameters of the points of one label."""
    return [point.parameter for point in branch.labelled(label)]


def equations(rates: Any, states: dict[str, float], **parameters: float) -> sym.CompiledSystem:
    """A system of the first order."""
    return sym.compile(sym.Equations(rates, states=states, parameters=parameters))


@pytest.mark.parametrize("begin", [0.0, 0.05, 0.13, 0.29])
def test_two_tori_within_a_step(begin: float) -> None:
    """Assert that stability lost and regained within a step is seen, wherever the steps fall."""
    branch = per.trace(growing(), "mu", (begin, 1.0))
    assert places(branch, Label.TORUS) == pytest.approx([0.30, 0.36], rel=1e-7)


@pytest.mark.parametrize("begin", [0.0, 0.2])
def test_torus_is_placed_as_multipliers_are_known(begin: float) -> None:
    """Assert that log |mu| = (.03^2 - (mu - .33)^2) T/2 is 0 within the multipliers' error."""
    (torus,) = per.trace(growing(), "mu", (begin, 0.34), tol=1e-4).labelled(Label.TORUS)
    growth = (9e-4 - (torus.parameter - 0.33) ** 2) * np.pi / 0.7
    assert abs(growth) < torus.error.multiplier < 1e-4


INNER, A, B, D1, D2 = 10, 2.0, 5.45, 0.008, 0.004
"""Brusselator with diffusion between fixed ends, so many inner points."""


def diffusing() -> sym.CompiledSystem:
    """x' = A - (B+1) x + x^2 y + D1/l^2 x_ss, y' = B x - x^2 y + D2/l^2 y_ss, s from 0 to 1."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        first = [A, *(getattr(x, f"x{k}") for k in range(INNER)), A]
        second = [B / A, *(getattr(x, f"y{k}") for k in range(INNER)), B / A]
        found = {}
        for k in range(INNER):
            u, v = first[k : k + 3], second[k : k + 3]
            diffusion = ((INNER + 1) / p.l) ** 2
            made = u[1] ** 2 * v[1]
            found[f"x{k}"] = A - (B + 1) * u[1] + made + D1 * diffusion * (u[0] - 2 * u[1] + u[2])
            found[f"y{k}"] = B * u[1] - made + D2 * diffusion * (v[0] - 2 * v[1] + v[2])
        return found

    states = {f"x{k}": A for k in range(INNER)} | {f"y{k}": B / A for k in range(INNER)}
    return equations(rates, states, l=0.5)


def test_two_tori_one_way_within_a_step() -> None:
    """Assert both NS of the Brusselator, known by independent shooting, where 1 -> 5 are unstable."""
    system = diffusing()
    born = per.trace(system, "l", (0.5, 0.6), method=per.Equilibrium()).labelled(Label.HOPF)[0]
    assert born.parameter == pytest.approx(0.5112781470, abs=1e-9)
    # Nearer by, rounding decides whether the first orbit is this one or another of the branch.
    guess = per.hopf(system, born.orbit, "l", distance=0.05)
    branch = per.trace(
        system, "l", (0.511, 2.0), start=None, guess=guess, determined={"omega": per.PhaseCondition()}
    )
    assert places(branch, Label.TORUS) == pytest.approx([1.7475314261, 1.8172173465], rel=1e-8)
    assert branch.unaccounted == ()


APART = [1e-2, 1e-4, 1e-5, -1e-5, -1e-4, -1e-2]


@pytest.mark.parametrize("apart", APART)
def test_torus_beside_a_neutral_saddle(apart: float) -> None:
    """Assert the NS at c = 0 of one oscillator, where mu_1 mu_2 of another is 1 for c = apart.

    Both real multipliers of that pass nothing there, but the product of all 1 - mu_i mu_j changes sign.
    """

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        turned = 0.3 * wave.cos - p.c * x.v - 0.37 * x.x - 0.1 * x.x**3
        return {"x": x.v, "v": turned, "y": x.w, "w": 0.5 * x.y - (p.c - apart) * x.w}

    states, values = dict.fromkeys(("x", "v", "y", "w"), 0.0), {"Omega": 1.3, "c": 0.1}
    system = sym.compile(sym.Equations(rates, states, values, frequency="Omega"))
    branch = per.trace(system, "c", (-0.1, 0.1), start=0.1)
    assert places(branch, Label.TORUS) == pytest.approx([0.0], abs=1e-9)
    assert branch.unaccounted == ()


def test_base_that_a_new_mesh_carries_past_a_special_point(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is left: what lies behind the base of a step is not looked for in it."""
    met, remeshed = list[Solution](), Stepper.remeshed

    def carried(stepper: Stepper, new: Solution, due: bool) -> Solution:
        met.append(new)
        same = len(met) < 2 or turningpoint.unstable(met[-2]) == turningpoint.unstable(new)
        return remeshed(stepper, new, due) if same else met[-2]

    monkeypatch.setattr(Stepper, "remeshed", carried)
    branch = per.trace(growing(), "mu", (0.0, 0.34))
    assert len({turningpoint.unstable(solution) for solution in met}) == 2
    assert places(branch, Label.TORUS) == pytest.approx([0.30], rel=1e-7)


def test_two_doublings_within_a_step() -> None:
    """Assert both doublings of a damped pair that meets at -1, at tol 1e-3, in a step of .19."""
    f = sym.functions

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        contact = 20 * f.fmax(x.x - 0.5, 0) ** 1.5 * (1 + x.v)
        return {"x": x.v, "v": 0.3 * wave.cos - 0.1 * x.v - x.x - contact}

    system = sym.compile(sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"Omega": 1.0}, frequency="Omega"))
    fine = per.trace(system, "Omega", (0.7, 0.9), start=0.9, tol=1e-8)
    known = [p.parameter for p in fine.labelled(per.Label.DOUBLING)]
    assert len(known) == 2
    draft = per.trace(system, "Omega", (0.3, 2.5), start=2.5, tol=1e-3)
    assert [p.parameter for p in draft.labelled(per.Label.DOUBLING)] == pytest.approx(known, abs=1e-4)


@pytest.mark.parametrize("part", [0.4, 0.5, 0.6, 0.8])
@pytest.mark.parametrize("label", ["BP", "HB"])
def test_two_changes_of_equilibria_within_a_step(label: str, part: float) -> None:
    """Assert that stability that is regained within a step is seen, wherever in the step it is lost."""
    steps = per.trace(window("BP", 2.0), "mu", (0, 1), method=per.Equilibrium()).values
    centre = steps[5] + part * (steps[6] - steps[5])
    branch = per.trace(window(label, centre), "mu", (0, 1), method=per.Equilibrium())
    assert places(branch, Label(label)) == pytest.approx([centre - 0.01, centre + 0.01], rel=1e-9)


def window(label: str, centre: float) -> sym.CompiledSystem:
    """A rest that is unstable within .01 of a centre: a pair (HB) or a real eigenvalue (BP) grows there."""
    turn = 1 if label == "HB" else 0

    def rates(x: Any, p: Any) -> dict[str, Any]:
        growth = (p.mu - centre) ** 2 - 1e-4
        return {"x": growth * x.x - turn * x.y, "y": turn * x.x + (growth if turn else -1) * x.y}

    return equations(rates, {"x": 0.0, "y": 0.0}, mu=0.0)


@pytest.mark.parametrize("ds", [0.02, 0.2])
@pytest.mark.parametrize("pairs", [2, 3])
def test_hopf_points_of_several_pairs(pairs: int, ds: float) -> None:
    """Assert every HB of four and six coupled states, beside real eigenvalues of opposite sign (no HB)."""
    weights = np.random.default_rng(pairs).normal(size=(2 * pairs + 2, 2 * pairs + 2))
    inverse = np.linalg.inv(weights)

    def rates(x: Any, p: Any) -> dict[str, Any]:
        known = [getattr(x, f"x{k}") for k in range(2 * pairs + 2)]
        modal = [sum(w * v for w, v in zip(row, known, strict=True)) for row in inverse]
        own: list[Any] = []
        for k in range(pairs):
            a, b, growth, turn = modal[2 * k], modal[2 * k + 1], p.mu - 0.2 * (k + 1), 1 + 0.7 * k
            own += [growth * a - turn * b, turn * a + growth * b]
        own += [-(1 + p.mu) * modal[-2], 1.5 * modal[-1]]  # their sum passes 0 at mu = .5
        return {f"x{k}": sum(w * v for w, v in zip(row, own, strict=True)) for k, row in enumerate(weights)}

    system = equations(rates, {f"x{k}": 0.0 for k in range(2 * pairs + 2)}, mu=0.0)
    control = per.ArclengthControl(ds=ds, ds_max=1.0)
    branch = per.trace(system, "mu", (0, 1), control=control, method=per.Equilibrium())
    assert places(branch, Label.HOPF) == pytest.approx([0.2 * (k + 1) for k in range(pairs)], rel=1e-9)
    assert branch.labelled(Label.BRANCH) == ()


@pytest.mark.unaccounted
def test_what_has_no_label_is_said() -> None:
    """Assert that two multipliers that pass 1 at once, which changes no sign, are told with their place."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": (p.mu - 0.5) * x.x, "y": (p.mu - 0.5) * x.y, "z": wave.cos - x.z}

    states, parameters = dict.fromkeys("xyz", 0.0), {"Omega": 1.0, "mu": 0.0}
    system = sym.compile(sym.Equations(rates, states, parameters, frequency="Omega"))
    branch = per.trace(system, "mu", (0.0, 1.0))
    assert branch.stop.reason is per.Reason.BOUND
    (gap,) = branch.unaccounted
    assert gap.begin < 0.5 < gap.end and gap.end - gap.begin < 1e-3
    assert gap.why == "unstable multipliers go from 0 to 2 without a labelled point"
    assert branch.remarks == (str(gap),)
    assert branch.table().splitlines()[-1] == str(gap)


def entry(label: str, value: float, *multipliers: complex, slope: float = 1.0) -> Entry:
    """A point of a forced branch with these multipliers, known to 1e-6."""
    return Entry(Label(label), value, slope, np.log(np.abs(multipliers)), 1e-6)


PAIR = (0.8 + 0.6j, 0.8 - 0.6j)


@pytest.mark.parametrize(
    "entries",
    [
        [entry("", 0, 0.5, 0.2), entry("PD", 1, -1, 0.2), entry("", 2, -1.5, 0.2)],
        [entry("", 0, 0.5, 0.2), entry("LP", 1, 1, 0.2, slope=0), entry("", 0.5, 1.5, 0.2, slope=-1)],
        [entry("", 0, 0.9, 0.2), entry("NS", 1, *PAIR), entry("UZ", 1.5, 1.2, 1.2), entry("", 2, 1.3, 1.3)],
        [entry("", 0, 1.5, 0.2), entry("BP", 1, 1, 0.2), entry("", 2, 0.5, 0.2)],
        [entry("", 0, 1.5, 0.2), entry("BP", 1, 1, 0.2, slope=0), entry("", 0, 1.5, 0.2, slope=-1)],
        [entry("", 0, 0.5, 0.2), entry("BP", 1, 1 + 2e-6, 0.2, slope=3e-5), entry("", 0, 0.5, 0.2, slope=-1)],
        [entry("", 0, 0.5, 0.2), entry("GR", 1, 0.5, 0.2), entry("", 2, 0.4, 0.3)],
        [
            entry("", 0, 0.5, 0.2),
            entry("GR", 1, 0.5, 0.2),
            entry("PD", 1, 0.5, 0.2),
            entry("", 2, -58.0, -0.3),
        ],
        [
            *(entry("", 0, *PAIR, 0.2), entry("GR", 1, *PAIR, 0.2), entry("PD", 1, *PAIR, 0.2)),
            *(entry("NS", 1, *PAIR, 0.2), entry("", 2, 1.1, 1.2, -9.0)),
        ],
        [
            entry("", 0, 0.5, 0.2),
            entry("LP", 1, 1, 0.9, slope=0),
            entry("PD", 0.5, 1.3, -1, slope=-1),
            entry("", 0, 1.5, -1.5, slope=-1),
        ],
    ],
)
def test_balanced(entries: list[Entry]) -> None:
    """Assert that labelled points account for what they let pass, grazing at a fold and a fold included."""
    assert gaps(entries) == []


@pytest.mark.parametrize(
    ("entries", "whys"),
    [
        (
            [entry("", 0, 0.5, 0.2), entry("", 2, -1.5, 0.2)],
            ["unstable multipliers go from 0 to 1 without a labelled point"],
        ),
        (
            [entry("", 0, 0.5, 0.2), entry("NS", 1, *PAIR), entry("", 2, 0.5, 0.2)],
            ["unstable multipliers go from 2 to 0 without a labelled point"],
        ),
        (
            [entry("", 0, 0.5, 0.2), entry("PD", 1, -1, 2), entry("", 2, 1.5, 2)],
            ["unstable multipliers go from 0 to 1 or 2, which PD does not explain"],
        ),
        (
            [entry("", 0, 0.5, 0.2), entry("", 1, 0.5, 0.2), entry("", 0.5, 0.5, 0.2, slope=-1)],
            ["the parameter turns without a labelled point"],
        ),
        (
            [entry("", 0, 0.5, 0.2), entry("GR", 1, 0.5, 0.2), entry("", 2, -58.0, -0.3)],
            ["unstable multipliers go from 0 to 1 without a labelled point"],
        ),
        (
            [entry("", 0, 0.5, 0.2), entry("BP", 1, 1, 0.2), entry("", 2, 0.5, 0.2)],
            ["unstable multipliers go from 1 to 0 without a labelled point"],
        ),
    ],
)
def test_unbalanced(entries: list[Entry], whys: list[str]) -> None:
    """Assert what the ledger says of a change without a label, and of a label without its change."""
    assert [gap.why for gap in gaps(entries)] == whys


def test_unknown_multipliers_say_nothing() -> None:
    """Assert that points whose multipliers are not known open no gap, and labels of one's own allow any."""
    some = [entry("", 0, 0.5), entry("", 1, 1.5), entry("", 2, 0.5)]
    assert len(gaps(some)) == 2
    assert gaps([replace(some[0]), replace(some[1], noise=np.inf), some[2]]) == []
    own = per.Label.register("Q8")
    assert gaps([some[0], replace(some[1], label=own, value=0.5), some[1]]) == []


@pytest.mark.long
def test_torus_beside_events_that_change_places() -> None:
    """Assert a pair of multipliers on the circle at each torus bifurcation off grazings, and none missed.

    Behind two events that change places the branch goes on at some distance, and a pair may pass in between.
    """
    case = drawn("chains", 150)
    control = per.ArclengthControl(max_points=400, max_newton=4000)
    branch = per.trace(case.system, "Omega", case.bounds, start=case.start, tol=1e-6, control=control)
    assert branch.unaccounted == ()
    grazings = {point.parameter for point in branch.labelled(per.Label.GRAZING)}  # there multipliers jump
    points = [p for p in branch.labelled(per.Label.TORUS) if p.parameter not in grazings]
    assert len(points) >= 30
    for point in points:
        beside = np.sort(np.abs(np.abs(point.multipliers[point.multipliers.imag != 0]) - 1))
        assert beside[1] < 1e-9
