"""The README's examples run, one after another in one place, and give the numbers that it names."""

from __future__ import annotations

import math
import re
from pathlib import Path

import matplotlib
import pytest
from scipy.special import ellipk

import periodic as per

README = Path(__file__).resolve().parent.parent / "README.md"


def test_examples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert folds, cusp, Hopf point and backbone of the examples, the disc's apart, which is long."""
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", README.read_text("utf-8"), re.DOTALL)
    said: dict = {}
    for block in blocks:
        if "vitrea79" not in block:
            exec(block, said)
    assert [p.parameter for p in said["branch"].labelled(per.Label.FOLD)] == pytest.approx(
        [2.2119353, 1.4386701]
    )
    assert said["cusp"].parameter == pytest.approx(1.0901095, rel=1e-7)
    assert said["border"].column("F").min() > 0.0513635 * (1 - 1e-6)
    assert said["reached"][-1].peak_to_peak("x") == pytest.approx(3.0, rel=1e-9)
    assert said["level"].peak_to_peak("x") == pytest.approx([3.0] * len(said["level"]), rel=1e-7)
    assert said["hopf"].parameter == pytest.approx(470 / 19, rel=1e-10)
    assert said["pitchfork"].parameter == pytest.approx(1.0, rel=1e-10)
    for point, energy in zip(said["backbone"], said["energies"], strict=True):
        sine = math.sin(point.maximum["q"] / 2)
        assert point.parameter == pytest.approx(math.pi / 2 / ellipk(sine**2), rel=1e-9)
        assert energy == pytest.approx(2 * sine**2, rel=1e-6)
    assert (tmp_path / "duffing.png").is_file() and (tmp_path / "duffing.nc").is_file()
