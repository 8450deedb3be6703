"""Scenes composed in text: what a table of a part may say, what it becomes, and what is refused."""

from __future__ import annotations

import pickle
import re
from dataclasses import dataclass, fields
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from support.models import draw, residual_in_order

import symbolic as sym
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError
from symbolic.scenes.model.catalogue import catalogue
from symbolic.scenes.model.composing import composed
from symbolic.scenes.model.scene import ModelScene
from symbolic.scenes.reading import Override, load

HEAD = 'title = "Mine"\nkind = "model"\n'
COORDINATES = '[[coordinate]]\nname = "x"\nstart = 0.4\n[[coordinate]]\nname = "y"\nscale = 2.0\n'
RANGE = '[trace]\nparameter = "Omega"\nfrom = 0.5\nto = 1.5\n'
PARTS = """
[[part]]
kind = "Mass"
q = ["x", "y"]
m = 1.5
[[part]]
kind = "Spring"
q = "x"
k = "stiffness"
[[part]]
kind = "Spring"
q = "x"
to = "y"
k = "stiffness"
[[part]]
kind = "Damper"
name = "left"
q = "x"
c = 0.1
[[part]]
kind = "Damper"
name = "right"
q = "y"
c = 0.2
[[part]]
kind = "Backlash"
q = "y"
k = 2
b = 0.1
variation = {kind = "FourierSeries", cosines = [0.1, 0.0, 0.05], sines = [0.2]}
[[part]]
kind = "HarmonicForce"
q = "x"
force = 0.3
order = "1/2"
phase = 0.7
"""
SHARED = '[parameters]\nstiffness = {value = 2.5, unit = "N/m"}\n'
TEXT = HEAD + SHARED + COORDINATES + PARTS + RANGE


def written(folder: Path, text: str) -> str:
    """Write a scene file and return its path."""
    file = folder / "mine.toml"
    file.write_text(text, "utf-8")
    return str(file)


def scene(folder: Path, text: str = TEXT, *overrides: Override) -> ModelScene:
    """Load a scene of a text."""
    found = load(written(folder, text), overrides)
    assert isinstance(found, ModelScene)
    return found


def sentence(folder: Path, text: str, *overrides: Override) -> str:
    """Return the sentence with which a scene is refused."""
    with pytest.raises(InputError) as caught:
        load(written(folder, text), overrides)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def same_by_hand() -> sym.CompiledSystem:
    """The model of TEXT, written in Python."""
    x, y = sym.coordinate("x", start=0.4), sym.coordinate("y", scale=2.0)
    k = sym.parameter("stiffness", 2.5, "N/m")
    varied = sym.FourierSeries((0.1, 0.0, 0.05), (0.2,))
    parts = [sym.Mass(x, 1.5), sym.Mass(y, 1.5), sym.Spring(x, k), sym.Spring(x, k, to=y)]
    parts += [sym.Damper(x, 0.1).named("left"), sym.Damper(y, 0.2).named("right")]
    parts += [sym.Backlash(y, 2.0, 0.1, variation=varied), sym.HarmonicForce(x, 0.3, 1.0, "1/2", 0.7)]
    return sym.compile(sym.combine(parts))


def test_text_is_the_model_in_python(tmp_path: Path) -> None:
    """Assert that tables come to the very equations, parameters and switches of the parts in Python."""
    system, hand = build(scene(tmp_path)), same_by_hand()
    assert system.parameters == hand.parameters and system.switches == hand.switches
    assert {"c_left", "c_right", "stiffness"} < {p.name for p in system.parameters}
    points = draw(hand)
    np.testing.assert_array_equal(residual_in_order(points, hand, system), hand.residual(*points.arguments))
    np.testing.assert_array_equal(system.rest(system.nominal)[0], hand.rest(hand.nominal)[0])


def test_vector_of_coordinates(tmp_path: Path) -> None:
    """Assert that a count makes a vector, and that lists lay a part on each of its coordinates."""
    text = HEAD + '[[coordinate]]\nname = "x"\ncount = 3\n'
    text += '[[part]]\nkind = "Mass"\nq = ["x1", "x2", "x3"]\nm = 1\n'
    text += '[[part]]\nkind = "Spring"\nq = ["x1", "x2"]\nto = ["x2", "x3"]\nk = 3\n'
    text += '[[part]]\nkind = "Spring"\nq = "x1"\nk = 3\n'
    text += '[[part]]\nkind = "HarmonicForce"\nq = "x1"\nforce = 1\n'
    frequencies = sym.modes(build(scene(tmp_path, text + RANGE))).frequencies
    matrix = 3.0 * np.array([[2, -1, 0], [-1, 2, -1], [0, -1, 1]])
    np.testing.assert_allclose(frequencies, np.sqrt(np.linalg.eigvalsh(matrix)), rtol=1e-12)


def test_wavy_disc_in_text(tmp_path: Path) -> None:
    """Assert that contact parts share the pair that they name, and a law is a table: the dry disc."""
    text = HEAD + '[[coordinate]]\nname = "x"\n'
    for kind, rest in (
        ("ReducedMass", 'q = "x"\nm1 = 20.4\nm2 = 20.4'),
        ("Preload", 'pair = "x"\nforce = 810'),
        ("ElasticContact", 'pair = ["x"]\nlaw = {kind = "HertzLaw", stiffness = 28e9}'),
        ("Waviness", 'pair = {coordinates = ["x"]}\namplitude = 1.27e-6\nwaves = 120\nspeed = 50'),
        ("ContactDamping", 'pair = "x"\nratio = 0.007'),
    ):
        text += f'[[part]]\nkind = "{kind}"\n{rest}\n'
    text += '[trace]\nparameter = "speed"\naxis = "rev/min"\nfrom = 500\nto = 100\n'
    found, dry = scene(tmp_path, text), sym.scene("dry-810N")
    assert found.trace.bounds == pytest.approx((500 * np.pi / 30, 100 * np.pi / 30))
    system = build(found)
    names = {"mass": ("m1", "m2")}
    points = draw(dry)
    values = dict(zip([p.name for p in dry.parameters], points.parameter, strict=True))
    values |= {new: values[old] for old, both in names.items() for new in both}
    parameter = np.array([values[p.name] for p in system.parameters])
    assert [s.scale for s in system.states] == [s.scale for s in dry.states]
    found_rows = system.residual(*points.arguments[:-1], parameter)
    expected = dry.residual(*points.arguments)
    # Each scales its equation of motion by its own nominal frequency.
    found_rows[:, 1] *= 50**2 / (500 * np.pi / 30) ** 2
    np.testing.assert_allclose(found_rows, expected, rtol=1e-12)


OVERRIDES: list[tuple[str, str, str, float]] = [
    ("m", "2", "m", 2.0),
    ("c_left", "0.3", "c_left", 0.3),
    ("part.left.c", "0.4", "c_left", 0.4),
    ("part.Backlash.b", "0.2", "b", 0.2),
    ("part.Backlash.variation.sines", "[0.3]", "b_1", 0.3),
    ("parameters.stiffness", "4", "stiffness", 4.0),
    ("stiffness", "5", "stiffness", 5.0),
    ("b", "0.3", "b", 0.3),
]


@pytest.mark.parametrize(("key", "text", "name", "value"), OVERRIDES, ids=[row[0] for row in OVERRIDES])
def test_override(tmp_path: Path, key: str, text: str, name: str, value: float) -> None:
    """Assert that keys of parts, shared parameters and parameters of the model take other values."""
    system = build(scene(tmp_path, TEXT, (key, text)))
    assert {p.name: p.value for p in system.parameters}[name] == value


def test_values_are_pickled(tmp_path: Path) -> None:
    """Assert that a system keeps the scene's values on its way to another process."""
    system = build(scene(tmp_path, TEXT, ("c_left", "0.3")))
    assert pickle.loads(pickle.dumps(system)).parameters == system.parameters


def test_override_of_the_range(tmp_path: Path) -> None:
    """Assert that range and axis are keys."""
    found = scene(tmp_path, TEXT, ("trace.axis", "Hz"), ("trace.to", "0.3"))
    assert found.trace.bounds == pytest.approx((np.pi, 0.6 * np.pi))


def replaced(old: str, new: str) -> str:
    """TEXT with something else in it."""
    assert old in TEXT
    return TEXT.replace(old, new)


REFUSED = [
    (
        replaced('kind = "Backlash"', 'kind = "Baklash"'),
        r'\[\[part\]\] 6 kind is "Baklash"; it must be the name of a part .*; nearest is "Backlash"',
    ),
    (
        replaced("force = 0.3", "forse = 0.3"),
        r"\[\[part\]\] 7 \(HarmonicForce\) .forse. is not a key; nearest is force; it may have q, force, .*",
    ),
    (replaced("b = 0.1\n", ""), r"\[\[part\]\] 6 \(Backlash\) b is missing; it must be a number or .*"),
    (
        replaced("b = 0.1\n", "b = -0.1\n"),
        r"\[\[part\]\] 6 \(Backlash\): half backlash b is -0.1; it must be a number of at least 0",
    ),
    (replaced("c = 0.1", "c = nan"), r"\[\[part\]\] 4 \(Damper\) c is nan; it must be a number or .*"),
    (replaced("c = 0.1", 'c = "stifness"'), r'.* is "stifness"; .*; nearest is "stiffness"'),
    (replaced("c = 0.1", "c = true"), r"\[\[part\]\] 4 \(Damper\) c is true; it must be a number or .*"),
    (replaced('q = "y"\nk', 'q = "z"\nk'), r'.* q is "z"; it must be the name of a \[\[coordinate\]\]; .*'),
    (
        replaced('order = "1/2"', "order = 1.41421356"),
        r"order is 1.41421356; it must be a positive rational .* no common period otherwise",
    ),
    (replaced('order = "1/2"', "order = 0"), r"order is 0; it must be a positive rational .*"),
    (replaced('"FourierSeries"', '"Fourier"'), r'.* kind is "Fourier"; .*; nearest is "FourierSeries"'),
    (replaced("cosines = [0.1", 'cosines = ["a"'), r".* cosines\[1\] is \"a\"; it must be a number or .*"),
    (
        replaced('parameter = "Omega"', 'parameter = "omga"'),
        r'.*trace.parameter is "omga"; .* nearest is "Omega"',
    ),
    (
        replaced("from = 0.5", "from = -1"),
        r"trace.from is -1; the frequency of the excitation .* greater than 0",
    ),
    (replaced("to = 1.5", "to = 0.5"), r"trace.to is 0.5; it must differ from trace.from .*"),
    (replaced("to = 1.5", "too = 1.5"), r"trace.too is not a key .*; \[trace\] may have parameter, from, .*"),
    (
        replaced("[trace]", "[trace]\naxis = 'rpm'"),
        r'trace.axis is "rpm"; it must be "rev/min", "Hz" or "rad/s"',
    ),
    (
        replaced('parameter = "Omega"', 'parameter = "stiffness"\naxis = "Hz"'),
        r'trace.axis of a parameter in "N/m" is "Hz"; only an angular frequency .*',
    ),
    (replaced("scale = 2.0", "scale = -2.0"), r"coordinate.2.scale is -2.0; it must be a positive number .*"),
    (replaced('name = "y"\nsc', 'name = "x"\nsc'), r'.*name is "x"; it must be one of its own'),
    (replaced("m = 1.5", "m = 0"), r"coordinate '.' has no mass; add a Mass on it"),
    (replaced("m = 1.5", "m = -1"), r"\[\[part\]\] 1 \(Mass\): mass m is -1.0; it must be .* at least 0"),
    (replaced('kind = "Mass"', 'knd = "Mass"'), r"\[\[part\]\] 1 kind is missing; .*"),
    (replaced('kind = "Mass"', 'kind = "Equations"'), r'\[\[part\]\] 1 kind is "Equations"; .*'),
    (HEAD + RANGE, "part is missing; it must be tables .*"),
    (HEAD + "part = []\n" + RANGE, r"part is a list; it must be tables .*"),
    (TEXT + "[values]\nq = 1.0\n", r'\[values\] is "q"; it must be the name of a parameter .*'),
]


@pytest.mark.parametrize(("text", "said"), REFUSED, ids=[said for _, said in REFUSED])
def test_refused_in_one_sentence(tmp_path: Path, text: str, said: str) -> None:
    """Assert that what cannot be is refused with its place, its value and the nearest name."""
    assert re.fullmatch(said, sentence(tmp_path, text))


def test_overlapping_clearances(tmp_path: Path) -> None:
    """Assert that stops that overlap are refused."""
    gap = 'kind = "Gap"\nq = "y"\nk = 2\nlower = 0.1\nupper = -0.1\n'
    text = TEXT.replace(TEXT[TEXT.index('kind = "Backlash"') : TEXT.index('[[part]]\nkind = "Harm')], gap)
    said = "upper stop of a Gap is -0.1; it must be above the lower stop 0.1, or the two overlap"
    assert sentence(tmp_path, text) == f"[[part]] 6 (Gap): {said}"


def test_unknown_override(tmp_path: Path) -> None:
    """Assert that an unknown key is answered with those that exist."""
    assert sentence(tmp_path, TEXT, ("part.left.k", "1")).startswith(
        '--set key is "part.left.k"; it must be one of'
    )


@pytest.mark.parametrize("name", catalogue())
def test_catalogue(name: str) -> None:
    """Assert that every part has a summary, texts for all keys, and an example that can be read."""
    entry = catalogue()[name]
    assert entry.text.summary and all(key.text for key in entry.keys)
    coordinates = [sym.coordinate(q) for q in "xyzuvw"]
    model = composed(coordinates, [], [{"kind": name, **entry.example}])
    assert type(model.parts[0]).__name__ == name


@pytest.mark.parametrize("name", ["RollingBearing", "GearMesh", "JournalBearing", "Rub", "Jenkins", "Gap"])
def test_example_compiles(name: str) -> None:
    """Assert that the example of a part is no mistake: it moves its coordinates."""
    coordinates = [sym.coordinate(q) for q in "xy"]
    masses = [{"kind": kind, "q": ["x", "y"], key: 1.0} for kind, key in (("Mass", "m"), ("Spring", "k"))]
    model = composed(coordinates, [], [*masses, {"kind": name, **catalogue()[name].example}])
    assert {"x", "y"} <= {state.name for state in sym.compile(model).states}


@pytest.mark.parametrize(
    ("part", "law", "other"),
    [("SqueezeFilm", "GivenThickness", "PowerFilm"), ("LubricantFilm", "PowerFilm", "GivenThickness")],
)
def test_law_of_another_protocol_is_refused(part: str, law: str, other: str) -> None:
    """Assert that a film takes only laws whose `thickness` has the arguments that it gives."""
    key = next(key for key in catalogue()[part].keys if key.name == "law")
    assert law in key.reader.allowed and other not in key.reader.allowed
    table = {"kind": part, **catalogue()[part].example, "law": {"kind": other}}
    with pytest.raises(sym.InputError, match=f'law kind is "{other}"'):
        composed([sym.coordinate("x")], [], [table])


def test_every_part_of_symbolic_is_in_the_catalogue() -> None:
    """Assert that text can give all parts but those that hold functions, models or matrices."""
    public = {name: getattr(namespace, name) for namespace in (sym, sym.films) for name in namespace.__all__}
    parts = {n for n, value in public.items() if isinstance(value, type) and issubclass(value, sym.Part)}
    assert parts - set(catalogue()) <= {"Part", "Equations", "ThirdOrder", "Structure"}


@dataclass(frozen=True)
class Quintic(sym.Part):
    """Spring of the fifth power: force -k5 q^5.

    Parameters
    ----------
    q : Coordinate
        The coordinate.
    k5 : float or Parameter
        k5 in N/m^5.
    """

    q: sym.Coordinate
    k5: float

    def contribute(self, assembly: sym.Assembly) -> None:
        """Add the force."""
        motion = assembly.motion(self.q)
        motion.force -= assembly.parameter(self.k5, "k5", "N/m^5") * motion.position.symbol**5


def test_registered_part(tmp_path: Path) -> None:
    """Assert that a part that a program registers can be named, with its own keys."""
    sym.register_part(Quintic)
    text = TEXT.replace(
        'kind = "HarmonicForce"', 'kind = "Quintic"\nq = "x"\nk5 = 3\n[[part]]\nkind = "HarmonicForce"'
    )
    system = build(scene(tmp_path, text))
    assert {p.name: p.value for p in system.parameters}["k5"] == 3
    assert [key.name for key in catalogue()["Quintic"].keys] == [f.name for f in fields(Quintic)]
    with pytest.raises(ValueError, match="must be a class that inherits from symbolic.Part"):
        sym.register_part(int)  # type: ignore[arg-type]


BEAM = """
[[structure]]
name = "beam"
beam = {length = 0.3, bending = 1.4, mass_per_length = 0.16, elements = 2}
damping = 0.02
scale = 1e-3
at = {middle = 0}
[[part]]
kind = "Spring"
q = "beam.tip"
k = 2000
[[part]]
kind = "HarmonicForce"
q = "beam.middle"
force = 0.05
[[part]]
kind = "Spring"
q = "beam.tip"
to = "x"
k = 10
[[part]]
kind = "Mass"
q = "x"
m = 0.1
"""
STRUCTURE = 'title = "Mine"\nkind = "structure"\n[[coordinate]]\nname = "x"\n' + BEAM + RANGE


def test_structure(tmp_path: Path) -> None:
    """Assert that a built structure, and one from files beside the scene, are those of Python."""
    matrices = sym.beam(length=0.3, bending=1.4, mass_per_length=0.16, elements=2)
    s = sym.Structure(matrices, at={"middle": 0}, damping=0.02, name="beam", scale=1e-3)
    x, k = sym.coordinate("x"), (sym.parameter("k_beam", 2000.0), sym.parameter("k_x", 10.0))
    parts = [s, sym.Spring(s["tip"], k[0]), sym.HarmonicForce(s["middle"], 0.05, 1.0)]
    parts += [sym.Spring(s["tip"], k[1], to=x), sym.Mass(x, 0.1)]
    expected = sym.modes(sym.compile(sym.combine(parts), condense=False)).eigenvalues
    system = build(scene(tmp_path, STRUCTURE), condense=False)
    np.testing.assert_allclose(sym.modes(system).eigenvalues, expected, rtol=1e-10)
    assert len(build(scene(tmp_path, STRUCTURE)).states) == 6
    np.savez(tmp_path / "beam.npz", M=matrices.M, K=matrices.K)
    line = BEAM.splitlines()[3]
    tip = matrices.at["tip"]
    text = STRUCTURE.replace(line, 'file = "beam.npz"').replace("middle = 0", f"middle = 0, tip = {tip}")
    system = build(scene(tmp_path, text), condense=False)
    np.testing.assert_allclose(sym.modes(system).eigenvalues, expected, rtol=1e-10)


REFUSED_STRUCTURES = [
    ("beam.tip", "beam.tp", r'.* q is "tp"; it must be a place of the structure beam; nearest is "tip"'),
    ("elements = 2", "elements = 0", r"\[\[structure\]\] beam beam: elements is 0; it must be .* least 1"),
    ("elements = 2", "elements = 501", r"\[\[structure\]\] beam elements is 501; .* from 1 to 500"),
    (
        "length = 0.3",
        "lenth = 0.3",
        r"\[\[structure\]\] beam beam \"lenth\" is not a key; nearest is length; .*",
    ),
    ("damping = 0.02", "damping = -0.02", r"\[\[structure\]\] beam: .*damping.*"),
    ("middle = 0", "middle = 90", r"\[\[structure\]\] beam: the index of place 'middle' is 90; .*"),
    (
        "beam = {",
        'file = "a.npz"\nbeam = {',
        r"\[\[structure\]\] beam has file and beam; it must have one .*",
    ),
    ("[[structure]]", "[[structur]]", r"structur is not a key of the scene; .*"),
]


@pytest.mark.parametrize(
    ("old", "new", "said"), REFUSED_STRUCTURES, ids=[row[2] for row in REFUSED_STRUCTURES]
)
def test_structure_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    """Assert that what cannot be of a structure is refused in one sentence."""
    assert old in STRUCTURE
    assert re.fullmatch(said, sentence(tmp_path, STRUCTURE.replace(old, new)))


@dataclass(frozen=True)
class Point:
    """An entry point as an installed package has it."""

    name: str
    gives: object

    def load(self) -> object:
        """Return what it names, or fail as an import does."""
        if isinstance(self.gives, Exception):
            raise self.gives
        return self.gives


@dataclass(frozen=True)
class _Septic(Quintic):
    """A part that its module keeps to itself."""


def test_entry_point_of_a_module(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a module gives the parts that it defines, but none that it keeps to itself or imports."""
    module = SimpleNamespace(__name__=__name__, Quintic=Quintic, _Septic=_Septic, Imported=sym.Mass)
    monkeypatch.setattr("symbolic.scenes.model.catalogue.entry_points", lambda group: [Point("mine", module)])
    catalogue.cache_clear()
    try:
        assert "Quintic" in catalogue() and "_Septic" not in catalogue()
    finally:
        monkeypatch.undo()
        catalogue.cache_clear()


def test_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that parts of installed packages are in the catalogue, and one that is broken is told."""
    module = "symbolic.scenes.model.catalogue"
    catalogue.cache_clear()
    monkeypatch.setattr(f"{module}.entry_points", lambda group: [Point("mine", Quintic)])
    try:
        assert "Quintic" in catalogue()
        catalogue.cache_clear()
        monkeypatch.setattr(f"{module}.entry_points", lambda group: [Point("mine", ImportError("no gears"))])
        with pytest.raises(
            InputError, match=r"entry point mine cannot be loaded \(ImportError: no gears\); "
        ):
            catalogue()
    finally:
        monkeypatch.undo()
        catalogue.cache_clear()


@pytest.mark.parametrize("count", [0, 1001])
def test_count_of_a_vector(count: int, tmp_path: Path) -> None:
    """Assert the sentence on a number of coordinates that is not allowed."""
    text = HEAD + f'[[coordinate]]\nname = "x"\ncount = {count}\n[[part]]\nkind = "Mass"\nq = "x1"\nm = 1\n'
    with pytest.raises(InputError, match=f"count is {count}; it must be a whole number from 1 to 1000"):
        build(scene(tmp_path, text + RANGE))


def test_what_an_inline_table_may_be() -> None:
    """Assert that the only kind is told by its keys, several kinds by their names."""
    inline = [
        key.reader for entry in catalogue().values() for key in entry.keys if hasattr(key.reader, "entries")
    ]
    several, one = (next(r for r in inline if (len(r.entries) == 1) is only) for only in (False, True))
    assert several.allowed.startswith("a table of the kind ") and several.entries[-1].name in several.allowed
    assert one.allowed.startswith("a table with ") and one.entries[0].keys[0].name in one.allowed


@pytest.mark.parametrize(("given", "shown"), [("true", "true"), ('"2.5"', '"2.5"'), ("[2.5]", "a list")])
def test_parameter_that_is_no_number(tmp_path: Path, given: str, shown: str) -> None:
    """Assert that a truth value, a text and a list are refused, each with what is allowed."""
    text = TEXT.replace('stiffness = {value = 2.5, unit = "N/m"}', f"stiffness = {given}")
    allowed = 'it must be a number, or a table as {value = 1.0, unit = "rad/s"}'
    assert sentence(tmp_path, text) == f"parameters.stiffness is {shown}; {allowed}"


@pytest.mark.parametrize(
    ("given", "value", "unit"),
    [("3", 3.0, ""), ("2.5", 2.5, ""), ('{value = 2, unit = "N/m"}', 2.0, "N/m")],
)
def test_parameter_as_number_or_table(tmp_path: Path, given: str, value: float, unit: str) -> None:
    """Assert that whole numbers, numbers and tables are taken."""
    text = TEXT.replace('stiffness = {value = 2.5, unit = "N/m"}', f"stiffness = {given}")
    found = scene(tmp_path, text).parameters["stiffness"]
    assert (found.value, found.unit) == (value, unit)


@pytest.mark.parametrize(
    ("variation", "said"),
    [
        ('{kind = "Fourier", cosines = [0.1]}', 'is "Fourier"; it must be {}; nearest is "FourierSeries"'),
        ("{kind = 3, cosines = [0.1]}", "is 3; it must be {}; there is FourierSeries, Harmonic and Samples"),
        ("{cosines = [0.1]}", "is missing; it must be {}"),
    ],
)
def test_kind_of_a_table_in_a_part(tmp_path: Path, variation: str, said: str) -> None:
    """Assert that a kind that is none, or is missing, is refused with those there are."""
    given = 'variation = {kind = "FourierSeries", cosines = [0.1, 0.0, 0.05], sines = [0.2]}'
    found = sentence(tmp_path, TEXT.replace(given, f"variation = {variation}"))
    among = said.format("FourierSeries, Harmonic or Samples")
    assert found == f"[[part]] 6 (Backlash) variation kind {among}"
