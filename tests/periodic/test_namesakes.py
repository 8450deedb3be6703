"""Whether a package that is found under one of our names is ours."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType

import pytest

import periodic.namesakes
import symbolic.namesakes

OURS = '__version__ = version("orbitrace")\n'
COPIES = pytest.mark.parametrize("copy", [periodic.namesakes, symbolic.namesakes])


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder on the path for packages, and one there without a file."""
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "neighbour").mkdir()
    return tmp_path / "neighbour"


@COPIES
def test_ours_by_its_first_file(copy: ModuleType, package: Path) -> None:
    """Assert that nothing is said of a package whose file asks for our version, nor of one not installed."""
    (package / "__init__.py").write_text(OURS)
    assert copy.foreign("neighbour") == ""
    assert "neighbour" not in sys.modules
    assert copy.foreign("neighbour_that_nobody_has") == ""


@COPIES
@pytest.mark.parametrize("file", ["__init__.py", None])
def test_another_on_the_path(copy: ModuleType, package: Path, file: str | None) -> None:
    """Assert the sentence about a package that shadows ours, and about a folder of that name."""
    if file:
        (package / file).write_text("class Symbol: ...\n")
    where = str(package / file if file else package)
    assert copy.foreign("neighbour") == (
        f"neighbour is not orbitrace's but {where!r}; rename that, or keep it off Python's path"
    )


@COPIES
@pytest.mark.parametrize("folder", ["site-packages", "dist-packages"])
def test_another_that_is_installed(
    copy: ModuleType, folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that an installed one is to be uninstalled."""
    file = tmp_path / folder / "neighbour" / "__init__.py"
    file.parent.mkdir(parents=True)
    file.write_text("")
    monkeypatch.syspath_prepend(str(tmp_path / folder))
    assert copy.foreign("neighbour") == (
        f"neighbour is another project's ({str(file)!r}); `pip uninstall neighbour`, then "
        "`pip install --force-reinstall --no-deps orbitrace`"
    )


@COPIES
def test_one_that_is_imported_is_not_looked_up(copy: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that what has been imported counts, with nothing to say of one that came from no file."""
    assert copy.foreign("periodic") == ""
    monkeypatch.setitem(sys.modules, "neighbour_made_here", ModuleType("neighbour_made_here"))
    assert copy.foreign("neighbour_made_here") == ""
