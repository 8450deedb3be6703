"""Mesh density: the next derivative, known in closed form, on uneven meshes; its scale and its floor."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.refinement.equidistribution import FLOOR, density

WAVES = {1: 1.0, 3: 0.02}


def derivative(tau: Array, order: int) -> Array:
    """That of the sum of a sin(k tau)."""
    return np.asarray(sum(a * k**order * np.sin(k * tau + order * np.pi / 2) for k, a in WAVES.items()))


def motion(scheme: Scheme, size: float = 1.0, count: int = 96) -> Orbit:
    """The sum itself on a mesh whose intervals differ threefold."""
    even = np.linspace(0, 1, count + 1)
    mesh = Mesh(scheme, (even + np.sin(2 * np.pi * even) / (4 * np.pi),), (), 2 * np.pi)
    nodes = size * derivative(mesh.nodes(np.zeros(0)), 0)[:, None]
    blank = np.zeros((count, scheme.ncol, 0))
    bare = Orbit(mesh, nodes, np.zeros((count, scheme.ncol, 1)), blank, np.zeros(0), np.ones(1))
    stages = size * derivative(bare.stage_phases, 0).reshape(count, scheme.ncol, 1)
    return Orbit(mesh, nodes, stages, blank, np.zeros(0), np.ones(1))


@pytest.mark.parametrize(
    "scheme", [Scheme(Family.RADAU, 3), Scheme(Family.GAUSS, 4), Scheme(Family.RADAU, 5)]
)
def test_density_is_the_next_derivative(scheme: Scheme) -> None:
    """Assert |x^(m)|^(1/m), m = ncol + 1, to a factor that is the same everywhere, to 12 %."""
    orbit, m = motion(scheme), scheme.ncol + 1
    middle = orbit.grid.left + orbit.grid.width / 2
    exact = np.abs(derivative(middle, m)) ** (1 / m)
    clear = exact > 0.7 * exact.max()
    ratio = (density(orbit) / exact)[clear]
    assert clear.sum() > 20
    assert ratio == pytest.approx(np.full(len(ratio), np.median(ratio)), rel=0.12)


def test_density_grows_with_the_motion() -> None:
    """Assert the power of the motion's size, and the least part of the mean."""
    scheme = Scheme(Family.RADAU, 4)
    one, large = density(motion(scheme)), density(motion(scheme, 1e5))
    assert large == pytest.approx(10 * one, rel=1e-6)
    mean = float(one @ motion(scheme).grid.width) / (2 * np.pi)
    assert one.min() >= 0.9 * FLOOR * mean
    still = density(motion(scheme, 0.0))
    assert still == pytest.approx(np.ones(96))
