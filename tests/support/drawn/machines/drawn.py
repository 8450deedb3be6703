"""All families, and the machine of a seed."""

from __future__ import annotations

import zlib
from collections.abc import Callable

import numpy as np

from support.drawn.machines import bearings, gears, ross, rotors, structures
from support.drawn.machines.machine import Machine, Random

FAMILIES: dict[str, Callable[[Random], Machine]] = {
    "ball bearings": bearings.balls,
    "roller bearings": bearings.rollers,
    "gear pairs": gears.pair,
    "gears on two shafts": gears.wheels,
    "journal bearings": rotors.journals,
    "squeeze-film dampers": rotors.dampers,
    "rubs": rotors.rubs,
    "shafts in films": rotors.shafts,
    "shafts of ROSS": ross.shafts,
    "friction dampers": structures.friction,
    "beams with stops": structures.beams,
}


def machine(family: str, seed: int) -> Machine:
    """Return the machine of a seed."""
    return FAMILIES[family](np.random.default_rng([seed, zlib.crc32(family.encode())]))
