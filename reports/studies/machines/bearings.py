"""The ball bearing JIS 6306, dry and with an oil film on each ball."""

from __future__ import annotations

from typing import Any

import numpy as np

from periodic import Branch, DoublingCondition, Label, trace
from reports.studies.machines.figures import Curve
from reports.studies.machines.machine import Known, Machine, place, rpm, swing

MICRO, KRPM = 1e-6, 1000 * rpm(1.0)
COMMON: dict[str, Any] = {
    "parameter": "speed",
    "axis": "speed of the shaft (10³ rev/min)",
    "unit": KRPM,
    "size": MICRO,
    "swing": "x peak to peak (µm)",
    "settle": 1200,
}

DRY = Machine(
    key="ball-bearing",
    title="Ball bearing: varying compliance",
    range=(10.0, 4.0),
    at=(7.0, 6.0, 4.25),
    marched=(9.0, 8.0, 7.0, 6.0, 5.7, 4.3),
    words="A rigid shaft of 20 kg under its weight in a bearing of 8 balls with 6 µm of clearance: as balls "
    "pass, the stiffness varies, and near resonance all balls lose contact. The period is that of the "
    "passage of one ball, 3.084615 times the shaft's frequency, so that multipliers are those of one passage "
    "and a doubling is one (written at the cage's frequency they come to the 8th power). The known peaks to "
    "peak lie a few 1e-6 below ours, as the largest of samples do; shooting with DOP853 gives ours to 1e-6.",
    known=(
        Known(name="x p-p at 7000 rev/min (µm)", value=0.49618627, ours=swing(7 * KRPM, "x", MICRO)),
        Known(name="y p-p at 7000 rev/min (µm)", value=0.29072993, ours=swing(7 * KRPM, "y", MICRO)),
        Known(name="x p-p at 6000 rev/min (µm)", value=2.43086450, ours=swing(6 * KRPM, "x", MICRO)),
        Known(name="y p-p at 6000 rev/min (µm)", value=0.41931401, ours=swing(6 * KRPM, "y", MICRO)),
        Known(name="PD (10³ rev/min)", value=5.428828134, ours=place(Label.DOUBLING, 0, KRPM)),
    ),
    **COMMON,
)


def over_clearance(machine: Machine, found: Branch) -> Curve:
    """Return the first doubling over the clearance, up to a preload of a micrometre."""
    doubling = found.labelled(Label.DOUBLING)[0]
    border = trace(
        machine.system,
        "clearance",
        (-1e-6, 8e-6),
        guess=doubling.orbit,
        determined={"speed": DoublingCondition()},
    )
    clearance = np.array([p.parameter for p in border]) / MICRO
    speed = border.column("speed") / KRPM
    return Curve(speed, clearance, ("speed of the doubling (10³ rev/min)", "clearance (µm)"))


OILED = Machine(
    key="ball-bearing-lubricated",
    title="Ball bearing with an oil film on each ball",
    range=(10.0, 4.0),
    marched=(9.0, 8.0, 7.0, 6.6),
    words="The same bearing with a film of 0.3 µm (at 100 N) between each ball and either race, in series "
    "with Hertz's contact: h = h0 (W/W0)^(-1/13.7), without squeeze. The film takes up clearance, softens "
    "the loss of contact, and leaves no kink.",
    two=over_clearance,
    **COMMON,
)
