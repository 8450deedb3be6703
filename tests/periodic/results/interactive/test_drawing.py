"""What a page draws: scale bars, magnification and shapes, by hand."""

from __future__ import annotations

import base64
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.results.interactive import drawing as module
from periodic.results.interactive.drawing import _bar, _deflected, drawing, packed, sketch_of


@pytest.mark.parametrize(
    ("largest", "unit", "length", "text"),
    [
        (1.0, "", 1.0, "1"),
        (1.999, "", 1.0, "1"),
        (2.0, "", 2.0, "2"),
        (4.9, "", 2.0, "2"),
        (5.0, "", 5.0, "5"),
        (9.99, "", 5.0, "5"),
        (0.0031, "m", 0.002, "2 mm"),
        (7e-6, "m", 5e-6, "5 um"),
    ],
)
def test_scale_bar(largest: float, unit: str, length: float, text: str) -> None:
    """Assert the largest of 1, 2 and 5 times a power of ten up to the movement, and its size as drawn."""
    found = _bar(largest, unit)
    assert found["length"] == pytest.approx(0.4 * length / largest, rel=1e-12)
    assert found["text"].replace("\N{MICRO SIGN}", "u").replace("\N{GREEK SMALL LETTER MU}", "u") == text


def test_numbers_as_text() -> None:
    """Assert 32-bit floats, the last index fastest."""
    values = np.array([[1.5, -2.0], [0.25, 4.0]])
    found = np.frombuffer(base64.b64decode(packed(values.T)), "<f4")
    assert found.tolist() == [1.5, 0.25, -2.0, 4.0]


def shape(kind: str = "box", moved: str = "x", **more: Any) -> dict[str, Any]:
    """A shape that one name moves."""
    lengths: dict[str, Any] = {key: {"moved": []} for key in ("x", "y", "size", "depth")}
    return {"kind": kind, "of": [moved], **lengths, "x": {"moved": [(moved, 1.0)]}, **more}


def point(**parameters: float) -> Any:
    """A point with nothing but parameters."""
    return SimpleNamespace(orbit=SimpleNamespace(parameters=parameters, mesh=SimpleNamespace(period=6.0)))


def test_magnification_and_numbers() -> None:
    """Assert 0.4 over the largest of signals in SI and of parameters, and only what shapes are moved by."""
    orbits = np.array([[[1.0, -4.0], [90.0, 0.0]], [[2.0, 3.0], [0.0, 0.0]]])
    signals = {"x": (0, 1e-3), "other": (1, 1.0)}
    points = [point(gap=-2e-3, k=7.0), point(gap=1e-3, k=7.0)]
    found = drawing([shape()], points, signals, orbits, {"x": "m"}, None)
    assert found is not None
    assert found["signals"] == {"x": [0, 1e-3]} and found["numbers"] == {}
    assert found["magnified"] == pytest.approx(0.4 / 4e-3) and found["bar"]["text"] == "2 mm"
    both = drawing([shape(), shape(moved="gap")], points, signals, 0.1 * orbits, {"x": "m"}, None)
    assert both is not None and both["numbers"] == {"gap": [-2e-3, 1e-3]}
    assert both["magnified"] == pytest.approx(0.4 / 2e-3) and len(both["shapes"]) == 2
    still = drawing([shape()], points, signals, 0 * orbits, {}, None)
    assert still is not None and still["magnified"] == 0.4


def test_nothing_to_draw() -> None:
    """Assert None without shapes, and where one is moved by what is not on the page."""
    orbits = np.ones((1, 1, 2))
    assert drawing([], [point()], {"x": (0, 1.0)}, orbits, {}, None) is None
    assert drawing([shape(moved="y")], [point()], {"x": (0, 1.0)}, orbits, {}, None) is None
    assert sketch_of(object()) == []
    assert sketch_of(SimpleNamespace(sketch=[{"kind": "box"}])) == [{"kind": "box"}]


@pytest.mark.parametrize(
    ("count", "kept"),
    [(5, [0, 1, 2, 3, 4]), (20, list(range(20))), (21, [*range(0, 20, 2), 20]), (61, [*range(0, 60, 4), 60])],
)
def test_nodes_of_structures(count: int, kept: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert every k-th up to some 20 and the last, displaced at instants of a period."""

    def displaced(system: Any, orbit: Any, nodes: Any, phases: Any, structure: str) -> Any:
        assert (system, structure, len(phases), phases[0]) == ("system", "s", 32, 0.0)
        assert phases[1] == pytest.approx(6.0 / 32)
        return np.outer(phases, np.arange(len(nodes)))

    monkeypatch.setattr(module, "displacements", displaced)
    line = shape("line", nodes=[("x", k) for k in range(count)], structure="s")
    system: Any = "system"
    found = _deflected(line, [point(), point()], system)
    assert [k for _, k in found["nodes"]] == kept
    assert found["values"].shape == (2, len(kept), 32)
    assert found["values"][1, 2, 1] == pytest.approx(2 * 6.0 / 32)
    box = shape()
    assert _deflected(box, [point()], system) == box and _deflected(line, [point()], None) == line
