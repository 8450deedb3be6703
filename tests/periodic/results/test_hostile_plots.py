"""Pictures of branches whose names are written to break them, as SVG: texts letter by letter, no formula."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest
from matplotlib.axes import Axes
from support.attacks import ATTACKS, hostile

import periodic as per

NAMES = {**ATTACKS, "half a formula": "a_$b", "wrong formula": r"$\frac{$", "escaped": r"\$x\$"}


def texts(axes: Axes, file: Path) -> set[str]:
    """All texts of a picture that is written as SVG; it must be well formed and run and link nothing."""
    axes.figure.set_size_inches(30, 30)  # the names are long
    with mpl.rc_context({"svg.fonttype": "none"}):
        axes.figure.savefig(file)
    plt.close("all")
    found = list(ElementTree.parse(file).iter())
    kinds = {element.tag.rpartition("}")[2] for element in found}
    assert not kinds & {"script", "a", "image", "foreignObject", "animate"}
    assert not [name for element in found for name in element.attrib if name.startswith("on")]
    return {"".join(element.itertext()) for element in found if element.tag.endswith("}text")}


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES.keys())
def test_pictures(name: str, tmp_path: Path) -> None:
    """Assert axes, labels of points and legends of a branch, an orbit and its spectra."""
    _, branch = hostile(name)
    shown = texts(per.plot(branch), tmp_path / "a.svg")
    assert {f"{name} k ({name})", f"{name} e"} <= shown
    shown = texts(per.plots.orbit(branch[0], name), tmp_path / "b.svg")
    assert f"{name} ({name})" in shown
    assert f"frequency of {name} (Hz)" in texts(per.plots.waterfall(branch), tmp_path / "c.svg")
