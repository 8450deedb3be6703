"""The paper's disc as a cylinder: line contact with its film and the squeeze of it."""

from reports.studies.machines.machine import Machine
from symbolic.scenes.axes import RPM

CYLINDER = Machine(
    key="line-contact-810N",
    title="Wavy cylinder in lubricated line contact",
    parameter="speed",
    axis="speed (rev/min)",
    range=(900.0, 200.0),
    unit=RPM,
    size=1e-6,
    swing="x peak to peak (µm)",
    marched=(850.0, 700.0, 580.0, 450.0, 300.0),
    words="The paper's disc rolling on a line of 10 mm: Palmgren's contact of rollers, nearly linear, in "
    "series with a film of h/R = 3.06 U^0.69 G^0.56 W^-0.10 that squeezes. A line is stiffer than a point: "
    "the resonance lies near 380 rev/min, where the point contact has it at 240 to 250 under the "
    "same load, and without folds.",
)
