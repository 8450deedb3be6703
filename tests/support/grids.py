"""Claims that are asserted of many cases: some of them by `make test`, the others by `make grids`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from _pytest.mark.structures import ParameterSet


def spread(cases: Iterable[Any], first: int) -> list[ParameterSet]:
    """Return all cases; those but `first` of them, spread from the first one to the last, are marked `grids`.

    A case is a tuple of values, or one value.
    """
    given = [case if isinstance(case, tuple) else (case,) for case in cases]
    ends = max(first - 1, 1)
    run = {round(k * (len(given) - 1) / ends) for k in range(first)}
    return [pytest.param(*case, marks=() if k in run else pytest.mark.grids) for k, case in enumerate(given)]
