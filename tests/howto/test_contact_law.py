"""How to add a law of contact: one class, one line to name it in scene files, and nothing else.

A law says how large the load W is when two bodies have approached each other by delta. Hertz's law for
points, W = K delta^(3/2), comes with the package; here a roller touches along a line, for which
W = K delta^(10/9) is Palmgren's regression in use for roller bearings.

1. Write a frozen dataclass that inherits from `sym.ContactLaw`. Its fields are the law's numbers; `load` is
   the law, written with `sym.functions`. `assembly.parameter` makes a number a parameter of the model, which
   one can continue in. The load must rise for delta > 0; bodies that part carry what you say, here nothing.
   The tiny number in place of 0 keeps second derivatives finite.
2. Use it in parts: `sym.Stop` puts it on a coordinate, `sym.ElasticContact` between the bodies of a
   `sym.ContactPair`, with or without any of the films, which find the deflection under the preload, and the
   deflection that carries a given load, from `load` by themselves.
3. `sym.register_contact_law("line", LineContact)` lets any scene file say `law = "line"` in its table
   [contact], with the fields of the class as keys. The file itself executes nothing.

The tests hold each use against SciPy's integration of equations that are written out here once more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym

N = 10 / 9


@dataclass(frozen=True)
class LineContact(sym.ContactLaw):
    """W = K max(delta, 0)^(10/9), K in N/m^(10/9)."""

    stiffness: float | sym.Parameter

    def load(self, assembly: sym.Assembly, deflection: Any) -> Any:
        """Return W in N."""
        stiffness = assembly.parameter(self.stiffness, "line_stiffness", "N/m^(10/9)")
        return stiffness * sym.functions.fmax(deflection, 1e-300) ** N


sym.register_contact_law("line", LineContact)

MASS, DIAMETER, STIFFNESS, PRELOAD, AMPLITUDE, WAVES, ZETA = 20.4, 0.102, 5e8, 810.0, 3e-7, 120, 0.02
BETA, SQUEEZE = 22.23, 2734.3
SCENE = f"""
title = "Wavy roller on a roller, 810 N"
kind = "disc"
[discs]
mass = {MASS}
diameter = {DIAMETER}
[contact]
law = "line"
stiffness = {STIFFNESS}
preload = {PRELOAD}
[waviness]
amplitude = {AMPLITUDE}
waves = {WAVES}
[damping]
ratio = {ZETA}
[trace]
from_rpm = 500
to_rpm = 300
"""
FILM = f"""
[film]
law = "squeeze"
lubricant = "vitrea79"
beta = {BETA}
squeeze = {SQUEEZE}
"""
RPM, DELTA0 = 2 * np.pi / 60, (PRELOAD / STIFFNESS) ** (1 / N)


def line(delta: float) -> float:
    """The law once more."""
    return STIFFNESS * max(delta, 0) ** N


def settled(rhs: Callable[[float, Any], list[float]], start: list[float], period: float) -> float:
    """Peak to peak of the first state in the last of 200 periods, by SciPy."""
    tight: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-14, "method": "LSODA", "max_step": period / 50}
    last = np.linspace(199 * period, 200 * period, 2001)
    found = solve_ivp(rhs, (0, last[-1]), start, t_eval=last, **tight)
    return float(np.ptp(found.y[0]))


def test_stop_on_a_coordinate() -> None:
    """Assert that an oscillator that runs into a roller is traced to what SciPy settles to."""
    x = sym.coordinate("x")
    model = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 0.5)
    system = sym.compile(model + sym.Stop(x, LineContact(4.0), gap=1.0))
    branch = per.trace(system, "Omega", (0.4, 0.9), start=0.4)

    def rhs(t: float, y: Any) -> list[float]:
        stop = 4.0 * max(y[0] - 1.0, 0) ** N
        return [y[1], 0.5 * np.cos(0.9 * t) - 0.1 * y[1] - y[0] - stop]

    expected = settled(rhs, [0.0, 0.0], 2 * np.pi / 0.9)
    assert expected > 2.2  # the stop is reached
    assert branch.peak_to_peak("x")[-1] == pytest.approx(expected, rel=1e-5)


def test_dry_disc_scene(tmp_path: Path) -> None:
    """Assert linear frequency and traced motion of a scene file that names the law."""
    (tmp_path / "roller.toml").write_text(SCENE)
    system = sym.scene(tmp_path / "roller.toml", {"from_rpm": 600})
    frequency = np.sqrt(N * PRELOAD / DELTA0 / (MASS / 2))
    assert sym.modes(system).frequencies == pytest.approx([frequency], rel=1e-10)
    branch = per.trace(system, "speed", (500 * RPM, 600 * RPM), start=600 * RPM)
    omega, damping = WAVES * 500 * RPM, 2 * ZETA * frequency

    def rhs(t: float, y: Any) -> list[float]:
        load = line(DELTA0 + AMPLITUDE * np.sin(omega * t) - y[0])
        return [y[1], (load - PRELOAD) / (MASS / 2) - damping * y[1]]

    expected = settled(rhs, [0.0, 0.0], 2 * np.pi / omega)
    assert branch.peak_to_peak("x")[-1] == pytest.approx(expected, rel=1e-5)


def test_disc_scene_with_a_film(tmp_path: Path) -> None:
    """Assert that a squeeze film takes the law as it takes Hertz's."""
    (tmp_path / "lubricated.toml").write_text(SCENE + FILM)
    system = sym.scene(tmp_path / "lubricated.toml")
    branch = per.trace(system, "speed", (450 * RPM, 500 * RPM), start=500 * RPM)
    omega, speed = WAVES * 450 * RPM, 450 * RPM * DIAMETER / 2
    rest = sym.modes(system, {"speed": 450 * RPM})
    h0, mu = rest.state[2] * system.states[2].scale, MASS / 2
    damping = 2 * ZETA * np.sqrt(N * PRELOAD / DELTA0 / mu)

    def rhs(t: float, y: Any) -> list[float]:
        load = line(DELTA0 + y[2] - h0 + AMPLITUDE * np.sin(omega * t) - y[0])
        rate = -(speed / SQUEEZE) * (np.log(load / PRELOAD) + BETA * np.log(y[2] / h0))
        return [y[1], (load - PRELOAD) / mu - damping * y[1], rate]

    expected = settled(rhs, [0.0, 0.0, h0], 2 * np.pi / omega)
    assert branch.peak_to_peak("x")[-1] == pytest.approx(expected, rel=1e-5)
