"""The report on structures: size, accuracy, nonlinear tips, a rotor."""

from __future__ import annotations

from pathlib import Path

from reports.studies.pages.page import Page
from reports.studies.structures.accuracy import ACCURACY
from reports.studies.structures.chain import ONE_OF_MANY
from reports.studies.structures.modes import MODES
from reports.studies.structures.peer import BESIDE
from reports.studies.structures.rotor import ROTOR
from reports.studies.structures.size import SIZE
from reports.studies.structures.tips import TIPS

REPORT = Page(
    name="structures",
    folder=Path(__file__).parent,
    sections={
        "size": SIZE,
        "accuracy": ACCURACY,
        "peer": BESIDE,
        "chain": ONE_OF_MANY,
        "tips": TIPS,
        "modes": MODES,
        "rotor": ROTOR,
    },
)
