"""What notebooks show of branches, points and systems whose names are written to break it, in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.attacks import ATTACKS, hostile
from support.pages import opened

from periodic.display.sketch import Line, Mark, sketch

OWN = {
    *("html", "head", "meta", "title", "body", "div", "p", "table", "thead", "tbody", "tr", "th", "td"),
    *("svg", "rect", "polyline", "circle", "text", "details", "summary"),
}


def run(browser: Any, file: Path, text: str) -> dict[str, list[str]]:
    """The texts of elements by kind, after a page of some HTML without a policy has let run what it can."""
    file.write_text(f"<!DOCTYPE html><meta charset=utf-8><title>a</title><body>{text}<p id=end>.", "utf-8")
    with opened(browser, file, "#end") as page:
        page.wait_for_timeout(50)
        assert page.evaluate("window.broken") is None
        found = page.evaluate("[...document.querySelectorAll('*')].map(e => [e.localName, e.textContent])")
        inside = page.evaluate("[...document.querySelectorAll('*')].flatMap(e => e.getAttributeNames())")
    assert {kind for kind, _ in found} <= OWN
    assert [name for name in inside if name.startswith(("on", "src", "href"))] == []
    return {kind: [text for other, text in found if other == kind] for kind in OWN}


@pytest.mark.parametrize("attack", ATTACKS.values(), ids=ATTACKS.keys())
def test_notebook(attack: str, browser: Any, tmp_path: Path) -> None:
    """Assert that names, units, labels and notes are there letter by letter, and nothing else is made."""
    system, branch = hostile(attack)
    shown = run(browser, tmp_path / "branch.html", branch._repr_html_())
    assert shown["th"][1:3] == [f"{attack} k ({attack})", f"{attack} p-p ({attack})"]
    assert f"{attack} e" in shown["td"] and f"{attack} e" in shown["text"] and repr(branch) in shown["p"]
    shown = run(browser, tmp_path / "point.html", branch[-1]._repr_html_())
    assert shown["td"][0] == f"{attack} ({attack})" and shown["text"][-1] == f"{attack} ({attack})"
    assert any(text.startswith(repr(branch[-1])) for text in shown["p"])
    shown = run(browser, tmp_path / "system.html", system._repr_html_())
    assert {attack, f"{attack} k", f"{attack} f"} <= set(shown["td"])
    assert f"$$\n{system.latex}\n$$" in shown["body"][0]


@pytest.mark.parametrize("attack", ATTACKS.values(), ids=ATTACKS.keys())
def test_sketch(attack: str, browser: Any, tmp_path: Path) -> None:
    """Assert labels and marks of a picture letter by letter."""
    line = Line(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    shown = run(browser, tmp_path / "a.html", sketch([line], [Mark(1.0, 1.0, attack)], attack, attack))
    assert [text for text in shown["text"] if text == attack] == [attack] * 3
