"""Periodic orbits: collocation, continuation, stability, special points. Knows only the `System` protocol.

The names stand in `__init__.pyi`; each is imported when it is first asked for. What everybody calls stands
here, the rest in namespaces: `plots`, `maps`, `decisions`, `extend`.
"""

import sys
import warnings
from functools import partial
from importlib.metadata import version
from operator import attrgetter
from typing import Any

import lazy_loader

from periodic.namesakes import foreign

_listed, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__version__ = version("orbitrace")
if _told := foreign("symbolic"):
    warnings.warn(_told, UserWarning, stacklevel=2)

_PLOTS = ("campbell", "multipliers", "orbit", "phase", "regions", "spectrum", "waterfall")
_MAPS = (
    *("Adaptive", "Grid", "Highest", "Lowest", "MapFileError", "MapInterrupted", "MapStoppedError"),
    *("Number", "Places", "Progress", "Sheets", "StableRanges", "Task"),
)
_EXTEND = (
    *("Condition", "Discretisation", "Increment", "Operator", "Row", "SideCondition"),
    *("Solution", "System", "TestFunction", "Unknowns"),
)
_MOVED = {
    **{f"plot_{name}": f"plots.{name}" for name in _PLOTS},
    **{name: f"maps.{name}" for name in _MAPS},
    **{name: f"extend.{name}" for name in _EXTEND},
    "equilibria": "trace(..., method=periodic.Equilibrium())",
    "map": "design_map",
    "mode": "normal_mode",
}
"""Names of version 0.2, and where they are now."""


def __getattr__(name: str) -> Any:
    """Import a name when it is first asked for; one of version 0.2 with a warning that says its new place."""
    if name not in _MOVED:
        return _listed(name)
    warnings.warn(
        f"periodic.{name} is now periodic.{_MOVED[name]}; the old name goes with version 0.4",
        DeprecationWarning,
        stacklevel=2,
    )
    here = sys.modules[__name__]
    if name == "equilibria":
        return partial(here.trace, method=here.Equilibrium())
    return attrgetter(_MOVED[name])(here)
