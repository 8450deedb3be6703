"""Cantilevers with something at their tips: EI = rho A = L = 1, damped in its modes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import symbolic as sym


def cantilever(
    elements: int,
    at_tip: Callable[[Any], Sequence[sym.Part]],
    *,
    condense: bool = True,
    force: float = 0.1,
    **given: Any,
) -> sym.CompiledSystem:
    """A cantilever of so many elements with parts at its tip, driven there by a harmonic force."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=elements)
    structure = sym.Structure(beam, **{"damping": 0.01, **given})
    tip = structure["tip"]
    parts = [structure, *at_tip(tip), sym.HarmonicForce(tip, force, 3.0)]
    return sym.compile(sym.combine(parts), condense=condense)


def cubic(tip: Any) -> list[sym.Part]:
    """A cubic spring ten times as stiff as the beam at a deflection of 1."""
    return [sym.CubicSpring(tip, 30.0)]
