"""Scenes: what the built-in ones hold, how they are changed, and what is refused in which words."""

from pathlib import Path

import pytest

from symbolic.scenes.building import build, static_deflection
from symbolic.scenes.errors import InputError
from symbolic.scenes.names import scene_names, short_name
from symbolic.scenes.reading import load
from symbolic.scenes.schema import DiscScene, Oscillator, OscillatorScene

SIZES = {
    "ball-bearing": (4, 0),
    "ball-bearing-lubricated": (4, 0),
    "beam-stop": (2, 1),
    "cavitating-film-810N": (3, 0),
    "dry-810N": (2, 0),
    "duffing": (2, 0),
    "friction-damper": (2, 0),
    "gear-pair": (2, 0),
    "impact-oscillator": (2, 0),
    "jeffcott-internal-damping": (4, 0),
    "jeffcott-rub": (4, 0),
    "jenkins-damper": (3, 0),
    "journal-bearing": (4, 0),
    "line-contact-810N": (3, 1),
    "quasistatic-film-810N": (2, 1),
    "squeeze-film-damper": (4, 0),
    "stop": (2, 0),
    "supports-810N": (5, 1),
    "third-order-810N": (3, 0),
    "turbo33-810N": (3, 1),
    "turbo33-2100N": (3, 1),
    "vitrea79-810N": (3, 1),
    "vitrea79-2100N": (3, 1),
}
"""States and algebraic unknowns of every built-in scene."""

NO_ABSURD = ("-1", "nan", "inf", "-inf", "1e300", "many")
NUMBERS = [
    *(
        ("vitrea79-810N", key, text)
        for key in (
            "discs.mass",
            "discs.diameter",
            "contact.stiffness",
            "contact.exponent",
            "contact.preload",
            "waviness.amplitude",
            "waviness.waves",
            "film.viscosity",
            "film.piezoviscosity",
            "film.beta",
            "film.squeeze",
            "trace.from_rpm",
            "trace.to_rpm",
        )
        for text in (*NO_ABSURD, "0", "1e-300")
    ),
    *(("dry-810N", "damping.ratio", text) for text in NO_ABSURD),
    *(
        ("supports-810N", key, text)
        for key in ("support.stiffness", "support.disc_share", "discs.crown", "discs.modulus")
        for text in (*NO_ABSURD, "0", "1e-300")
    ),
    *(
        ("supports-810N", key, text)
        for key in ("support.damping", "support.leaf", "discs.poisson")
        for text in NO_ABSURD
    ),
    *(("cavitating-film-810N", "film.floor", text) for text in (*NO_ABSURD, "0", "1e-300", "1")),
    *(
        ("duffing", key, text)
        for key in ("oscillator.mass", "oscillator.force", "trace.from_frequency", "trace.to_frequency")
        for text in (*NO_ABSURD, "0", "1e-300")
    ),
    *(("duffing", key, text) for key in ("oscillator.damping", "oscillator.stiffness") for text in NO_ABSURD),
    *(("duffing", "oscillator.cubic", text) for text in ("nan", "inf", "-inf", "1e300", "many")),
]
"""Scene, key and a value that it must not take."""


def sentence(source: str, *overrides: tuple[str, str]) -> str:
    """Return the sentence with which a scene is refused."""
    with pytest.raises(InputError) as caught:
        load(source, overrides)
    return str(caught.value)


def written(folder: Path, text: str) -> str:
    """Write a scene file and return its path."""
    file = folder / "mine.toml"
    file.write_text(text, "utf-8")
    return str(file)


def text_of(name: str) -> str:
    """Return the text of a built-in scene."""
    return (Path(__file__).parents[3] / "symbolic" / "scenes" / "data" / f"{name}.toml").read_text("utf-8")


def test_names() -> None:
    """Assert that the built-in scenes are those of the documentation, smaller numbers first."""
    assert scene_names() == list(SIZES)


@pytest.mark.parametrize("name", SIZES)
def test_size(name: str) -> None:
    """Assert that the system of a scene has no more states and unknowns than its parts need."""
    system = build(load(name))
    assert (len(system.states), len(system.algebraics)) == SIZES[name]


def test_lubricant_fills_in() -> None:
    """Assert that the lubricant's viscosities stand in the scene."""
    scene = load("turbo33-2100N")
    assert isinstance(scene, DiscScene) and scene.film is not None
    assert (scene.film.viscosity, scene.film.piezoviscosity) == (0.034, 21.6e-9)


def test_viscosity_replaces_lubricant() -> None:
    """Assert that a viscosity given beside a lubricant replaces the lubricant's and nothing else."""
    scene = load("turbo33-810N", [("viscosity", "0.5")])
    assert isinstance(scene, DiscScene) and scene.film is not None
    assert (scene.film.viscosity, scene.film.piezoviscosity) == (0.5, 21.6e-9)


def test_parameters_reach_the_system() -> None:
    """Assert that the numbers of a scene are the nominal parameters of its system."""
    system = build(load("vitrea79-2100N", [("beta", "20"), ("waves", "60")]))
    values = {p.name: p.value for p in system.parameters}
    expected = {"mass": 20.4, "preload": 2100, "stiffness": 28e9, "exponent": 1.5, "amplitude": 1.27e-6}
    expected |= {"waves": 60, "beta": 20, "squeeze": 2734.3, "radius": 0.051, "viscosity": 0.890}
    assert expected.items() <= values.items()


def test_last_component_is_enough() -> None:
    """Assert that a key may be given by its last component."""
    assert load("dry-810N", [("preload", "900")]) == load("dry-810N", [("contact.preload", "900")])


def test_last_override_holds() -> None:
    """Assert that of two overrides of one key the later holds."""
    assert load("duffing", [("force", "1"), ("force", "2")]) == load("duffing", [("force", "2")])


def test_tables_come_and_go() -> None:
    """Assert that the film can be taken out of a squeeze-film scene and a damper put in: the dry scene."""
    changed = load("vitrea79-810N", [("film", ""), ("damping.ratio", "0.007")])
    dry = load("dry-810N")
    assert changed.model_dump(exclude={"title"}) == dry.model_dump(exclude={"title"})


def test_squeeze_can_be_taken_out() -> None:
    """Assert that the quasi-static film is the squeeze film without its squeeze."""
    overrides = [("law", "quasistatic"), ("squeeze", ""), ("damping.ratio", "0.007")]
    system = build(load("vitrea79-810N", overrides))
    assert (len(system.states), len(system.algebraics)) == SIZES["quasistatic-film-810N"]


def test_own_file(tmp_path: Path) -> None:
    """Assert that a file works in place of a name and is called by its stem."""
    source = written(tmp_path, text_of("duffing"))
    assert load(source) == load("duffing")
    assert short_name(source) == "mine"


@pytest.mark.parametrize("part", ["damping", "cubic"])
def test_optional_parts(part: str) -> None:
    """Assert that an oscillator without damper or cubic spring is a scene."""
    scene = load("duffing", [(part, "")])
    assert isinstance(scene, OscillatorScene) and getattr(scene.oscillator, part) is None
    assert len(build(scene).parameters) == 5


@pytest.mark.parametrize(("source", "key", "text"), NUMBERS)
def test_number_refused(source: str, key: str, text: str) -> None:
    """Assert that a number out of range is refused in a sentence with its key, its value and the range."""
    said = sentence(source, (key, text))
    value = f'"{text}"' if text == "many" else text.replace("1e300", "1e+300")
    assert said.startswith(f"{key} is {value}; it must be a ")
    assert "number from " in said and "\n" not in said


def given(source: str, **values: float) -> bool:
    """Tell whether a scene takes these numbers, and has them as the parameters of its system."""
    system = build(load(source, [(key, str(value)) for key, value in values.items()]))
    found = {p.name: p.value for p in system.parameters}
    return all(found[key] == value for key, value in values.items())


def test_limits_are_generous() -> None:
    """Assert that the domain that the numerics are meant for is allowed, up to its ends."""
    for preload, viscosity, amplitude, beta in ((1, 1e-4, 1e-9, 1), (1e6, 1e2, 1e-4, 60)):
        assert given("vitrea79-810N", preload=preload, viscosity=viscosity, amplitude=amplitude, beta=beta)
    assert given("dry-810N", exponent=1) and given("dry-810N", exponent=3)
    assert given("vitrea79-810N", squeeze=2.7e5)
    slow = load("dry-810N", [("ratio", "0"), ("from_rpm", "1"), ("to_rpm", "20000")])
    assert isinstance(slow, DiscScene)
    assert (slow.trace.from_rpm, slow.trace.to_rpm) == (1, 20000)
    light, heavy = (load("dry-810N", [("ratio", text)]) for text in ("0", "1"))
    assert isinstance(light, DiscScene) and isinstance(heavy, DiscScene)
    assert light.damping is not None and heavy.damping is not None
    assert (light.damping.ratio, heavy.damping.ratio) == (0, 1)


@pytest.mark.parametrize("text", ["0.99", "4.01"])
def test_exponents_of_a_contact(text: str) -> None:
    """Assert that a contact's stiffness does not fall with its deflection, and rises by its cube at most."""
    assert sentence("dry-810N", ("exponent", text)).endswith("it must be a number from 1 to 4")


def test_range_sentence() -> None:
    """Assert the whole sentence of a number out of range."""
    assert sentence("dry-810N", ("preload", "-3")) == (
        "contact.preload is -3; it must be a number from 0.01 to 1e+08 (N)"
    )


def test_whole_number_sentence() -> None:
    """Assert that a count takes whole numbers only."""
    assert sentence("dry-810N", ("waves", "1.5")) == (
        "waviness.waves is 1.5; it must be a whole number from 1 to 100000"
    )


def test_one_point_range() -> None:
    """Assert that a range of one point is refused."""
    said = sentence("vitrea79-810N", ("to_rpm", "500"))
    assert said == "trace.to_rpm is 500; it must differ from trace.from_rpm so that there is a range"
    assert sentence("duffing", ("to_frequency", "0.3")).startswith(
        "trace.to_frequency is 0.3; it must differ"
    )


def test_unknown_scene() -> None:
    """Assert that an unknown scene is answered with those that exist."""
    said = sentence("vitrea80")
    assert said.startswith('scene is "vitrea80"; it must be one of ')
    assert all(name in said for name in scene_names())


def test_unknown_key() -> None:
    """Assert that an unknown key is answered with those that exist."""
    said = sentence("duffing", ("oscillator.forse", "1"))
    assert said.startswith('--set key is "oscillator.forse"; it must be one of oscillator.mass, ')
    assert "trace.to_frequency" in said


def test_kind_cannot_be_set() -> None:
    """Assert that the kind of a scene is not among the keys to override."""
    assert sentence("duffing", ("kind", "disc")).startswith('--set key is "kind"; ')


def test_unknown_lubricant() -> None:
    """Assert that an unknown lubricant is answered with those that exist."""
    assert sentence("vitrea79-810N", ("lubricant", "castor")) == (
        'film.lubricant is "castor"; it must be turbo33 or vitrea79'
    )


def test_no_lubricant() -> None:
    """Assert that a film with neither lubricant nor viscosity is refused."""
    assert sentence("vitrea79-810N", ("lubricant", "")).startswith("film.viscosity is missing; it must be ")


def test_unknown_law() -> None:
    """Assert that an unknown film law is answered with those that exist."""
    assert sentence("vitrea79-810N", ("law", "wet")) == (
        'film.law is "wet"; it must be "squeeze", "quasistatic", "cavitating" or "third-order"'
    )


def test_law_and_squeeze_agree() -> None:
    """Assert that the squeeze film has a squeeze coefficient and the quasi-static film none."""
    assert sentence("vitrea79-810N", ("law", "quasistatic")) == (
        'film.squeeze is 2734.3; law = "quasistatic" must have none'
    )
    assert sentence("quasistatic-film-810N", ("law", "squeeze")).startswith("film.squeeze is missing; ")


def test_only_the_cavitating_film_has_a_floor() -> None:
    """Assert that the cavitating film has a floor and the squeeze film none."""
    assert sentence("vitrea79-810N", ("law", "cavitating")) == (
        'film.floor is missing; it must be a number from 1e-08 to 0.5 (law = "cavitating" only)'
    )
    assert sentence("cavitating-film-810N", ("law", "squeeze")) == (
        'film.floor is 0.0001; law = "squeeze" must have none'
    )


def test_unknown_thickness() -> None:
    """Assert that an unknown law of the steady thickness is answered with those that exist."""
    said = sentence("vitrea79-810N", ("thickness", "thin"))
    assert said.startswith('film.thickness is "thin"; it must be "calibrated", "equation-5", ')


def test_oscillator_without_spring() -> None:
    """Assert that an oscillator that nothing holds is refused."""
    said = sentence("duffing", ("stiffness", "0"), ("cubic", ""))
    assert said == "oscillator.stiffness is 0; it must be greater than 0 where cubic is not"


@pytest.mark.parametrize(("key", "value"), [("damping", 5e-324), ("stiffness", 1e-300)])
def test_number_that_no_model_may_have(key: str, value: float) -> None:
    """Assert that what a table allows and a part does not is refused as bad input, when it is built."""
    scene = load("duffing", [(f"oscillator.{key}", value)])
    with pytest.raises(InputError, match="it must be 0, or of a magnitude from 1e-100 to 1e\\+100"):
        build(scene)


def test_number_in_place_of_table() -> None:
    """Assert that a number in place of a table is refused with the keys of the table."""
    assert sentence("dry-810N", ("damping", "1")) == "damping is 1; it must be a table with ratio"


def test_missing_table(tmp_path: Path) -> None:
    """Assert that a missing table is named with its keys."""
    text = text_of("duffing").partition("[trace]")[0]
    assert sentence(written(tmp_path, text)) == (
        "trace is missing; it must be a table with from_frequency and to_frequency"
    )


def test_mistyped_key(tmp_path: Path) -> None:
    """Assert that a mistyped key is told before the one that it leaves missing."""
    text = text_of("duffing").replace("force", "forse")
    assert sentence(written(tmp_path, text)) == (
        "oscillator.forse is not a key of the scene; "
        "[oscillator] may have mass, damping, stiffness, cubic and force"
    )


def test_text_in_place_of_number(tmp_path: Path) -> None:
    """Assert that a number in quotes is not taken for a number."""
    text = text_of("duffing").replace("mass = 1.0", 'mass = "1.0"')
    assert sentence(written(tmp_path, text)).startswith('oscillator.mass is "1.0"; it must be a number from ')


def test_kind(tmp_path: Path) -> None:
    """Assert that a scene of unknown or no kind is answered with the kinds."""
    text = text_of("duffing")
    allowed = 'it must be "disc", "oscillator", "model" or "structure"'
    unknown = written(tmp_path, text.replace('"oscillator"', '"pendulum"'))
    assert sentence(unknown) == f'kind is "pendulum"; {allowed}'
    assert sentence(written(tmp_path, text.replace("kind", "# kind"))) == f"kind is missing; {allowed}"


@pytest.mark.parametrize("text", ["[discs", "mass = ", "a = 1\na = 2", "x = " + "[" * 5000])
def test_malformed_toml(tmp_path: Path, text: str) -> None:
    """Assert that a file that is not TOML is refused by its name, on one line."""
    source = written(tmp_path, text)
    said = sentence(source)
    assert said.startswith(f'scene file "{source}" is not TOML: ') and "\n" not in said


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("a = 1\nmass = ", "Invalid value (at end of document)"),
        ("a = 1\nb = = 2", "Invalid value (at line 2, column 5)"),
        ("a = 1\na = 2", "Cannot overwrite a value (at end of document)"),
        ("[a]\n[a]", "it is wrong at line 2, column 3"),
        ("a = {b = 1, b = 2}", "it is wrong at line 1, column 18"),
        ("a = 1" + "0" * 5000, "it has a number of too many digits"),
    ],
)
def test_where_a_file_is_wrong(tmp_path: Path, text: str, why: str) -> None:
    """Assert the place that Python's reader tells, without what the file says there."""
    said = sentence(written(tmp_path, text))
    assert said.endswith(f"is not TOML: {why}; it must hold lines like preload = 810")


def test_deep_tables(tmp_path: Path) -> None:
    """Assert that tables beyond what Python's reader takes are called so."""
    said = sentence(written(tmp_path, "x = " + "[" * 5000))
    assert said.endswith("is not TOML: its tables are too deep; it must hold lines like preload = 810")


def test_binary_file(tmp_path: Path) -> None:
    """Assert that a file that is not text is refused."""
    file = tmp_path / "mine.toml"
    file.write_bytes(b"\xff\xfe\x00")
    assert sentence(str(file)).endswith("is not text in UTF-8; it must be a TOML file")


def test_directory(tmp_path: Path) -> None:
    """Assert that a directory is no scene."""
    assert sentence(str(tmp_path)).startswith(f'scene file "{tmp_path}" cannot be read (')


@pytest.mark.parametrize(
    ("stiffness", "cubic", "scale"),
    [(2.0, None, 4.0), (2.0, 1.0, 2.0), (4.0, 1.0, 2.0), (8.0, 1.0, 1.0), (0.0, 8.0, 1.0), (2.0, -64.0, 0.5)],
)
def test_scale_of_an_oscillator(stiffness: float, cubic: float | None, scale: float) -> None:
    """Assert what a force of 8 N bends the softer of both springs by: F/k or (F/k3)^(1/3)."""
    part = Oscillator(mass=1.0, stiffness=stiffness, cubic=cubic, force=8.0)
    assert static_deflection(part) == pytest.approx(scale, rel=1e-14)
