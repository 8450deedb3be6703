"""What a periodic orbit is: collocation, continuation, stability. Knows only the `System` protocol."""

from periodic.branch import Branch, BranchFileError
from periodic.closure import PhaseCondition
from periodic.continuation import Run
from periodic.measure import extrema, outputs
from periodic.methods.collocation import Collocation
from periodic.methods.harmonic import HarmonicBalance
from periodic.newton import NewtonSettings
from periodic.orbit import Orbit
from periodic.plotting import plot
from periodic.point import Label, Point
from periodic.sampling import sampled
from periodic.scheme import Family, Scheme
from periodic.settings import Accuracy, MeshSettings, Settings, StepSettings
from periodic.stop import Reason, Stop
from periodic.switching import SwitchError, branched, doubled
from periodic.system import System
from periodic.tracing import trace

__all__ = [
    "Accuracy",
    "Branch",
    "BranchFileError",
    "Collocation",
    "Family",
    "HarmonicBalance",
    "Label",
    "MeshSettings",
    "NewtonSettings",
    "Orbit",
    "PhaseCondition",
    "Point",
    "Reason",
    "Run",
    "Scheme",
    "Settings",
    "StepSettings",
    "Stop",
    "SwitchError",
    "System",
    "branched",
    "doubled",
    "extrema",
    "outputs",
    "plot",
    "sampled",
    "trace",
]
