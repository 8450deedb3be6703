"""Independent stiff time integration of the wavy rolling disc: a reference for the tests.

Scaled variables: length delta0, time 1/omega, load Q; x = X/delta0, v = dx/dtau, lam = ln(delta/delta0).
With A = a/delta0, H = h/delta0, H0 = h0/delta0, g = gamma omega delta0 and c = 2Q/(m omega^2 delta0):

    H    = H0 + exp(lam) - 1 - A sin(tau) + x          geometry
    H'   = -(beta ln(H/H0) + 1.5 lam)/g                film with squeeze, W/Q = exp(1.5 lam)
    x'   = v,   v' = c (exp(1.5 lam) - 1)              the discs
    lam' = r(lam) (H' + A cos(tau) - v)                derivative of the geometry, r = exp(-lam)

Where contact is lost lam falls, within ~exp(lam) of a radian, to the root of H' + A cos(tau) - v and then
follows it.  That layer gets thinner than the spacing of doubles in tau, so r = min(exp(-lam), 1e8). Caps of
1e6 to 1e10 give the same x p-p (to 1e-11 um) and multipliers (to 2e-9; from 1e8 on to 3e-12).

Perturbations are carried as (dx, dv, dD), D = delta/delta0 = exp(lam): they stay of order 1 where contact is
lost (dD -> 0 there), unlike d(lam) = exp(-lam) dD.  The multipliers are the same in either basis.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.interpolate import BPoly

Array = npt.NDArray[np.float64]
TWO_PI = 2.0 * math.pi
RATE_CAP = 1e8


@dataclass(frozen=True)
class Scene:
    """Constants of the scene in SI units; the defaults are ``vitrea79-810N``."""

    speed_rpm: float = 360.0
    preload: float = 810.0
    viscosity: float = 0.890
    piezoviscosity: float = 25.9e-9
    mass: float = 20.4
    hertz: float = 28e9
    amplitude: float = 1.27e-6
    waves: int = 120
    diameter: float = 0.102
    beta: float = 22.23
    squeeze: float = 2734.3

    @property
    def omega(self) -> float:
        """Excitation frequency 2 pi (N/60) waves, rad/s."""
        return TWO_PI * self.speed_rpm / 60.0 * self.waves

    @property
    def u(self) -> float:
        """Rolling speed pi D N/60, m/s."""
        return math.pi * self.diameter * self.speed_rpm / 60.0

    @property
    def delta0(self) -> float:
        """Static deflection (Q/K_c)^(2/3), m."""
        return math.pow(self.preload / self.hertz, 2.0 / 3.0)

    @property
    def h0(self) -> float:
        """Steady film, the law calibrated to 3.85 um at 360 rpm, 810 N, Vitrea 79, m."""
        film = 3.85e-6 * math.pow(self.u / 1.92265 * self.viscosity / 0.890, 0.625)
        film *= math.pow(self.piezoviscosity / 25.9e-9, 0.46)
        return film * math.pow(self.preload / 810.0, -1.0 / self.beta)

    @property
    def scaled(self) -> tuple[float, float, float, float, float]:
        """(A, H0, beta, g, c) of the module's docstring; gamma = squeeze/u."""
        g = self.squeeze / self.u * self.omega * self.delta0
        c = 2.0 * self.preload / (self.mass * self.omega**2 * self.delta0)
        return self.amplitude / self.delta0, self.h0 / self.delta0, self.beta, g, c

    def at(self, speed_rpm: float) -> Scene:
        """The same scene at another speed."""
        return replace(self, speed_rpm=speed_rpm)


VITREA79 = Scene()
TURBO33 = Scene(viscosity=0.034, piezoviscosity=21.6e-9)


@dataclass(frozen=True)
class Period:
    """One period, tau = 0 to 2 pi: extrema of the continuous solution (SI units) and the monodromy matrix."""

    start: Array
    end: Array
    x_pp: float
    h_pp: float
    load_min: float
    load_max: float
    log_load_min: float  # ln(W_min/Q)
    monodromy: Array  # in (x, v, D)
    steps: int

    @property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """Eigenvalues of the monodromy matrix, largest modulus first."""
        mu = np.linalg.eigvals(self.monodromy).astype(np.complex128)
        return mu[np.argsort(-np.abs(mu), kind="stable")]


def state_from_xvh(scene: Scene, xvh: npt.ArrayLike, tau: float = 0.0) -> Array:
    """(x, v, lam) from (X, dX/dtau, h)/delta0: exp(lam) = 1 + H - H0 + A sin(tau) - x.

    Out of contact H cannot resolve lam; there H' = v - A cos(tau), so 1.5 lam = -beta ln(H/H0) - g H'.
    """
    x, v, film = (float(z) for z in np.asarray(xvh, dtype=np.float64))
    amp, h0, beta, g, _ = scene.scaled
    gap = 1.0 + film - h0 + amp * math.sin(tau) - x
    free = -(beta * math.log(film / h0) + g * (v - amp * math.cos(tau))) / 1.5
    return np.array([x, v, math.log(gap) if gap > 1e-9 else min(free, math.log(1e-9))])


def _equations(scene: Scene) -> tuple[Callable[[float, Array], Array], Callable[[float, Array], Array]]:
    """Right-hand side and Jacobian of (x, v, lam) and, if 12 long, of (dx, dv, dD) of 3 perturbations."""
    amp, h0, beta, g, c = scene.scaled

    def local(tau: float, y: Array) -> tuple[float, float, float, float, float]:
        lam = min(max(float(y[2]), -600.0), 20.0)
        height = max(h0 + math.expm1(lam) - amp * math.sin(tau) + float(y[0]), 1e-6 * h0)
        rate = -(beta * math.log(height / h0) + 1.5 * lam) / g
        return lam, math.exp(lam), min(math.exp(-lam), RATE_CAP), height, rate + amp * math.cos(tau) - y[1]

    def rhs(tau: float, y: Array) -> Array:
        lam, gap, inv, height, gap_rate = local(tau, y)
        out = np.empty_like(y)
        out[0], out[1], out[2] = y[1], c * math.expm1(1.5 * lam), inv * gap_rate
        if y.size == 12:
            dx, dv, dd = y[3:6], y[6:9], y[9:12]
            out[3:6], out[6:9] = dv, 1.5 * c * math.sqrt(gap) * dd
            out[9:12] = -(beta / height * (dx + dd) + 1.5 * inv * dd) / g - dv
        return out

    def jac(tau: float, y: Array) -> Array:
        lam, gap, inv, height, gap_rate = local(tau, y)
        k, b = 1.5 * c * math.sqrt(gap), beta / height / g
        out = np.zeros((y.size, y.size))
        out[0, 1], out[1, 2] = 1.0, k * gap
        free = inv == RATE_CAP
        out[2, :3] = -inv * b, -inv, -inv * (b * gap + 1.5 / g) - (0.0 if free else inv * gap_rate)
        if y.size == 12:
            dx, dd, i = y[3:6], y[9:12], np.arange(3)
            out[3 + i, 6 + i], out[6 + i, 9 + i], out[9 + i, 6 + i] = 1.0, k, -1.0
            out[9 + i, 3 + i], out[9 + i, 9 + i] = -b, -b - 1.5 * inv / g
            out[6:9, 2] = 0.5 * k * dd
            out[9:12, 0] = b / height * (dx + dd)
            out[9:12, 2] = gap * out[9:12, 0] + (0.0 if free else 1.5 * inv / g) * dd
        return out

    return rhs, jac


def _integrate(scene: Scene, y0: Array, rtol: float, method: str) -> tuple[Array, Array]:
    """Mesh and states of one period, tau from 0 to 2 pi."""
    rhs, jac = _equations(scene)
    options = {"rtol": rtol, "atol": rtol, "max_step": 0.05}  # in flight the solver would take steps of 0.3
    sol = solve_ivp(rhs, (0.0, TWO_PI), y0, method=method, jac=jac, **options)
    if not sol.success or not np.all(np.isfinite(sol.y)):
        raise ArithmeticError(f"integration at {scene.speed_rpm} rpm: {sol.message}")
    return sol.t, sol.y


def _extrema(t: Array, derivatives: Array) -> tuple[float, float]:
    """Minimum and maximum of the Hermite interpolant of the columns (z, z', ...), its extrema polished."""
    z, dz = derivatives[:, 0], derivatives[:, 1]
    low, high = float(z.min()), float(z.max())
    for i in np.flatnonzero(dz[:-1] * dz[1:] < 0.0):
        piece = BPoly.from_derivatives(t[i : i + 2], derivatives[i : i + 2])
        slope, a, b = piece.derivative(), t[i], t[i + 1]
        for _ in range(60):  # bisection: robust, and z is stationary there
            mid = 0.5 * (a + b)
            a, b = (mid, b) if slope(mid) * dz[i] > 0.0 else (a, mid)
        value = float(piece(0.5 * (a + b)))
        low, high = min(low, value), max(high, value)
    return low, high


def one_period(scene: Scene, state0: npt.ArrayLike, rtol: float = 1e-10, method: str = "Radau") -> Period:
    """Integrate state and perturbations over one period.

    x, h and ln W are interpolated by Hermite pieces whose derivatives the equations give on the mesh.
    Where the rate cap acts (out of contact) H' = v - A cos(tau), ln(W/Q) = -beta ln(H/H0) - g H' (the root).
    """
    start = np.asarray(state0, dtype=np.float64)
    t, y = _integrate(scene, np.concatenate([start, np.eye(3).ravel()]), rtol, method)
    amp, h0, beta, g, c = scene.scaled
    x, v, lam = y[:3]
    sin, cos, inv, acc = amp * np.sin(t), amp * np.cos(t), np.exp(-lam), c * np.expm1(1.5 * lam)
    film = np.maximum(h0 + np.expm1(lam) - sin + x, 1e-6 * h0)
    rate = -(beta * np.log(film / h0) + 1.5 * lam) / g
    slope, free = inv * (rate + cos - v), inv > RATE_CAP
    rate2 = np.where(free, acc + sin, -(beta * rate / film + 1.5 * slope) / g)
    rate = np.where(free, v - cos, rate)
    root = [beta * np.log(film / h0) + g * rate, beta * rate / film + g * rate2]
    root.append(beta * (rate2 / film - (rate / film) ** 2) + g * cos)
    x_low, x_high = _extrema(t, np.column_stack([x, v, acc]))
    h_low, h_high = _extrema(t, np.column_stack([film, rate, rate2]))
    loads = []
    for i in np.split(np.arange(t.size), np.flatnonzero(np.diff(free)) + 1):
        columns = -np.column_stack(root) if free[i[0]] else 1.5 * np.column_stack([lam, slope])
        loads += list(_extrema(t[i], columns[i]))
    w_low, w_high = min(loads), max(loads)
    pp = ((x_high - x_low) * scene.delta0, (h_high - h_low) * scene.delta0)
    load = (scene.preload * math.exp(w_low), scene.preload * math.exp(w_high))
    return Period(start, y[:3, -1], *pp, *load, w_low, y[3:, -1].reshape(3, 3), t.size - 1)


def periodic_orbit(
    scene: Scene, guess: npt.ArrayLike = (0.0, 0.0, 0.0), rtol: float = 1e-10, method: str = "Radau"
) -> Period:
    """Single shooting: Newton on end(start) - start = 0 in (x, v, lam), with d(lam) = exp(-lam) dD."""
    state, size = np.asarray(guess, dtype=np.float64), math.inf
    for _ in range(30):
        period = one_period(scene, state, rtol, method)
        if size < max(1e-6, 10.0 * rtol):
            return period  # after one more quadratically convergent step
        last = np.diag([1.0, 1.0, math.exp(-period.end[2])])
        matrix = last @ period.monodromy @ np.diag([1.0, 1.0, math.exp(state[2])])
        step = np.linalg.solve(np.eye(3) - matrix, period.end - state)
        size = float(np.max(np.abs(step)))
        state = state + step / max(1.0, size)
    raise ArithmeticError(f"shooting at {scene.speed_rpm} rpm did not converge")
