"""Known answers are asked of kernels in C where there is a compiler, as users have them, else of NumPy's."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from symbolic.kernels import native


@pytest.fixture(autouse=True, scope="module")
def kernels() -> Iterator[None]:
    """Systems of a module are compiled with the kernels that a user gets, unless some are asked for."""
    with pytest.MonkeyPatch.context() as patch:
        if "ORBITRACE_KERNELS_UNASKED" in os.environ and native.compiler() is not None:
            patch.setenv("ORBITRACE_KERNELS", "c")
        yield
