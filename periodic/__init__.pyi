"""Periodic orbits: collocation, continuation, stability, special points. Knows only the `System` protocol."""

from . import decisions, extend, maps, phasespace, plots, tori
from .bifurcations.hopf import eigenvalues, hopf, normal_mode
from .bifurcations.label import Label
from .bifurcations.switching import SwitchError, branched, doubled
from .collocation.collocation import Collocation
from .condensed.whole.displacements import motion
from .condensed.whole.recovery import recovery
from .conditions.extremes import Maximum, Minimum, PeakToPeak
from .conditions.functionals import Amplitude, Component, Multiplier, PhaseLag, Value, mean
from .conditions.levels import Level, Peak
from .conditions.phase import Conservative, PhaseCondition
from .conditions.sensitivity import sensitivities
from .conditions.twoparameter.augmented import DoublingCondition, FoldCondition, HopfCondition, TorusCondition
from .conditions.twoparameter.grazing import GrazingCondition
from .conditions.unstable import unstable
from .correction.condition import Given
from .correction.newton import NewtonSettings
from .correction.problem import Problem
from .correction.tolerance import Accuracy, Tolerance
from .decisions.fitting.fit import fit
from .decisions.fitting.measured import Measured, MeasuredQuantity, recorded
from .decisions.modebranch import mode_branch
from .decisions.optimising.optimise import optimise
from .decisions.responses.response import Response
from .decisions.scattering.scatter import scatter
from .equilibrium.equilibrium import Equilibrium
from .equilibrium.normalform import first_lyapunov
from .events.eventnodes import KinkSettings
from .harmonic.harmonicbalance import HarmonicBalance
from .maps.map import design_map
from .orbit.extrema import extrema, outputs
from .orbit.orbit import Orbit
from .orbit.sampling import sampled
from .orbit.scheme import Family, Scheme
from .phasespace.atlas import atlas
from .phasespace.basins import basins
from .phasespace.following.working import working
from .phasespace.lyapunov import LyapunovError, lyapunov
from .phasespace.motions import motions
from .proof.proof import Proof, proved
from .results.branch import Branch
from .results.export.export import export
from .results.interactive.page import page
from .results.journal import JournalError, recovered
from .results.netcdf import BranchFileError
from .results.plots.branch import plot
from .results.point import Point
from .results.stop import Reason, Stop
from .shooting.shooting import Shooting
from .tori.born import torus
from .tori.section import TorusError
from .tori.settled import settled_torus
from .tori.torus import Torus
from .tracing.continuation import Continuation
from .tracing.pointsat import points_at
from .tracing.resumption import Interrupted, ResumeError
from .tracing.steps.stepsize import ArclengthControl
from .tracing.trace import continuation, trace
from .tracing.watch import Watch

__all__ = [
    "Accuracy",
    "Amplitude",
    "ArclengthControl",
    "Branch",
    "BranchFileError",
    "Collocation",
    "Component",
    "Conservative",
    "Continuation",
    "DoublingCondition",
    "Equilibrium",
    "Family",
    "FoldCondition",
    "Given",
    "GrazingCondition",
    "HarmonicBalance",
    "HopfCondition",
    "Interrupted",
    "JournalError",
    "KinkSettings",
    "Label",
    "Level",
    "LyapunovError",
    "Maximum",
    "Measured",
    "MeasuredQuantity",
    "Minimum",
    "Multiplier",
    "NewtonSettings",
    "Orbit",
    "Peak",
    "PeakToPeak",
    "PhaseCondition",
    "PhaseLag",
    "Point",
    "Problem",
    "Proof",
    "Reason",
    "Response",
    "ResumeError",
    "Scheme",
    "Shooting",
    "Stop",
    "SwitchError",
    "Tolerance",
    "Torus",
    "TorusCondition",
    "TorusError",
    "Value",
    "Watch",
    "atlas",
    "basins",
    "branched",
    "continuation",
    "decisions",
    "design_map",
    "doubled",
    "eigenvalues",
    "export",
    "extend",
    "extrema",
    "first_lyapunov",
    "fit",
    "hopf",
    "lyapunov",
    "maps",
    "mean",
    "mode_branch",
    "motion",
    "motions",
    "normal_mode",
    "optimise",
    "outputs",
    "page",
    "plot",
    "phasespace",
    "plots",
    "points_at",
    "proved",
    "recorded",
    "recovered",
    "recovery",
    "sampled",
    "scatter",
    "settled_torus",
    "sensitivities",
    "tori",
    "torus",
    "trace",
    "unstable",
    "working",
]
__version__: str
