"""What a method of the user's own has without saying so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.numpy_systems import LinearOscillator
from support.surfaces import along

from periodic.correction import discretisation
from periodic.correction.discretisation import Discretisation
from periodic.stability.multipliers import Stability


class Own(Discretisation):
    """A method that has what it must."""

    def guess(self, system: Any, parameter: Any, near: Any) -> Any:
        """The orbit near."""
        return near

    def linearise(self, system: Any, orbit: Any, free: Any) -> Any:
        """No equations."""

    def transfer(self, system: Any, orbit: Any, mesh: Any, phases: Any) -> Any:
        """The orbit itself."""
        yield orbit

    def error(self, problem: Any, correction: Any, tangent: Any, spectrum: Any) -> Any:
        """No error."""

    def refine(self, system: Any, orbit: Any, error: Any) -> Any:
        """No other mesh."""


ORBIT = along(lambda tau: np.sin(tau)[:, None])


def test_method_without_events() -> None:
    """Assert no changes of the pattern, no other words, and nothing that settles."""
    own, system = Own(), LinearOscillator()
    assert own.change(system, ORBIT, ORBIT) is None
    assert own.reordered(system, ORBIT, np.zeros(0)) is None
    assert own.rewritten(system, ORBIT) is None and own.reworded(system, ORBIT) is None
    assert own.pattern(system, ORBIT) == () and own.alternatives == ()
    assert own.settles(system) is False and own.settled(system, ORBIT) is None
    assert own.stability is Stability.MULTIPLIERS and own.trusted == float("inf")
    assert own.at(1e-3) is own


def test_method_keeps_what_newton_found() -> None:
    """Assert the correction itself, and its multipliers."""
    own = Own()
    correction: Any = SimpleNamespace(fundamental=np.array([np.eye(2), np.diag([0.5, 2.0])]))
    assert own.accepted(LinearOscillator(), correction) is correction
    spectrum = own.spectrum(correction, 1)
    assert np.sort(spectrum.multipliers.real).tolist() == [0.5, 2.0] and spectrum.trivial == 1


def test_rest_and_drift_are_those_of_the_mean_load(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that they are asked of the system."""
    monkeypatch.setattr(discretisation, "resting", lambda system, start: (system, start))
    monkeypatch.setattr(discretisation, "drifting", lambda system, parameter: [system, parameter])
    own: Any = Own()
    assert own.resting("system", "start") == ("system", "start")
    assert own.drifting("system", "p") == ["system", "p"]


@pytest.mark.parametrize("name", ["guess", "linearise", "transfer", "error", "refine"])
def test_method_that_lacks_something_is_none(name: str) -> None:
    """Assert that it cannot be made without what it must have."""
    given = {key: value for key, value in vars(Own).items() if key != name and not key.startswith("__")}
    with pytest.raises(TypeError, match=name):
        type("Lacking", (Discretisation,), given)()
