"""Small orbits beside an equilibrium: what is tried one after the other, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.equations import stuart_landau

import periodic as per
from periodic.bifurcations import hopf
from periodic.bifurcations.switching import FIRST_DISTANCE, SwitchError
from periodic.orbit.orbit import Orbit


def rest(mu: float = 0.0) -> Orbit:
    """The equilibrium of z' = (mu + i) z + ..., whose eigenvalues are mu + i and mu - i."""
    found = per.trace(stuart_landau(1.0), "mu", (mu, mu + 1), start=mu, method=per.Equilibrium())
    return found[0].orbit


@pytest.fixture
def tried(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """What is tried, none of which is found."""
    calls: list[tuple[Any, ...]] = []

    def refused(*given: Any) -> Orbit:
        calls.append(given)
        raise SwitchError(f"none at {given[-1]}")

    monkeypatch.setattr(hopf, "switched", refused)
    return calls


def test_first_orbit_is_sought_nearer_and_nearer(tried: list[tuple[Any, ...]]) -> None:
    """Assert positive distances, each less than half the one before, and the last refusal."""
    with pytest.raises(SwitchError) as refused:
        per.hopf(stuart_landau(1.0), rest(), "mu")
    lengths = [given[-1] for given in tried]
    assert lengths[0] == FIRST_DISTANCE and len(lengths) > 2
    assert all(0 < after < before / 2 for before, after in zip(lengths, lengths[1:], strict=False))
    assert str(refused.value) == f"none at {lengths[-1]}"


def test_distance_that_is_asked_for_is_the_only_one(tried: list[tuple[Any, ...]]) -> None:
    """Assert one trial at it, along the linear oscillation, with the parameter and its condition."""
    system = stuart_landau(1.0)
    with pytest.raises(SwitchError, match="^none at 0.3$"):
        per.hopf(system, rest(), "mu", distance=0.3)
    ((_, origin, direction, parameter, determined, _),) = tried
    assert parameter == "mu" and list(determined) == ["omega"]
    assert np.ptp(origin.nodes, axis=0) == pytest.approx(0.0)
    tau = origin.mesh.nodes(origin.phases)
    turned = np.array([[np.cos(tau), -np.sin(tau)], [np.sin(tau), np.cos(tau)]])
    assert direction.nodes == pytest.approx(np.einsum("ijk,j", turned, direction.nodes[0]).T, abs=1e-12)
    assert np.abs(direction.nodes).max() > 0.1


@pytest.mark.parametrize("mu", [-0.01, 0.01])
def test_equilibrium_beside_a_hopf_point_is_refused(mu: float, tried: list[tuple[Any, ...]]) -> None:
    """Assert the sentence with the eigenvalue nearest the axis."""
    with pytest.raises(SwitchError, match=rf"^the equilibrium is no Hopf point: .* is {mu:.6g}\+1j$"):
        per.hopf(stuart_landau(1.0), rest(mu), "mu")
    assert not tried


def test_eigenvalues_in_order_of_their_growth() -> None:
    """Assert mu + i and mu - i, times the frequency."""
    found = per.eigenvalues(stuart_landau(1.0), rest(0.25))
    assert np.sort_complex(found) == pytest.approx(np.array([0.25 - 1j, 0.25 + 1j]))


def test_modes_that_do_not_exist_are_refused() -> None:
    """Assert the sentence with the number of undamped modes, which a damped equilibrium has none of."""
    for which in (-1, 1):
        with pytest.raises(ValueError, match=rf"^which is {which}; the equilibrium has 1 undamped modes,"):
            per.normal_mode(stuart_landau(1.0), rest(), "mu", which=which)
    with pytest.raises(
        ValueError, match="^which is 0; the equilibrium has 0 undamped modes, counted from 0$"
    ):
        per.normal_mode(stuart_landau(1.0), rest(0.1), "mu")


def test_orbit_is_refused() -> None:
    """Assert that small orbits begin at an equilibrium alone."""
    orbit = per.hopf(stuart_landau(1.0), rest(), "mu")
    with pytest.raises(ValueError, match="^orbit is no equilibrium; it must be one, of a branch by"):
        per.hopf(stuart_landau(1.0), orbit, "mu")
