"""Texts that a terminal would obey, or that would make a record of their own in another program's file."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.attacks import hostile

import periodic as per
from periodic.maps.cell import Outcome
from periodic.orbit.layout import Quantity
from periodic.results import netcdf
from periodic.results.described import differences
from periodic.results.stop import Reason, Stop

OBEYED = ["\x1b[31m", "\x1b]0;title\x07", "\x9b2J", "a\rb", "a\nb", "\b", "a\u202eb", "\u2066", "a\u2028b"]
"""Colours, titles, control sequences of one sign, moves back, line ends, and what turns the reading round."""

Change = Callable[[dict[str, Any], str], None]


@pytest.mark.parametrize("text", OBEYED)
def test_names_and_units(text: str) -> None:
    """Assert that no system has such a name or unit, and that the sentence shows it written out."""
    for given in ({"name": text}, {"name": "x", "unit": text}):
        with pytest.raises(ValueError, match="it must be one line of text") as caught:
            Quantity(**given)
        assert str(caught.value).isprintable()


@pytest.mark.parametrize("text", OBEYED)
def test_names_of_a_user(text: str) -> None:
    """Assert the same of columns and events."""
    for given in ({"columns": {text: per.Maximum("x")}}, {"events": {text: per.Level(per.Maximum("x"), 1)}}):
        with pytest.raises(ValueError, match="a name in .*; it must be one line of text") as caught:
            per.Watch(**given)
        assert str(caught.value).isprintable()


@pytest.mark.parametrize("text", OBEYED)
def test_sentences(text: str) -> None:
    """Assert that reasons and differences are printed on one line, with such signs written out."""
    said = [
        Stop(Reason.SMALL_STEP, text).detail,
        Outcome((1.0,), reason=text).reason,
        *differences({"f": {"a": text}}, {"f": {"a": 1}}),
    ]
    assert len(said) == 3 and all(each.isprintable() for each in said)


def changed(name: str, of: Callable[[Any, str], Any]) -> Change:
    """Change what a file says under a name."""

    def change(attributes: dict[str, Any], text: str) -> None:
        attributes[name] = json.dumps(of(json.loads(attributes[name]), text))

    return change


def _unit(layout: Any, text: str) -> Any:
    layout["parameters"][0][1] = text
    return layout


def _over(attributes: dict[str, Any], text: str) -> None:
    attributes["parameter"] = text


CHANGES: dict[str, Change] = {
    "parameter": _over,
    "unit": changed("layout", _unit),
    "columns": changed("columns", lambda found, text: [text] * len(found)),
    "versions": changed("versions", lambda found, text: found | {"numpy": text}),
    "events": changed("made", lambda found, text: found | {"events": {text: 1}}),
}


@pytest.mark.parametrize("text", ["\x1b[31m", "a\nb"])
@pytest.mark.parametrize("what", CHANGES)
def test_branch_file(what: str, text: str, tmp_path: Path) -> None:
    """Assert that a file with such a name is refused, its seal and checksum made anew."""
    _, branch = hostile("y")
    data = netcdf.dataset(branch)
    CHANGES[what](data.attrs, text)
    path = written(tmp_path, data)
    with pytest.raises(per.BranchFileError, match="is damaged") as caught:
        per.Branch.load(path)
    assert str(caught.value).isprintable()


def written(folder: Path, data: Any) -> Path:
    """A branch file of a data set."""
    data.attrs["checksum"] = netcdf.checksum(data)
    path = folder / "b.nc"
    path.write_bytes(netcdf.packed(data))
    return path


def test_event_of_a_file(tmp_path: Path) -> None:
    """Assert the same of the name of an event at a point."""
    _, branch = hostile("y")
    data = netcdf.dataset(branch)
    data["event"] = ("point", np.array(["\x1b[31m"] * len(branch), dtype=object))
    with pytest.raises(per.BranchFileError, match="a name that is not one line of text"):
        per.Branch.load(written(tmp_path, data))


def test_parameter_that_a_file_has_not(tmp_path: Path) -> None:
    """Assert one sentence for a branch over a parameter that its orbits do not have."""
    _, branch = hostile("y")
    data = netcdf.dataset(branch)
    data.attrs["parameter"] = "unheard of"
    with pytest.raises(per.BranchFileError, match="it is over a parameter that it has not"):
        per.Branch.load(written(tmp_path, data))


def test_reason_of_a_file(tmp_path: Path) -> None:
    """Assert that why a branch ended is shown with such signs written out."""
    _, branch = hostile("y")
    data = netcdf.dataset(branch)
    data.attrs["stop"] = json.dumps(["BOUND", "\x1b[31m\n"])
    found = per.Branch.load(written(tmp_path, data))
    assert r"\x1b[31m\n" in repr(found) and repr(found).isprintable()


@pytest.mark.parametrize("name", ["-1", "    -1", "-1 x", "y     -1", "=1", "."])
def test_uff(name: str, tmp_path: Path) -> None:
    """Assert that no name is taken for the line that ends a data set."""
    import pyuff

    _, plain = hostile("y")
    _, branch = hostile(name)
    counts = []
    for each in (plain, branch):
        (file,) = per.export(each, tmp_path / "a.uff", samples=8)
        text = file.read_text("utf-8")
        assert text.count("    -1") == sum(line == "    -1" for line in text.splitlines())
        sets = pyuff.UFF(str(file)).read_sets()
        counts.append(len(sets) / len(each))
        assert all(len(line) <= 81 for line in text.splitlines())
    assert counts[0] == pytest.approx(counts[1], rel=0.2) and len(sets) == text.count("    -1") / 2
    assert sets[1]["id1"].strip().lstrip("'") == " ".join(f"{name} p-p".split())


@pytest.mark.parametrize("name", [".", "t", "a/b"])
def test_hdf5(name: str, tmp_path: Path) -> None:
    """Assert that a signal does not take the place of the times, nor of its group."""
    import h5py

    _, branch = hostile(name)
    per.export(branch, tmp_path / "a.h5", samples=8)
    with h5py.File(tmp_path / "a.h5") as file:
        orbits = file["orbits"]
        assert len(orbits) == 3 and orbits["t"].attrs["units"] == "s"
        own = {"units": [key for key in orbits if orbits[key].attrs["units"] == name]}
        assert own["units"], list(orbits)
        signal = branch[0].orbit[name](np.arange(8) / 8 * branch[0].orbit.period)
        assert any(np.array_equal(orbits[key][0], signal) for key in own["units"])
