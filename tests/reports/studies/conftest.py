"""Studies are computed with kernels in C where there is a compiler, as users have them, else NumPy's."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True, scope="module")
def kernels(users_kernels: None) -> None:
    """As users have them."""
