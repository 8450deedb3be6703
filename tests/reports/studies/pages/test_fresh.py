"""What holds sections computed anew against a page notices each kind of difference, and no rounding."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure
from support.fresh import TIME, assert_fresh, differences

from reports.studies.pages.content import Found, Section
from reports.studies.pages.page import Page

KEPT = {
    "fold": 0.5981531,
    "s": 2.0,
    "rows": [{"label": "LP", "at": [1.0, -2.0]}, {"label": "GR at 1.25", "at": []}],
}


def changed(**values: Any) -> dict[str, Any]:
    return KEPT | values


def found(**values: Any) -> list[str]:
    """Return the places that differ, times left out and numbers to 1e-6."""
    told = differences(changed(**values), KEPT, {"/s$": TIME, "/at/": 1e-3}, 1e-6)
    return [line.partition(":")[0] for line in told]


def test_what_is_no_difference() -> None:
    """Assert that rounding, times and numbers known to few digits are none."""
    assert found() == found(fold=0.5981532) == found(s=77.0) == []
    rows: Any = [{"label": "LP", "at": [1.0005, -2.0]}, {"label": "GR at 1.2500001", "at": []}]
    assert found(rows=rows) == []


@pytest.mark.parametrize(
    ("values", "where"),
    [
        ({"fold": 0.598154}, "/fold"),
        ({"fold": float("nan")}, "/fold"),
        ({"fold": None}, "/fold"),
        ({"s": None}, "/s"),
        ({"more": 1.0}, ""),
        ({"rows": KEPT["rows"][:1]}, "/rows"),
        ({"rows": [{"label": "PD", "at": [1.0, -2.0]}, KEPT["rows"][1]]}, "/rows/0/label"),
        ({"rows": [{"label": "LP", "at": [1.0, 2.0]}, KEPT["rows"][1]]}, "/rows/0/at/1"),
        ({"rows": [KEPT["rows"][0], {"label": "GR at 1.26", "at": []}]}, "/rows/1/label"),
    ],
)
def test_what_is_a_difference(values: dict[str, Any], where: str) -> None:
    """Assert that another number, none, another count, name, sign or word is said where it is."""
    assert found(**values) == [where]


@pytest.mark.parametrize(
    ("number", "figures"), [(1.0, ("curve",)), (1.1, ("curve",)), (1.0, ("other",)), (1.0, ())]
)
def test_section_held_against_its_page(number: float, figures: tuple[str, ...], tmp_path: Path) -> None:
    """Assert that a section passes with its number and a figure that the page shows, and not else."""
    (tmp_path / "toy.md.j2").write_text("{{ n.it }}\n\n![A curve](curve.png)", "utf-8")
    (tmp_path / "introduction.md.j2").write_text("# Toy", "utf-8")
    first, again = (
        Section(
            title="Toy",
            compute=lambda _, n=n, names=names: Found(
                numbers={"it": n}, figures={f: Figure() for f in names}
            ),
        )
        for n, names in ((1.0, ("curve",)), (number, figures))
    )
    Page(name="toys", folder=tmp_path, sections={"toy": first}).make(tmp_path, ["toy"], lambda _: None)
    page = Page(name="toys", folder=tmp_path, sections={"toy": again})
    if (number, figures) == (1.0, ("curve",)):
        assert_fresh(page, "toy", {})
    else:
        with pytest.raises(AssertionError):
            assert_fresh(page, "toy", {})
