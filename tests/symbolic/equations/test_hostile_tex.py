"""Names that LaTeX would read as commands, groups or the end of a formula, as a typesetter reads them."""

from __future__ import annotations

import html
import re
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Any

import pytest
from support.attacks import ATTACKS, hostile

import symbolic as sym
from symbolic.equations.tex.names import SIGNS, tex

NAMES = {
    **ATTACKS,
    "command": r"x} \href{javascript:alert(1)}{y",
    "one word": r"x}\href{javascript:alert(1)}{y}",
    "file": r"\input{/etc/passwd}",
    "signs": "a#b$c%d&e{f}g^h~i\\j<k>l",
    "sign": "%",
    "row": r"\\[9cm]",
    "end": r"\end{aligned}$$",
    "lines": "a\n\n\t\x00b",
}

SAFE = re.compile(
    r"\\(?:text|mathrm)\{[^#$%&_{}\\^~<>]*\}|\\hat\{\\ \}|\\(?:backslash|sim)\{\}"
    r"|\\[#$%&_{}]|\{[<>]\}|\\,|[\w{}]"
)
"""What a name may be written with: text without signs in a command, signs, groups, indices."""

by_name = pytest.mark.parametrize("name", NAMES.values(), ids=NAMES.keys())


@by_name
def test_no_letter_of_a_name_is_a_command(name: str) -> None:
    """Assert what the LaTeX is made of, that its groups close, and that no HTML can begin in it."""
    found = tex(name)
    assert SAFE.sub("", found) in ("", "_")
    bare = re.sub(r"\\[{}]", "", found)
    assert bare.count("{") == bare.count("}")
    assert not re.search(r"<[A-Za-z/!?]|&[#A-Za-z]", found)


def test_signs() -> None:
    """Assert each sign alone and within words, and that a name without any is as it was."""
    for sign, shown in SIGNS.items():
        if sign != "_":
            assert tex(sign) == shown
            assert tex(f"a{sign}bc") == rf"{{\text{{a}}{shown}\text{{bc}}}}"
            assert tex(f"a {sign}") == rf"{{\text{{a }}{shown}}}"
    assert (
        tex("place of x") == r"\text{place of x}" and tex("k_3") == "k_{3}" and tex("gap") == r"\mathrm{gap}"
    )


def typesetter() -> str:
    """MathJax, which notebooks run, with all its commands, as one script."""
    try:
        found = [file for file in files("sphinx-mathjax-offline") or [] if file.name == "tex-svg-full.js"]
    except PackageNotFoundError:
        pytest.skip("needs sphinx-mathjax-offline, which brings MathJax")
    return str(found[0].locate())


def typeset(browser: Any, file: Path, text: str, script: str) -> Any:
    """What a script finds in a page of some HTML that MathJax has gone through."""
    loaded = f"<script src='{typesetter()}'></script>"
    file.write_text(f"<!DOCTYPE html><meta charset=utf-8>{loaded}<body>{text}</body>", "utf-8")
    context = browser.new_context()
    page, said = context.new_page(), []
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("dialog", lambda dialog: (said.append(dialog.message), dialog.dismiss()))
    page.goto(file.as_uri())
    page.evaluate("MathJax.startup.promise")
    found = page.evaluate(script)
    assert page.evaluate("window.broken") is None and said == []
    context.close()
    return found


def test_names_are_typeset(browser: Any, tmp_path: Path) -> None:
    """Assert what MathJax makes of all, letter by letter but for spaces and the underscores of indices."""
    each = ", ".join(f"MathJax.tex2mml({tex(name)!r})" for name in NAMES.values())
    for name, found in zip(
        NAMES.values(), typeset(browser, tmp_path / "a.html", "", f"[{each}]"), strict=True
    ):
        assert not re.search("merror|<[^>]*href=|<a |maction", found)
        letters = "".join(re.findall(r">([^<\n]*)<", found))
        letters = html.unescape(letters).translate(
            {0x2216: "\\", 0x223C: "~", 0x2018: "`", 0x2019: "'", 0x201D: '"'}
        )
        plain = "".join(letter for letter in name if letter.isprintable() and letter not in " _")
        assert re.sub(r"[\s_]", "", letters) == plain


@pytest.mark.parametrize("name", ["formula", "link", "end of a script"])
def test_system_in_a_notebook(name: str, browser: Any, tmp_path: Path) -> None:
    """Assert that the equations are one formula without an error or a link, and that tables have none."""
    system, branch = hostile(NAMES[name])
    assert isinstance(system, sym.CompiledSystem)
    script = (
        "[...document.querySelectorAll('mjx-container')].map(e => [e.parentElement.localName,"
        " e.querySelectorAll('a, [data-mml-node=merror]').length])"
    )
    text = system._repr_html_() + branch._repr_html_() + branch[-1]._repr_html_()
    assert typeset(browser, tmp_path / "a.html", text, script) == [["body", 0]]
