"""Pieces of a motion up to where an integrator fails: by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.follower import Follower


def failing(at: float) -> Any:
    """A motion y = tau whose integration fails past a phase."""

    def sweep(modes: Any, y: Any, phase: Any) -> Any:
        if phase[-1] > at:
            raise IntegrationError("given up", at)
        return phase[:, None]

    return SimpleNamespace(_raised=[], _modes=None, sweep=sweep)


@pytest.mark.parametrize(("at", "count"), [(9.0, 4), (2.5, 3), (1.5, 2), (1.0, 2)])
def test_piece_as_far_as_integration_succeeds(at: float, count: int) -> None:
    """Assert the phases 0, 1, 2, 3 up to the failure, two of them at the least."""
    found = Follower._ahead(failing(at), np.zeros(1), np.arange(4.0))
    assert found[:, 0].tolist() == list(range(count))


def test_failure_at_once_is_told() -> None:
    """Assert that there is no piece of one phase."""
    with pytest.raises(IntegrationError, match="given up"):
        Follower._ahead(failing(0.5), np.zeros(1), np.arange(4.0))
