"""Systems of the first order with known equilibria and orbits, written as equations."""

from __future__ import annotations

import symbolic as sym
from symbolic.parts.equations import Names

F = sym.functions
ORBITS = {"x": 0.0, "v": 0.0}


def lorenz() -> sym.CompiledSystem:
    """Lorenz's equations: pitchfork at rho = 1, Hopf points at rho = 470/19."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {
                "x": p.sigma * (x.y - x.x),
                "y": x.x * (p.rho - x.z) - x.y,
                "z": x.x * x.y - p.beta * x.z,
            },
            states={"x": 0.0, "y": 0.0, "z": 0.0},
            parameters={"sigma": 10.0, "rho": 28.0, "beta": 8 / 3},
            scales={"x": 10.0, "y": 10.0, "z": 10.0},
        )
    )


def feedback() -> sym.CompiledSystem:
    """x''' = -alpha x'' - x' - x + x^2 (MatCont's adaptx): Hopf point at alpha = 1."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {"x": x.y, "y": x.z, "z": -p.alpha * x.z - x.y - x.x + x.x**2},
            states={"x": 0.0, "y": 0.0, "z": 0.0},
            parameters={"alpha": 2.0},
        )
    )


def reaction() -> sym.CompiledSystem:
    """AUTO-07p's demo ab: a reaction A -> B with heat (Uppal, Ray & Poore 1974)."""

    def rates(x: Names, p: Names) -> dict[str, object]:
        burnt = p.p1 * (1 - x.u1) * F.exp(x.u2)
        return {"u1": -x.u1 + burnt, "u2": -x.u2 + p.p2 * burnt - p.p3 * x.u2}

    parameters = {"p1": 0.0, "p2": 14.0, "p3": 2.0}
    return sym.compile(sym.Equations(rates, states={"u1": 0.0, "u2": 0.0}, parameters=parameters))


def brusselator() -> sym.CompiledSystem:
    """Hopf point at B = 1 + A^2 with the frequency A."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {
                "x": p.A + x.x**2 * x.y - (p.B + 1) * x.x,
                "y": p.B * x.x - x.x**2 * x.y,
            },
            states={"x": 1.0, "y": 1.0},
            parameters={"A": 1.3, "B": 1.0},
        )
    )


def fitzhugh_nagumo() -> sym.CompiledSystem:
    """Hopf points where v^2 = 1 - b e."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {
                "v": x.v - x.v**3 / 3 - x.w + p.I,
                "w": p.e * (x.v + p.a - p.b * x.w),
            },
            states={"v": -1.2, "w": -0.6},
            parameters={"I": 0.0, "e": 0.08, "a": 0.7, "b": 0.8},
        )
    )


def stuart_landau(sign: float = -1.0) -> sym.CompiledSystem:
    """z' = (mu + i) z + sign |z|^2 z: the orbit |z|^2 = -sign mu of period 2 pi."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {
                "x": (p.mu + sign * (x.x**2 + x.y**2)) * x.x - x.y,
                "y": (p.mu + sign * (x.x**2 + x.y**2)) * x.y + x.x,
            },
            states={"x": 0.0, "y": 0.0},
            parameters={"mu": -1.0},
        )
    )


def oscillator(linear: float, cubic: float, quintic: float = 0.0) -> sym.CompiledSystem:
    """x'' + c x' + linear x + cubic x^3 + quintic x^5 = 0, with its energy; c is nominally 0."""
    return sym.compile(
        sym.Equations(
            lambda x, p: {
                "x": x.v,
                "v": -p.c * x.v - linear * x.x - cubic * x.x**3 - quintic * x.x**5,
            },
            states=ORBITS,
            parameters={"c": 0.0},
            outputs=lambda x, p: {
                "energy": x.v**2 / 2 + linear * x.x**2 / 2 + cubic * x.x**4 / 4 + quintic * x.x**6 / 6
            },
        )
    )


def two_masses(everywhere: bool = True) -> sym.CompiledSystem:
    """x1'' + 2 x1 - x2 + 0.5 x1^3 = 0, x2'' + 2 x2 - x1 = 0 (Kerschen et al. 2009), dampers c or one only."""

    def rates(x: Names, p: Names) -> dict[str, object]:
        return {
            "x1": x.v1,
            "x2": x.v2,
            "v1": -2 * x.x1 + x.x2 - 0.5 * x.x1**3 - p.c * x.v1,
            "v2": -2 * x.x2 + x.x1 - (p.c * x.v2 if everywhere else 0),
        }

    def energy(x: Names, p: Names) -> dict[str, object]:
        return {"energy": (x.v1**2 + x.v2**2) / 2 + x.x1**2 + x.x2**2 - x.x1 * x.x2 + x.x1**4 / 8}

    return sym.compile(
        sym.Equations(
            rates,
            states={"x1": 0.0, "x2": 0.0, "v1": 0.0, "v2": 0.0},
            parameters={"c": 0.0},
            outputs=energy,
        )
    )


def growing() -> sym.CompiledSystem:
    """x'' = (.03^2 - (mu - .33)^2) x' - x + .1 cos(.7 t): damped but between mu = .30 and .36."""
    return sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": x.v, "v": (9e-4 - (p.mu - 0.33) ** 2) * x.v - x.x + 0.1 * wave.cos},
            states={"x": 0.0, "v": 0.0},
            parameters={"Omega": 0.7, "mu": 0.0},
            frequency="Omega",
        )
    )
