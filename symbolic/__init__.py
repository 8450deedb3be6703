"""What the equations are: parts that add up to models, scenes of such models, and their compilation.

The names stand in `__init__.pyi`; each is imported when it is first asked for, so that the command line need
not import CasADi to say how it is used. What everybody calls stands here, the rest in namespaces: `films`,
`functions`.
"""

import builtins
import sys
import warnings
from importlib.metadata import version
from operator import attrgetter
from typing import Any

import lazy_loader

from symbolic.namesakes import foreign

_listed, __dir__, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = [name for name in _names if not hasattr(builtins, name)]  # `import *` leaves Python's compile alone
__version__ = version("orbitrace")
if _told := foreign("periodic"):
    warnings.warn(_told, UserWarning, stacklevel=2)

_FILMS = (
    *("AmplitudeReduction", "CalibratedThickness", "CavitatingFilm", "Compliance", "ConstantThickness"),
    *("ExplicitSqueezeFilm", "FilmLaw", "FilmRegime", "FlattenedWaviness", "GivenThickness"),
    *("HamrockDowsonThickness", "LineFilm", "LineReduction", "PointReduction", "PowerFilm"),
    *("QuasistaticFilm", "RegimeFilm", "RegressionThickness", "Rolling", "SeriesFilm", "SteadyThickness"),
    *("ThicknessLaw", "ThirdOrder", "film_regime"),
)
_MOVED = {name: f"films.{name}" for name in _FILMS}
"""Names of version 0.2, and where they are now."""


def __getattr__(name: str) -> Any:
    """Import a name when it is first asked for; one of version 0.2 with a warning that says its new place."""
    if name not in _MOVED:
        return _listed(name)
    warnings.warn(
        f"symbolic.{name} is now symbolic.{_MOVED[name]}; the old name goes with version 0.4",
        DeprecationWarning,
        stacklevel=2,
    )
    return attrgetter(_MOVED[name])(sys.modules[__name__])
