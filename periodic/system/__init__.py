"""The whole boundary between the engine and a model: what `periodic` asks of a system.

    R(x', x, z, tau, p) = 0,   ' = d/dtau

n differential rows and m algebraic rows, n states x and m unknowns z, N points at a time; x and z are
scaled to order one. A forced system has period 2 pi in tau. Any object with these members will do; a
hand-written NumPy class is as good as a compiled model.

Every system has what stands in `equations`; what a system may have besides is one file each.
"""

from periodic.system.arrays import Array, Complex
from periodic.system.compiler import Compiling, address_of, compiling
from periodic.system.derivatives import Differentiable, GradientLike, differentiable
from periodic.system.ensembles import EnsembleLike, Ensembling, FollowedLike
from periodic.system.equations import (
    Checked,
    LinearisationLike,
    SwitchLike,
    System,
    VariableLike,
    check_system,
    check_value,
    index_of,
)
from periodic.system.events import (
    HELD,
    MINUS,
    PLUS,
    STUCK,
    EventLike,
    Guarded,
    Jumping,
    Kind,
    Resetting,
    Surface,
    SurfaceLike,
    check_continuous,
    guards,
    guards_gradient,
    jumps_of,
    resets_of,
    slides_of,
    surfaces_of,
)
from periodic.system.motion import Flowing, FlowLike, Happened, Moving, TrajectoryLike
from periodic.system.split import Condensable, LinearPart, ModesLike, Split, Within, linear_of
from periodic.system.timing import Timed, frequency_factor_of, frequency_held_of, frequency_of
from periodic.system.written import Writing, WrittenLike

__all__ = [
    "HELD",
    "MINUS",
    "PLUS",
    "STUCK",
    "Array",
    "Checked",
    "Compiling",
    "Complex",
    "Condensable",
    "Differentiable",
    "EnsembleLike",
    "Ensembling",
    "EventLike",
    "FollowedLike",
    "FlowLike",
    "Flowing",
    "GradientLike",
    "Happened",
    "Guarded",
    "Jumping",
    "Kind",
    "LinearPart",
    "LinearisationLike",
    "ModesLike",
    "Moving",
    "Resetting",
    "Split",
    "Surface",
    "SurfaceLike",
    "SwitchLike",
    "System",
    "Timed",
    "TrajectoryLike",
    "VariableLike",
    "Within",
    "Writing",
    "WrittenLike",
    "address_of",
    "check_continuous",
    "check_system",
    "check_value",
    "compiling",
    "differentiable",
    "frequency_factor_of",
    "frequency_held_of",
    "frequency_of",
    "guards",
    "guards_gradient",
    "index_of",
    "jumps_of",
    "linear_of",
    "resets_of",
    "slides_of",
    "surfaces_of",
]
