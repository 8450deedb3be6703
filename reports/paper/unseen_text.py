"""The words on what the paper could not see, with what was computed put in; checks name their tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from periodic import Point
from reports.paper.contact import LOST
from reports.paper.unseen_figures import TITLES
from reports.view import MICRO, RPM

Numbers = Mapping[str, float]
SCENE = "vitrea79-810N"

WORDS = {
    "A": "smooth, the paper's own speed",
    "B": "just above the first loss of contact",
    "C": "contact lost in every cycle, stable",
    "D": "upper fold",
    "E": "between the folds",
    "F": "lower sheet",
}


def text(n: Numbers, orbits: Mapping[str, Point], damping: Sequence[tuple[float, float]]) -> str:
    """Return the section's Markdown."""
    return "\n\n".join([_branches(n), _orbits(n, orbits), _damping(n, damping), _doubled(n)]) + "\n"


def _branches(n: Numbers) -> str:
    head = "| disc | folds in rev/min (x p-p in µm) | contact lost on the upper sheet |\n|---|---|---|\n"
    lines = []
    for name, title in TITLES.items():
        count = sum(key.startswith(f"{name} fold") and key.endswith("rpm") for key in n)
        folds = [
            f"{n[f'{name} fold {k} rpm']:.3f} ({n[f'{name} fold {k} x um']:.2f})" for k in range(1, count + 1)
        ]
        lines.append(f"| {title} | {', '.join(folds)} | below {n[f'{name} contact lost below rpm']:.1f} |")
    return f"""The paper's calculation found no finite amplitude in a band about the resonance: the discs
separate, the film opens ever faster and eq. (13) gives no finite value. The orbits are there all the same.
Found directly instead of waited for, they make one continuous branch for each disc:

![The whole branches. Solid: stable, dashed: unstable, red: the load falls below a thousandth of the preload
in every cycle, dots: folds.](unseen-branches.png)

{head}{chr(10).join(lines)}

Each resonance bends to lower speeds because a contact that opens is softer. Between the two main folds a
small and a large stable motion exist at the same speed; which one a machine shows depends on whether the
speed came from above or below. The thin oil has two more folds at half the natural speed: there the second
harmonic of the motion is in resonance (2:1), narrowly, and contact is lost again. Folds were found again by
shooting with stiff integration of other state variables: those at {n[f"{SCENE} fold 1 rpm"]:.3f} and
{n[f"{SCENE} fold 2 rpm"]:.3f} rev/min agree to 1e-9 (tests/test_disc_vitrea79.py). For the upper folds of
the first three discs orbits were shot on both sheets close to the fold, and the determinant of I - M taken,
M the monodromy matrix: it has opposite signs on the two sheets, and the speeds at which it vanishes agree
with the traced folds to 1e-8 (tests/test_paper_unseen.py)."""


def _orbits(n: Numbers, orbits: Mapping[str, Point]) -> str:
    lines = [
        "| | speed | x p-p (µm) | least load (N) | largest load (N) | largest multiplier | |",
        "|---|" + "---|" * 6,
    ]
    for letter, point in orbits.items():
        lines.append(
            f"| {letter} | {point.parameter / RPM:.2f} | {point.peak_to_peak('x') / MICRO:.3f} "
            f"| {point.minimum['load']:.2e} | {point.maximum['load']:.0f} "
            f"| {abs(point.multipliers[0]):.4f} | {WORDS[letter]} |"
        )
    return f"""**Loss of contact along the branch** (oil A, 810 N). Six orbits, labelled on the first panel:

![Six orbits along the branch of oil A at 810 N. Dashed: unstable. The speed of x is that of the discs'
approach; the load is shown on a logarithmic and on a plain scale.](unseen-orbits.png)

{chr(10).join(lines)}

Where contact is lost the load falls by tens of orders of magnitude but never to zero: the film is drawn out,
and dh/dt grows only with the logarithm of the deflection. A calculation in the load or in the deflection
runs into exp of a large number there, which is the paper's breakdown; the logarithm of the load does not.
On the way back the load rises from {LOST:g} Q to Q within {n["load back within rad"]:.3f} rad of the
excitation."""


def _damping(n: Numbers, curve: Sequence[tuple[float, float]]) -> str:
    (first, smallest), (last, largest) = curve[0], curve[-1]
    return f"""**Damping against amplitude.** The paper calls the film's contribution to damping
negligible, from small motion at 360 rev/min. The multipliers of the orbits say how free motion about each
of them decays.
For oil A at 810 N the damping ratio is {smallest:.4f} about an orbit of {first / MICRO:.2f} µm and
{largest:.3f} about one of {last / MICRO:.1f} µm: the film damps large motion with loss of contact
{largest / smallest:.0f} times as strongly. That is why the branch of oil A turns at
{n[f"{SCENE} fold 1 x um"]:.0f} µm; the thin oil's film begins to damp only where contact is lost.

![Damping ratio of small free motion about the orbits from 500 rev/min down the upper sheet, as long as it
oscillates.](unseen-damping.png)"""


def _doubled(n: Numbers) -> str:
    low, high = n[f"{SCENE} doubling 1 rpm"], n[f"{SCENE} doubling 2 rpm"]
    fold = n["doubled orbits fold rpm"]
    large, little = n["simulated motion at 500 rpm x um"], n["small orbit at 500 rpm x um"]
    head = "| disc | small motion unstable between |\n|---|---|\n"
    lines = [
        f"| {title} | {n[f'{name} doubling 1 rpm']:.3f} and {n[f'{name} doubling 2 rpm']:.3f} rev/min |"
        for name, title in TITLES.items()
    ]
    return f"""**Orbits of two periods.** Far above the resonance, near twice the natural speed, the
paper's curves are flat. Time integration at 500 rev/min from a hard knock settles to a motion of
{large:.2f} µm peak to peak that repeats after two excitation periods, {large / little:.0f} times the small
motion of {little:.2f} µm at the same speed.

![Orbits of one and of two excitation periods, oil A, 810 N.](unseen-doubled.png)

![The motion of two periods at 500 rev/min: one hard contact and one flight.](unseen-doubled-motion.png)

Traced from there, it turns out not to be an island. Its stable part goes up in speed and shrinks onto
the small motion at {high:.3f} rev/min; down in speed it ends in a fold at {fold:.3f} rev/min, from which
an unstable part leads back to the small motion at {low:.3f} rev/min. At these two speeds a multiplier of the
small motion passes -1, found on its own branch by its own test, and between them it is unstable:
the corrugations change the contact's stiffness at twice its natural frequency, which is the classical
parametric resonance. So from {fold:.1f} to {low:.1f} rev/min both motions are stable, and from
{low:.1f} to {high:.1f} rev/min only the one of two periods is. Independent stiff shooting confirms the
multiplier beyond -1 at 556 rev/min to 1e-7. All four discs have such a band:

{head}{chr(10).join(lines)}"""
