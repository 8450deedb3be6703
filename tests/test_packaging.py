"""What is installed: the engine and the command line, nothing that is run from a checkout."""

from __future__ import annotations

import builtins
import importlib.util
import re
import subprocess
import sys
import tomllib
import zlib
from pathlib import Path

import pytest

import periodic as per
import symbolic as sym
from periodic.collocation.native.elimination import ELIMINATION
from periodic.orbit.native.addresses import source
from symbolic.kernels import built, native

ROOT = Path(__file__).resolve().parent.parent
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
WHEEL = SETTINGS["tool"]["hatch"]["build"]["targets"]["wheel"]
LIBRARIES = WHEEL["hooks"]["custom"]["libraries"]
MEGABYTES = 1_200_000


def test_of_the_reports_only_the_command_line_is_installed() -> None:
    """Assert that the wheel has nothing of reports but `app`, and stays below 1.2 megabytes.

    The package that is installed under its own name is not installed twice.
    """
    assert WHEEL["only-include"] == ["symbolic", "periodic", "reports/app"]
    assert WHEEL["exclude"] == ["/reports/app/orbitrace.py"]
    files = [path for name in ("symbolic", "periodic", "reports/app") for path in (ROOT / name).rglob("*.*")]
    packed = [zlib.compress(path.read_bytes()) for path in files if path.is_file() and path.suffix != ".pyc"]
    assert 0 < sum(map(len, packed)) < MEGABYTES


def test_package_under_the_name_that_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that `orbitrace` is both packages and their first calls, and shadows nothing of Python's."""
    (source,) = (file for file, to in WHEEL["force-include"].items() if to == "orbitrace/__init__.py")
    spec = importlib.util.spec_from_file_location("orbitrace", ROOT / source, submodule_search_locations=[])
    assert spec is not None and spec.loader is not None
    namespace = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "orbitrace", namespace)
    spec.loader.exec_module(namespace)
    assert (
        namespace.periodic is per and namespace.symbolic is sym and namespace.__version__ == per.__version__
    )
    for name in set(namespace.__all__) - {"periodic", "symbolic"}:
        assert getattr(namespace, name) is getattr(per if name in per.__all__ else sym, name)
    assert set(dir(builtins)).isdisjoint(namespace.__all__) and set(namespace.__all__) <= set(dir(namespace))


def test_what_is_installed_imports_nothing_else() -> None:
    """Assert that the command line names no module that is run from a checkout."""
    for path in (ROOT / "reports" / "app").rglob("*.py"):
        assert not re.search(r"reports\.(studies|benchmarks)|jinja2", path.read_text("utf-8")), path


def test_version_is_the_same_everywhere() -> None:
    """Assert that the project, its citation and both packages tell one version."""
    version = SETTINGS["project"]["version"]
    assert f"version: {version}\n" in (ROOT / "CITATION.cff").read_text("utf-8")
    assert per.__version__ == sym.__version__ == version


def library_source() -> str:
    """The C source that the wheel's library is made of."""
    (files,) = LIBRARIES
    return "".join((ROOT / file).read_text("utf-8") for file in files)


def test_wheel_has_the_library_that_is_asked_for() -> None:
    """Assert that the source which the build compiles is the one that the engine asks for."""
    assert library_source() == source(ELIMINATION)


def test_library_of_the_wheel_needs_no_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a library in its folder is used where there is no compiler and agrees with NumPy."""
    if (compiler := native.compiler()) is None:
        pytest.skip("this machine has no C compiler")
    text = library_source()
    command = [*compiler[0], *built.FLAGS, "-o", str(tmp_path / built.file_name(text)), "-x", "c", "-", "-lm"]
    made = subprocess.run(command, input=text, text=True, capture_output=True, check=False)
    assert made.returncode == 0, made.stderr
    here = per.trace(sym.compile(duffing_model(), kernels="numpy"), "Omega", (0.3, 0.5))
    native.forget()
    monkeypatch.setattr(built, "FOLDER", tmp_path)
    monkeypatch.setattr(native, "compiler", lambda: None)
    system = sym.compile(duffing_model(), kernels="auto")
    found = per.trace(system, "Omega", (0.3, 0.5))
    native.forget()
    library = system.library(source(ELIMINATION))
    assert library is not None and str(tmp_path) in library._name
    assert found.values == pytest.approx(here.values, rel=1e-9)
    assert found[-1].multipliers == pytest.approx(here[-1].multipliers, rel=1e-8)


def test_library_that_does_not_load_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a library of another machine is passed over."""
    monkeypatch.setattr(built, "FOLDER", tmp_path)
    (tmp_path / built.file_name("int x;")).write_bytes(b"of another machine")
    assert built.built("int x;") is None and built.built("int y;") is None


def duffing_model() -> sym.Model:
    """A forced oscillator."""
    x = sym.coordinate("x")
    model = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.CubicSpring(x, 1.0)
    return model + sym.HarmonicForce(x, 0.5)
