"""The page to play with: what it holds, how large it is, what is refused, and that a browser runs it."""

from __future__ import annotations

import base64
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from support.pages import held, opened

import periodic as per
import symbolic as sym

RPM = math.pi / 30


@pytest.fixture(scope="module")
def branch() -> per.Branch:
    """Duffing through its two folds."""
    return per.trace(sym.scene("duffing"), "Omega", (0.8, 2.5), start=0.8, tol=1e-5)


@pytest.fixture(scope="module")
def file(branch: per.Branch, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its page, frequencies in Hz and lengths in mm."""
    units = {"Omega": ("Hz", 2 * math.pi), "x": ("mm", 1e-3)}
    there = tmp_path_factory.mktemp("page") / "duffing.html"
    return per.page(branch, there, system=sym.scene("duffing"), title="A <b> & c", units=units)


def test_page_holds_the_branch(branch: per.Branch, file: Path) -> None:
    """Assert points, labels, sizes and orbits in the units asked for, to the six digits that it keeps."""
    data = held(file)
    assert data["parameter"] == {"name": "Omega", "unit": "Hz"}
    assert [q["unit"] for q in data["signals"]] == ["mm", "mm/s"] and data["pairs"] == [[0, 1]]
    assert [p["label"] for p in data["points"] if p["label"]] == ["EP", "peak of x", "LP", "LP", "EP"]
    orbits = np.frombuffer(base64.b64decode(data["orbits"]), "<f4").reshape(len(branch), 2, data["samples"])
    (across, up), parts = data["curves"][0], data["parts"]
    assert len(across) == len(up) == parts * (len(branch) - 1) + 1
    assert up[::parts] == pytest.approx([p["heights"][0] for p in data["points"]], rel=1e-5)
    assert across[::parts] == pytest.approx([p["at"] for p in data["points"]], rel=1e-5)
    for k in (0, len(branch) // 2, len(branch) - 1):
        point, told = branch[k], data["points"][k]
        assert told["at"] == pytest.approx(point.parameter / (2 * math.pi), rel=1e-14)
        assert told["stable"] == point.stable
        assert told["heights"][0] == pytest.approx(1e3 * point.peak_to_peak("x"), rel=1e-5)
        assert np.ptp(orbits[k, 0]) == pytest.approx(1e3 * point.peak_to_peak("x"), rel=2e-3)
        assert orbits[k, 1, 7] == pytest.approx(
            1e3 * point.orbit["x'"](7 / 128 * point.orbit.period), rel=1e-6
        )


def test_page_is_one_file_of_at_most_6_MB(file: Path) -> None:
    """Assert that nothing is fetched, that a title is text, and the size."""
    text = file.read_text("utf-8")
    assert file.stat().st_size < 6e6
    own = re.sub(r"<script>.*?</script>", "", text, count=1, flags=re.DOTALL)  # without the library
    assert not re.search(r"(src|href)=|https?://|@@", own)
    assert "A &lt;b&gt; &amp; c" in text


def test_long_branch_is_thinned(branch: per.Branch, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Assert that special points and the ends stay."""
    monkeypatch.setattr("periodic.results.interactive.content.MOST_POINTS", 12)
    data = held(per.page(branch, tmp_path / "a.html"))
    assert len(data["points"]) < 20
    assert data["curves"] is None
    assert [p["label"] for p in data["points"] if p["label"]] == ["EP", "peak of x", "LP", "LP", "EP"]


def test_what_is_no_page_is_refused(branch: per.Branch, tmp_path: Path) -> None:
    """Assert one sentence for each."""
    with pytest.raises(ValueError, match="it must be a file that ends in .html$"):
        per.page(branch, tmp_path / "branch.pdf")
    with pytest.raises(ValueError, match="^units has 'y'; its names must be among time, x, "):
        per.page(branch, tmp_path / "a.html", units={"y": ("mm", 1e-3)})
    nothing: Any = 3
    with pytest.raises(ValueError, match="^branch is 3; it must be a Branch, as periodic.trace returns it$"):
        per.page(nothing, tmp_path / "a.html")
    with pytest.raises(ValueError, match="^units is 3; it must give units by their names$"):
        per.page(branch, tmp_path / "a.html", units=nothing)
    with pytest.raises(ValueError, match=r"^notes has Point\(.*; it must be a point of the branch$"):
        per.page(branch, tmp_path / "a.html", notes={replace(branch[5]): "proven"})
    with pytest.raises(ValueError, match=r"^the note of Point\(.* is 3; it must be a text$"):
        per.page(branch, tmp_path / "a.html", notes={branch[5]: nothing})
    with pytest.raises(ValueError, match="^branch has 6 parameters; it must have the 12 of the system$"):
        per.page(branch, tmp_path / "a.html", system=sym.scene("gear-pair"))


def test_folders_are_made(branch: per.Branch, tmp_path: Path) -> None:
    """Assert that a page goes where it is asked to, as other files do."""
    assert per.page(branch, tmp_path / "pages" / "a.html").exists()


def test_loads_and_drawing_of_a_disc(tmp_path: Path) -> None:
    """Assert that outputs which are no states are shown with the system, and what its drawing needs."""
    system = sym.scene("vitrea79-810N")
    branch = per.trace(system, "speed", (460 * RPM, 500 * RPM), start=500 * RPM, tol=1e-3)
    data = held(per.page(branch, tmp_path / "disc.html", system=system, units={"speed": "rev/min"}))
    names = [q["name"] for q in data["signals"]]
    assert "load" in names
    shape = (len(branch), len(names), data["samples"])
    load = np.frombuffer(base64.b64decode(data["orbits"]), "<f4").reshape(shape)[0, names.index("load")]
    size = {"N": 1.0, "kN": 1e3}[data["signals"][names.index("load")]["unit"]]
    point = branch[0]
    assert size * load.max() == pytest.approx(point.maximum["load"], rel=1e-3)
    drawn = data["drawing"]
    assert [s["look"] for s in drawn["shapes"]] == ["film", "body", "body"]
    wavy, upper = drawn["shapes"][1:]
    assert wavy["waves"] == 120 and wavy["turn"] == pytest.approx(1 / 120)
    assert upper["y"] == {"fixed": 4.0, "moved": [["x", 1.0]]}
    assert drawn["numbers"]["amplitude"] == [point.orbit.parameters["amplitude"]] * len(branch)
    largest = max(abs(p.maximum["x"]) for p in branch)
    assert drawn["magnified"] * max(largest, drawn["numbers"]["amplitude"][0]) == pytest.approx(0.4, rel=0.05)


@pytest.mark.parametrize("condense", [True, False])
def test_shape_of_a_structure(condense: bool, tmp_path: Path) -> None:
    """Assert that the drawn beam's last node moves as its tip does, and that the others follow."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=3)
    structure = sym.Structure(beam, damping=0.02)
    model = (
        structure + sym.HarmonicForce(structure["tip"], 0.01, 2.6) + sym.CubicSpring(structure["tip"], 1.0)
    )
    system = sym.compile(model, condense=condense)
    branch = per.trace(system, "Omega", (2.6, 3.0), start=2.6, tol=1e-4)
    drawn = held(per.page(branch, tmp_path / "beam.html", system=system))["drawing"]
    (line,) = drawn["shapes"]
    bent = np.frombuffer(base64.b64decode(line["values"]), "<f4").reshape(len(branch), 3, 32)
    times = np.arange(32) / 32 * branch[2].orbit.period
    assert bent[2, -1] == pytest.approx(branch[2].orbit["tip"](times), abs=1e-4 * float(np.abs(bent).max()))
    assert (np.ptp(bent[2], axis=1) == np.sort(np.ptp(bent[2], axis=1))).all()
    assert drawn["bar"]["text"].endswith("m")


def test_page_of_a_map(tmp_path: Path) -> None:
    """Assert numbers over both parameters, no number as null, and that three parameters are refused."""
    x, y = xr.Variable("F", [1.0, 2.0], {"units": "N"}), xr.Variable("c", [0.1, 0.2, 0.3])
    peak = xr.Variable(("F", "c"), [[1.0, 2.0, 3.0], [4.0, np.nan, 6.0]], {"units": "m"})
    status = xr.Variable(("F", "c"), np.full((2, 3), "done", dtype=object))
    data = xr.Dataset({"peak": peak, "status": status}, {"F": x, "c": y})
    shown = held(per.page(data, tmp_path / "map.html"))
    assert [axis["name"] for axis in shown["axes"]] == ["F", "c"]
    (number,) = shown["numbers"]
    assert number == {"name": "peak", "unit": "m", "values": [[1.0, 4.0], [2.0, None], [3.0, 6.0]]}
    with pytest.raises(
        ValueError, match="^the map has the axes k, F, c; a page shows numbers over one or two"
    ):
        per.page(data.expand_dims(k=[1.0, 2.0]), tmp_path / "map.html")


def test_page_of_a_curve(tmp_path: Path) -> None:
    """Assert that a curve in two parameters is shown over both."""
    system = sym.scene("duffing")
    fold = per.trace(system, "Omega", (0.8, 2.5), start=0.8).labelled("LP")[0]
    border = per.trace(system, "Omega", (0.9, 3.0), guess=fold.orbit, determined={"F": per.FoldCondition()})
    data = held(per.page(border, tmp_path / "curve.html"))
    assert data["border"] and data["heights"][0] == {"name": "F", "unit": "N", "said": "F"}
    assert [p["heights"][0] for p in data["points"]] == pytest.approx(border.column("F"), rel=1e-5)


def said(page: Any) -> float:
    """The value of the parameter in the sentence on the orbit."""
    found = re.search(r"Omega ([\d.]+) Hz · x peak to peak [\d.]+ mm · (un)?stable", page.inner_text("#said"))
    assert found is not None
    return float(found[1])


def place(page: Any, k: int) -> tuple[float, float]:
    """Where a point of the branch is on the screen."""
    script = """k => {
      const branch = document.getElementById("branch"), { xaxis, yaxis } = branch._fullLayout;
      const box = branch.getBoundingClientRect(), p = data.points[k];
      return [box.left + xaxis._offset + xaxis.d2p(p.at), box.top + yaxis._offset + yaxis.d2p(p.heights[0])];
    }"""
    x, y = page.evaluate(script, k)
    return x, y


def test_keys_finger_and_mouse(browser: Any, branch: per.Branch, file: Path) -> None:
    """Assert that each leads to the orbit that it points at, and that the system moves."""
    values = [p.parameter / (2 * math.pi) for p in branch]
    with opened(browser, file, has_touch=True) as page:
        assert said(page) == pytest.approx(values[0], rel=1e-8)
        page.keyboard.press("ArrowRight")
        page.keyboard.press("PageUp")
        assert said(page) == pytest.approx(values[11], rel=1e-8)
        page.keyboard.press("End")
        assert said(page) == pytest.approx(values[-1], rel=1e-8)
        middle = len(branch) // 2
        page.touchscreen.tap(*place(page, middle))
        assert said(page) == pytest.approx(values[middle], rel=1e-8)
        page.mouse.move(*place(page, 5))
        assert said(page) == pytest.approx(values[5], rel=1e-8)
        before = page.locator("#drawing svg").inner_html()
        page.click("#play")
        page.wait_for_timeout(400)
        page.click("#play")
        assert page.locator("#drawing svg").inner_html() != before
        assert page.locator("#play").get_attribute("aria-pressed") == "false"
        assert page.locator(".js-plotly-plot").count() == 5


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_and_dark(browser: Any, file: Path, scheme: str) -> None:
    """Assert the paper's colour, of the page and of what is drawn on it."""
    with opened(browser, file, color_scheme=scheme) as page:
        colour = page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert colour == {"light": "rgb(255, 255, 255)", "dark": "rgb(20, 24, 29)"}[scheme]
        paper = page.evaluate("document.getElementById('branch')._fullLayout.paper_bgcolor")
        assert paper == {"light": "#fff", "dark": "#14181d"}[scheme]


def test_map_in_a_browser(browser: Any, tmp_path: Path) -> None:
    """Assert that keys lead from cell to cell."""
    peak = xr.Variable(("F", "c"), [[1.0, 2.0], [4.0, np.nan]], {"units": "m"})
    data = xr.Dataset({"peak": peak}, {"F": [1.0, 2.0], "c": [0.1, 0.2]})
    with opened(browser, per.page(data, tmp_path / "map.html")) as page:
        assert page.inner_text("#said") == "F 1 · c 0.1 · peak 1 m"
        page.keyboard.press("ArrowRight")
        assert page.inner_text("#said") == "F 2 · c 0.1 · peak 4 m"
        page.keyboard.press("ArrowUp")
        assert page.inner_text("#said") == "F 2 · c 0.2 · peak: none"


def test_page_in_a_folder_that_is_made(branch: per.Branch, tmp_path: Path) -> None:
    """Assert that folders of folders are made too."""
    file = tmp_path / "a" / "b" / "c.html"
    assert per.page(branch, file) == file and file.stat().st_size > 1000
