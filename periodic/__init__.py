"""Periodic orbits: collocation, continuation, stability, special points. Knows only the `System` protocol."""

from importlib.metadata import version

from periodic.bifurcations.hopf import eigenvalues, hopf, mode
from periodic.bifurcations.label import Label
from periodic.bifurcations.normalform import first_lyapunov
from periodic.bifurcations.switching import SwitchError, branched, doubled
from periodic.bifurcations.testfunction import TestFunction
from periodic.collocation.kinks import KinkSettings
from periodic.collocation.method import Collocation
from periodic.condensed.motion import motion
from periodic.condensed.recovery import recovery
from periodic.conditions.augmented import DoublingCondition, FoldCondition, HopfCondition, TorusCondition
from periodic.conditions.extremes import Maximum, Minimum, PeakToPeak
from periodic.conditions.functionals import Amplitude, Component, Multiplier, PhaseLag, Value, mean
from periodic.conditions.grazing import GrazingCondition
from periodic.conditions.levels import Level, Peak
from periodic.conditions.phase import Conservative, PhaseCondition
from periodic.conditions.sensitivity import sensitivities
from periodic.conditions.unstable import unstable
from periodic.correction.condition import Condition, Given, SideCondition
from periodic.correction.discretisation import Discretisation
from periodic.correction.newton import NewtonSettings
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.equilibrium.method import Equilibrium
from periodic.harmonic.method import HarmonicBalance
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment, Unknowns
from periodic.maps.adaptive import Adaptive
from periodic.maps.grid import Grid
from periodic.maps.map import MapInterrupted, MapStoppedError, map
from periodic.maps.numbers.extremes import Highest, Lowest
from periodic.maps.numbers.places import Places, StableRanges
from periodic.maps.numbers.sheets import Sheets
from periodic.maps.progress import Progress
from periodic.maps.store import MapFileError
from periodic.maps.task import Number, Task
from periodic.orbit.extrema import extrema, outputs
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.sampling import sampled
from periodic.orbit.scheme import Family, Scheme
from periodic.results.branch import Branch
from periodic.results.export.export import export
from periodic.results.interactive.page import page
from periodic.results.journal import JournalError, recovered
from periodic.results.netcdf import BranchFileError
from periodic.results.plots.branch import plot
from periodic.results.plots.campbell import plot_campbell
from periodic.results.plots.motion import plot_orbit, plot_phase, plot_spectrum
from periodic.results.plots.multipliers import plot_multipliers
from periodic.results.plots.regions import plot_regions
from periodic.results.plots.waterfall import plot_waterfall
from periodic.results.point import Point
from periodic.results.stop import Reason, Stop
from periodic.shooting.method import Shooting
from periodic.system import System
from periodic.tori.invariant import Torus
from periodic.tori.torus import TorusError, torus
from periodic.tracing.continuation import Continuation
from periodic.tracing.equilibria import equilibria
from periodic.tracing.resumption import Interrupted, ResumeError
from periodic.tracing.stepsize import ArclengthControl
from periodic.tracing.trace import continuation, trace
from periodic.tracing.watch import Watch

__all__ = [
    "__version__",
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


__version__ = version("orbitrace")


def __dir__() -> list[str]:
    return __all__
