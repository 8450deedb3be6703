"""The discs without squeeze film as problems for shooting, written from physics.md and not from `symbolic`.

Scaled variables: length delta0, time 1/omega, x = X/delta0, d = 1 + A sin(tau) - x the dry deflection:

    x'' = c (w - 1) - 2 zeta r x',    w = W/Q,  r = omega0/omega,  c = r^2/1.5

dry contact: w = max(d, 0)^1.5. Film without squeeze: w^(2/3) - H0 (w^(-1/beta) - 1) = d, H0 = h0/delta0.
"""

from __future__ import annotations

import math

from reference.shooting import Field, oscillator
from reference.squeeze import Scene

RATIO = 0.007


def dry(scene: Scene, ratio: float = RATIO) -> Field:
    """Dry Hertz contact, its two sides joined at d = 0."""
    amp, _, _, _, c = scene.scaled
    damping = 2 * ratio * math.sqrt(1.5 * c)

    def deflection(tau: float, x: float) -> float:
        return 1 + amp * math.sin(tau) - x

    def acceleration(tau: float, x: float, v: float, side: float) -> float:
        load = max(deflection(tau, x), 0.0) ** 1.5 if side > 0 else 0.0
        return c * (load - 1) - damping * v

    def by_x(tau: float, x: float, v: float, side: float) -> float:
        return -1.5 * c * math.sqrt(max(deflection(tau, x), 0.0)) if side > 0 else 0.0

    return oscillator(
        acceleration=acceleration, by_x=by_x, by_v=lambda tau, x, v, side: -damping, switch=deflection
    )


def quasistatic(scene: Scene, ratio: float = RATIO) -> Field:
    """Contact through a film that follows the load, y = ln w by Newton's method: smooth, though it bends."""
    amp, h0, beta, _, c = scene.scaled
    damping = 2 * ratio * math.sqrt(1.5 * c)

    def terms(y: float) -> tuple[float, float]:
        contact, film = math.exp(2 * y / 3), h0 * math.exp(-y / beta)
        return contact - film + h0, 2 / 3 * contact + film / beta

    def log_load(tau: float, x: float) -> float:
        d = 1 + amp * math.sin(tau) - x
        y = 1.5 * math.log(d) if d > 0.5 else -beta * math.log((h0 + 0.5 - d) / h0)
        for _ in range(60):
            value, slope = terms(y)
            step = (value - d) / slope
            y -= min(max(step, -2.0), 2.0)
            if abs(step) < 1e-14 * (1 + abs(y)):
                break
        return y

    def by_x(tau: float, x: float, v: float, side: float) -> float:
        y = log_load(tau, x)
        return -c * math.exp(y) / terms(y)[1]

    return oscillator(
        acceleration=lambda tau, x, v, side: c * math.expm1(log_load(tau, x)) - damping * v,
        by_x=by_x,
        by_v=lambda tau, x, v, side: -damping,
    )
