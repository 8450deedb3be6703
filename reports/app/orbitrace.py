"""`import orbitrace`: both packages under the name that is installed, and the calls most sessions begin with.

    from orbitrace import periodic as per, symbolic as sym

The build puts this file into the wheel as the package `orbitrace`, with the command line as `orbitrace.app`
(see `pyproject.toml`): somebody else's `reports` is not asked. Each name is imported when it is first asked
for, so that another project's `symbolic` or `periodic` is told before it is used.
"""

import sys
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import periodic
    import symbolic
    from periodic import Branch, Label, design_map, page, plot, trace
    from symbolic import scene, simulate

PACKAGES = ("periodic", "symbolic")
_NAMES = {
    **dict.fromkeys(("Branch", "Label", "design_map", "page", "plot", "trace"), "periodic"),
    **dict.fromkeys(("scene", "simulate"), "symbolic"),
}
__all__ = [
    "Branch",
    "Label",
    "design_map",
    "page",
    "periodic",
    "plot",
    "scene",
    "simulate",
    "symbolic",
    "trace",
]
__version__ = version("orbitrace")

if not Path(__file__).with_name("app").is_dir():
    # An editable install has a copy of this file; the command line is in the checkout, beside the packages.
    _beside = find_spec("periodic")
    if _beside is not None and _beside.origin is not None:
        sys.modules[__name__].__path__.append(str(Path(_beside.origin).parents[1] / "reports"))


def __dir__() -> list[str]:
    """The names that are offered."""
    return sorted([*__all__, "__version__", "main"])


def __getattr__(name: str) -> Any:
    """Import a package or a call of its. Raises ImportError where another project has taken the name."""
    if name in PACKAGES:
        from orbitrace.app.namesakes import foreign

        if told := foreign(name):
            raise ImportError(told)
        return import_module(name)
    if name in _NAMES:
        return getattr(__getattr__(_NAMES[name]), name)
    raise AttributeError(f"module 'orbitrace' has no attribute {name!r}")


def main() -> int:
    """The command `orbitrace`: one sentence and exit code 2 where a package of ours is another project's."""
    from orbitrace.app.namesakes import foreign

    if told := next(filter(None, map(foreign, PACKAGES)), ""):
        print(f"orbitrace: {told}", file=sys.stderr)
        return 2
    from orbitrace.app.cli import main as run

    return run()
