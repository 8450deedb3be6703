"""A sample of spoilt files in the normal run, ten thousand of each kind under the mark `long`."""

from __future__ import annotations

import pytest

from fuzz.kinds import KINDS
from fuzz.process import fuzzed

SAMPLE, ALL = 200, 10_000


@pytest.mark.parametrize("kind", KINDS)
def test_spoilt_files(kind: str) -> None:
    """Assert that each of some is read or refused as it should be, and that there are both."""
    found = fuzzed(kind, 0, 40 if kind in ("branch", "map") else SAMPLE)
    assert found.wrong == [] and found.read > 0 and found.refused > 0, found


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_all_spoilt_files(kind: str) -> None:
    """Assert it of all."""
    found = fuzzed(kind, SAMPLE, ALL - SAMPLE)
    assert found.wrong == [], found
