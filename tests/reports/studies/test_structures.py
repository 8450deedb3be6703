"""The report on structures: its numbers are those of the code, its methods agree, its cost does not grow."""

from __future__ import annotations

import re

import pytest

from reports.studies.pages.page import PAGE
from reports.studies.pages.text import FIGURES
from reports.studies.structures import accuracy, chain, modes, peer, rotor, size
from reports.studies.structures.page import REPORT

pytestmark = pytest.mark.studies

FOLDER = REPORT.folder


def test_methods_agree() -> None:
    """Assert that the peaks kept of each method are one number to 9 digits."""
    rows = REPORT.kept(FOLDER)["accuracy"].rows
    assert [row["method"] for row in rows] == list(accuracy.METHODS)
    for row in rows[1:]:
        assert row["swings"] == pytest.approx(rows[0]["swings"], rel=1e-9)


def test_accuracy_is_fresh() -> None:
    """Assert that harmonic balance traced anew has the peaks of the page, to 9 digits."""
    kept = next(r for r in REPORT.kept(FOLDER)["accuracy"].rows if r["method"].endswith("balance, condensed"))
    assert accuracy.swings("harmonic balance, condensed") == pytest.approx(kept["swings"], rel=1e-9)


def test_size_is_fresh() -> None:
    """Assert the folds of 20 degrees of freedom anew to 1e-8, and that no size needs more points."""
    rows = [row for row in REPORT.kept(FOLDER)["size"].rows if row["method"] == size.CONDENSED]
    kept = next(row for row in rows if row["freedoms"] == 20)
    assert size.row(size.CONDENSED, 10)["folds"] == pytest.approx(kept["folds"], rel=1e-8)
    assert max(row["points"] for row in rows) < 1.4 * min(row["points"] for row in rows)
    assert {row["unknown"] for row in rows} == {2}


def test_twenty_thousand_freedoms_are_kept() -> None:
    """Assert the folds of 20 000 degrees of freedom against those reduced, and their cost beside 20's.

    And that fewer elements in plane stress have both folds to 1 %, anew.
    """
    kept = REPORT.kept(FOLDER)["size"].rows
    full, reduced = (next(r for r in reversed(kept) if r["method"] == m) for m in (size.PLANE, size.REDUCED))
    assert full["freedoms"] == reduced["freedoms"] == 20160
    assert full["folds"] == pytest.approx(reduced["folds"], rel=1e-6)
    few = next(r for r in kept if r["method"] == size.CONDENSED and r["freedoms"] == 20)
    assert full["ms"] < 2 * few["ms"]
    anew = size.branch(size.of_reduced(8), size.METHODS[size.REDUCED].discretisation)
    assert [point.parameter for point in anew.labelled("LP")] == pytest.approx(full["folds"], rel=0.01)


def test_chain_is_fresh() -> None:
    """Assert that all ways have the folds of ten oscillators to 1e-6, and who is quicker; one anew, 1e-8."""
    rows = REPORT.kept(FOLDER)["chain"].rows
    kept = next(r for r in rows if r["way"] == chain.CONDENSED and r["states"] == 20)
    for row in (r for r in rows if r["states"] == 20):
        assert sorted(row["folds"]) == pytest.approx(sorted(kept["folds"]), rel=1e-6)
    assert chain.own(10, chain.CONDENSED)["folds"] == pytest.approx(kept["folds"], rel=1e-8)
    seconds = {r["way"]: r["s"] for r in rows if r["states"] == 50}
    assert 3 * seconds[chain.CONDENSED] < seconds[chain.WHOLE]
    assert 15 * seconds[chain.CONDENSED] < seconds[chain.AUTO]


def test_peer_is_fresh() -> None:
    """Assert our folds anew to 1e-8, that pyHarm has them to 3e-4, and who is quicker."""
    rows = [row for row in REPORT.kept(FOLDER)["peer"].rows if row["method"] != "version"]
    for row in rows:
        first = next(r for r in rows if r["freedoms"] == row["freedoms"])
        assert row["folds"] == pytest.approx(first["folds"], rel=3e-4)
    ours, _, its = rows[-3:]
    kept = next(r for r in rows if r["freedoms"] == 20)
    assert peer.own(10, ours["method"])["folds"] == pytest.approx(kept["folds"], rel=1e-8)
    assert rows[2]["s"] < rows[0]["s"] and its["s"] > 30 * ours["s"]


def test_stop_is_fresh() -> None:
    """Assert grazing and folds of the stop, 20 degrees of freedom, to 1e-6, and the truths that are kept."""
    kept = REPORT.kept(FOLDER)["modes"]
    first = next(row for row in kept.rows if row["name"] == "stop")
    found = modes.row("stop", modes.CASES["stop"].elements[0])["special"]
    assert [label for label, _ in found] == [label for label, _ in first["special"]]
    assert [at for _, at in found] == pytest.approx([at for _, at in first["special"]], rel=1e-6)
    for name, value in kept.numbers.items():
        assert value < modes.CASES[name.split(":")[0]].tolerance


@pytest.mark.long
def test_rotor_is_fresh() -> None:
    """Assert the special points of three rotors anew to 1e-7, those of the rub and the film to 1e-6."""
    hardening, rub, film = REPORT.kept(FOLDER)["rotor"].rows
    ends, ring = rotor.ELEMENTS, rotor.DISCS[1]
    made = (
        (hardening, rotor.system(rotor.reduced(ends)), 1e-7),
        (rub, rotor.rubbing(rotor.reduced(ring)), 1e-6),
        (film, rotor.floating(rotor.reduced(ring, ends, bearings=(0,), kept=rotor.FEW)), 1e-6),
    )
    for row, system, close in made:
        found = rotor.special(rotor.branch(system))
        assert [label for label, _ in found] == [label for label, _ in row["special"]]
        assert [at for _, at in found] == pytest.approx([at for _, at in row["special"]], rel=close)


def test_page_is_that_of_its_sections() -> None:
    """Assert that text and numbers on the page are those of the code, that nothing is missing or too much."""
    page = (FOLDER / PAGE).read_text("utf-8")
    assert page == REPORT.text(FOLDER)
    assert tuple(REPORT.kept(FOLDER)) == tuple(REPORT.sections)
    shown = re.findall(rf"\]\({FIGURES}/([\w-]+\.png)\)", page)
    assert sorted(shown) == sorted(file.name for file in (FOLDER / FIGURES).iterdir())
