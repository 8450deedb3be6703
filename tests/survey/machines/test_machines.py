"""The survey of machines: what is drawn, the accelerations by hand, the judge, and what the page counts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.drawn.machines.drawn import FAMILIES, machine

import periodic as per
import symbolic as sym
from survey.machines.judge import Verdict, _compared, judged
from survey.machines.page import page
from survey.machines.rows import DOWN, SECONDS, SEEDS, models, parts, row
from survey.rows import Row, read, write

BY_HAND = [family for family in FAMILIES if machine(family, 0).accelerations is not None]


def test_all_machines_are_drawn_once() -> None:
    """Assert that each family has as many, from either end, and a tenth of them at either other tolerance."""
    drawn = list(models())
    assert len(set(drawn)) == len(drawn) == 2 * SEEDS * len(FAMILIES) * 12 // 10 == 528
    for end in ("", " at 1e-3", " at 1e-9"):
        assert drawn.count((f"rubs{DOWN}{end}", 1)) == 1 and drawn.count((f"rubs{end}", 2)) == (end == "")
    assert len(BY_HAND) == 7


@pytest.mark.parametrize("family", FAMILIES)
def test_a_seed_is_a_machine(family: str) -> None:
    """Assert that a seed gives the same numbers again, and another one others; that the range is one."""
    first, again, other = machine(family, 3), machine(family, 3), machine(family, 4)
    assert first.told == again.told != other.told
    assert first.bounds == again.bounds
    assert 0 < first.bounds[0] < first.bounds[1]
    values = [sym.compile(each.model).nominal for each in (first, again)]
    assert (values[0] == values[1]).all()


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("family", BY_HAND)
def test_accelerations_by_hand_are_the_models(family: str, seed: int) -> None:
    """Assert that the equations vanish with them, to 1e-9 of what they are without, at six states."""
    drawn = machine(family, seed)
    system, given = sym.compile(drawn.model), drawn.accelerations
    assert given is not None
    speed = float(np.mean(drawn.bounds))
    parameter = np.array(system.nominal)
    parameter[[p.name for p in system.parameters].index(drawn.parameter)] = speed
    scales = np.array([state.scale for state in system.states])[::2]
    draw = np.random.default_rng(seed)
    tau, z = draw.uniform(0, 2 * np.pi, 6), draw.uniform(-0.4, 0.4, (6, len(system.states)))
    z *= _room(family) / np.tile(np.repeat(scales, 2), (6, 1))
    pace, rate = drawn.pace * speed, np.empty_like(z)
    rate[:, ::2] = z[:, 1::2]
    for k in range(6):
        at, moved = z[k, ::2, None] * scales[:, None], pace * z[k, 1::2, None] * scales[:, None]
        rate[k, 1::2] = given(float(tau[k]), at, moved, speed)[:, 0] / (scales * pace**2)
    unknown = np.zeros((6, 0))
    found = [system.residual(r, z, unknown, tau, parameter) for r in (rate, 0.0 * rate)]
    assert np.abs(found[0]).max() < 1e-9 * np.abs(found[1]).max()


def _room(family: str) -> float:
    """How far, in m, the coordinates may be: films have their clearance, others reach beyond it."""
    return {"ball bearings": 1e-4, "roller bearings": 1e-4, "rubs": 1e-3}.get(family, 1e-5)


def test_machine_is_traced_and_judged(tmp_path: Path) -> None:
    """Assert that one reaches its end, that three points are judged and right, and that its row is kept."""
    found = row("gear pairs" + DOWN, 0, 3)
    assert (found.fate, found.judged, found.wrong, found.unjudged) == ("to the end", 3, (), ())
    assert 0 < found.ratio < 1
    write(tmp_path / "rows", found)
    assert read([tmp_path / "rows"]) == {("gear pairs down", 0): found}


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("rubs", ("rubs", False, 1e-6)),
        ("rubs down", ("rubs", True, 1e-6)),
        ("gear pairs at 1e-3", ("gear pairs", False, 1e-3)),
        ("gear pairs down at 1e-9", ("gear pairs", True, 1e-9)),
    ],
)
def test_kinds(kind: str, said: tuple[str, bool, float]) -> None:
    """Assert family, end and tolerance."""
    assert parts(kind) == said


def test_machine_is_traced_at_another_tolerance() -> None:
    """Assert that it is held to what it claims there."""
    loose, tight = (row("gear pairs" + end, 0, 3) for end in (" at 1e-3", " at 1e-9"))
    for found in (loose, tight):
        assert (found.fate, found.judged, found.wrong) == ("to the end", 3, ())
    assert loose.newton < tight.newton


def test_judge_sees_a_wrong_point() -> None:
    """Assert that a point is told for what it is: right, and wrong by 1e-4 of its motion."""
    drawn = machine("gear pairs", 0)
    system = sym.compile(drawn.model)
    high, few = drawn.bounds[1], per.ArclengthControl(max_points=1)
    point = per.trace(system, drawn.parameter, drawn.bounds, start=high, control=few, tol=1e-8)[0]
    scales = np.array([system.states[0].scale])
    assert judged(drawn, scales, point, 1e-8).wrong(point, 1e-8) == ""
    nodes = point.orbit.nodes.copy()
    nodes[:, 0] += 1e-4 * np.ptp(nodes, axis=0).max()
    spoilt = replace(point, orbit=replace(point.orbit, nodes=nodes))
    assert judged(drawn, scales, spoilt, 1e-8).wrong(spoilt, 1e-8).startswith("orbit ")


def test_verdicts() -> None:
    """Assert each sentence."""
    drawn = machine("gear pairs", 0)
    few = per.ArclengthControl(max_points=1)
    point = per.trace(sym.compile(drawn.model), "Omega", drawn.bounds, start=drawn.bounds[1], control=few)[0]
    assert Verdict(1e-7, 0.0, True).wrong(point, 1e-6) == ""
    assert Verdict(1.1e-5, 0.0, True).wrong(point, 1e-6).startswith("orbit 1.1e-05, claimed")
    assert Verdict(np.nan, 0.0, True).wrong(point, 1e-6).startswith("orbit nan")
    assert Verdict(0.0, 2e-3, True).wrong(point, 1e-6).startswith("multipliers 2.0e-03, claimed")
    assert Verdict(0.0, 0.0, False).wrong(point, 1e-6) == f"stable is {point.stable}"


def test_page_counts() -> None:
    """Assert what the page says of a machine traced, one that is wrong and one that ran out of time."""
    right = Row(
        "rubs", 0, "BOUND", "bound reached: upper end", 10, seconds=2.0, judged=8, ratio=0.5, memory=0.25
    )
    wrong = Row("rubs down", 0, "BOUND", "bound reached: lower end", 20, judged=8, wrong=("speed 1: orbit",))
    short = Row("gear pairs", 0, "INTERRUPTED", "interrupted: after 3 points", 3)
    tight = Row("rubs at 1e-9", 0, "BOUND", "bound reached: upper end", 30, seconds=4.0, judged=1)
    assert "| all at 1e-9 | 1 | 1 | 0 | 0 | 30 | 4.0 |  | 1 | 0 | 0 |" in page([right, tight])
    told = page([right, wrong, short])
    assert "3 of 528 traces: 20 machines of each of 11 families" in told
    assert "**2 of 3 (66.7 %) are traced to the end; 1 of the 16 points judged is wrong.**" in told
    assert "\n1 that ran out of time were allowed less than those traced today.\n" in told
    assert "allowed less" not in page([right, replace(short, seconds=SECONDS)])
    assert "| rubs | 2 | 2 | 0 | 0 | 15 | 1.0 | 0.25 | 16 | 1 | 0.5 |" in told
    assert "| gear pairs | 1 | 0 | 1 | 0 | 3 | 0.0 |  | 0 | 0 | 0 |" in told
    assert "| rubs down 0 | speed 1: orbit |" in told
    assert "| gear pairs 0 | interrupted: after 3 points (3 points, 0 s) |" in told


def test_judge_looks_closer_before_it_condemns() -> None:
    """Assert that teeth that part for 0.01 rad, which a thousand steps hold but a hundred pass, are seen."""
    drawn = machine("gear pairs", 0)
    system, at = sym.compile(drawn.model), 10733.611805236991
    branch = per.trace(system, drawn.parameter, drawn.bounds, start=drawn.bounds[0], tol=1e-6, at=[at])
    point = min(branch, key=lambda each: abs(each.parameter - at))
    apart = np.diff(np.sort(point.orbit.phases))
    assert min(apart[0], 2 * np.pi - apart[0]) == pytest.approx(0.01, abs=2e-3)
    scales = np.array([system.states[0].scale])
    assert judged(drawn, scales, point, 1e-6).multipliers < 1e-5
    assert _compared(drawn, scales, point, 100, 1e-6).multipliers > 1e-3


def test_judge_takes_smaller_differences_beside_a_grazing() -> None:
    """Assert that multipliers beside it are known to 1e-3 with them, and only to 1e-2 without."""
    drawn = machine("rubs", 14)
    system = sym.compile(drawn.model)
    branch = per.trace(system, drawn.parameter, (drawn.bounds[0], 62.4), start=drawn.bounds[0], tol=1e-6)
    (*_, grazing) = branch.labelled(per.Label.GRAZING)
    point = branch.points[branch.points.index(grazing) + 1]
    assert 0 < point.parameter - grazing.parameter < 1e-4
    scales = np.array([state.scale for state in system.states])[::2]
    assert _compared(drawn, scales, point, 1000, 1e-6).multipliers > 1e-2
    found = judged(drawn, scales, point, 1e-6)
    assert found.multipliers < 1e-3 and found.wrong(point, 1e-6) == ""


def test_judge_knows_a_state_to_its_own_digits() -> None:
    """Assert that a preloaded bearing, which moves by 1e-13 m, is judged, and condemned where it is off."""
    drawn = machine("roller bearings", 7)
    system = sym.compile(drawn.model)
    few = per.ArclengthControl(max_points=1)
    point = per.trace(system, drawn.parameter, drawn.bounds, start=drawn.bounds[0], control=few)[0]
    scales = np.array([state.scale for state in system.states])[::2]
    assert point.orbit.span() < 1e-6 < 1.0 < point.orbit.nodes[0, 0]
    assert judged(drawn, scales, point, 1e-6).wrong(point, 1e-6) == ""
    moved = replace(point.orbit, nodes=point.orbit.nodes + [1e-8, 0.0, 0.0, 0.0])
    assert judged(drawn, scales, replace(point, orbit=moved), 1e-6).wrong(point, 1e-6).startswith("orbit ")
