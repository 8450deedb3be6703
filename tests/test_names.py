"""Other projects' packages under the names of ours: told in one sentence, and never used unawares."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
COPIES = [ROOT / folder / "namesakes.py" for folder in ("periodic", "symbolic", "reports/app")]
DOOR = "import sys; from orbitrace import main; sys.exit(main())"


@pytest.fixture
def site(tmp_path: Path) -> Path:
    """A directory that has what the wheel puts there, as links."""
    made = tmp_path / "site-packages"
    (made / "orbitrace").mkdir(parents=True)
    for name in ("periodic", "symbolic"):
        (made / name).symlink_to(ROOT / name)
    (made / "orbitrace" / "app").symlink_to(ROOT / "reports" / "app")
    (made / "orbitrace" / "__init__.py").symlink_to(ROOT / "reports" / "app" / "orbitrace.py")
    return made


def overwritten(site: Path, name: str) -> Path:
    """Put another project's first file into a package of ours, as pip does; return the file."""
    (site / name).unlink()
    (site / name).mkdir()
    for path in (ROOT / name).iterdir():
        if path.name not in ("__init__.py", "__pycache__"):
            (site / name / path.name).symlink_to(path)
    file = site / name / "__init__.py"
    file.write_text("class Symbol: ...\n")
    return file


def python(program: str, *path: Path, arguments: tuple[str, ...] = ()) -> subprocess.CompletedProcess[str]:
    """Run a program with only these directories before what is installed."""
    first = f"import sys; sys.path[:0] = {list(map(str, path))}\n"
    command = [sys.executable, "-P", "-c", first + program, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_copies_are_the_same() -> None:
    """Assert that the three files that look for namesakes are one."""
    assert len({path.read_bytes() for path in COPIES}) == 1


def test_ours_are_ours(site: Path) -> None:
    """Assert that nothing is said of our packages, whichever is first, and that all calls are there."""
    for program in (
        "import periodic, symbolic",
        "import symbolic, periodic",
        "from orbitrace import periodic as per, symbolic as sym; assert per.trace and sym.scene",
        "import orbitrace, periodic; from orbitrace import *; assert trace is periodic.trace and scene",
    ):
        done = python(program, site)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", ""), program


@pytest.mark.parametrize(("name", "other"), [("symbolic", "periodic"), ("periodic", "symbolic")])
def test_overwritten_package_is_told(name: str, other: str, site: Path) -> None:
    """Assert one sentence from the other package, from `orbitrace` and from the command line."""
    file = overwritten(site, name)
    cure = f"`pip uninstall {name}`, then `pip install --force-reinstall --no-deps orbitrace`"
    told = f"{name} is another project's ({str(file)!r}); {cure}"
    assert f"UserWarning: {told}\n" in python(f"import {other}", site).stderr
    for program in (f"from orbitrace import {name}", "import orbitrace; orbitrace.trace; orbitrace.scene"):
        done = python(program, site)
        assert done.returncode == 1 and done.stderr.endswith(f"ImportError: {told}\n")
    for arguments in (("doctor",), ("trace", "duffing")):
        done = python(DOOR, site, arguments=arguments)
        assert (done.returncode, done.stdout, done.stderr) == (2, "", f"orbitrace: {told}\n")


def test_script_that_is_called_as_a_package(site: Path, tmp_path: Path) -> None:
    """Assert that a user's own module under the name of a package is told by its path."""
    (tmp_path / "symbolic.py").write_text("x = 1\n")
    done = python("import periodic", tmp_path, site)
    file = str(tmp_path / "symbolic.py")
    assert f"symbolic is not orbitrace's but {file!r}; rename that, or keep" in done.stderr


def test_folder_of_reports_is_not_asked(site: Path, tmp_path: Path) -> None:
    """Assert that the command line runs beside a user's package `reports`."""
    (tmp_path / "reports").mkdir()
    (tmp_path / "reports" / "__init__.py").write_text("raise SystemExit('the user has reports')\n")
    for arguments in (("--version",), ("scenes",), ("doctor", "--json")):
        done = python(DOOR, tmp_path, site, arguments=arguments)
        assert done.returncode == 0 and done.stdout and done.stderr == "", done.stderr


def test_command_line_asks_for_nothing_called_reports() -> None:
    """Assert that what is installed as `orbitrace.app` names its own modules relative to itself."""
    for path in (ROOT / "reports" / "app").rglob("*.py"):
        lines = path.read_text("utf-8").splitlines()
        assert not [line for line in lines if line.strip().startswith(("from reports", "import reports"))], (
            path
        )
