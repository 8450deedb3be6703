"""Known answers are asked of kernels in C where there is a compiler, as users have them, else of NumPy's."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from symbolic.kernels import native


@pytest.fixture(autouse=True, scope="module")
def kernels() -> Iterator[None]:
    """Systems of a module are compiled with the kernels that a user gets."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", "numpy" if native.compiler() is None else "c")
        yield
