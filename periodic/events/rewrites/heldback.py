"""How long friction that slips before an event goes on after it, as the force on it falls back there.

The force passes the limit at a rate a for a time L, and the guard grows to a L^2 / 2. Where the force falls
by J at the event, the guard is 0 again a L^2 / 2J later. Where it only begins to fall, at a rate b, as where
a spring loses contact, the guard goes on as a L^2 / 2 + a L t - b t^2 / 2, which is 0 at

    t = L (a + (a^2 + a b)^(1/2)) / b.
"""

from __future__ import annotations

from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import TOGETHER
from periodic.events.violations import largest
from periodic.orbit.scheme import Array


def after(dense: SwitchPolynomials, node: int, switch: int, side: int) -> tuple[float, float]:
    """Return part and power of L: how long after an event node the slip ends that begins L before it.

    Parameters
    ----------
    dense : SwitchPolynomials
        The orbit, whose friction is held there.
    node : int
        The event node.
    switch : int
        The release that just reaches its level at the node.
    side : int
        The side of its level on which it is.
    """
    start = int(dense.orbit.mesh.starts[node])
    values, rates = side * dense.knots[:, :, switch], side * _rates(dense, switch)
    falls, rises = -float(rates[start - 1, -1]), float(rates[start, 0])
    jump = float(values[start, 0] - values[start - 1, -1])
    if falls > 0 and jump > TOGETHER * largest(dense, switch):
        return falls / (2 * jump), 2.0
    if falls > 0 and rises > 0:
        return (falls + (falls**2 + falls * rises) ** 0.5) / rises, 1.0
    return 1.0, 2.0


def _rates(dense: SwitchPolynomials, switch: int) -> Array:
    """The derivative of a switch in tau at the beginning and the end of each interval, shape (N, 2)."""
    orbit, values = dense.orbit, dense.knots[:, :, switch]
    scheme = orbit.mesh.scheme
    at_ends = scheme.basis(scheme.knots[[0, -1]]) @ scheme.differentiation
    return values @ at_ends.T / orbit.grid.width[:, None]
