"""Figures of the section on the paper's time histories."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from reports.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.paper.histories import (
    BEATS,
    DURATION,
    HEAVY,
    RPM_SHOWN,
    STEADY_6B,
    A,
    B,
    Decay,
    History,
    Spectrum,
    at_rest,
    decay,
    envelope,
    free_part,
    orbit_decay,
    settled,
    spectrum,
    stepped,
    trusted,
)
from reports.view import MICRO

TITLES = {
    A: "Shell Vitrea 79, 810 N",
    HEAVY: "Shell Vitrea 79, 2100 N",
    B: "Shell Turbo 33, 810 N",
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


def ripples() -> Figure:
    figure, axes = panels(2, 2, height=2.3, sharey="row", sharex="col")
    for column, window in enumerate(((0.0, 0.02), (0.48, 0.5))):
        for row, quantity in enumerate(("deflection", "film")):
            _both(axes[row, column], A, window, quantity)
        axes[1, column].set_xlabel("time (ms)")
    axes[0, 0].set_ylabel("deflection δ (µm)")
    axes[1, 0].set_ylabel("film thickness h (µm)")
    axes[0, 0].set_title("from the start of the sinusoid", fontsize=9)
    axes[0, 1].set_title("steady", fontsize=9)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


def beats() -> Figure:
    figure, axes = panels(2, 1, height=2.2)
    _both(axes[0], A, (0.0, 0.09))
    _both(axes[1], A, STEADY_6B)
    half = settled(A).peak_to_peak("x") / 2 / MICRO
    middle = settled(A).maximum["x"] / MICRO - half
    for level in (middle - half, middle + half):
        axes[1].axhline(level, color=SECOND, lw=0.9, ls="--", label="steady extremes" if level > 0 else None)
    for panel, title in zip(axes, ("(a)", "(b)"), strict=True):
        panel.set_ylabel("x (µm)")
        panel.set_title(title, fontsize=9, loc="left")
    axes[1].set_xlabel("time (ms)")
    figure.legend(*axes[1].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def spectra() -> Figure:
    figure, axes = panels(1, 1, height=2.8)
    for name, colour in ((A, TRUSTED), (HEAVY, SECOND), (B, "tab:orange")):
        found: Spectrum = spectrum(trusted(name, DURATION[name]), BEATS)
        axes.plot(found.frequency, found.amplitude / MICRO, color=colour, label=TITLES[name])
        axes.axvline(float(at_rest(name).frequencies[0]) / (2 * math.pi), color=colour, lw=0.8, ls=":")
    axes.axvline(2 * RPM_SHOWN, color="0.4", lw=0.8, ls="--")
    axes.plot([], [], color="0.2", lw=0.8, ls=":", label="natural frequency at rest")
    axes.plot([], [], color="0.4", lw=0.8, ls="--", label="excitation, 720 Hz")
    axes.set(xlim=(450, 850), xlabel="frequency (Hz)", ylabel="amplitude of x (µm)")
    axes.set_ylim(bottom=0)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=8)
    return figure


def window(name: str, span: tuple[float, float]) -> Figure:
    figure, axes = panels(1, 1, height=2.3)
    _both(axes, name, span)
    swing = settled(name)
    for level in (swing.minimum["x"], swing.maximum["x"]):
        label = "steady extremes" if level > 0 else None
        axes.axhline(level / MICRO, color=SECOND, lw=0.9, ls="--", label=label)
    axes.set(xlabel="time (ms)", ylabel="x (µm)")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def settling() -> Figure:
    figure, axes = panels(1, 3, height=2.8, sharey=True)
    for panel, name in zip(axes, (A, HEAVY, B), strict=True):
        history: History = trusted(name, DURATION[name])
        time, height = envelope(history, free_part(name, history))
        orbit = settled(name).peak_to_peak("x") / 2
        fading: Decay = decay(name, DURATION[name])
        panel.semilogy(time, height / orbit, ".", color=TRUSTED, ms=1.5, label="peaks of the free part")
        slope = np.exp(-float(at_rest(name).damping_ratios[0] * at_rest(name).frequencies[0]) * time)
        panel.semilogy(time, height[0] / orbit * slope, color=SECOND, lw=1, label="Jacobian at rest")
        panel.semilogy(
            time, height[0] / orbit * np.exp(-orbit_decay(name) * time), "k--", lw=1, label="multiplier"
        )
        panel.axhline(0.01, color="0.5", lw=0.8)
        panel.axvline(fading.time, color="0.5", lw=0.8)
        panel.set(xlabel="time (s)", ylim=(1e-4, 5))
        panel.set_title(TITLES[name], fontsize=9)
    axes[0].set_ylabel("free part / settled amplitude")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3, markerscale=4)
    return figure
