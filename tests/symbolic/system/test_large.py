"""Models of thousands of coordinates: compiled in seconds, with a bar where somebody looks on."""

from __future__ import annotations

import time

import pytest

import symbolic as sym


def chain(count: int) -> sym.Model:
    """Masses between springs and dampers, the first driven."""
    q = sym.coordinates("x", count)
    parts: list[sym.Part] = [sym.HarmonicForce(q[0], 1.0, 1.0)]
    for k in range(count):
        parts += [sym.Mass(q[k], 1.0), sym.Spring(q[k], 1.0), sym.Damper(q[k], 0.1)]
        parts += [sym.Coupling(q[k - 1], q[k], 1.0, 0.1)] if k else []
    return sym.combine(parts)


def test_time_grows_with_the_number_of_coordinates() -> None:
    """Assert that four times as many take less than ten times as long: it was sixteen, and minutes."""
    times = []
    for count in (100, 400):
        model = chain(count)
        begun = time.process_time()
        assert len(sym.compile(model, "numpy").states) == 2 * count
        times.append(time.process_time() - begun)
    assert times[1] < 10 * times[0] + 1.0


def test_a_bar(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that it says what is compiled and how far that is."""
    monkeypatch.setenv("ORBITRACE_PROGRESS", "1")
    monkeypatch.setattr("symbolic.meter.DELAY", 0.0)
    sym.compile(chain(20), "numpy")
    told = capsys.readouterr().err
    assert "compiling" in told and "/80" in told and "/20" in told
