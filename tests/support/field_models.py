"""Models of the demos of AUTO, COCO, MatCont and NLvib, written from their published equations."""

from __future__ import annotations

from typing import Any

import symbolic as sym
from symbolic.parts.equations import Names

F = sym.functions
Rates = dict[str, Any]


def circuit() -> sym.CompiledSystem:
    """AUTO's demos tor and cir, COCO's tor: an electronic oscillator (Freire et al., Physica D 62, 1993)."""

    def rates(x: Names, p: Names) -> Rates:
        bridge = p.beta * (x.y - x.x) + p.b3 * (x.y - x.x) ** 3
        return {
            "x": (bridge - p.nu * x.x - p.a3 * x.x**3) / p.r,
            "y": -bridge - p.gamma * x.y - x.z,
            "z": x.y,
        }

    parameters = {"nu": -0.9, "beta": 0.5, "gamma": -0.6, "r": 0.6, "a3": 0.328578, "b3": 0.933578}
    return sym.compile(sym.Equations(rates, states=dict.fromkeys("xyz", 0.0), parameters=parameters))


def enzyme() -> sym.CompiledSystem:
    """AUTO's demo plp: an activator-inhibitor reaction with two substrates (Doedel et al. 1991)."""

    def rates(x: Names, p: Names) -> Rates:
        rate = p.rho * x.s * x.a / (1 + x.s + p.kappa * x.s**2)
        return {"s": p.s0 - x.s - rate, "a": p.alpha * (p.a0 - x.a) - rate}

    return sym.compile(
        sym.Equations(
            rates,
            states={"s": 45.59974, "a": 177.7987},
            parameters={"s0": 110.0, "a0": 500.0, "alpha": 0.2, "rho": 2.021628, "kappa": 0.1},
            scales={"s": 100.0, "a": 100.0},
        )
    )


def predator() -> sym.CompiledSystem:
    """AUTO's demo pp2: fish, sharks and fishing up to a quota."""

    def rates(x: Names, p: Names) -> Rates:
        caught = p.quota * (1 - F.exp(-5 * x.fish))
        return {
            "fish": 3 * x.fish * (1 - x.fish) - x.fish * x.sharks - caught,
            "sharks": -x.sharks + 3 * x.fish * x.sharks,
        }

    return sym.compile(sym.Equations(rates, states={"fish": 0.0, "sharks": 0.0}, parameters={"quota": 0.0}))


def reactions() -> sym.CompiledSystem:
    """AUTO's demo abc: consecutive reactions A -> B -> C with heat (Doedel & Heinemann 1983)."""

    def rates(x: Names, p: Names) -> Rates:
        burnt = p.D * F.exp(x.u3)
        return {
            "u1": -x.u1 + burnt * (1 - x.u1),
            "u2": -x.u2 + burnt * (1 - x.u1 - p.sigma * x.u2),
            "u3": -x.u3 - p.beta * x.u3 + burnt * p.B * (1 - x.u1 + p.alpha * p.sigma * x.u2),
        }

    parameters = {"D": 0.0, "alpha": 1.0, "beta": 1.55, "B": 8.0, "sigma": 0.04}
    return sym.compile(sym.Equations(rates, states={"u1": 0.0, "u2": 0.0, "u3": 0.0}, parameters=parameters))


def catalyst() -> sym.CompiledSystem:
    """MatCont's cataloscill: oxidation of carbon monoxide (Bykov, Yablonskii & Kim 1978)."""

    def rates(x: Names, p: Names) -> Rates:
        free = 1 - x.x - x.y - x.s
        return {
            "x": 2 * p.q1 * free**2 - 2 * p.q5 * x.x**2 - p.q3 * x.x * x.y,
            "y": p.q2 * free - p.q6 * x.y - p.q3 * x.x * x.y,
            "s": p.q4 * (free - p.k * x.s),
        }

    return sym.compile(
        sym.Equations(
            rates,
            states={"x": 0.001137, "y": 0.891483, "s": 0.062345},
            parameters={"q1": 2.5, "q2": 2.204678, "q3": 10, "q4": 0.0675, "q5": 1, "q6": 0.1, "k": 0.4},
        )
    )


def peroxidase() -> sym.CompiledSystem:
    """MatCont's tutorial on cycles: the peroxidase-oxidase reaction of Steinmetz & Larter (1991)."""

    def rates(x: Names, p: Names) -> Rates:
        first, third = p.k1 * x.A * x.B * x.X, p.k3 * x.A * x.B * x.Y
        second = p.k2 * x.X**2
        return {
            "A": -first - third + p.k7 - p.km7 * x.A,
            "B": -first - third + p.k8,
            "X": first - 2 * second + 2 * third - p.k4 * x.X + p.k6,
            "Y": -third + 2 * second - p.k5 * x.Y,
        }

    constants = {"k1": 0.1631021, "k2": 1250.0, "k3": 0.046875, "k4": 20.0, "k5": 1.104, "k6": 0.001}
    return sym.compile(
        sym.Equations(
            rates,
            states={"A": 31.78997, "B": 1.45468, "X": 0.01524586, "Y": 0.1776113},
            parameters={**constants, "k7": 4.235322, "km7": 0.1175, "k8": 0.5},
            scales={"A": 10.0, "X": 0.01, "Y": 0.1},
        )
    )


def spiral() -> sym.CompiledSystem:
    """Rossler's equations, a = b = 0.2: doublings over c (MatCont's tutorials, COCO's roess)."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {"x": -x.y - x.z, "y": x.x + p.a * x.y, "z": p.b + x.z * (x.x - p.c)},
            states={"x": 0.0, "y": 0.0, "z": 0.0},
            parameters={"a": 0.2, "b": 0.2, "c": 2.5},
        )
    )


def forced_van_der_pol() -> sym.CompiledSystem:
    """x'' - mu (1 - x^2) x' + x = F cos(Omega t): entrainment."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": x.v, "v": p.mu * (1 - x.x**2) * x.v - x.x + p.F * wave.cos},
            states={"x": 0.0, "v": 0.0},
            parameters={"mu": 0.2, "F": 0.2, "Omega": 1.0},
            frequency="Omega",
        )
    )


def ueda() -> sym.CompiledSystem:
    """x'' + 0.1 x' + x^3 = B cos t (Ueda 1979)."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": x.v, "v": -p.k * x.v - x.x**3 + p.B * wave.cos},
            states={"x": 0.0, "v": 0.0},
            parameters={"k": 0.1, "B": 0.2, "Omega": 1.0},
            frequency="Omega",
        )
    )


def two_springs() -> sym.CompiledSystem:
    """NLvib's example 06: a mass on two springs at a right angle under large displacements."""
    first, second = 1.13, 2.0
    both = (first**2 + second**2) / 2

    def rates(x: Names, p: Names, wave: Names) -> Rates:
        a, b = x.q1, x.q2
        force1 = first**2 * (a + (3 * a**2 + b**2) / 2) + second**2 * a * b + both * a * (a**2 + b**2)
        force2 = second**2 * (b + (3 * b**2 + a**2) / 2) + first**2 * a * b + both * b * (a**2 + b**2)
        return {
            "q1": x.v1,
            "q2": x.v2,
            "v1": p.F * wave.cos - 2e-3 * first * x.v1 - force1,
            "v2": p.F * wave.cos - 10e-3 * second * x.v2 - force2,
        }

    return sym.compile(
        sym.Equations(
            rates,
            states={"q1": 0.0, "q2": 0.0, "v1": 0.0, "v2": 0.0},
            parameters={"F": 3e-3, "Omega": 1.0},
            frequency="Omega",
        )
    )


def absorber() -> sym.CompiledSystem:
    """NLvib's example 02: a mass of 1 with a small one on it, both on cubic springs."""
    x1, x2 = sym.coordinate("x1"), sym.coordinate("x2")
    soft, light, leak = 0.0042, sym.parameter("m2", 0.05, "kg"), 0.013
    parts = [
        sym.Mass(x1, 1.0),
        sym.Mass(x2, light),
        sym.Spring(x1, 1.0),
        sym.Damper(x1, 0.002),
        sym.CubicSpring(x1, 1.0),
        sym.HarmonicForce(x1, 0.11),
        sym.Equations(
            lambda x, p: {
                "x1": -(force := 0.0453 * (x.x1 - x.x2) + soft * (x.x1 - x.x2) ** 3)
                - leak * (x.x1_dot - x.x2_dot),
                "x2": force + leak * (x.x1_dot - x.x2_dot),
            },
            states={},
            coordinates=[x1, x2],
        ),
    ]
    return sym.compile(sym.combine(parts))


def pendula() -> sym.CompiledSystem:
    """AUTO's demo pen: two coupled pendula that turn over at a mean rate, by their angles ahead of rate t."""

    def rates(x: Names, p: Names, wave: Names) -> Rates:
        weights = [wave.sin * F.cos(angle) + wave.cos * F.sin(angle) for angle in (x.a, x.b)]
        return {
            "a": x.u - p.rate,
            "b": x.v - p.rate,
            "u": -p.eps * x.u - weights[0] + p.torque + p.gamma * (x.b - x.a),
            "v": -p.eps * x.v - weights[1] + p.torque + p.gamma * (x.a - x.b),
        }

    return sym.compile(
        sym.Equations(
            rates,
            states={"a": 0.0, "b": 0.0, "u": 4.0, "v": 4.0},
            parameters={"gamma": 0.175, "eps": 0.1, "torque": 0.4, "rate": 4.0},
            frequency="rate",
        )
    )
