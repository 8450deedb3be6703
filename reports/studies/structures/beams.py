"""The cantilever of the report: EI = rho A = L = 1, ten elements or so many, driven at its tip."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import symbolic as sym

FORCE = 0.1
"""Amplitude of the force at the tip."""

CUBIC = 30.0
"""Stiffness of the cubic spring at the tip, ten times the beam's tip at a deflection of 1."""

DAMPING = 0.01
"""Of critical, in each mode."""

Tip = Callable[[Any], sym.Part]
"""What is attached to the tip."""


def cubic(tip: Any) -> sym.Part:
    """The cubic spring."""
    return sym.CubicSpring(tip, CUBIC)


def beam(elements: int) -> sym.Matrices:
    """Return the beam's matrices."""
    return sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=elements)


def cantilever(
    elements: int, part: Tip, *, condense: bool = True, force: float = FORCE
) -> sym.CompiledSystem:
    """Return the compiled cantilever, damped by 1 % in each mode."""
    return with_tip(beam(elements), part, condense=condense, force=force)


def with_tip(
    matrices: sym.Matrices, part: Tip, *, condense: bool = True, force: float = FORCE
) -> sym.CompiledSystem:
    """Return a compiled structure, damped by 1 % in each mode, with something at its tip."""
    structure = sym.Structure(matrices, damping=DAMPING)
    tip = structure["tip"]
    model = structure + part(tip) + sym.HarmonicForce(tip, force, 3.0)
    return sym.compile(model, condense=condense)
