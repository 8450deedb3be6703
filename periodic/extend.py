"""What a system, discretisation, linear solver, condition or special point of one's own is written with."""

from periodic.bifurcations.testfunction import TestFunction
from periodic.correction.condition import Condition, SideCondition
from periodic.correction.discretisation import Discretisation
from periodic.correction.solution import Solution
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment, Unknowns
from periodic.orbit.row import Row
from periodic.system import System

__all__ = [
    "Condition",
    "Discretisation",
    "Increment",
    "Operator",
    "Row",
    "SideCondition",
    "Solution",
    "System",
    "TestFunction",
    "Unknowns",
]
