"""Time histories of the paper: what its Figs. 5 to 8 are compared with."""

import math
import re
from functools import cache

import numpy as np
import pytest

from reports.studies.pages.content import Found
from reports.studies.paper import timedomain
from reports.studies.paper.common.discs import OIL_A as A
from reports.studies.paper.common.discs import OIL_B as B
from reports.studies.paper.marching.histories import (
    DURATION,
    decay,
    free_part,
    orbit_decay,
    ripple,
    settled,
    spectrum,
    stepped,
    trusted,
)
from reports.studies.paper.page import REPORT
from reports.studies.paper.rows import Verdict, rows

pytestmark = pytest.mark.studies


@cache
def section() -> Found:
    """Return the section, computed once."""
    return timedomain.compute(lambda what: None)


@pytest.mark.long
@pytest.mark.parametrize(
    ("key", "value", "accuracy"),
    [
        ("deflection_um", 9.4236, 1e-4),
        ("film_h0_um", 3.85, 1e-4),
        ("oil_a_film_um", 0.12203, 1e-3),
        ("oil_a_deflection_um", 6.3225, 1e-4),
        ("oil_a_x_um", 3.865414, 1e-6),
        ("heavy_x_um", 12.3598, 1e-4),
        ("heavy_fig8_x_um", 14.76, 1e-3),
        ("oil_a_fig6b_x_um", 4.275, 1e-3),
        ("oil_b_fig7_x_um", 7.43, 2e-3),
        ("oil_a_rest_Hz", 561.425, 1e-5),
        ("oil_a_free_Hz", 554.8, 2e-3),
        ("oil_a_settled_s", 0.199, 2e-2),
        ("oil_b_settled_s", 8.19, 1e-2),
    ],
)
def test_key_numbers(key: str, value: float, accuracy: float) -> None:
    """Assert the section's key numbers as far as they are known."""
    assert section().numbers[key] == pytest.approx(value, rel=accuracy)


@pytest.mark.long
@pytest.mark.parametrize("disc", ["oil_a", "heavy", "oil_b"])
def test_decay_is_that_of_the_multiplier(disc: str) -> None:
    """Assert that the free motion dies out as fast as collocation's largest multiplier says."""
    n = section().numbers
    assert n[f"{disc}_decay_per_s"] == pytest.approx(n[f"{disc}_orbit_decay_per_s"], rel=5e-3)


@pytest.mark.long
@pytest.mark.parametrize("disc", ["oil_a", "heavy", "oil_b"])
def test_forced_line(disc: str) -> None:
    """Assert that one of the two lines of the spectrum is the excitation's, to a bin of 1.25 Hz."""
    assert section().numbers[f"{disc}_forced_Hz"] == pytest.approx(720, abs=1.25)


@pytest.mark.long
def test_verdicts() -> None:
    """Assert what the first table says of each number of the paper."""
    assert {row.key: row.verdict for row in rows("timedomain", section().numbers)} == {
        "P1": "reproduced within 3 %",
        "P2": Verdict.NOT_COMPARABLE.value,
        "P3": Verdict.NOT_REPRODUCED.value,
        "P4": "reproduced within 3 %",
        "P5": Verdict.REPRODUCED.value,
        "P6": "reproduced within 2 %",
        "P7": Verdict.REPRODUCED.value,
        "P12": Verdict.REPRODUCED.value,
    }


@pytest.mark.long
def test_figures_are_those_of_the_text() -> None:
    """Assert that the text shows each figure once."""
    text = REPORT.told("timedomain", section().kept())
    assert sorted(re.findall(r"\]\(figures/([\w-]+)\.png\)", text)) == sorted(section().figures)


def test_integration_ends_on_the_periodic_orbit() -> None:
    """Assert that at the end of its history oil A moves on the orbit that collocation found."""
    late = trusted(A, 0.5).during(0.49, 0.5)
    assert np.abs(free_part(A, late)).max() < 1e-4 * settled(A).peak_to_peak("x")
    assert ripple(late.film) == pytest.approx(settled(A).peak_to_peak("film"), rel=1e-3)


def test_paper_step_follows_cvodes() -> None:
    """Assert that 0.1 ms is short enough for oil A at 360 rev/min: p-p of x to 0.5 % over the beats."""
    ours, paper = trusted(A, 0.5).during(0, 0.09), stepped(A, 0.09)
    assert ripple(paper.x) == pytest.approx(ripple(ours.x), rel=5e-3)


def test_spectrum_of_two_sines() -> None:
    """Assert that two lines of known frequency and amplitude are found."""
    history = trusted(A, 0.5).during(0, 0.2)
    time = history.time
    x = 2.0 * np.sin(2 * math.pi * 560 * time) + np.sin(2 * math.pi * 720 * time)
    made = type(history)(time=time, x=x, film=x, deflection=x, load=x)
    found = spectrum(made, 0.1)
    assert found.peaks == (pytest.approx(560, abs=1.3), pytest.approx(720, abs=1.3))
    assert found.amplitude.max() == pytest.approx(2.0, rel=0.02)


@pytest.mark.long
def test_thin_oil_is_not_settled_after_a_second() -> None:
    """Assert that oil B still swings 1.8 times its settled motion after 1 s, and decays slowly."""
    late = trusted(B, DURATION[B]).during(0.95, 1.0)
    assert ripple(late.x) > 1.8 * settled(B).peak_to_peak("x")
    assert decay(B, DURATION[B]).rate < 0.65
    assert orbit_decay(B) == pytest.approx(0.630, rel=2e-3)
