"""Everything a system can do at given parameters: all its motions, their basins, chaos by its exponents."""

from periodic.phasespace.charted import Atlas
from periodic.phasespace.lyapunov import Exponents
from periodic.phasespace.motion import Motion, Motions, Sort
from periodic.phasespace.partition import Basins
from periodic.phasespace.picture import Elsewhere
from periodic.phasespace.sheet import Sheet
from periodic.phasespace.stages import SearchInterrupted
from periodic.phasespace.working import WorkStoppedError
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
