"""Periodic orbits: collocation, continuation, stability, special points. Knows only the `System` protocol."""

from .bifurcations.hopf import eigenvalues, hopf, mode
from .bifurcations.label import Label
from .bifurcations.switching import SwitchError, branched, doubled
from .bifurcations.testfunction import TestFunction
from .collocation.method import Collocation
from .condensed.whole.motion import motion
from .condensed.whole.recovery import recovery
from .conditions.augmented import DoublingCondition, FoldCondition, HopfCondition, TorusCondition
from .conditions.extremes import Maximum, Minimum, PeakToPeak
from .conditions.functionals import Amplitude, Component, Multiplier, PhaseLag, Value, mean
from .conditions.grazing import GrazingCondition
from .conditions.levels import Level, Peak
from .conditions.phase import Conservative, PhaseCondition
from .conditions.sensitivity import sensitivities
from .conditions.unstable import unstable
from .correction.condition import Condition, Given, SideCondition
from .correction.discretisation import Discretisation
from .correction.newton import NewtonSettings
from .correction.problem import Problem
from .correction.solution import Solution
from .correction.tolerance import Accuracy, Tolerance
from .equilibrium.method import Equilibrium
from .equilibrium.normalform import first_lyapunov
from .events.tying import KinkSettings
from .harmonic.method import HarmonicBalance
from .linear.operator import Operator
from .linear.unknowns import Increment, Unknowns
from .maps.adaptive import Adaptive
from .maps.grid import Grid
from .maps.map import MapInterrupted, MapStoppedError, map
from .maps.numbers.extremes import Highest, Lowest
from .maps.numbers.places import Places, StableRanges
from .maps.numbers.sheets import Sheets
from .maps.progress import Progress
from .maps.store import MapFileError
from .maps.task import Number, Task
from .orbit.extrema import extrema, outputs
from .orbit.orbit import Orbit
from .orbit.row import Row
from .orbit.sampling import sampled
from .orbit.scheme import Family, Scheme
from .results.branch import Branch
from .results.export.export import export
from .results.interactive.page import page
from .results.journal import JournalError, recovered
from .results.netcdf import BranchFileError
from .results.plots.branch import plot
from .results.plots.campbell import plot_campbell
from .results.plots.motion import plot_orbit, plot_phase, plot_spectrum
from .results.plots.multipliers import plot_multipliers
from .results.plots.regions import plot_regions
from .results.plots.waterfall import plot_waterfall
from .results.point import Point
from .results.stop import Reason, Stop
from .shooting.method import Shooting
from .system import System
from .tori.invariant import Torus
from .tori.torus import TorusError, torus
from .tracing.continuation import Continuation
from .tracing.equilibria import equilibria
from .tracing.resumption import Interrupted, ResumeError
from .tracing.steps.stepsize import ArclengthControl
from .tracing.trace import continuation, trace
from .tracing.watch import Watch

__all__ = [
    "Accuracy",
    "Adaptive",
    "Amplitude",
    "ArclengthControl",
    "Branch",
    "BranchFileError",
    "Collocation",
    "Component",
    "Condition",
    "Conservative",
    "Continuation",
    "Discretisation",
    "DoublingCondition",
    "Equilibrium",
    "Family",
    "FoldCondition",
    "Given",
    "GrazingCondition",
    "Grid",
    "HarmonicBalance",
    "HopfCondition",
    "Highest",
    "Increment",
    "Interrupted",
    "JournalError",
    "KinkSettings",
    "Label",
    "Level",
    "Lowest",
    "MapFileError",
    "MapInterrupted",
    "MapStoppedError",
    "Maximum",
    "Minimum",
    "Multiplier",
    "NewtonSettings",
    "Number",
    "Operator",
    "Orbit",
    "Peak",
    "PeakToPeak",
    "PhaseCondition",
    "PhaseLag",
    "Places",
    "Point",
    "Problem",
    "Progress",
    "Reason",
    "ResumeError",
    "Row",
    "Scheme",
    "Sheets",
    "Shooting",
    "SideCondition",
    "Solution",
    "StableRanges",
    "Stop",
    "SwitchError",
    "System",
    "Task",
    "TestFunction",
    "Tolerance",
    "Torus",
    "TorusCondition",
    "TorusError",
    "Unknowns",
    "Value",
    "Watch",
    "branched",
    "continuation",
    "doubled",
    "eigenvalues",
    "equilibria",
    "export",
    "extrema",
    "first_lyapunov",
    "hopf",
    "map",
    "mean",
    "mode",
    "motion",
    "outputs",
    "page",
    "plot",
    "plot_campbell",
    "plot_multipliers",
    "plot_orbit",
    "plot_phase",
    "plot_regions",
    "plot_spectrum",
    "plot_waterfall",
    "recovered",
    "recovery",
    "sampled",
    "sensitivities",
    "torus",
    "trace",
    "unstable",
]
__version__: str
