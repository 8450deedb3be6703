"""How many multipliers of an orbit lie outside the unit circle, whatever the number of its states."""

from __future__ import annotations

from periodic.checks import positive
from periodic.conditions.variations import variations
from periodic.orbit.construction import as_read_by
from periodic.orbit.orbit import Orbit
from periodic.system import System


def unstable(system: System, orbit: Orbit, radius: float = 1.0) -> int:
    """Return how many Floquet multipliers of an orbit have a modulus larger than `radius`.

    Of a condensed system by the winding of a determinant round the circle, beside the leading multipliers
    that a branch has: for any number of states at the cost of a few tens of matrices of its places.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        An orbit of it, a piecewise polynomial.
    radius : float
        Of the circle; one a little larger than 1 leaves out multipliers that are 1 whatever the parameters.

    Returns
    -------
    int
        Their number.

    Raises
    ------
    ValueError
        For a radius that is not positive, and a Fourier series.
    FloatingPointError
        Where a multiplier lies on the circle, to rounding.
    """
    found = variations(system, as_read_by(system, orbit), ())
    return found.outside(positive("radius", radius))
