"""Films beside `symbolic.SqueezeFilm` and `symbolic.LubricantFilm`, and the laws that films follow."""

from symbolic.parts.films.cavitating import CavitatingFilm
from symbolic.parts.films.explicit import ExplicitSqueezeFilm
from symbolic.parts.films.flattening import (
    AmplitudeReduction,
    FlattenedWaviness,
    LineReduction,
    PointReduction,
)
from symbolic.parts.films.law import FilmLaw, PowerFilm
from symbolic.parts.films.line import LineFilm
from symbolic.parts.films.quasistatic import QuasistaticFilm
from symbolic.parts.films.regimes import FilmRegime, RegimeFilm, film_regime
from symbolic.parts.films.regressions import (
    Compliance,
    ConstantThickness,
    HamrockDowsonThickness,
    RegressionThickness,
    Rolling,
)
from symbolic.parts.films.series import SeriesFilm
from symbolic.parts.films.thickness import CalibratedThickness, GivenThickness, SteadyThickness, ThicknessLaw
from symbolic.parts.films.thirdorder import ThirdOrder

__all__ = [
    "AmplitudeReduction",
    "CalibratedThickness",
    "CavitatingFilm",
    "Compliance",
    "ConstantThickness",
    "ExplicitSqueezeFilm",
    "FilmLaw",
    "FilmRegime",
    "FlattenedWaviness",
    "GivenThickness",
    "HamrockDowsonThickness",
    "LineFilm",
    "LineReduction",
    "PointReduction",
    "PowerFilm",
    "QuasistaticFilm",
    "RegimeFilm",
    "RegressionThickness",
    "Rolling",
    "SeriesFilm",
    "SteadyThickness",
    "ThicknessLaw",
    "ThirdOrder",
    "film_regime",
]
