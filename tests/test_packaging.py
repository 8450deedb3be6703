"""What is installed: the engine and the command line, nothing that is run from a checkout."""

from __future__ import annotations

import re
import tomllib
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WHEEL = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]["targets"][
    "wheel"
]
MEGABYTE = 1_000_000


def test_of_the_reports_only_the_command_line_is_installed() -> None:
    """Assert that the wheel leaves out all folders of reports but `app`, and stays below a megabyte."""
    assert WHEEL["packages"] == ["symbolic", "periodic", "reports"]
    folders = {path.parent.name for path in ROOT.glob("reports/*/__init__.py")}
    assert {path.removeprefix("/reports/") for path in WHEEL["exclude"]} == folders - {"app"}
    files = [path for name in ("symbolic", "periodic", "reports/app") for path in (ROOT / name).rglob("*.*")]
    packed = [zlib.compress(path.read_bytes()) for path in files if path.is_file() and path.suffix != ".pyc"]
    assert 0 < sum(map(len, packed)) < MEGABYTE


def test_what_is_installed_imports_nothing_else() -> None:
    """Assert that the command line names no module that is run from a checkout."""
    for path in (ROOT / "reports" / "app").rglob("*.py"):
        assert not re.search(r"reports\.(studies|benchmarks)|jinja2", path.read_text("utf-8")), path
