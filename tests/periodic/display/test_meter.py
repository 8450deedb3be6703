"""A bar for what takes longer than a second, where somebody looks on."""

from __future__ import annotations

import re
import time
from typing import Any

import pytest
from support.traces import duffing_system

import periodic as per
import symbolic as sym
from periodic.display import meter as display
from periodic.display.meter import meter, say, watched

Capture = pytest.CaptureFixture[str]
Patch = pytest.MonkeyPatch


@pytest.fixture
def at_once(monkeypatch: Patch) -> None:
    """Somebody looks on, and bars are shown at once and at every step."""
    monkeypatch.setenv("ORBITRACE_PROGRESS", "1")
    monkeypatch.setattr(display, "DELAY", 0.0)
    monkeypatch.setattr(display, "EVERY", 0.0)


@pytest.mark.parametrize(("told", "expected"), [("1", True), ("0", False), ("", False)])
def test_who_looks_on(told: str, expected: bool, monkeypatch: Patch) -> None:
    """Assert that the environment decides, and that without it nobody looks at a pipe."""
    monkeypatch.setenv("ORBITRACE_PROGRESS", told)
    assert watched() is expected


@pytest.mark.usefixtures("at_once")
def test_trace_is_shown(capsys: Capture) -> None:
    """Assert that a trace counts its points on standard error and takes its bar away at the end."""
    branch = per.trace(duffing_system(0.1, 1.0, 0.5), "Omega", (0.3, 0.5))
    told = capsys.readouterr()
    assert told.out == "" and "tracing over Omega" in told.err and "at 0.3" in told.err
    assert re.split(r"[\r\n]", told.err.rstrip("\r\n"))[-1].strip() == "" and len(branch) > 1


@pytest.mark.usefixtures("at_once")
def test_search_for_a_first_orbit_is_shown(capsys: Capture) -> None:
    """Assert that the bar says in turn what is being tried where no orbit is found at the start itself."""
    free = sym.functions

    def loose(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        play = free.fmax(x.x - 1, 0) + free.fmin(x.x + 1, 0)
        return {"x": x.v, "v": -0.05 * x.v - play + 0.1 + 0.05 * wave.cos}

    system = sym.compile(sym.Equations(loose, {"x": 0.0, "v": 0.0}, {"Omega": 0.8}, frequency="Omega"))
    per.trace(system, "Omega", (0.8, 1.0), control=per.ArclengthControl(max_points=2))
    told = capsys.readouterr().err
    said = [told.find(f"looking for a first orbit: {what}") for what in ("at the start", "a simulation")]
    assert 0 <= said[0] < said[1] < told.find("at 0.8")


@pytest.mark.usefixtures("at_once")
def test_long_silence_is_shown(capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that what was said before the bar is shown stands there once it is, though nothing follows."""
    monkeypatch.setattr(display, "DELAY", 0.05)
    with meter("tracing", "points"):
        say("looking for it")
        assert "looking for it" not in capsys.readouterr().err
        time.sleep(0.3)
        assert "looking for it" in capsys.readouterr().err


def test_nobody_is_told_without_a_bar(capsys: Capture) -> None:
    """Assert silence, outside a bar and within one that nobody sees."""
    say("anything")
    with meter("tracing", "points"):
        say("anything")
    assert capsys.readouterr().err == ""


@pytest.mark.usefixtures("at_once")
def test_own_progress_takes_its_place(capsys: Capture) -> None:
    """Assert that a progress of the user's is not shown twice."""
    seen: list[per.Point] = []
    system, watch = duffing_system(0.1, 1.0, 0.5), per.Watch(progress=seen.append)
    branch = per.trace(system, "Omega", (0.3, 0.5), watch=watch)
    assert capsys.readouterr().err == "" and len(seen) == len(branch)


@pytest.mark.usefixtures("at_once")
def test_one_bar_at_a_time(capsys: Capture) -> None:
    """Assert that a map counts its cells, and that traces within it have no bars of their own."""
    task = per.maps.Task(
        duffing_system(0.1, 1.0, 0.5),
        "Omega",
        (0.3, 0.4),
        numbers={"peak": per.maps.Highest(per.PeakToPeak("x"))},
    )
    per.design_map(task, {"F": [0.1, 0.2]}, store=None)
    told = capsys.readouterr().err
    assert "mapping" in told and "2/2" in told and "tracing" not in told


def test_nothing_is_shown_of_quick_work(capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that work shorter than a second shows nothing."""
    monkeypatch.setenv("ORBITRACE_PROGRESS", "1")
    with meter("quick", "steps", 2) as advance:
        advance(2, "done")
    assert "quick" not in capsys.readouterr().err


def test_interrupt_leaves_the_branch() -> None:
    """Assert that an interrupted trace says where its points are, which are in the exception."""

    def press(point: per.Point) -> None:
        if point.parameter > 0.35:
            raise KeyboardInterrupt

    with pytest.raises(
        per.Interrupted, match=r"after \d+ points, which are the `branch` of this exc"
    ) as caught:
        per.trace(duffing_system(0.1, 1.0, 0.5), "Omega", (0.3, 0.5), watch=per.Watch(progress=press))
    assert len(caught.value.branch) > 1
