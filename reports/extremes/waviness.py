"""Section of the report: waviness of the disc, 1 nm to 100 µm."""

from __future__ import annotations

from dataclasses import replace

from reports.extremes.disc import case
from reports.extremes.study import Study
from reports.extremes.survey import Case

BASE, CAVITATING, DRY = "vitrea79-810N", "cavitating-film-810N", "dry-810N"
FILM = (1e-9, 1e-8, 1e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4)
LARGE = (1e-9, 1e-5, 3e-5, 1e-4)


def cases() -> list[Case]:
    """Return the disc with its film, then with a film that cavitates, then dry."""
    film = [case(a, {"amplitude": a}) for a in FILM]
    return film + [
        replace(case(a, {"amplitude": a}, base), way=base) for base in (CAVITATING, DRY) for a in LARGE
    ]


STUDY = Study(
    key="waviness",
    title="Waviness",
    quantity="amplitude",
    unit="m",
    cases=cases,
    lead="""\
The static deflection is 9.4 µm: from about 10 µm on the discs leave each wave. The film of the scene never
cavitates, so the discs do not part: a thicker film forms, on which they hover the higher the larger the
waves, and beyond some 20 µm that height grows without measure; nothing near rest is an orbit. The film
that cavitates knows no such limit, nor does the dry contact.""",
    quick=(1e-8, 1e-7),
)
section = STUDY.section
