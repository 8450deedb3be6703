"""What the equations are: coordinates, parameters, parts, models, and their compilation to a System."""

from symbolic import functions
from symbolic.choice import Kernels
from symbolic.compile import CompiledSystem, compile
from symbolic.model import Model, Part, combine
from symbolic.parts.cavitation import CavitatingFilm
from symbolic.parts.contact import ContactDamping, ContactPair, Hertz, Preload, Waviness
from symbolic.parts.equations import Equations
from symbolic.parts.film import QuasistaticFilm, SqueezeFilm
from symbolic.parts.mechanics import (
    Coupling,
    CubicSpring,
    Damper,
    HarmonicForce,
    Mass,
    ReducedMass,
    Spring,
    Support,
)
from symbolic.parts.start import ExplicitSqueezeFilm, RampedWaviness
from symbolic.parts.thickness import (
    CalibratedThickness,
    Compliance,
    ConstantThickness,
    GivenThickness,
    HamrockDowsonThickness,
    RegressionThickness,
    Rolling,
    ThicknessLaw,
)
from symbolic.parts.thirdorder import ThirdOrder
from symbolic.variables import Coordinate, Parameter, Variable, coordinate, parameter

__all__ = [
    "CalibratedThickness",
    "CavitatingFilm",
    "CompiledSystem",
    "Compliance",
    "ConstantThickness",
    "ContactDamping",
    "ContactPair",
    "Coordinate",
    "Coupling",
    "CubicSpring",
    "Damper",
    "Equations",
    "ExplicitSqueezeFilm",
    "GivenThickness",
    "HamrockDowsonThickness",
    "HarmonicForce",
    "Hertz",
    "Kernels",
    "Mass",
    "Model",
    "Parameter",
    "Part",
    "Preload",
    "QuasistaticFilm",
    "RampedWaviness",
    "ReducedMass",
    "RegressionThickness",
    "Rolling",
    "Spring",
    "SqueezeFilm",
    "Support",
    "ThicknessLaw",
    "ThirdOrder",
    "Variable",
    "Waviness",
    "combine",
    "compile",
    "coordinate",
    "functions",
    "parameter",
]
