"""Pages of an atlas and of tori: what they hold, and that a browser leads from place to place."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.kept import kept
from support.pages import held, opened

import periodic as per
import symbolic as sym
from reports.studies.motions.tori import coupled

pytestmark = pytest.mark.usefixtures("users_kernels")


@kept
def atlas() -> per.phasespace.Atlas:
    """The gear pair about its resonance."""
    box = {"x": (-3, 3), "x'": (-2, 2)}
    given = {"count": 5, "diagram": 9, "starts": 24, "places": 8, "periods": 1}
    return per.atlas(sym.scene("gear-pair"), "Omega", (0.56, 0.96), box=box, **given)


@kept
def family() -> per.tori.TorusBranch:
    """Tori of two coupled oscillators."""
    system = coupled()
    return per.trace(system, "e", (0.3, 0.6), guess=per.settled_torus(system, start={"x": 1.0, "y": 0.5}))


def test_page_of_an_atlas(tmp_path: Path) -> None:
    """Assert curves, folds, shares and motions at each value against the atlas."""
    found = atlas()
    data = held(per.page(found, tmp_path / "atlas.html"))
    assert data["said"] == str(found).splitlines()
    curves, shares = data["overviews"]
    assert (curves["across"], curves["up"]) == ("Omega (rad/s)", "x at tau = 0")
    (marked,) = [line for line in curves["lines"] if line["style"] == "open"]
    special = [point for point in found.sheets[0].branch if point.label in ("LP", "GR")]
    assert marked["texts"] == [str(point.label) for point in special]
    assert marked["x"] == pytest.approx([point.parameter for point in special], rel=1e-6)
    assert marked["y"] == pytest.approx([point.orbit["x"](0.0).item() for point in special], rel=1e-6)
    for k, line in enumerate(shares["lines"]):
        given = [None if share == 0 else pytest.approx(100 * share) for share in found.sheets[0].shares[k]]
        assert line["y"] == given and line["name"] == "1" + "ab"[k] and line["of"] == list(range(5))
    assert [place["at"] for place in data["places"]] == pytest.approx(found.values.tolist())
    for place, motions in zip(data["places"], found.motions, strict=True):
        (states,) = place["pictures"]
        assert len(states["lines"]) == len(motions)
        x, speed = (value * float(unit) for value, unit in zip(motions[0].sections[0], (1, 1), strict=True))
        assert states["lines"][0]["x"] == [pytest.approx(x, rel=1e-6)]
        assert states["lines"][0]["y"] == [pytest.approx(speed * place["at"], rel=1e-6)]
        assert f"1: {motions[0].name}" in place["said"][1]


def test_curves_between_points_are_near_the_diagram(tmp_path: Path) -> None:
    """Assert that what settled is on a drawn curve, to half a percent of its range."""
    curves = held(per.page(atlas(), tmp_path / "atlas.html"))["overviews"][0]["lines"]
    dots = next(line for line in curves if line["style"] == "dots")
    through = next(line for line in curves if line["style"] == "line")
    pairs = [(x, y) for x, y in zip(through["x"], through["y"], strict=True) if y is not None]
    x, y = np.array(pairs).T
    size = float(np.ptp(y))
    for across, up in zip(dots["x"], dots["y"], strict=True):
        near = np.flatnonzero((x[:-1] - across) * (x[1:] - across) <= 0)
        part = (across - x[near]) / np.where(x[near + 1] == x[near], 1.0, x[near + 1] - x[near])
        assert np.abs(y[near] + part * (y[near + 1] - y[near]) - up).min() < 5e-3 * size


def test_page_of_a_family_of_tori(tmp_path: Path) -> None:
    """Assert measures over the parameter, and of each torus section, motion and spectrum."""
    found, system = family(), coupled()
    plain, full = (
        held(per.page(found, tmp_path / f"{k}.html", system=given)) for k, given in enumerate((None, system))
    )
    size, turns, moduli = full["overviews"]
    assert (size["across"], turns["up"], moduli["up"]) == (
        "e",
        "rotation number",
        "moduli of the multipliers",
    )
    assert turns["lines"][0]["y"] == pytest.approx(found.rotation_numbers.tolist(), rel=1e-6)
    assert size["lines"][0]["y"] == pytest.approx([point.torus.size for point in found], rel=1e-6)
    assert [place["at"] for place in full["places"]] == pytest.approx(found.values.tolist())
    assert [len(place["pictures"]) for place in plain["places"]] == [1] * len(found)
    section, motion, spectrum = full["places"][0]["pictures"]
    (curve,), (stems,) = section["lines"], spectrum["lines"]
    assert curve["x"][0] == curve["x"][-1] and curve["y"][0] == curve["y"][-1]
    lines = per.tori.combinations(system, found[0].torus, "x")
    assert stems["y"] == pytest.approx(lines.amplitudes.tolist(), rel=1e-6) and spectrum["log"]
    time, moved = per.tori.in_time(system, found[0].torus, 12, 24)
    assert motion["lines"][0]["y"] == pytest.approx(moved["x"].tolist(), rel=1e-5, abs=1e-6)


def test_page_of_one_torus(tmp_path: Path) -> None:
    """Assert that it has no places, and its frequencies in words."""
    data = held(per.page(family()[0].torus, tmp_path / "torus.html", system=coupled()))
    assert data["places"] == [] and len(data["overviews"]) == 3
    assert f"{family()[0].torus.rotation_number:.9f}" in data["said"][0]


def test_keys_and_mouse(browser: Any, tmp_path: Path) -> None:
    """Assert that keys, slider and mouse lead to the motions at a value."""
    found = atlas()
    with opened(browser, per.page(found, tmp_path / "atlas.html")) as page:
        said = page.locator("#said li").first
        assert said.inner_text() == f"Omega (rad/s) = {found.values[0]:.9g}"
        page.keyboard.press("ArrowRight")
        assert said.inner_text() == f"Omega (rad/s) = {found.values[1]:.9g}"
        page.keyboard.press("End")
        assert said.inner_text() == f"Omega (rad/s) = {found.values[-1]:.9g}"
        script = """() => {
          const box = document.querySelector("#overviews > div"), { xaxis, yaxis } = box._fullLayout;
          const { x, y } = data.overviews[0].lines.find(l => l.style === "open");
          const at = box.getBoundingClientRect();
          return [at.left + xaxis._offset + xaxis.d2p(x[0]), at.top + yaxis._offset + yaxis.d2p(y[0])];
        }"""
        page.mouse.move(*page.evaluate(script))
        page.wait_for_timeout(200)
        special = next(point for point in found.sheets[0].branch if point.label in ("LP", "GR"))
        nearest = found.values[np.abs(found.values - special.parameter).argmin()]
        assert said.inner_text() == f"Omega (rad/s) = {nearest:.9g}"
        assert page.locator("#places .js-plotly-plot").count() == 1
