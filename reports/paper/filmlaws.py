"""Readings of the film law: what they give for the steady film, and what of it matters to the motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import periodic
from reports.curve import draw_curve, solid
from reports.pages.figures import panels
from reports.pages.section import Section, Tell
from reports.paper import films
from reports.paper.causes import PAPER_B
from reports.paper.scenes import branch
from reports.view import MICRO, RPM

NAMES = {
    "calibrated": "calibrated to the paper's 3.85 µm (default)",
    "equation-5": "eq. (5) as printed, U* to the power 0.625",
    "constant-one-body": "K as printed, one-body modulus",
    "constant-two-body": "K as printed, two-body modulus",
    "hamrock-dowson": "Hamrock-Dowson minimum film",
}
"""What the readings are called; the keys are values of film.thickness in a scene."""

SHORT = dict(
    zip(NAMES, ("calibrated", "eq. (5)", "K, one body", "K, two bodies", "Hamrock-Dowson"), strict=True)
)
"""The same in a figure's legend."""

COLOURS = ("tab:blue", "tab:orange", "tab:green", "tab:red", "tab:purple", "tab:brown")

Numbers = dict[str, float]


def numbers() -> Numbers:
    """Return the key numbers, those of all branches among them (rev/min, um)."""
    found = films.exponent_numbers() | films.film_for_damping()
    for name in films.READINGS:
        found |= films.reading_numbers(name) | films.fold_numbers(name, films.reading_branch(name))
        found[f"{name} second direction"] = films.directions(name)
    for floor in films.FLOORS:
        found |= films.floor_numbers(floor)
    low = films.lower_branch(1e-4).labelled(periodic.Label.FOLD)
    return found | {
        "tuned orbits difference": films.tuned_difference(),
        "least log load at the upper fold": films.least_load(),
        "ambient share": films.ambient_share(),
        "floor 0.0001 lower fold rpm": low[0].parameter / RPM,
        "floor 0.0001 at 100 rpm um": films.floor_branch(1e-4)[-1].peak_to_peak("x") / MICRO,
    }


def section(tell: Tell) -> Section:
    """Return the section."""
    tell("readings of the film law")
    found = numbers()
    return Section(
        title="Readings of the film law, and a film that cavitates",
        text="\n\n".join((_readings(found), _one_number(found), _oil_b(found), _floor(found))),
        numbers=found,
        figures={"filmlaws-readings": _reading_figure(), "filmlaws-floor": _floor_figure()},
    )


def _readings(n: Numbers) -> str:
    head = (
        "| law | h0 (µm) | resonance (rev/min) | ζ | upper fold (rev/min; µm) | lower fold | further folds |"
    )
    rows = [head, "|---|---|---|---|---|---|---|"]
    for key, words in NAMES.items():
        count = sum(name.startswith(f"{key} fold") for name in n) // 2
        cells = [
            words,
            f"{n[f'{key} film um']:.3f}",
            f"{n[f'{key} resonance rpm']:.2f}",
            f"{n[f'{key} damping ratio']:.2g}",
            *(f"{n[f'{key} fold {i} rpm']:.2f}; {n[f'{key} fold {i} um']:.2f}" for i in (1, 2)),
            ", ".join(f"{n[f'{key} fold {i} rpm']:.2f}" for i in range(3, count + 1)) or "none",
        ]
        rows.append("| " + " | ".join(cells) + " |")
    exponents = ", ".join(
        f"{n[f'equation-5 film with exponent {e:g} um']:.2f} µm with {e:g}" for e in films.EXPONENTS
    )
    table = "\n".join(rows)
    return f"""Two formulas of the paper give the steady film thickness h0: eq. (5), whose exponent of U*
is illegible in our copy, and the constant K under eq. (13), which carries a factor exp(54.85) that eq.
(5) lacks. They do not agree with each other, and neither gives just the 3.85 µm that the paper reports at
360 rev/min, 810 N and Shell Vitrea 79. What each reading does (steel: E = 207 GPa, ν = 0.3, which the
paper does not give; h0 and the damping ratio ζ at the paper's point; folds as x peak to peak; of further
folds the speed):

{table}

![Response with each reading; right: the folds. Dashed: unstable.](filmlaws-readings.png)

In K the exponent of G* is read as 10.2, which is 0.46 β; one more in its last digit adds
{n["percent of film per digit"]:.1f} % to h0. The two readings of K differ in the modulus: one body's (1 -
ν²)/(πE), as the list of symbols seems to say, or the sum over both. Eq. (5) gives {exponents} as the
exponent of U*; only about {n["equation-5 exponent for 3.85 um"]:.3f} would give 3.85 µm. So eq. (5)
cannot be the formula with which the paper's film was computed, as far as it can be read, and K or a
formula like it was. The thin film of eq. (5) all but takes the damping away: the response then has folds
at the superharmonic of order two as well."""


def _one_number(n: Numbers) -> str:
    worst = max(n[f"{name} second direction"] for name in films.READINGS)
    return f"""**Only h0, β and γ enter.** Written relative to its steady state, the film law is W = Q
(h/h0)^(-β) exp(-γ ḣ), and a reading says nothing but h0. Checked in three ways. As expressions: the
equations with any law are those with h0 as a number of its own and the law's formula put in its place (to
rounding, tests/test_film_laws.py). By derivatives: those of the equations with respect to viscosity,
piezoviscosity, crown radius and elastic constants all have one direction (second singular value over the
first at most {worst:.0e}). By orbits: with the viscosity chosen so that Hamrock-Dowson's formula gives
the calibrated h0 at {films.TUNED_SPEED:g} rev/min, where contact is lost in every cycle, the two orbits
differ by {n["tuned orbits difference"]:.0e} of their size. What the readings' other exponents do is to
change h0 with speed; the lower fold, where the contact is not lost, hardly notices any of it."""


def _oil_b(n: Numbers) -> str:
    return f"""**Oil B.** The calibrated law gives Shell Turbo 33 a film of {n["oil B film um"]:.3f} µm at
360 rev/min and 810 N, and with it a damping ratio of {n["oil B damping ratio"]:.2g}. The paper's
{PAPER_B:g} (P11) would need a film of {n[f"oil B film for {PAPER_B:g} um"]:.2f} µm."""


def _floor(n: Numbers) -> str:
    rows = [
        "| floor φ | upper fold (rev/min; µm) | x p-p at 250 rev/min (µm) | at 200 rev/min |",
        "|---|---|---|---|",
    ]
    for floor in films.FLOORS:
        key = f"floor {floor:g}"
        fold = (
            f"{n[f'{key} fold 1 rpm']:.2f}; {n[f'{key} fold 1 um']:.1f}"
            if f"{key} fold 1 rpm" in n
            else "none above 100"
        )
        rows.append(
            f"| {floor:.0e} | {fold} | {n[f'{key} at 250 rpm um']:.2f} | {n[f'{key} at 200 rpm um']:.2f} |"
        )
    rows.append(
        f"| squeeze film | {n['calibrated fold 1 rpm']:.2f}; {n['calibrated fold 1 um']:.1f} "
        f"| {_squeezed_at_250():.2f} | no such orbit |"
    )
    table = "\n".join(rows)
    folded = [floor for floor in films.FLOORS if f"floor {floor:g} fold 1 rpm" in n]
    open_ended = min(set(films.FLOORS) - set(folded))
    return f"""**A film that cavitates.** On the upper sheet the squeeze film must fill whatever gap the
discs open. As the load that it carries falls it separates ever faster without bound; at the upper fold W
falls to exp({n["least log load at the upper fold"]:.0f}) Q. No liquid does that: ambient pressure over
the footprint carries about {n["ambient share"]:.1e} Q, and below such a load the film ruptures. The scene
`cavitating-film-810N` therefore lets the film separate no faster than under the load φQ,

    dh/dt = -(1/γ) [ln max(W/Q, φ) + β ln(h/h0)],   W = Q max(δ/δ0, 0)^1.5,

and where the discs part faster, a cavity opens between film and disc and carries no load. This is one
model of rupture, chosen because it is the paper's law above φQ and leads back to it as φ → 0; φ is not
known.

{table}

![Response with floors on the film's load; circles: upper folds. Dashed: unstable.](filmlaws-floor.png)

The upper fold of the squeeze film does not survive. With a floor of {open_ended:g} or more the upper
sheet goes on below 100 rev/min, stable all the way, the discs leaping by
{n["floor 0.0001 at 100 rpm um"]:.0f} µm there with φ = 0.0001. With φ of {max(folded):g} and less there is a
fold above 100 rev/min, and it moves towards the squeeze film's, slowly, since φ enters by its logarithm.
Floors smaller than {min(films.FLOORS):g} were not traced in this form, which becomes too stiff. So
the fold at {n["calibrated fold 1 rpm"]:.1f} rev/min rests on a film that fills the
gap at such loads, and a film that ruptures earlier does not have it there: the paper's law cannot be
relied on for how far the upper sheet goes. What limits the leaps then (supports, air, the bearings'
travel) is not in this scene. The lower fold stays where it was, at {n["floor 0.0001 lower fold rpm"]:.3f}
rev/min with φ = 0.0001, since contact is not lost there; and on the upper sheet x at 250 rev/min changes
little with φ."""


def _squeezed_at_250() -> float:
    traced = branch(films.SCENE, at=(250.0, films.TUNED_SPEED))
    met = [p for p in traced.labelled(periodic.Label.USER) if p.parameter == 250.0 * RPM]
    return max(p.peak_to_peak("x") for p in met) / MICRO


def _reading_figure() -> Figure:
    figure, (left, right) = panels(1, 2, height=3.6)
    for axes in (left, right):
        for name, color in zip(films.READINGS, COLOURS, strict=False):
            _curve(axes, films.reading_branch(name), color, SHORT[name])
        axes.set(xlabel="speed (rev/min)", ylabel="x peak to peak (µm)")
    left.set(xlim=(100, 450), ylim=(0, None))
    right.set(xlim=(232, 258), ylim=(14, 30))
    left.legend(loc="upper right", fontsize="x-small")
    return figure


def _floor_figure() -> Figure:
    figure, axes = panels(1, 1, height=3.6)
    for floor, color in zip(films.FLOORS[2:], COLOURS, strict=False):
        _curve(axes, films.floor_branch(floor), color, f"floor {floor:.0e} Q")
        _upper_fold(axes, films.floor_branch(floor), color)
    _curve(axes, films.reading_branch("calibrated"), "black", "squeeze film")
    _upper_fold(axes, films.reading_branch("calibrated"), "black")
    axes.set(xlabel="speed (rev/min)", ylabel="x peak to peak (µm)", xlim=(100, 400), yscale="log")
    axes.legend(loc="upper right", fontsize="x-small")
    return figure


def _upper_fold(axes: Any, traced: periodic.Branch, color: str) -> None:
    for fold in traced.labelled(periodic.Label.FOLD)[:1]:
        axes.plot(
            fold.parameter / RPM, fold.peak_to_peak("x") / MICRO, "o", color=color, markersize=5, zorder=5
        )


def _curve(axes: Any, traced: periodic.Branch, color: str, name: str) -> None:
    across = np.array([p.parameter for p in traced]) / RPM
    up = np.array([p.peak_to_peak("x") for p in traced]) / MICRO
    draw_curve(axes, across, up, solid(traced), color=color, labels=(name, ""), linewidth=1.4)
