"""The targets of the Makefile: all that `make test` leaves out, long studies aside, CI runs by another."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from support.rooms import ROOMS, TESTS

ROOT = Path(__file__).resolve().parent.parent
MAKEFILE = (ROOT / "Makefile").read_text("utf-8")
CI = (ROOT / ".ci" / "run").read_text("utf-8")
NO_KIND = {"long", "unaccounted"}


def words(variable: str) -> list[str]:
    """The words of a variable of the Makefile."""
    found = re.search(rf"^{variable} := (.*)$", MAKEFILE, re.MULTILINE)
    assert found is not None
    return found[1].split()


def test_every_kind_has_a_target() -> None:
    """Assert that markers, kinds and the targets in their names are the same."""
    markers = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["pytest"]["ini_options"][
        "markers"
    ]
    kinds = {marker.partition(":")[0] for marker in markers} - NO_KIND
    assert set(words("KINDS")) == kinds
    targets = [line.partition(":")[0].split() for line in MAKEFILE.splitlines() if "tests of a kind" in line]
    assert [set(names) for names in targets] == [kinds]


@pytest.mark.parametrize("target", ["lint", "types", "layers", "kernels", "test", "apart"])
def test_ci_runs_it(target: str) -> None:
    """Assert that no target is forgotten there."""
    assert re.search(rf"\btimed {target}\b", CI)


def test_expressions_leave_nothing_out() -> None:
    """Assert that what `make test` does not run is what `make apart` runs, long studies aside."""
    assert '$(PYTEST) -rs --in-c -m "not (long or $(ANY_KIND))"' in MAKEFILE
    assert '$(PYTEST) -rs --in-c -m "($(ANY_KIND)) and not long"' in MAKEFILE


def test_rooms_run_with_both_back_ends() -> None:
    """Assert that rooms that `make test` runs in C are those that `make kernels` runs in NumPy."""
    assert words("KERNEL_ROOMS") == list(ROOMS)
    assert (
        'ORBITRACE_KERNELS=numpy $(PYTEST) $(KERNEL_ROOMS:%=tests/periodic/%) -m "not (long or backends)"'
        in MAKEFILE
    )
    assert all(list((TESTS / "periodic" / room).rglob("test_*.py")) for room in ROOMS)
