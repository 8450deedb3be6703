"""What the equations are: coordinates, parameters, parts, models, and their compilation to a System."""

from symbolic.compile import CompiledSystem, compile
from symbolic.model import Model, Part, combine
from symbolic.parts.contact import ContactDamping, ContactPair, Hertz, Preload, Waviness
from symbolic.parts.film import CalibratedThickness, QuasistaticFilm, SqueezeFilm
from symbolic.parts.mechanics import CubicSpring, Damper, HarmonicForce, Mass, ReducedMass, Spring
from symbolic.variables import Coordinate, Parameter, Variable, coordinate, parameter

__all__ = [
    "CalibratedThickness",
    "CompiledSystem",
    "ContactDamping",
    "ContactPair",
    "Coordinate",
    "CubicSpring",
    "Damper",
    "HarmonicForce",
    "Hertz",
    "Mass",
    "Model",
    "Parameter",
    "Part",
    "Preload",
    "QuasistaticFilm",
    "ReducedMass",
    "Spring",
    "SqueezeFilm",
    "Variable",
    "Waviness",
    "combine",
    "compile",
    "coordinate",
    "parameter",
]
