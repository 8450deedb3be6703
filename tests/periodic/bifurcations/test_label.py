"""Labels: strings of which there is one instance each, open to new kinds of points."""

import copy
import math
import pickle
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import periodic as per
from periodic.bifurcations import stationary


def test_a_label_is_its_text_and_there_is_one_of_each() -> None:
    """Assert that a label equals its text, and that reading, copying and pickling give the one instance."""
    assert per.Label.FOLD == "LP" and per.Label("LP") is per.Label.FOLD
    assert type(per.Label.FOLD.value) is str and f"{per.Label.FOLD}" == "LP"
    assert copy.deepcopy(per.Label.CUSP) is per.Label.CUSP
    assert pickle.loads(pickle.dumps(per.Label.HOPF)) is per.Label.HOPF


def test_labels_with_a_multiplier_on_the_unit_circle() -> None:
    """Assert which labels mean a multiplier on the unit circle."""
    named = {"EP", "LP", "PD", "NS", "BP", "HB", "UZ", "MX", "CP", "R1", "R2", "R3", "R4"}
    named |= {"LPPD", "LPNS", "PDNS", "GH", "ZH", "BT", "GPD"}
    critical = {label for label in named if per.Label(label).critical}
    assert named <= set(per.Label.known()) and critical == {"LP", "PD", "NS", "BP", "HB"}


def test_a_new_label_takes_one_line() -> None:
    """Assert that a label can be registered, twice alike, and not otherwise."""
    new = per.Label.register("Q7", critical=True)
    assert per.Label("Q7") is new is per.Label.register("Q7", critical=True)
    assert new in per.Label.known() and new.critical
    with pytest.raises(ValueError, match="Q7 is registered with critical=True, not False"):
        per.Label.register("Q7")


@pytest.mark.parametrize("text", ["two words", "a-b", 7])
def test_text_that_is_no_label_is_refused(text: str) -> None:
    """Assert that a label is made of letters and digits."""
    with pytest.raises(ValueError, match="it must be made of letters and digits"):
        per.Label.register(text)


def test_an_unknown_label_names_those_there_are() -> None:
    """Assert that the refusal of an unknown label names the known ones."""
    with pytest.raises(ValueError, match=r"label is 'XX'; it must be one of EP, LP, PD, NS, BP"):
        per.Label("XX")


def test_growth_is_that_of_the_pair_nearest_the_axis() -> None:
    """Assert that a real eigenvalue nearer to the axis does not count; the sign is that of the test."""
    eigenvalues = np.array([-0.1, -2 + 1j, -2 - 1j, -0.5 + 3j, -0.5 - 3j])
    solution: Any = SimpleNamespace(spectrum=SimpleNamespace(multipliers=eigenvalues))
    assert stationary._growth(solution) == math.copysign(0.5, stationary.balance(eigenvalues))
