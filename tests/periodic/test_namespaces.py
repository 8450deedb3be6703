"""The public names: what `import periodic` offers, and its namespaces."""

from __future__ import annotations

import builtins
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from support.equations import lorenz

import periodic as per

NAMESPACES = ["decisions", "extend", "maps", "phasespace", "plots", "tori"]
PROTOCOLS = (
    *("Condition", "Discretisation", "Increment", "Operator", "Row", "SideCondition"),
    *("Solution", "System", "TestFunction", "Unknowns"),
)
MOVED = {
    "equilibria": "trace(..., method=periodic.Equilibrium())",
    "map": "design_map",
    "mode": "normal_mode",
    "plot_campbell": "plots.campbell",
    "plot_multipliers": "plots.multipliers",
    "plot_orbit": "plots.orbit",
    "plot_phase": "plots.phase",
    "plot_regions": "plots.regions",
    "plot_spectrum": "plots.spectrum",
    "plot_waterfall": "plots.waterfall",
    **{name: f"maps.{name}" for name in per.maps.__all__},
    **{name: f"extend.{name}" for name in PROTOCOLS},
}
"""Names of version 0.2, and where they are now."""


def behind(place: str) -> Any:
    """What stands at a dotted place in `periodic`."""
    found: Any = per
    for name in place.split("."):
        found = getattr(found, name)
    return found


def test_names_and_no_modules() -> None:
    """Assert that dir() shows the public names, each of which is there, and no modules but the namespaces."""
    assert dir(per) == sorted(per.__all__)
    found = {name: getattr(per, name) for name in per.__all__}
    assert [name for name, value in found.items() if isinstance(value, ModuleType)] == NAMESPACES
    with pytest.raises(AttributeError, match="nothing"):
        behind("nothing")
    assert (Path(per.__file__).parent / "py.typed").is_file()


def test_each_name_stands_in_one_place() -> None:
    """Assert that nothing is in two namespaces, and that what a namespace names is there."""
    names = [*per.__all__, *(name for namespace in NAMESPACES for name in behind(namespace).__all__)]
    assert len(names) == len(set(names))
    for namespace in NAMESPACES:
        assert all(hasattr(behind(namespace), name) for name in behind(namespace).__all__)


def test_star_import_leaves_builtins_alone() -> None:
    """Assert that no name which `from periodic import *` brings is one of Python's."""
    for namespace in (per, *map(behind, NAMESPACES)):
        assert set(dir(builtins)).isdisjoint(namespace.__all__)


@pytest.mark.parametrize("name", sorted(set(MOVED) - {"equilibria"}))
def test_old_names_say_where_they_are(name: str) -> None:
    """Assert that what has moved is found by its name of version 0.2, with a warning that says its place."""
    with pytest.warns(DeprecationWarning) as caught:
        assert getattr(per, name) is behind(MOVED[name])
    said = f"periodic.{name} is now periodic.{MOVED[name]}; the old name goes with version 0.4"
    assert [str(warning.message) for warning in caught] == [said]
    assert caught[0].filename == __file__


def test_equilibria_is_trace_with_a_method() -> None:
    """Assert that the old call traces what the method does, point for point."""
    with pytest.warns(DeprecationWarning, match="is now periodic.trace.*method=periodic.Equilibrium"):
        old = behind("equilibria")(lorenz(), "rho", (0.5, 30.0))
    new = per.trace(lorenz(), "rho", (0.5, 30.0), method=per.Equilibrium())
    assert old.values.tolist() == new.values.tolist()
    assert [point.label for point in old] == [point.label for point in new]


def test_namespace_opens_nothing_by_itself() -> None:
    """Assert that to import the package, or ask for what there is, loads neither NumPy nor matplotlib."""
    code = "import sys, periodic; dir(periodic); print({'numpy', 'matplotlib'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
