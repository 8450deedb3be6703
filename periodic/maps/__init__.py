"""Many branches: what is traced in each cell of a `design_map`, the cells, and what is read off a branch."""

from periodic.maps.adaptive import Adaptive
from periodic.maps.grid import Grid
from periodic.maps.map import MapInterrupted, MapStoppedError
from periodic.maps.numbers.extremes import Highest, Lowest
from periodic.maps.numbers.places import Places, StableRanges
from periodic.maps.numbers.sheets import Sheets
from periodic.maps.progress import Progress
from periodic.maps.store import MapFileError
from periodic.maps.task import Number, Task

__all__ = [
    "Adaptive",
    "Grid",
    "Highest",
    "Lowest",
    "MapFileError",
    "MapInterrupted",
    "MapStoppedError",
    "Number",
    "Places",
    "Progress",
    "Sheets",
    "StableRanges",
    "Task",
]
