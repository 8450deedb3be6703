"""The layers: `periodic` knows neither CasADi nor `symbolic`, `symbolic` does not know `periodic`.

Here as they are loaded, and for imports by a name in a string; `make layers` holds all other imports, those
between rooms too, against the order in `pyproject.toml`.
"""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
FORBIDDEN = {"periodic": {"casadi", "symbolic", "reports"}, "symbolic": {"periodic", "reports"}}
FILES = [(layer, path) for layer in FORBIDDEN for path in sorted((ROOT / layer).rglob("*.py"))]


def imported(source: str) -> set[str]:
    """Top-level packages that a source imports anywhere, dynamic imports of a literal name included."""
    names: list[str] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names.append(node.module or "")
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called in ("import_module", "__import__"):
                names.append(str(node.args[0].value))
    return {name.partition(".")[0] for name in names}


def python(code: str) -> str:
    """What a fresh interpreter prints; warnings are errors in it and the tests' helpers importable."""
    command = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(command, cwd=ROOT / "tests", capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize(
    "source",
    [
        "import casadi",
        "import os, casadi.tools as tools",
        "from casadi import SX",
        "from casadi.tools import graph",
        "def late():\n    if True:\n        import casadi",
        "import importlib\nimportlib.import_module('casadi.tools')",
        "from importlib import import_module\nimport_module('casadi')",
        "__import__('casadi')",
    ],
)
def test_every_form_of_import_is_seen(source: str) -> None:
    """Assert that the reader of sources below sees this import."""
    assert "casadi" in imported(source)


@pytest.mark.parametrize(("layer", "path"), FILES, ids=[str(path.relative_to(ROOT)) for _, path in FILES])
def test_file_imports_nothing_from_above(layer: str, path: Path) -> None:
    """Assert that no file of a layer imports what the layer must not know, not even within a function."""
    assert imported(path.read_text(encoding="utf-8")) & FORBIDDEN[layer] == set()


@pytest.mark.parametrize("layer", FORBIDDEN)
def test_layer_loads_nothing_from_above(layer: str) -> None:
    """Assert that importing every module of a layer leaves the others out of sys.modules."""
    code = f"""
import importlib, pkgutil, sys
import {layer}
for module in pkgutil.walk_packages({layer}.__path__, "{layer}."):
    importlib.import_module(module.name)
print(*sys.modules)
"""
    loaded = set(python(code).split())
    own = [path for owner, path in FILES if owner == layer]
    assert len({name for name in loaded if name.split(".")[0] == layer}) == len(own)
    assert {name.partition(".")[0] for name in loaded} & FORBIDDEN[layer] == set()


def test_rooms_keep_their_order() -> None:
    """Assert that every import keeps the order declared in pyproject.toml, and that there is no circle.

    In a process of its own: the linter configures logging, which would silence our warnings in later tests.
    """
    code = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports(no_cache=True))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_handwritten_system_is_traced_without_casadi() -> None:
    """Assert that `periodic` traces a NumPy class to its exact orbit where casadi cannot be imported."""
    code = """
import sys
for name in ("casadi", "symbolic", "reports"):
    sys.modules[name] = None  # makes any import of it fail
import numpy as np
import periodic as per
from support.numpy_systems import LinearOscillator
system = LinearOscillator(Omega=0.8)
branch = per.trace(system, "Omega", (0.8, 1.2), tol=per.Accuracy.STANDARD)
tau = np.linspace(0, 2 * np.pi, 9)
error = np.abs(branch[0].orbit.state(tau) - system.exact_state(tau)).max()
print(branch.stop.reason.name, error < 1e-6, abs(branch[-1].parameter - 1.2) < 1e-12)
try:
    import casadi
except ImportError:
    print("blocked")
"""
    assert python(code).split() == ["BOUND", "True", "True", "blocked"]
