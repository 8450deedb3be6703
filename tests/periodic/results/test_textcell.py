"""Texts in CSV files that a spreadsheet would compute."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np
import pytest
from support.attacks import hostile

import periodic as per
from periodic.results.textcell import text_cell

FORMULAS = [
    "=1+1",
    "+1",
    "-1",
    "@SUM(A1)",
    "\t=1",
    "\r=1",
    "\n=1",
    "＝1+1",
    "=cmd|'/C calc'!A0",
    "=HYPERLINK(1)",
]


@pytest.mark.parametrize("text", FORMULAS)
def test_formulas(text: str) -> None:
    """Assert that an apostrophe stands before a formula, at the beginning and after a semicolon."""
    found = text_cell(text)
    assert found.startswith("'") and found.replace("'", "") == text.replace("'", "")
    assert f";{text}".replace(text, found) == text_cell(f";{text}")


@pytest.mark.parametrize("text", ["x p-p [m]", "x'", "a = b", "e-mail@x", "Ω (rad/s)", "", "1-2", "a;b"])
def test_other_texts(text: str) -> None:
    """Assert that texts without a formula are as they were."""
    assert text_cell(text) == text


@pytest.mark.parametrize("attack", ["=1+1", "+1", "-1", "@SUM(A1)", "x;=1+1"])
def test_export(attack: str, tmp_path: Path) -> None:
    """Assert heads and labels as text, and numbers, negative ones too, as they were."""
    _, branch = hostile(attack)
    files = per.export(branch, tmp_path / "a.csv", samples=8)
    tables = [list(csv.reader(io.StringIO(file.read_text("utf-8")))) for file in files]
    for table in tables:
        texts = [*table[0], *(row[1] for row in table if table[0][1] == "label")]
        assert all(text_cell(text) == text for text in texts)
        assert any(text.startswith(text_cell(attack)) for text in table[0])
    assert tables[0][-1][1] == text_cell(f"{attack} e")
    samples = np.array([float(row[2]) for row in tables[1][1:9]])
    assert samples == pytest.approx(branch[0].orbit[attack](np.arange(8) / 8 * branch[0].orbit.period))
    assert samples.min() < 0
