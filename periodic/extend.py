"""What a system, discretisation, linear solver, condition or special point of one's own is written with.

`tests/howto/` has one of each.
"""

from periodic.bifurcations.switching import repeated, switched
from periodic.bifurcations.testfunction import TestFunction
from periodic.correction.condition import Condition, SideCondition
from periodic.correction.discretisation import Discretisation
from periodic.correction.error import ErrorEstimate, Halving, deferred
from periodic.correction.newton import Correction
from periodic.correction.refinement import Refinement
from periodic.correction.solution import Solution
from periodic.linear.bordering import Chain
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment, Unknowns
from periodic.orbit.construction import at_rest, transfer
from periodic.orbit.mesh import Mesh, uniform
from periodic.orbit.row import Row
from periodic.stability.multipliers import Spectrum
from periodic.system import LinearisationLike, System

__all__ = [
    "Chain",
    "Condition",
    "Correction",
    "Discretisation",
    "ErrorEstimate",
    "Halving",
    "Increment",
    "LinearisationLike",
    "Mesh",
    "Operator",
    "Refinement",
    "Row",
    "SideCondition",
    "Solution",
    "Spectrum",
    "System",
    "TestFunction",
    "Unknowns",
    "at_rest",
    "deferred",
    "repeated",
    "switched",
    "transfer",
    "uniform",
]
