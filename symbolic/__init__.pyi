"""What the equations are: parts that add up to models, scenes of such models, and their compilation."""

from . import films, functions
from .equations.assembly import Assembly
from .equations.model import Model, Part, combine
from .equations.variables import Coordinate, Parameter, Variable, coordinate, coordinates, parameter
from .integration.cvodes import IntegrationError
from .kernels.choice import Kernels
from .kernels.native import CompilerError
from .motion.frequencyresponse import FrequencyResponse, response
from .motion.linear import Modes, NoRestError, modes, resonance
from .motion.simulate import Simulation, SimulationInterrupted, simulate
from .parts.bearings.rolling import RollingBearing
from .parts.bearings.waves import RaceWave
from .parts.contact.excitation import RampedWaviness, Waviness
from .parts.contact.huntcrossley import HuntCrossleyStop
from .parts.contact.law import ContactLaw, HertzLaw
from .parts.contact.loads import ContactDamping, ElasticContact, Hertz, Preload
from .parts.contact.pair import ContactPair
from .parts.contact.palmgren import PalmgrenLaw
from .parts.contact.rigidstop import RigidStop
from .parts.contact.stop import Stop
from .parts.equations import Equations
from .parts.films.lubricated import LubricantFilm
from .parts.films.squeeze import SqueezeFilm
from .parts.friction.coulomb import CoulombFriction
from .parts.friction.jenkins import Iwan, Jenkins
from .parts.friction.load import NormalLoad
from .parts.friction.tanh import TanhFriction
from .parts.gears.error import TransmissionError
from .parts.gears.mesh import GearMesh
from .parts.mechanics.clearances import Backlash, Gap, OneSidedSpring
from .parts.mechanics.cubicdamper import CubicDamper
from .parts.mechanics.driven import BaseMotion, PeriodicForce, VaryingSpring
from .parts.mechanics.forces import ConstantForce, HarmonicForce
from .parts.mechanics.inertia import Mass, ReducedMass
from .parts.mechanics.piecewise import PiecewiseLinearSpring
from .parts.mechanics.profiles import FourierSeries, Harmonic, Profile, Samples
from .parts.mechanics.springs import Coupling, CubicSpring, Damper, Spring, Support
from .parts.rotors.films import JournalBearing, SqueezeFilmDamper
from .parts.rotors.gyroscopic import GyroscopicMoment
from .parts.rotors.internal import InternalDamping
from .parts.rotors.rub import Rub
from .parts.rotors.unbalance import Unbalance
from .parts.structure import Structure
from .scenes.compiling import scene
from .scenes.errors import InputError
from .scenes.laws import register_contact_law
from .scenes.model.catalogue import register_part
from .scenes.names import scene_names
from .structures.beam import beam
from .structures.campbell import Campbell, campbell
from .structures.energy import modal_energy
from .structures.files import read_matrices
from .structures.flexibility import flexibility
from .structures.matrices import Matrices
from .structures.reduction import Reduction, craig_bampton, residual_modes
from .structures.ross import ross_matrices
from .structures.shaft import ShaftDisc, shaft
from .system.compile import compile as compile
from .system.compiled import CompiledSystem
from .system.splitting import condensed, structure_of

__all__ = [
    "Assembly",
    "Backlash",
    "BaseMotion",
    "Campbell",
    "CompiledSystem",
    "CompilerError",
    "ConstantForce",
    "ContactDamping",
    "ContactLaw",
    "ContactPair",
    "Coordinate",
    "CoulombFriction",
    "Coupling",
    "CubicDamper",
    "CubicSpring",
    "Damper",
    "ElasticContact",
    "Equations",
    "FourierSeries",
    "FrequencyResponse",
    "Gap",
    "GearMesh",
    "GyroscopicMoment",
    "Harmonic",
    "HarmonicForce",
    "Hertz",
    "HertzLaw",
    "HuntCrossleyStop",
    "InputError",
    "IntegrationError",
    "InternalDamping",
    "Iwan",
    "Jenkins",
    "JournalBearing",
    "Kernels",
    "LubricantFilm",
    "Mass",
    "Matrices",
    "Model",
    "Modes",
    "NoRestError",
    "NormalLoad",
    "OneSidedSpring",
    "PalmgrenLaw",
    "Parameter",
    "Part",
    "PeriodicForce",
    "PiecewiseLinearSpring",
    "Preload",
    "Profile",
    "RaceWave",
    "RampedWaviness",
    "ReducedMass",
    "Reduction",
    "RigidStop",
    "RollingBearing",
    "Rub",
    "Samples",
    "ShaftDisc",
    "Simulation",
    "SimulationInterrupted",
    "Spring",
    "SqueezeFilm",
    "SqueezeFilmDamper",
    "Stop",
    "Structure",
    "Support",
    "TanhFriction",
    "TransmissionError",
    "Unbalance",
    "Variable",
    "VaryingSpring",
    "Waviness",
    "beam",
    "campbell",
    "combine",
    "condensed",
    "coordinate",
    "coordinates",
    "craig_bampton",
    "films",
    "flexibility",
    "functions",
    "modal_energy",
    "modes",
    "parameter",
    "read_matrices",
    "register_contact_law",
    "register_part",
    "residual_modes",
    "resonance",
    "response",
    "ross_matrices",
    "scene",
    "scene_names",
    "shaft",
    "simulate",
    "structure_of",
]
__version__: str
