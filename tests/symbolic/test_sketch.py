"""Drawings of models: what parts say of their looks, as plain data."""

from __future__ import annotations

import json
import math

import pytest

import symbolic as sym


def kinds(name: str) -> list[tuple[str, str]]:
    """Kind and look of every shape of a scene."""
    return [(str(shape["kind"]), str(shape["look"])) for shape in sym.scene(name).sketch]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("duffing", [("block", "body")]),
        ("gear-pair", [("wall", "fixed"), ("wall", "fixed"), ("block", "body")]),
        ("vitrea79-810N", [("block", "film"), ("disc", "body"), ("disc", "body")]),
        ("jeffcott-rub", [("disc", "body"), ("disc", "mark"), ("ring", "fixed")]),
        ("ball-bearing", [("ring", "fixed"), ("disc", "body"), *[("disc", "mark")] * 8]),
    ],
)
def test_shapes_of_scenes(name: str, expected: list[tuple[str, str]]) -> None:
    """Assert the shapes of each scene, once, and that they are plain data."""
    assert kinds(name) == expected
    shapes = list(sym.scene(name).sketch)
    assert json.loads(json.dumps(shapes)) == shapes


@pytest.mark.parametrize("name", ["jeffcott-rub", "ball-bearing"])
def test_rotor_lies_in_the_middle_of_its_ring(name: str) -> None:
    """Assert that a rotor and its ring have one centre, from which the rotor alone moves."""
    shapes = {shape["look"]: shape for shape in sym.scene(name).sketch}
    rotor, ring = shapes["body"], shapes["fixed"]
    assert rotor["x"] == {"fixed": 0.0, "moved": [["x", 1.0]]}
    assert rotor["y"] == {"fixed": 0.0, "moved": [["y", 1.0]]}
    assert ring["x"] == ring["y"] == {"fixed": 0.0, "moved": []}
    assert ring["size"]["moved"] == [["clearance", 1.0]]  # type: ignore[index]


def test_names_of_what_moves() -> None:
    """Assert that coordinates and parameters are called as the system calls them."""
    p, q = sym.coordinate("p"), sym.coordinate("q")
    model = sym.Mass(p, 1.0) + sym.Mass(q, 2.0) + sym.Spring(p, 1.0) + sym.Spring(q, 1.0, to=p)
    model = model + sym.OneSidedSpring(p, 5.0, gap=0.5) + sym.OneSidedSpring(q, 5.0, gap=0.7, below=True)
    system = sym.compile(model)
    names = {v.name for v in (*system.outputs, *system.parameters)}
    right, left, first, second = system.sketch
    assert right["x"] == {"fixed": 0.3, "moved": [["gap_p", 1.0]]}
    assert left["x"]["moved"] == [["gap_q", -1.0]] and left["size"]["fixed"] == -1  # type: ignore[index]
    assert first["x"]["moved"] == [["p", 1.0]] and second["x"]["moved"] == [["q", 1.0]]  # type: ignore[index]
    assert {"gap_p", "gap_q", "p", "q"} <= names
    assert right["x"]["fixed"] == pytest.approx(0.3) and second["x"]["fixed"] != first["x"]["fixed"]  # type: ignore[index]


def test_angles_are_in_the_phase() -> None:
    """Assert that a turn of a shaft is a turn, where the system's phase is that of half an order too."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    model = sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.Spring(x, 1.0) + sym.Spring(y, 1.0)
    model = model + sym.Unbalance(x, y, 1.0, 0.1, speed=1.0, angle=math.pi / 2)
    (_, heavy) = sym.compile(model).sketch
    assert heavy["turn"] == 1.0 and heavy["start"] == pytest.approx(math.pi / 2)
    omega = sym.parameter("speed", 1.0, "rad/s")
    halved = sym.compile(
        sym.Mass(x, 1.0)
        + sym.Mass(y, 1.0)
        + sym.Spring(x, 1.0)
        + sym.Spring(y, 1.0)
        + sym.Unbalance(x, y, 1.0, 0.1, speed=omega)
        + sym.HarmonicForce(x, 0.1, omega, order="1/2")
    )
    turns = [shape["turn"] for shape in halved.sketch if shape["look"] == "mark"]
    assert turns == [2.0]


def test_structure_is_a_line() -> None:
    """Assert the nodes of a beam, condensed or with all its states, and no blocks nor walls besides."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=3)
    structure = sym.Structure(beam, damping=0.02)
    tip = structure["tip"]
    model = structure + sym.HarmonicForce(tip, 0.01, 2.6) + sym.OneSidedSpring(tip, 3.0, gap=0.03)
    for condense in (True, False):
        (line,) = sym.compile(model, condense=condense).sketch
        assert line["kind"] == "line" and line["structure"] == "structure"
        assert [k for _, k in line["nodes"]] == [0, 2, 4]  # type: ignore[attr-defined]


def test_discs_in_contact_move_with_their_own_coordinates() -> None:
    """Assert two discs that touch at rest, the upper one moved up by one coordinate, the lower one down."""
    upper, lower = sym.coordinate("upper"), sym.coordinate("lower")
    pair = sym.ContactPair(upper, lower)
    model = sym.Mass(upper, 1.0) + sym.Mass(lower, 1.0) + sym.Preload(pair, 10.0) + sym.Hertz(pair, 1e9)
    model = model + sym.HarmonicForce(upper, 0.1)
    below, above = (shape for shape in sym.compile(model).sketch if shape["kind"] == "disc")
    assert below["y"]["fixed"] == -above["y"]["fixed"] < 0  # type: ignore[index]
    assert below["size"]["fixed"] == above["size"]["fixed"] == above["y"]["fixed"]  # type: ignore[index]
    assert below["y"]["moved"] == [["lower", -1.0]] and above["y"]["moved"] == [["upper", 1.0]]  # type: ignore[index]
