"""The surfaces of a compiled model: which of them each switch belongs to, and of what kind it is."""

from __future__ import annotations

from collections.abc import Sequence

from symbolic.equations.expressions import Expressions
from symbolic.equations.surfaces import Kind, Surface
from symbolic.equations.variables import SwitchInfo


def releases(expressions: Expressions, switches: int) -> dict[int, tuple[int, int]]:
    """Return the switches (up, down) at which it ends that motions slide along jumps, or sliders are held."""
    sliding = [k for k, *_ in expressions.sided.slides]
    first = switches - 2 * len(sliding) - len(expressions.resting)
    found = {k: (first + 2 * i, first + 2 * i + 1) for i, k in enumerate(sliding)}
    found |= {k: held.releases for k, held in expressions.sliders.items()}
    return dict(sorted(found.items()))


def surfaces(
    expressions: Expressions, switches: Sequence[SwitchInfo], parameters: Sequence[str]
) -> tuple[Surface, ...]:
    """Return the surfaces of a system in the order of their guards: every switch belongs to one of them.

    Parameters
    ----------
    expressions : Expressions
        The system's equations.
    switches : sequence of SwitchInfo
        Its switches.
    parameters : sequence of str
        Names of its parameters.
    """
    e, slides = expressions, releases(expressions, len(switches))
    leaves = {k: resting.leaves for k, resting in e.resting.items()}
    places = {k: (parameters.index(name), weights) for k, (name, weights) in e.places.items()}
    released = {*(k for pair in slides.values() for k in pair), *leaves.values()}
    jumps = e.sided.jumps

    def kind(k: int) -> Kind:
        if k in e.resets:
            return Kind.IMPACT
        if k in e.sliders:
            return Kind.SLIDER
        if k in e.relays:
            return Kind.RELAY
        if k in jumps:
            return Kind.SLIDING if k in slides else Kind.JUMP
        plain = switches[k].levels == (0.0,) and switches[k].direction == 0
        return Kind.KINK if plain else Kind.MARKER

    return tuple(
        Surface(
            kind(k),
            info.name,
            k,
            slides.get(k),
            jumps.index(k) if k in jumps else None,
            places.get(k) if k in slides else None,
            k in e.sided.alone,
            leaves.get(k),
        )
        for k, info in enumerate(switches)
        if k not in released
    )
