"""The report on machines: one section for each, and the films."""

from __future__ import annotations

from pathlib import Path

from reports.studies.machines import bearings, friction, gears, rotors
from reports.studies.machines.cylinder import CYLINDER
from reports.studies.machines.films import FILMS
from reports.studies.pages.page import Page

MACHINES = {
    machine.key: machine
    for machine in (
        gears.GEAR,
        bearings.DRY,
        bearings.OILED,
        rotors.INTERNAL,
        rotors.RUB,
        rotors.JOURNAL,
        rotors.SQUEEZE,
        friction.SMOOTH,
        friction.SLIDER,
        friction.STOP,
        friction.IMPACT,
        friction.BEAM,
        CYLINDER,
    )
}

REPORT = Page(
    name="machines",
    folder=Path(__file__).parent,
    sections={key: machine.section for key, machine in MACHINES.items()} | {"films": FILMS},
)
