"""What is known of multipliers beside their values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from support.numpy_systems import Array

from periodic.stability.graded import spectrum_of
from periodic.stability.multipliers import Pair, Spectrum, nearest
from periodic.stability.product import multipliers
from periodic.stability.winding import collisions


@pytest.mark.parametrize("growth", [-0.6, 0.0, 0.4])
@pytest.mark.parametrize("rate", [0.3, 2.3])
def test_turns_of_a_pair_are_counted_through_the_period(rate: float, growth: float) -> None:
    """Assert the angle of exp((growth + i rate) tau) after a period, which its multiplier has lost."""
    tau = np.linspace(0.0, 2 * np.pi, 41)
    turn = np.array([[np.cos(rate * tau), -np.sin(rate * tau)], [np.sin(rate * tau), np.cos(rate * tau)]])
    (pair,) = Spectrum(np.moveaxis(np.exp(growth * tau) * turn, -1, 0), 0).pairs
    assert pair.rotated == pytest.approx(2 * np.pi * rate, rel=1e-12)


def turning(first: float, second: float, mixed: float = 0.0) -> Spectrum:
    """Two pairs of multipliers that turn evenly by these angles in a period, in planes that are mixed."""
    part = np.linspace(0.0, 1.0, 41)
    whole = np.zeros((len(part), 4, 4))
    for k, angle in enumerate((first, second)):
        cos, sin = np.cos(angle * part), np.sin(angle * part)
        whole[:, 2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = np.array([[cos, -sin], [sin, cos]]).transpose(
            2, 0, 1
        )
    mixing = np.eye(4) + mixed * np.roll(np.eye(4), 2, axis=1)
    return Spectrum(mixing @ whole @ np.linalg.inv(mixing))


@pytest.mark.parametrize("way", [1, -1])
def test_pairs_that_pass_each_other_meet(way: int) -> None:
    """Assert where two coupled pairs meet on the circle, where 0.5 + 0.4 s = 0.8 - 0.1 s; else nothing."""
    before, after = turning(0.5, 2 * np.pi + 0.8), turning(0.9, 2 * np.pi + 0.7, mixed=0.2)
    (meeting,) = collisions(*(before, after)[::way])
    assert meeting.place == pytest.approx(0.6 if way > 0 else 0.4, abs=1e-9)
    assert meeting.growth == pytest.approx(0.0, abs=1e-12)
    assert collisions(before, turning(0.55, 2 * np.pi + 0.85, mixed=0.2)) == []


def test_each_of_many_pairs_leads_where_it_does_alone() -> None:
    """Assert the nearest of 30 pairs, or its conjugate, for all of 25 at once as for each by itself."""
    random = np.random.default_rng(1)

    def drawn(count: int) -> list[Pair]:
        both = random.uniform([0.0, -30.0], [np.pi, 30.0], (count, 2)).tolist()
        return [
            Pair(argument, 1.0, 1.0, rotated, np.array([1j]), k) for k, (argument, rotated) in enumerate(both)
        ]

    pairs, others = drawn(25), drawn(30)
    found, alone = nearest(pairs, others), [pair.nearest(others) for pair in pairs]
    assert {pair.place for pair in found if pair.argument < 0}
    for ours, theirs in zip(found, alone, strict=True):
        assert (ours.place, ours.argument, ours.rotated) == (theirs.place, theirs.argument, theirs.rotated)
        assert np.array_equal(ours.left, theirs.left)


@dataclass(frozen=True)
class Joints:
    """Steps from joint to joint, and the flow there."""

    steps: Array
    flow: Array
    growth: float = 1e9


def test_flow_that_does_not_come_back_as_itself_is_told() -> None:
    """Assert that multipliers of a graded orbit are known where its steps carry the flow along, not else."""
    steps, flow = np.array([np.diag([1.0, 1e-4])] * 2), np.array([[1.0, 0.0]] * 3)
    fundamental = np.array([np.eye(2), steps[0], steps[1] @ steps[0]])
    for rotated in (0.0, 0.5):
        flow[1] = np.cos(rotated), np.sin(rotated)
        spectrum = spectrum_of(fundamental, Joints(steps, flow), 1)
        assert spectrum.known is (rotated == 0.0)


def test_a_sheared_pair_stays_one() -> None:
    """Assert 0.43 exp(+-i w) beside 0.001, of two steps that are conditioned as 1e4, to 1e-8.

    The pair turns in a plane stretched by 100: its columns grow apart by more in some periods, and never
    settle; rounding keeps those of the third from settling early.
    """
    random, stretch = np.random.default_rng(0), np.diag([1.0, 100.0])
    for _ in range(400):
        angle, whole = random.uniform(0, np.pi), np.diag([0.0, 0.0, 1e-3])
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        whole[:2, :2] = 0.43 * stretch @ turn @ np.linalg.inv(stretch)
        frame, left, right = np.linalg.qr(random.normal(size=(3, 3, 3)))[0]
        first = left @ np.diag([1e4, 1.0, 1.0]) @ right
        found = multipliers(np.array([first, frame @ whole @ frame.T @ np.linalg.inv(first)]))
        assert np.sort(np.abs(found)) == pytest.approx([1e-3, 0.43, 0.43], abs=1e-8)


def test_motions_that_several_steps_end() -> None:
    """Assert multipliers, without a warning, where steps one after the other leave nothing of a motion."""
    stuck, turned = np.diag([2.0, 0.0]), np.array([[0.5, 0.0], [1.0, 1.0]])
    found = multipliers(np.array([stuck, stuck, turned, stuck]))
    assert found == pytest.approx([4.0, 0.0], abs=1e-15)
