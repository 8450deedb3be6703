"""The gallery: every script runs by itself and ends with its key number, to the digits that are known."""

from __future__ import annotations

import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

from symbolic.kernels import native

pytestmark = pytest.mark.gallery

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"

KEYS = {
    "all_motions": (2.605383, 1e-5),
    "atlas": (0.598153117, 1e-6),
    "chaos": (-0.25, 1e-6),
    "torus_family": (0.843933665, 1e-8),
    "torus": (0.501205988590, 1e-8),
    "beam_stop": (3.341671435481361, 1e-9),
    "damper_design": (1.101655979756, 1e-9),
    "isola": (0.99123409951, 1e-9),
    "measured_fit": (0.99654763, 1e-6),
    "absorber": (0.59604773, 1e-6),
    "damped_mode": (0.0402174, 1e-4),
    "tolerances": (2.21328366, 1e-6),
    "ball_bearing": (0.49618804, 1e-6),
    "cylinder_film": (6.28655, 2e-6),
    "design_map": (4.0841704, 1e-4),
    "duffing": (2.2119353, 1e-7),
    "elastic_stop": (1.38481692, 1e-7),
    "force_cusp": (0.0513635, 1e-6),
    "friction_damper": (1.244278877, 1e-8),
    "gear_pair": (0.598153117, 1e-8),
    "impact": (0.09997075362630, 1e-8),
    "oil_whirl": (7771.187, 1e-6),
    "parametric": (1.9007661188, 1e-6),
    "proof": (0.598153117286, 1e-11),
    "pendulum_backbone": (2.9830777999, 1e-6),
    "ross_rotor": (121.66576065, 1e-7),
    "rotor_whirl": (1.7147671116, 1e-8),
    "rub": (1.3407996345, 1e-8),
    "squeeze_film": (184.207242, 1e-6),
    "wavy_disc": (237.486586, 1e-6),
}
"""Key numbers, and to which relative precision they are known: closed forms and references of other tests."""

MANY = ("all_motions", "atlas", "chaos", "torus", "torus_family")
"""Those that follow many motions, which takes long without a compiler."""


def test_every_example_has_its_number() -> None:
    """Assert that no script is left out."""
    assert {file.stem for file in EXAMPLES.glob("*.py")} == set(KEYS)


@pytest.mark.parametrize("name", KEYS)
def test_example(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the key number, a picture, and that it is short."""
    if name in MANY and native.compiler() is not None:
        monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    file = EXAMPLES / f"{name}.py"
    plt.switch_backend("Agg")
    plt.close("all")
    monkeypatch.chdir(EXAMPLES)
    said = runpy.run_path(str(file))
    number, precision = KEYS[name]
    assert said["key"] == pytest.approx(number, rel=precision)
    assert said["axes"].has_data() and len(plt.get_fignums()) == 1
    plt.close("all")
    assert len(file.read_text("utf-8").split('"""', 2)[2].strip().splitlines()) <= 30
