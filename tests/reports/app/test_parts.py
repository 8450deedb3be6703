"""`orbitrace parts`, `orbitrace new`, scenes of the kind "model" and the axis on the command line."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import pytest
from support.commands import refusal

from reports.app.cli import main
from symbolic.scenes.model.catalogue import catalogue
from symbolic.scenes.names import scene_names
from symbolic.scenes.reading import load

Capture = pytest.CaptureFixture[str]
Patch = pytest.MonkeyPatch

OWN = '''
from dataclasses import dataclass
import symbolic as sym

@dataclass(frozen=True)
class SeventhPower(sym.Part):
    """Spring of the seventh power: force -k7 q^7.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k7 : float or Parameter
        k7 in N/m^7.
    """

    q: sym.Coordinate
    k7: float

    def contribute(self, assembly: sym.Assembly) -> None:
        motion = assembly.motion(self.q)
        motion.force -= assembly.parameter(self.k7, "k7", "N/m^7") * motion.position.symbol ** 7
'''


BEAM = """
title = "Clamped beam with a stop that it does not meet"
kind = "structure"
[[structure]]
name = "beam"
beam = {length = 0.3, bending = 1.4, mass_per_length = 0.16, elements = 10}
damping = 0.02
scale = 1e-3
[[part]]
kind = "OneSidedSpring"
q = "beam.tip"
k = 2000
gap = 5e-4
[[part]]
kind = "HarmonicForce"
q = "beam.tip"
force = 0.002
frequency = 80
[trace]
parameter = "Omega"
axis = "Hz"
from = 12
to = 14
"""


def traced(folder: Path, *arguments: str) -> dict[str, Any]:
    """Trace a scene and return what its JSON says."""
    assert main(["trace", *arguments, "--accuracy", "draft", "--out", str(folder)]) == 0
    found: dict[str, Any] = json.loads((folder / "branch.json").read_text("utf-8"))
    return found


@pytest.fixture
def start(tmp_path: Path) -> str:
    """The start of a model, written by `orbitrace new`."""
    file = tmp_path / "mine.toml"
    assert main(["new", "model", str(file)]) == 0
    return str(file)


def test_list(capsys: Capture) -> None:
    """Assert that every part is listed on a line of its own with its formula."""
    assert main(["parts"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(catalogue())
    assert "Spring " in "".join(lines) and "force -k (q - r)" in "".join(lines)


def test_one_part(capsys: Capture) -> None:
    """Assert that a part is shown with formula, keys, units, source and an example."""
    assert main(["parts", "Backlash"]) == 0
    told = capsys.readouterr().out
    for words in ("max(u - b, 0)", "variation", "N/m", "Kahraman", "[[part]]", 'kind = "Backlash"'):
        assert words in told


def test_unknown_part(capsys: Capture) -> None:
    """Assert that an unknown part is answered with the nearest one."""
    assert main(["parts", "backlsh"]) == 2
    assert 'nearest is "Backlash"' in capsys.readouterr().err


def test_start_is_traced(start: str, tmp_path: Path) -> None:
    """Assert that a start is a scene, and that its branch is told in its own parameter and unit."""
    found = traced(tmp_path / "out", start)
    for point in found["special_points"]:
        assert {"label", "parameter", "stable", "multipliers", "x_pp", "Omega"} <= point.keys()
        assert point["parameter"] == pytest.approx(point["Omega"], rel=1e-13)
    ends = [p["parameter"] for p in found["special_points"] if p["label"] == "EP"]
    assert ends == [0.4, 1.8]
    assert found["parameters"]["trace"] == {"parameter": "Omega", "from": 0.4, "to": 1.8}


@pytest.mark.parametrize("name", ["duffing", "vitrea79"])
def test_start_from_a_built_in_scene(name: str, tmp_path: Path) -> None:
    """Assert that the start of a word is the built-in scene of that name."""
    file = tmp_path / "mine.toml"
    assert main(["new", name, str(file)]) == 0
    full = next(n for n in scene_names() if name in n.split("-"))
    assert load(str(file)) == load(full)


def test_start_does_not_overwrite(start: str, capsys: Capture) -> None:
    """Assert that an existing file stays, and that an unknown kind is answered with those there are."""
    before = Path(start).read_text("utf-8")
    assert main(["new", "model", start]) == 2
    assert "which exists" in capsys.readouterr().err
    assert Path(start).read_text("utf-8") == before
    assert main(["new", "toaster", start + "2"]) == 2
    assert 'KIND is "toaster"; it must be model, or a word of' in capsys.readouterr().err


def test_axis(start: str, tmp_path: Path) -> None:
    """Assert that an axis changes the unit of the range, of --at and of the columns, not the parameter."""
    asked = ("--axis", "Hz", "--from", "0.08", "--to", "0.1", "--at", "0.09")
    points = traced(tmp_path / "out", start, *asked)["special_points"]
    assert [p["Omega_hz"] for p in points] == [0.08, 0.09, 0.1]
    assert [p["parameter"] for p in points] == pytest.approx([2 * math.pi * v for v in (0.08, 0.09, 0.1)])
    heading = (tmp_path / "out" / "branch.csv").read_text("utf-8").splitlines()[0]
    assert heading == "Omega_hz,x_pp,multiplier_max,stable,label,error_estimate"


@pytest.mark.parametrize(("scene", "column"), [("vitrea79-810N", "speed_hz"), ("duffing", "frequency_hz")])
def test_axis_of_other_kinds(scene: str, column: str, tmp_path: Path) -> None:
    """Assert that discs and oscillators take an axis too."""
    ends = {"speed_hz": ("7.5", "7.4"), "frequency_hz": ("0.05", "0.06")}[column]
    found = traced(tmp_path / "out", scene, "--axis", "Hz", "--from", ends[0], "--to", ends[1])
    assert [p[column] for p in found["special_points"]] == [float(end) for end in ends]


def test_axis_refused(start: str, capsys: Capture) -> None:
    """Assert that an unknown axis, and one of what is no frequency, are refused."""
    assert main(["trace", start, "--axis", "rpm"]) == 2
    assert '--axis is "rpm"; it must be rev/min, Hz or rad/s' in capsys.readouterr().err
    asked = ["--set", "trace.parameter=k_s", "--axis", "Hz"]
    assert main(["trace", start, *asked]) == 2
    assert "only an angular frequency" in capsys.readouterr().err


def test_own_parts(start: str, tmp_path: Path, monkeypatch: Patch, capsys: Capture) -> None:
    """Assert that a module in the working directory brings its parts, and a scene never does."""
    (tmp_path / "mine_of_the_seventh.py").write_text(OWN, "utf-8")
    text = Path(start).read_text("utf-8") + '\n[[part]]\nkind = "SeventhPower"\nq = "x"\nk7 = 0.1\n'
    source = tmp_path / "with.toml"
    source.write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    assert main(["trace", str(source)]) == 2
    assert 'kind is "SeventhPower"' in capsys.readouterr().err
    assert main(["parts", "SeventhPower", "--parts", "mine_of_the_seventh"]) == 0
    assert "k7 in N/m^7" in capsys.readouterr().out
    found = traced(tmp_path / "out", str(source), "--parts", "mine_of_the_seventh", "--to", "0.45")
    assert found["stop"] == "bound reached"


def test_own_parts_refused(capsys: Capture) -> None:
    """Assert that a module that is not there, or has no part, is refused in a sentence."""
    assert main(["parts", "--parts", "there_is_no_such_module"]) == 2
    assert '--parts is "there_is_no_such_module" (ModuleNotFoundError' in capsys.readouterr().err
    assert main(["parts", "--parts", "json"]) == 2
    assert '--parts is "json", which has no part' in capsys.readouterr().err


def test_linear(start: str, tmp_path: Path, capsys: Capture) -> None:
    """Assert that the linear study takes a model."""
    assert main(["linear", start, "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    assert "resonance of the lowest mode: 1 rad/s" in told and "x p-p" in told


@pytest.mark.parametrize("command", ["trace", "linear"])
def test_load_that_nothing_carries(command: str, start: str, tmp_path: Path, capsys: Capture) -> None:
    """Assert that a model without equilibrium is refused in one sentence."""
    text = Path(start).read_text("utf-8").replace('kind = "Spring"', 'kind = "OneSidedSpring"\ngap = 0.5')
    text += '\n[[part]]\nkind = "ConstantForce"\nq = "x"\nforce = -0.1\n'
    source = tmp_path / "free.toml"
    source.write_text(text, "utf-8")
    capsys.readouterr()
    said = refusal(capsys, command, str(source), "--out", str(tmp_path / "out"))
    assert said.startswith("scene has no equilibrium that was found at Omega = 0.4; something must carry")
    assert not list((tmp_path / "out").iterdir())


def test_structure(tmp_path: Path, capsys: Capture) -> None:
    """Assert that a beam in text is traced at its place: peak to peak of its response where it is linear."""
    source = tmp_path / "beam.toml"
    source.write_text(BEAM, "utf-8")
    found = traced(tmp_path / "out", str(source))["special_points"]
    assert main(["linear", str(source), "--at", "12,14", "--out", str(tmp_path / "out"), "--json"]) == 0
    linear = json.loads((tmp_path / "out" / "linear.json").read_text("utf-8"))["at"]
    for point, expected in zip(found, linear, strict=True):
        assert point["tip_pp"] == pytest.approx(expected["linear_response"]["tip_pp_m"], rel=1e-4)
