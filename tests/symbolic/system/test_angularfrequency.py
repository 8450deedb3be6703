"""The angular frequency as a function of parameters: what it is proportional to."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np
import pytest

from symbolic.system.angularfrequency import AngularFrequency

NAMES = ("n", "omega", "rest", "unused")
VALUES = np.array([3.0, 5.0, 7.0, 11.0])


def frequency(make: Any) -> AngularFrequency:
    """omega as a function of four parameters."""
    p = ca.SX.sym("p", 4)
    quantities = [SimpleNamespace(name=name, value=value) for name, value in zip(NAMES, VALUES, strict=True)]
    given: Any = SimpleNamespace(parameter=p, frequency=ca.SX(make(*(p[k] for k in range(4)))))
    return AngularFrequency(given, quantities)


@pytest.mark.parametrize(
    ("make", "value", "gradient", "product"),
    [
        (lambda n, w, r, u: w, 5.0, [0, 1, 0, 0], (("omega",), 1.0, {})),
        (lambda n, w, r, u: 2 * n * w, 30.0, [10, 6, 0, 0], (("n", "omega"), 2.0, {})),
        (lambda n, w, r, u: n * (w + r), 36.0, [12, 3, 3, 0], (("n",), 12.0, {"omega": 5.0, "rest": 7.0})),
        (lambda n, w, r, u: 4 * w + r, 27.0, [0, 4, 1, 0], ((), 1.0, {"omega": 5.0, "rest": 7.0})),
        (lambda n, w, r, u: w**2, 25.0, [0, 10, 0, 0], ((), 1.0, {"omega": 5.0})),
        (lambda n, w, r, u: ca.SX(6.0), 6.0, [0, 0, 0, 0], ((), 1.0, {})),
        (lambda n, w, r, u: n / r, 3 / 7, [1 / 7, 0, -3 / 49, 0], (("n",), 1 / 7, {"rest": 7.0})),
    ],
)
def test_frequency_of_parameters(make: Any, value: float, gradient: list[float], product: Any) -> None:
    """Assert value, gradient, and the factors with what is held, also where there are none."""
    own = frequency(make)
    assert own.omega(VALUES) == pytest.approx(value)
    assert own.gradient(VALUES) == pytest.approx(gradient)
    names, factor, held = own.product
    assert (names, held) == (product[0], product[2]) and factor == pytest.approx(product[1])


def test_gradient_is_not_shared() -> None:
    """Assert that what is done to it does not come back."""
    own = frequency(lambda n, w, r, u: w)
    own.gradient(VALUES)[:] = 9.0
    assert own.gradient(VALUES).tolist() == [0.0, 1.0, 0.0, 0.0]
