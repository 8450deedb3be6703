"""Pages of branches and maps whose titles, names, units, labels and files are written to break them."""

from __future__ import annotations

import base64
import hashlib
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from support.attacks import ATTACKS, hostile
from support.pages import held, opened

import periodic as per
from periodic.results.interactive.pictures import Line, Picture, Place, Shown, Style

by_attack = pytest.mark.parametrize("attack", ATTACKS.values(), ids=ATTACKS.keys())

OWN = {
    *("html", "head", "meta", "title", "style", "body", "header", "main", "script", "div", "p", "h1", "b"),
    *("label", "select", "option", "button", "input", "svg", "g", "defs", "clipPath", "path", "rect"),
    *("circle", "text", "tspan", "image", "line", "linearGradient", "stop", "ul", "li"),
}
"""All elements that a page makes; of Plotly's, `image` is a heat map."""


def check(page: Any) -> None:
    """Assert that nothing has run, and that no element or attribute is there which the page has not made."""
    page.wait_for_timeout(50)
    assert page.evaluate("window.broken") is None
    assert set(page.evaluate("[...document.querySelectorAll('*')].map(e => e.localName)")) <= OWN
    attributes = (
        "[...document.querySelectorAll('*')].flatMap(e => [...e.attributes].map(a => [a.name, a.value]))"
    )
    risky = [pair for pair in page.evaluate(attributes) if re.match("on|src|(xlink:)?href|action", pair[0])]
    assert all(value.startswith("data:image/png;base64,") for _, value in risky), risky
    assert page.locator("script").count() == 3


def shown(text: str) -> str:
    """A text as a browser has it where white space is one space."""
    return " ".join(text.split())


def texts(page: Any, selector: str) -> list[str]:
    """The texts of elements."""
    return [shown(text) for text in page.locator(selector).all_text_contents()]


@by_attack
def test_branch(attack: str, browser: Any, tmp_path: Path) -> None:
    """Assert that all of it is shown letter by letter: in the page, in Plotly's pictures, in the drawing."""
    system, branch = hostile(attack)
    units = {attack: (attack, 1.0), branch.parameter: (attack, 1.0)}
    file = per.page(branch, tmp_path / "page.html", system=system, title=attack, units=units)
    assert file.stat().st_size < 6e6
    with opened(browser, file) as page:
        page.keyboard.press("End")
        check(page)
        assert shown(page.title()) == shown(attack) and texts(page, "h1") == [shown(attack)]
        assert shown(f"stopped as asked: {attack} e") in shown(page.text_content("#stop"))
        said = f"{attack} e {attack} k {branch[-1].parameter:.9g} {attack} · {attack} peak to peak"
        assert shown(page.text_content("#said")).startswith(shown(said))
        assert texts(page, "#output option") == [shown(f"{attack} peak to peak ({attack})")]
        assert texts(page, "#pair option") == [shown(f"{attack}, {attack}'")]
        assert texts(page, "#branch .xtitle") == [shown(f"{attack} k ({attack})")]
        assert texts(page, "#branch .ytitle") == [shown(f"{attack} peak to peak ({attack})")]
        assert texts(page, "#phase .ytitle") == [shown(f"{attack}' ({attack}/s)")]
        assert shown(f"{attack} e") in texts(page, "#branch .textpoint")
        assert shown(attack) in texts(page, "#drawing svg text")
        there = "document.querySelector('#drawing svg rect').getAttribute('x')"
        before = page.evaluate(there)
        page.click("#play")
        page.wait_for_timeout(300)
        assert page.evaluate(there) != before
        check(page)


@by_attack
def test_notes(attack: str, browser: Any, tmp_path: Path) -> None:
    """Assert that what is said of a point is shown letter by letter, with a tick at the point."""
    system, branch = hostile(attack)
    notes = {branch[-1]: attack}
    file = per.page(branch, tmp_path / "page.html", system=system, title="notes", notes=notes)
    with opened(browser, file) as page:
        page.keyboard.press("End")
        check(page)
        assert shown(page.text_content("#said")).endswith(shown(f"✓ {attack}"))
        assert shown(f"{attack} e ✓") in texts(page, "#branch .textpoint")


@pytest.mark.parametrize("attack", [*ATTACKS.values(), "a\u2028\u2029';\n\r\t'b"], ids=[*ATTACKS, "lines"])
def test_map(attack: str, browser: Any, tmp_path: Path) -> None:
    """Assert the same of a map's title, axes, numbers and units."""
    up, number = f"{attack} 2", f"{attack} 3"
    values = xr.Variable((attack, up), [[1.0, 2.0], [4.0, np.nan]], {"units": attack})
    first, second = (xr.Variable(name, [1.0, 2.0], {"units": attack}) for name in (attack, up))
    data = xr.Dataset({number: values}, {attack: first, up: second})
    with opened(browser, per.page(data, tmp_path / "map.html", title=attack)) as page:
        page.keyboard.press("ArrowRight")
        check(page)
        assert shown(page.title()) == shown(attack) and texts(page, "h1") == [shown(attack)]
        said = f"{attack} 2 {attack} · {up} 1 {attack} · {number} 4 {attack}"
        assert shown(page.text_content("#said")) == shown(said)
        assert texts(page, "#number option") == [shown(f"{number} ({attack})")]
        assert texts(page, ".xtitle") == [shown(f"{attack} ({attack})")]
        assert texts(page, ".ytitle") == [shown(f"{up} ({attack})")]
        assert shown(f"{number} ({attack})") in texts(page, "#branch text")


class Hostile:
    """What says a text wherever it can say one."""

    def __init__(self, attack: str) -> None:
        self.attack = attack

    def shown(self, system: Any = None) -> Shown:
        """A picture over a parameter with one place, and one there."""
        said, at = self.attack, np.array([1.0, 2.0])
        lines = [Line(at, at, style, said, 0, (0, 1), (said, said)) for style in Style]
        picture = Picture(said, said, lines)
        return Shown([said], [picture], [Place(1.0, [said], [picture]), Place(2.0, [f"{said} 2"], [picture])])


@by_attack
def test_pictures(attack: str, browser: Any, tmp_path: Path) -> None:
    """Assert the same of pictures, and of what is said of their places."""
    with opened(browser, per.page(Hostile(attack), tmp_path / "page.html", title=attack)) as page:
        page.keyboard.press("ArrowRight")
        check(page)
        assert shown(page.title()) == shown(attack) and texts(page, "h1") == [shown(attack)]
        assert texts(page, "#told li") == [shown(attack)] and texts(page, "#said li") == [
            shown(f"{attack} 2")
        ]
        for axis in (".xtitle", ".ytitle"):
            assert texts(page, f"#overviews {axis}") == texts(page, f"#places {axis}") == [shown(attack)]
        assert set(texts(page, "#overviews .textpoint")) == {shown(attack)}
        assert set(texts(page, "#overviews .legendtext")) == {shown(attack)}


@pytest.mark.parametrize("name", ["<img src=x onerror=alert(1)>", "@@DATA@@ & {{ data }}", "javascript:x"])
def test_names_of_files(name: str, browser: Any, tmp_path: Path) -> None:
    """Assert that a file is called as asked, and that its page is the same as under any other name."""
    _, branch = hostile("prototype")
    file, plain = (per.page(branch, tmp_path / f"{stem}.html") for stem in (name, "a"))
    assert file == tmp_path / f"{name}.html" and file.read_bytes() == plain.read_bytes()
    with opened(browser, file) as page:
        check(page)


def test_what_is_no_text_is_refused(tmp_path: Path) -> None:
    """Assert one sentence for titles that no file can hold, before anything is written."""
    _, branch = hostile("prototype")
    other: Any = 3
    for title in ("a\udc80", other):
        with pytest.raises(ValueError, match=r"^title is .*; it must be a text of Unicode characters$"):
            per.page(branch, tmp_path / "a.html", title=title)
    assert not (tmp_path / "a.html").exists()


def test_policy(browser: Any, tmp_path: Path) -> None:
    """Assert that its two scripts have the hashes allowed, and what would be refused if it got in."""
    _, branch = hostile("prototype")
    file = per.page(branch, tmp_path / "a.html")
    text = file.read_text("utf-8")
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    hashes = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    (policy,) = re.findall(r'<meta http-equiv="Content-Security-Policy" content="(.*?)">', text)
    rules = dict(rule.split(" ", 1) for rule in policy.replace("&#39;", "'").split("; "))
    assert rules["script-src"] == " ".join(f"'sha256-{digest}'" for digest in hashes) and len(hashes) == 2
    assert rules["default-src"] == "'none'" and "unsafe" not in rules["script-src"]
    assert text.index("Content-Security-Policy") < text.index("<title>") < text.index("<script")
    broken = tmp_path / "broken.html"
    let_in = "<img src=x onerror=alert(1)><script>document.title = 'broken'</script>"
    let_in += "<img src='https://example.org/x'>"
    broken.write_text(text.replace("</h1>", f"</h1>{let_in}"), "utf-8")
    context = browser.new_context()
    page, said, asked = context.new_page(), [], []
    page.on("console", lambda message: said.append(message.text))
    page.on("dialog", lambda dialog: (asked.append("dialog"), dialog.dismiss()))
    page.on("response", lambda response: asked.append(response.url))
    page.goto(broken.as_uri())
    page.wait_for_selector(".js-plotly-plot")
    page.wait_for_timeout(100)
    assert page.title() != "broken" and asked == [broken.as_uri()]
    assert sum("Content Security Policy" in each for each in said) >= 3
    write = "() => { try { document.body.innerHTML = '<b>x</b>'; return ''; } catch (e) { return e.name; } }"
    assert page.evaluate(write) == "TypeError"
    context.close()


def test_data_are_those_given(tmp_path: Path) -> None:
    """Assert that what is escaped in the file is what was given when it is read."""
    system, branch = hostile(ATTACKS["end of a script"])
    data, name = held(per.page(branch, tmp_path / "a.html", system=system)), ATTACKS["end of a script"]
    assert data["signals"][0] == {"name": name, "unit": name}
    assert list(data["drawing"]["signals"]) == [name]
