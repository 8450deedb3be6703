"""Kinks and jumps of a model's equations: where fmax, fmin, fabs, sign and if_else pass from one branch to
the other.

Each of them has a switching argument s, and the equations are smooth on either side of s = 0, see
`symbolic.equations.branches`. Arguments of parameters alone are constant along a motion; those with a rate or
an algebraic unknown in them are no functions of state and phase: there the mesh has to resolve the kink, and
the error estimate tells how well it does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import replace

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.branches import Traits, switching
from symbolic.equations.packed import Packed
from symbolic.equations.samples import Samples, constant, multiples
from symbolic.equations.variables import SwitchInfo

LONG = 40
"""Longest expression (letters) that is the name of its switch."""


def find(assembly: Assembly) -> None:
    """Add to an assembly the switches of its equations that no part has declared.

    Multiples of a switch that is there already are the same switch.

    Parameters
    ----------
    assembly : Assembly
        The assembly of a model, with all its parts, and closed.
    """
    forces = [motion.force for motion in assembly.motions.values()]
    rows = ca.vertcat(ca.SX(0, 1), *forces, *assembly.differential_rows, *assembly.algebraic_rows)
    candidates = switching(rows, _traits(assembly))
    if not candidates and not assembly.relays:
        return
    assembly.with_frequency(assembly.omega)  # an omega of its own is a parameter like any other
    samples = Samples(Packed(assembly))
    _check_relays(assembly, samples)
    usable = _hashes(_moving(assembly)) | _hashes(_fixed(assembly))
    smooth = [s for s in assembly.smooth if _hashes(ca.symvar(s)) <= usable]
    special = {*assembly.sliders, *assembly.relays}
    declared = [s for k, (_, s) in enumerate(assembly.switches) if k not in special]
    values = samples.values([*declared, *smooth, *candidates])
    first = len(values) - len(candidates)
    known, new = values[:first], values[first:]
    for argument, found in zip(candidates, new, strict=True):
        if not constant(found) and not any(multiples(found, other) for other in known):
            known.append(found)
            name = _unused(_written(assembly, argument), [info.name for info, _ in assembly.switches])
            assembly.switches.append((SwitchInfo(name, 0), argument / samples.size(argument)))


def _check_relays(assembly: Assembly, samples: Samples) -> None:
    """Name relays by what they compare, and scale them. Raises ValueError for what is no relay."""
    usable = _hashes(_moving(assembly)) | _hashes(_fixed(assembly))
    for k, relay in assembly.relays.items():
        text = _written(assembly, relay.over)
        if _hashes(ca.symvar(ca.vertcat(relay.over, relay.under))) - usable:
            raise ValueError(
                f"the relay at {text} = 0 depends on rates or unknowns; it must compare functions of states, "
                f"phase and parameters"
            )
        over, under = samples.values([relay.over, relay.under])
        if constant(over):
            raise ValueError(f"the relay at {text} = 0 never switches; it must compare what moves")
        if not (over[0] < under[0]).all():
            raise ValueError(f"off of the relay at {text} = 0 is not less than on; it must be")
        size = samples.size(relay.over)
        assembly.relays[k] = replace(relay, over=relay.over / size, under=relay.under / size)
        name = _unused(f"relay at {text}", [info.name for info, _ in assembly.switches])
        assembly.switches[k] = SwitchInfo(name, 0), relay.over / size


def _moving(assembly: Assembly) -> list[ca.SX]:
    excitation = assembly.excitation
    waves = [excitation.symbols[k] for k in range(excitation.symbols.numel())]
    return [*(s.symbol for s in assembly.states), excitation.angle, *waves]


def _fixed(assembly: Assembly) -> list[ca.SX]:
    numbers = [n.parameter.symbol for n in assembly.numbers.taken]
    numbers += [relay.symbol for relay in assembly.relays.values()]  # it jumps at an event of its own
    return [*numbers, assembly.omega, assembly.excitation.pace]


def _traits(assembly: Assembly) -> Callable[[ca.SX], Traits]:
    """The sign of a symbol as far as it is known; a parameter is positive where its nominal value is."""
    moving, fixed = _hashes(_moving(assembly)), _hashes(_fixed(assembly))
    positive = _hashes(n.parameter.symbol for n in assembly.numbers.taken if n.parameter.value > 0)

    def given(symbol: ca.SX) -> Traits:
        key = symbol.element_hash()
        if key in moving:
            return Traits.MOVING
        if key in fixed:
            return Traits.POSITIVE if key in positive else Traits.NONE
        return Traits.OTHER

    return given


def _hashes(symbols: Iterable[ca.SX]) -> set[int]:
    return {symbol.element_hash() for symbol in symbols}


def _written(assembly: Assembly, argument: ca.SX) -> str:
    """The text of an argument, "x - 1"; of a long one the names of its variables."""
    text = str(argument)
    for motion in assembly.motions.values():
        text = text.replace(f"(omega*{motion.velocity.name})", f"d{motion.position.name}/dt")
    text = re.sub(r"(sin|cos)_(\S+?)_theta", r"\1 \2 theta", re.sub(r"(?<=\d)\.(?!\d)", "", text))
    text = text.replace(" 1 theta", " theta")
    text = re.sub(r"(?<=[^e(])([-+])", r" \1 ", text)
    if text.startswith("(") and text.endswith(")") and _matching(text) == len(text) - 1:
        text = text[1:-1]
    if "@" not in text and len(text) <= LONG:
        return text
    used = _hashes(ca.symvar(argument))
    names = [s.name for s in assembly.states if s.symbol.element_hash() in used]
    excited = len(used & _hashes(_moving(assembly))) > len(names)
    return "kink in " + ", ".join([*names, *(["theta"] if excited else [])])


def _matching(text: str) -> int:
    """Where the parenthesis closes that a text begins with."""
    depth = 0
    for place, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if depth == 0:
            return place
    return -1


def _unused(name: str, names: list[str]) -> str:
    """The name, with a number added where it is taken."""
    taken = [name, *(f"{name} ({k})" for k in range(2, len(names) + 2))]
    return next(each for each in taken if each not in names)
