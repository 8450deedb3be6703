"""What a periodic orbit is: collocation, continuation, stability. Knows only the `System` protocol."""

from periodic.branch import Branch, BranchFileError
from periodic.closure import Conservative, PhaseCondition
from periodic.conditions import Level, Peak
from periodic.continuation import Run
from periodic.curves import DoublingCondition, FoldCondition, TorusCondition
from periodic.equilibria import equilibria
from periodic.functionals import (
    Amplitude,
    Component,
    Maximum,
    Minimum,
    Multiplier,
    PeakToPeak,
    PhaseLag,
    Value,
    mean,
)
from periodic.journal import JournalError, recovered
from periodic.label import Label
from periodic.measure import extrema, outputs
from periodic.methods.collocation import Collocation
from periodic.methods.harmonic import HarmonicBalance
from periodic.methods.shooting import Shooting
from periodic.newton import NewtonSettings
from periodic.normalform import first_lyapunov
from periodic.onset import eigenvalues, hopf, mode
from periodic.orbit import Orbit
from periodic.plotting import plot
from periodic.point import Point
from periodic.sampling import sampled
from periodic.scheme import Family, Scheme
from periodic.sensitivity import sensitivities
from periodic.settings import Accuracy, MeshSettings, Settings, StepSettings
from periodic.stop import Reason, Stop
from periodic.switching import SwitchError, branched, doubled
from periodic.system import System
from periodic.tracing import ResumeError, trace

__all__ = [
    "Accuracy",
    "Amplitude",
    "Component",
    "DoublingCondition",
    "FoldCondition",
    "Level",
    "Maximum",
    "Minimum",
    "Multiplier",
    "Peak",
    "PeakToPeak",
    "PhaseLag",
    "TorusCondition",
    "Value",
    "mean",
    "sensitivities",
    "Branch",
    "BranchFileError",
    "Collocation",
    "Conservative",
    "Family",
    "HarmonicBalance",
    "JournalError",
    "Label",
    "MeshSettings",
    "NewtonSettings",
    "Orbit",
    "PhaseCondition",
    "Point",
    "Reason",
    "ResumeError",
    "Run",
    "Scheme",
    "Settings",
    "Shooting",
    "StepSettings",
    "Stop",
    "SwitchError",
    "System",
    "branched",
    "doubled",
    "eigenvalues",
    "equilibria",
    "extrema",
    "first_lyapunov",
    "hopf",
    "mode",
    "outputs",
    "plot",
    "recovered",
    "sampled",
    "trace",
]
