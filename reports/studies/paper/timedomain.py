"""The paper's time histories (its Figs. 5 to 8) beside ours."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from reports.studies.pages.content import Found, Section, Tell
from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.paper.common.discs import HEAVY, MICRO, OIL_A, OIL_B, RPM_SHOWN, TITLES
from reports.studies.paper.common.figures import legend
from reports.studies.paper.common.scenes import (
    at_paper_speed,
    film_at_rest,
    nominal,
    static_deflection,
    system,
)
from reports.studies.paper.marching.breakdown import step_limit
from reports.studies.paper.marching.histories import (
    BEATS,
    DURATION,
    decay,
    envelope,
    free_part,
    orbit_decay,
    ripple,
    settled,
    spectrum,
    stepped,
    trusted,
)
from symbolic.scenes.axes import RPM

EARLY, STEADY_6B, FIG_7, FIG_8 = (0.0, 0.02), (0.1, 0.14), (0.95, 1.0), (0.1, 0.15)
"""Windows in s, those of the paper's figures by their numbers."""


def compute(tell: Tell) -> Found:
    """Integrate from the paper's start, draw its Figs. 5 to 8 and measure what it gives numbers of."""
    tell("time histories at 360 rev/min")
    numbers = key_numbers()
    tell("drawing time histories")
    figures = {
        "timedomain-fig5": ripples(),
        "timedomain-fig6": beats(),
        "timedomain-spectrum": spectra(),
        "timedomain-fig7": window(OIL_B, FIG_7),
        "timedomain-fig8": window(HEAVY, FIG_8),
        "timedomain-settling": settling(),
    }
    return Found(numbers=numbers, figures=figures)


SECTION = Section(title="Time histories", compute=compute)


def key_numbers() -> dict[str, float]:
    """Return the numbers of this section: um, Hz, s as the names say."""
    found: dict[str, float] = {
        "deflection_um": static_deflection(nominal(OIL_A)) / MICRO,
        "wave_um": 2 * nominal(OIL_A)["amplitude"] / MICRO,
        "film_h0_um": film_at_rest(system(OIL_A), speed=RPM_SHOWN * RPM) / MICRO,
    }
    for key, name in (("oil_a", OIL_A), ("heavy", HEAVY), ("oil_b", OIL_B)):
        point, rest, fading = settled(name), at_paper_speed(name), decay(name, DURATION[name])
        free, forced = spectrum(trusted(name, DURATION[name]), BEATS).peaks
        found |= {f"{key}_{out}_um": point.peak_to_peak(out) / MICRO for out in ("x", "film", "deflection")}
        found |= {
            f"{key}_rest_Hz": float(rest.frequencies[0]) / (2 * math.pi),
            f"{key}_rest_damping": float(rest.damping_ratios[0]),
            f"{key}_free_Hz": free,
            f"{key}_forced_Hz": forced,
            f"{key}_decay_per_s": fading.rate,
            f"{key}_orbit_decay_per_s": orbit_decay(name),
            f"{key}_damping": fading.ratio,
            f"{key}_settled_s": fading.time,
            f"{key}_step_limit_ms": step_limit(name, RPM_SHOWN) * 1e3,
        }
    light, heavy, thin = (trusted(name, DURATION[name]) for name in (OIL_A, HEAVY, OIL_B))
    early = light.during(*EARLY)
    return found | {
        "oil_a_early_film_um": ripple(early.film) / MICRO,
        "oil_a_early_deflection_um": ripple(early.deflection) / MICRO,
        "oil_a_fig6b_x_um": ripple(light.during(*STEADY_6B).x) / MICRO,
        "heavy_fig8_x_um": ripple(heavy.during(*FIG_8).x) / MICRO,
        "heavy_fig8_stepped_x_um": ripple(stepped(HEAVY, FIG_8[1]).during(*FIG_8).x) / MICRO,
        "oil_b_fig7_x_um": ripple(thin.during(*FIG_7).x) / MICRO,
        "oil_b_stepped_until_ms": float(stepped(OIL_B, 0.1).time[-1]) * 1e3,
    }


def _both(axes: Any, name: str, window: tuple[float, float], quantity: str = "x") -> None:
    """Draw a quantity over a window in time: trusted, and stepped as far as that goes."""
    ours = trusted(name, DURATION[name]).during(*window)
    paper = stepped(name, window[1]).during(*window)
    axes.plot(ours.time * 1e3, getattr(ours, quantity) / MICRO, color=TRUSTED, lw=0.9, label="CVODES")
    if len(paper.time):
        style = {"color": PAPER, "ls": "none", "marker": ".", "ms": 2.5}
        axes.plot(paper.time * 1e3, getattr(paper, quantity) / MICRO, label="Runge-Kutta, 0.1 ms", **style)
    axes.set_xlim(window[0] * 1e3, window[1] * 1e3)


def _extremes(axes: Any, name: str) -> None:
    """Mark the extremes of the settled motion."""
    levels = settled(name).minimum["x"], settled(name).maximum["x"]
    for level, label in zip(levels, ("_", "steady extremes"), strict=True):
        axes.axhline(level / MICRO, color=SECOND, lw=0.9, ls="--", label=label)


def ripples() -> Figure:
    """Deflection and film of oil A at 810 N, early and late."""
    figure, axes = panels(2, 2, height=2.3, sharey="row", sharex="col")
    spans = {"from the start of the sinusoid": (0.0, 0.02), "steady": (0.48, 0.5)}
    for column, (title, window) in zip(axes.T, spans.items(), strict=True):
        _both(column[0], OIL_A, window, "deflection")
        _both(column[1], OIL_A, window, "film")
        column[0].set_title(title, fontsize=9)
        column[1].set_xlabel("time (ms)")
    axes[0, 0].set_ylabel("deflection δ (µm)")
    axes[1, 0].set_ylabel("film thickness h (µm)")
    legend(figure, axes[0, 0], "upper", 2)
    return figure


def beats() -> Figure:
    """x of oil A at 810 N from the start, and near the steady state."""
    figure, axes = panels(2, 1, height=2.2)
    for panel, window, title in zip(axes, ((0.0, 0.09), STEADY_6B), ("(a)", "(b)"), strict=True):
        _both(panel, OIL_A, window)
        panel.set_ylabel("x (µm)")
        panel.set_title(title, fontsize=9, loc="left")
    _extremes(axes[1], OIL_A)
    axes[1].set_xlabel("time (ms)")
    legend(figure, axes[1], "upper")
    return figure


def spectra() -> Figure:
    """Spectra of x over the first beats."""
    figure, axes = panels(1, 1, height=2.8)
    for name, colour in ((OIL_A, TRUSTED), (HEAVY, SECOND), (OIL_B, "tab:orange")):
        found = spectrum(trusted(name, DURATION[name]), BEATS)
        axes.plot(found.frequency, found.amplitude / MICRO, color=colour, label=f"Shell {TITLES[name]}")
        natural = float(at_paper_speed(name).frequencies[0]) / (2 * math.pi)
        axes.axvline(natural, color=colour, lw=0.8, ls=":")
    axes.axvline(2 * RPM_SHOWN, color="0.4", lw=0.8, ls="--")
    axes.plot([], [], color="0.2", lw=0.8, ls=":", label="natural frequency at rest")
    axes.plot([], [], color="0.4", lw=0.8, ls="--", label="excitation, 720 Hz")
    axes.set(xlim=(450, 850), xlabel="frequency (Hz)", ylabel="amplitude of x (µm)")
    axes.set_ylim(bottom=0)
    legend(figure, axes, "upper", size=8)
    return figure


def window(name: str, span: tuple[float, float]) -> Figure:
    """x of a disc over a window in time, with the extremes of its settled motion."""
    figure, axes = panels(1, 1, height=2.3)
    _both(axes, name, span)
    _extremes(axes, name)
    axes.set(xlabel="time (ms)", ylabel="x (µm)")
    legend(figure, axes, "upper")
    return figure


def settling() -> Figure:
    """The free part of x, and how fast small motion dies out at rest and about the orbit."""
    figure, axes = panels(1, 3, height=2.8, sharey=True)
    for panel, name in zip(axes, (OIL_A, HEAVY, OIL_B), strict=True):
        history, rest = trusted(name, DURATION[name]), at_paper_speed(name)
        time, height = envelope(history, free_part(name, history))
        height = height / (settled(name).peak_to_peak("x") / 2)
        panel.semilogy(time, height, ".", color=TRUSTED, ms=1.5, label="peaks of the free part")
        linear = float(rest.damping_ratios[0] * rest.frequencies[0])
        slopes = ((linear, "-", SECOND, "Jacobian at rest"), (orbit_decay(name), "--", "k", "multiplier"))
        for rate, style, color, label in slopes:
            panel.semilogy(time, height[0] * np.exp(-rate * time), style, color=color, lw=1, label=label)
        panel.axhline(0.01, color="0.5", lw=0.8)
        panel.axvline(decay(name, DURATION[name]).time, color="0.5", lw=0.8)
        panel.set(xlabel="time (s)", ylim=(1e-4, 5))
        panel.set_title(f"Shell {TITLES[name]}", fontsize=9)
    axes[0].set_ylabel("free part / settled amplitude")
    legend(figure, axes[0], "upper")
    return figure
