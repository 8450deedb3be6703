"""The cantilever of the report: EI = rho A = L = 1, ten elements or so many, driven at its tip."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import symbolic as sym

FORCE = 0.1
"""Amplitude of the force at the tip."""

Tip = Callable[[Any], sym.Part]
"""What is attached to the tip."""


def cubic(tip: Any) -> sym.Part:
    """A cubic spring, ten times as stiff as the beam's tip at a deflection of 1."""
    return sym.CubicSpring(tip, 30.0)


def cantilever(
    elements: int, part: Tip, *, condense: bool = True, force: float = FORCE
) -> sym.CompiledSystem:
    """Return the compiled cantilever, damped by 1 % in each mode."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=elements)
    structure = sym.Structure(beam, damping=0.01)
    tip = structure["tip"]
    model = structure + part(tip) + sym.HarmonicForce(tip, force, 3.0)
    return sym.compile(model, condense=condense)
