"""What a branch says of names, numbers and values that it does not have."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path

import pytest
from support.traces import duffing

import periodic as per

WRONG: list[tuple[Callable[[per.Branch], object], str]] = [
    (lambda branch: branch[0].maximum["zz"], "output is 'zz'; it must be one of x"),
    (lambda branch: branch[0].minimum["zz"], "output is 'zz'; it must be one of x"),
    (lambda branch: branch[0].columns["zz"], "column is 'zz'; it must be one of none"),
    (lambda branch: branch[0].orbit.parameters["zz"], "parameter is 'zz'; it must be one of "),
    (lambda branch: branch[1000], f"index is 1000; the branch has {len(duffing())} points"),
]  # fmt: skip


@pytest.mark.parametrize("case", range(len(WRONG)))
def test_names_that_are_none(case: int) -> None:
    """Assert one sentence that names what there is."""
    read, said = WRONG[case]
    with pytest.raises(LookupError) as caught:
        read(duffing())
    assert str(caught.value).startswith(said)


def test_numbers_by_name_are_pickled() -> None:
    """Assert that they come back, sentence and all."""
    found = pickle.loads(pickle.dumps(duffing()[0].maximum))
    assert found == duffing()[0].maximum
    with pytest.raises(KeyError, match="output is 'zz'; it must be one of x"):
        found["zz"]


def test_folders_are_made(tmp_path: Path) -> None:
    """Assert that a branch is saved to a folder that is not there yet."""
    duffing().save(tmp_path / "new" / "folder" / "branch.nc")
    assert len(per.Branch.load(tmp_path / "new" / "folder" / "branch.nc")) == len(duffing())


def test_values_that_are_not_passed() -> None:
    """Assert that values of `at` are told that have no point, and none of those that have."""
    assert duffing(at=(0.8, 1.7)).remarks == ()
    cut = per.Branch(**{**vars(duffing(at=(0.8, 1.7))), "points": duffing(at=(0.8, 1.7)).points[:3]})
    assert cut.remarks == ("no point at Omega = 0.8, 1.7: the branch does not pass there",)
