"""How pages are filled in and what they are allowed to do."""

from __future__ import annotations

import base64
import hashlib
from pathlib import Path
from typing import Any

import pytest

from periodic.results.interactive import library


def test_policy_of_scripts() -> None:
    """Assert that scripts run by their hashes alone, and nothing else is fetched."""
    hashes = [base64.b64encode(hashlib.sha256(text).digest()).decode() for text in (b"one", b"two")]
    assert library.policy(["one", "two"]) == (
        f"default-src 'none'; script-src 'sha256-{hashes[0]}' 'sha256-{hashes[1]}'; "
        "style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
        "require-trusted-types-for 'script'"
    )


@pytest.mark.parametrize("title", ["", "a", "\ud7ff\ue000", "\U0001f600"])
def test_titles(title: str) -> None:
    """Assert that what can be written as UTF-8 is taken."""
    library.check_title(title)
    assert title.encode("utf-8").decode("utf-8") == title


@pytest.mark.parametrize("title", [None, 3, b"a", "\ud800", "a\udfffb", "\udabc"])
def test_titles_that_are_refused(title: object) -> None:
    """Assert the sentence for what is no text, and for halves of characters."""
    with pytest.raises(ValueError, match="^title is .*; it must be a text of Unicode characters$"):
        library.check_title(title)


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """A library of few letters."""
    pytest.importorskip("jinja2")
    monkeypatch.setattr(library, "_plotly", lambda: "plot();")
    monkeypatch.setattr(library, "missing", list)


@pytest.mark.usefixtures("small")
def test_page_in_folders_that_are_made(tmp_path: Path) -> None:
    """Assert title, data and library in it, escaped, and that a page that is there is replaced."""
    file = tmp_path / "a" / "b" / "c.HTM"
    for title in ("first", "x < y"):
        assert library.write("map", file, title, {"axes": [], "text": "</script>", "n": 1.5}) == file
    text = file.read_text("utf-8")
    assert "x &lt; y" in text and "first" not in text and "plot();" in text
    assert text.count("</script>") == text.count("<script")
    assert '"n":1.5' in text


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize("name", ["a.txt", "a", "html", "a.html.gz"])
def test_names_that_are_refused(name: str, tmp_path: Path) -> None:
    """Assert the sentence, and that nothing is written."""
    with pytest.raises(ValueError, match="^path is .*; it must be a file that ends in .html$"):
        library.write("map", tmp_path / "new" / name, "title", {})
    assert not (tmp_path / "new").exists()


@pytest.mark.usefixtures("small")
def test_data_that_are_not_finite(tmp_path: Path) -> None:
    """Assert that what JSON has not is refused."""
    with pytest.raises(ValueError, match="JSON"):
        library.write("map", tmp_path / "a.html", "title", {"n": float("nan")})


def test_packages_that_are_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the first of them and how it is installed."""
    known = {"jinja2": None, "plotly": None}
    monkeypatch.setattr(library, "find_spec", known.get)
    assert library.missing() == ["jinja2", "plotly"]
    with pytest.raises(ModuleNotFoundError, match="^a page needs the package jinja2: pip install ") as found:
        library.write("map", tmp_path / "a.html", "title", {})
    assert found.value.name == "jinja2"
    there: Any = {"jinja2": object(), "plotly": None}
    monkeypatch.setattr(library, "find_spec", there.get)
    assert library.missing() == ["plotly"]
