"""Everything a system can do at given parameters: all its motions, their basins, chaos by its exponents."""

from periodic.phasespace.atlases.charted import Atlas
from periodic.phasespace.atlases.sheet import Sheet
from periodic.phasespace.following.working import WorkStoppedError
from periodic.phasespace.lyapunov import Exponents
from periodic.phasespace.motion import Motion, Motions, Sort
from periodic.phasespace.partition import Basins
from periodic.phasespace.picture import Elsewhere
from periodic.phasespace.search.stages import SearchInterrupted
from periodic.results.kept import StoreError

__all__ = [
    "Atlas",
    "Basins",
    "Elsewhere",
    "Exponents",
    "Motion",
    "Motions",
    "SearchInterrupted",
    "Sheet",
    "Sort",
    "StoreError",
    "WorkStoppedError",
]
