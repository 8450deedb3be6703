"""The gear pair, and where its main fold goes with the load."""

from __future__ import annotations

import numpy as np

from periodic import Branch, FoldCondition, Label, trace
from reports.studies.machines.figures import Curve
from reports.studies.machines.machine import Known, Machine, place


def over_load(machine: Machine, found: Branch) -> Curve:
    """Return the fold of the main resonance over the mean load."""
    fold = found.labelled(Label.FOLD)[1]
    border = trace(
        machine.system, "F_m", (0.06, 0.3), guess=fold.orbit, determined={"Omega": FoldCondition()}
    )
    load, place = np.array([p.parameter for p in border]), border.column("Omega")
    order = np.arange(len(load))
    return Curve(place[order], load[order], ("Ω of the fold", "mean load F_m"))


GEAR = Machine(
    key="gear-pair",
    title="Gear pair: backlash, varying mesh stiffness, transmission error",
    parameter="Omega",
    axis="mesh frequency Ω over the natural one",
    range=(1.2, 0.4),
    marched=(1.1, 1.0, 0.9, 0.8, 0.7, 0.62, 0.5, 0.42),
    words="Teeth part within each mesh period on the upper sheets: the resonance leans to low frequencies, "
    "and again at half the resonance, where the second harmonic of the mesh excites. In the dimensionless "
    "form of Kahraman and Singh, x'' + 2ζ x' + K(τ) B(x) = F_m + Σ F_j (jΩ)² cos jτ with ζ = 0.05, "
    "F_m = 0.1, F = (0.01, 0.004, 0.002), K = 1 - Σ k_j cos jτ, k = (0.2, 0.1, 0.05). Only the driving "
    "flanks part here: the folds do not depend on the size of the backlash, but on the load.",
    known=(
        Known(name="LP of the main resonance, low end", value=0.598153117, ours=place(Label.FOLD, 0)),
        Known(name="LP of the main resonance, high end", value=0.835837679, ours=place(Label.FOLD, 1)),
    ),
    two=over_load,
    waterfall=True,
)
