"""The page to play with: what it holds, how large it is, what is refused, and that a browser runs it."""

from __future__ import annotations

import base64
import json
import math
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

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
    return per.page(branch, tmp_path_factory.mktemp("page") / "duffing.html", title="A <b> & c", units=units)


def held(file: Path) -> dict[str, Any]:
    """The data in a page."""
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', file.read_text("utf-8"))
    assert found is not None
    data: dict[str, Any] = json.loads(found[1])
    return data


def test_page_holds_the_branch(branch: per.Branch, file: Path) -> None:
    """Assert points, labels, sizes and orbits in the units asked for, to the six digits that it keeps."""
    data = held(file)
    assert data["parameter"] == {"name": "Omega", "unit": "Hz"}
    assert [q["unit"] for q in data["signals"]] == ["mm", "mm/s"] and data["pairs"] == [[0, 1]]
    assert [p["label"] for p in data["points"] if p["label"]] == ["EP", "LP", "LP", "EP"]
    orbits = np.frombuffer(base64.b64decode(data["orbits"]), "<f4").reshape(len(branch), 2, data["samples"])
    for k in (0, len(branch) // 2, len(branch) - 1):
        point, told = branch[k], data["points"][k]
        assert told["at"] == pytest.approx(point.parameter / (2 * math.pi), rel=1e-14)
        assert told["stable"] == point.stable
        assert told["sizes"][0] == pytest.approx(1e3 * point.peak_to_peak("x"), rel=1e-5)
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
    monkeypatch.setattr("periodic.results.interactive.content.MOST", 12)
    data = held(per.page(branch, tmp_path / "a.html"))
    assert len(data["points"]) < 20
    assert [p["label"] for p in data["points"] if p["label"]] == ["EP", "LP", "LP", "EP"]


def test_what_is_no_page_is_refused(branch: per.Branch, tmp_path: Path) -> None:
    """Assert one sentence for each."""
    with pytest.raises(ValueError, match="it must be a file that ends in .html$"):
        per.page(branch, tmp_path / "branch.pdf")
    with pytest.raises(ValueError, match="^units has 'y'; its names must be among x, "):
        per.page(branch, tmp_path / "a.html", units={"y": ("mm", 1e-3)})
    nothing: Any = 3
    with pytest.raises(ValueError, match="^branch is 3; it must be a Branch, as periodic.trace returns it$"):
        per.page(nothing, tmp_path / "a.html")
    with pytest.raises(ValueError, match="^units is 3; it must give units by their names$"):
        per.page(branch, tmp_path / "a.html", units=nothing)


@pytest.mark.long
@pytest.mark.skipif(shutil.which("chromium") is None, reason="needs Chromium")
def test_browser_shows_the_first_orbit(file: Path) -> None:
    """Assert what stands in the page after its script has run: the sentence on the orbit, six drawings."""
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
    command = ["chromium", *options, "--virtual-time-budget=4000", "--dump-dom", file.as_uri()]
    text = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout
    assert re.search(
        r'role="status"[^>]*><b>EP  </b>Omega 0.127323954 Hz · x peak to peak [\d.]+ mm · stable', text
    )
    assert len(re.findall(r'class="[^"]*js-plotly-plot', text)) == 5
