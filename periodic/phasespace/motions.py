"""Every motion of a system at given parameters that can be found."""

from __future__ import annotations

from collections.abc import Mapping

from periodic.correction.tolerance import Accuracy
from periodic.display.meter import meter
from periodic.phasespace.motion import Motions
from periodic.phasespace.search.search import search_of
from periodic.phasespace.search.stages import Stages
from periodic.system import System


def motions(
    system: System,
    values: Mapping[str, float] | None = None,
    *,
    box: Mapping[str, tuple[float, float]] | None = None,
    periods: int = 6,
    starts: int = 256,
    settle: int = 2000,
    places: int = 64,
    along: Mapping[str, tuple[float, float]] | None = None,
    seed: int = 0,
    tol: float = Accuracy.STANDARD,
) -> Motions:
    """Return every motion of an excited system that is found at given parameters, stable and unstable.

    Motions from random places of a box are followed event by event. Those that come back, after up to
    `periods` excitation periods, are completed to orbits with multipliers and an error estimate; of the
    others weighted Birkhoff averages tell tori from chaos, and Lyapunov exponents are given. Unstable orbits
    are found by Newton's method on the map over 1 to `periods` periods, with deflation, and by tracing the
    branches of all orbits `along` a parameter and back.

    Parameters
    ----------
    system : System
        The equations; one that integrates itself in time, as those of `symbolic.compile` do.
    values : mapping of str to float, optional
        Parameters (SI) that differ from their nominal values.
    box : mapping of str to (float, float), optional
        Ranges of states (SI) in which motions start, x' being the velocity; of states that are not named, and
        by default of all, three times the range of the motion from rest.
    periods : int
        Most excitation periods after which a motion comes back that is looked for.
    starts : int
        How many motions start.
    settle : int
        Most periods that a motion is followed, but for those that then nearly come back.
    places : int
        Places from which Newton's method starts for each number of periods; 0 for stable motions alone.
    along : mapping of str to (float, float), optional
        A parameter and its range (SI), in which the branch of each orbit is traced for others of it at the
        parameter's value.
    seed : int
        Of the random places.
    tol : float
        Tolerance of orbits, as in `trace`; motions are integrated a hundred times finer.

    Returns
    -------
    Motions
        The motions, with their shares of the box, and what was tried.

    Raises
    ------
    ValueError
        For names, numbers, ranges and systems that are not allowed.
    SearchInterrupted
        For Ctrl-C: its `found` is what was found until then, with what was not tried.
    """
    search = search_of(system, values, box, periods, starts, settle, places, seed, tol)
    with meter("looking for motions", "parts of it") as show:
        return Stages(search, {} if along is None else along).run(lambda said: show(1, said))
