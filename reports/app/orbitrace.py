"""`import orbitrace`: both packages under the name that is installed, and the calls most sessions begin with.

    from orbitrace import periodic as per, symbolic as sym

The build puts this file into the wheel as the package `orbitrace` (see `pyproject.toml`).
"""

import periodic
import symbolic
from periodic import Branch, Label, design_map, page, plot, trace
from symbolic import scene, simulate

__all__ = [
    "Branch",
    "Label",
    "design_map",
    "page",
    "periodic",
    "plot",
    "scene",
    "simulate",
    "symbolic",
    "trace",
]
__version__ = periodic.__version__
