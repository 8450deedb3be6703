"""From measurement to decision: what models fitted to data, optimised designs and tolerances come to."""

from periodic.decisions.fitting.fitted import Fitted
from periodic.decisions.modebranch import DampingRatio, EnergyPerPeriod, shape, synthesised
from periodic.decisions.optimising.optimum import Optimum
from periodic.decisions.responses.quantity import Constraint, Quantity
from periodic.decisions.scattering.scattered import Estimate, Scattered

__all__ = [
    "Constraint",
    "DampingRatio",
    "EnergyPerPeriod",
    "Estimate",
    "Fitted",
    "Optimum",
    "Quantity",
    "Scattered",
    "shape",
    "synthesised",
]
