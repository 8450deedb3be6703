"""A motion that diverges is told while it does, not when the numbers end."""

from __future__ import annotations

from typing import Any

import pytest

import symbolic as sym


@pytest.mark.parametrize("growth", [0.5, 3.0])
def test_divergence_is_told(growth: float) -> None:
    """Assert that a simulation of an unstable oscillator stops with the state and the time, early."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": wave.cos - x.x + growth * x.v}

    system = sym.compile(sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"w": 1.0}, frequency="w"))
    with pytest.raises(sym.IntegrationError, match=r"past \d+\.?\d* s; it diverges: [xv] is .* times its"):
        sym.simulate(system)
