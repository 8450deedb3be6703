"""The public names: what `import symbolic` offers."""

from __future__ import annotations

import builtins
import importlib.metadata
from pathlib import Path
from types import ModuleType

import pytest

import symbolic as sym

ROOT = Path(sym.__file__).parent


def test_names_and_no_modules() -> None:
    """Assert that dir() shows the public names, each of which is there, and no modules but the namespaces."""
    assert dir(sym) == sorted([*sym.__all__, "compile"])
    found = {name: getattr(sym, name) for name in sym.__all__}
    namespaces = [name for name, value in found.items() if isinstance(value, ModuleType)]
    assert namespaces == ["films", "functions"]
    with pytest.raises(AttributeError, match="nothing"):
        sym.nothing  # type: ignore[attr-defined]  # noqa: B018
    assert sym.__version__ == importlib.metadata.version("orbitrace")
    assert (ROOT / "py.typed").is_file()


def test_star_import_leaves_builtins_alone() -> None:
    """Assert that no name which `from symbolic import *` brings is one of Python's."""
    assert set(dir(builtins)).isdisjoint([*sym.__all__, *sym.films.__all__, *sym.functions.__all__])


@pytest.mark.parametrize("name", sym.films.__all__)
def test_old_names_say_where_they_are(name: str) -> None:
    """Assert that a film law is found by its name of version 0.2, with a warning that says its place."""
    with pytest.warns(DeprecationWarning, match=f"^symbolic.{name} is now symbolic.films.{name}; "):
        assert getattr(sym, name) is getattr(sym.films, name)


def test_scene_by_name_path_and_changes(tmp_path: Path) -> None:
    """Assert that a scene comes by name or file, with numbers, names and removals."""
    path = tmp_path / "mine.toml"
    path.write_text((ROOT / "scenes" / "data" / "dry-810N.toml").read_text())
    for source in ("dry-810N", str(path), path):
        system = sym.scene(source, {"preload": 1200, "discs.mass": 10.0})
        values = {p.name: p.value for p in system.parameters}
        assert (values["preload"], values["mass"], values["damping_ratio"]) == (1200, 10, 0.007)
    assert "damping_ratio" not in [p.name for p in sym.scene("dry-810N", {"damping": None}).parameters]
    thin = sym.scene("vitrea79-810N", {"lubricant": "turbo33"})
    assert {p.name: p.value for p in thin.parameters}["viscosity"] == 0.034


@pytest.mark.parametrize(
    ("source", "changes", "said"),
    [
        (
            "nowhere",
            {},
            'scene is "nowhere"; it must be one of .*, vitrea79-2100N or the path of a TOML file',
        ),
        ("dry-810N", {"preload": -1}, "contact.preload is -1; it must be a number from 0.01 to 1e.08 .N."),
        ("", {}, 'scene is ""; it must be one of '),
        (3, {}, "scene is 3; it must be one of "),
        ("duffing", "force=2", 'changes is "force=2"; it must be a mapping of keys to values, as '),
        ("dry-810N", {"load": 1}, 'key is "load"; it must be one of discs.mass, '),
    ],
)
def test_scene_that_is_refused(source: str, changes: dict, said: str) -> None:
    """Assert that what is no scene is refused in one sentence."""
    with pytest.raises(sym.InputError, match=f"^{said}"):
        sym.scene(source, changes)
