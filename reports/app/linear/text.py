"""A linear study in words and numbers: the JSON object, the CSV text and the table for people."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Sequence
from importlib.metadata import version
from platform import python_version
from typing import Any

import numpy as np

from periodic.results.textcell import text_cell
from symbolic import CompiledSystem
from symbolic.scenes.axes import SHORT

from ..linear.study import Array, Study
from ..settings import parameters
from ..view import MICRO, View, view_of


def units(system: CompiledSystem) -> list[tuple[str, str, float]]:
    """Return name, unit shown and SI value of that unit of each output: micrometres but for oscillators."""
    small = any(output.name == "deflection" for output in system.outputs)
    return [
        (o.name, "um", MICRO) if small and o.unit == "m" else (o.name, o.unit, 1.0) for o in system.outputs
    ]


def csv_text(found: Study) -> str:
    """Return the response over the range as CSV: peak to peak of every output and its phase.

    The phase in degrees is that of the output against sin(tau) for discs (the wave) and cos(tau) for
    oscillators (the force). Headings begin no formula of a spreadsheet.
    """
    view, answer = view_of(found.scene), found.response
    columns = [
        [view.shown(value) for value in answer.values],
        list(answer.omega / (2 * math.pi)),
    ]
    headings = [view.abscissa.name, "excitation_hz"]
    for name, unit, scale in units(found.system):
        columns += [list(answer.peak_to_peak(name) / scale), list(degrees(found, name))]
        headings += [f"{name}_pp_{unit}", f"{name}_phase_deg"]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(text_cell, headings))
    writer.writerows([[f"{cell:.14g}" for cell in row] for row in zip(*columns, strict=True)])
    return text.getvalue()


def degrees(found: Study, output: str) -> Array:
    """Return the phase against the excitation in (-180, 180]; sin(tau) lags cos(tau) by 90 degrees."""
    lag = 90.0 if found.scene.kind == "disc" else 0.0
    turned = np.degrees(found.response.phase(output)) + lag
    return 180.0 - np.mod(180.0 - turned, 360.0)


def json_text(name: str, found: Study) -> str:
    """Return the JSON object of a study, without its response over the range."""
    return json.dumps(summary(name, found), indent=2, allow_nan=False) + "\n"


def summary(name: str, found: Study) -> dict[str, Any]:
    """Return what a study says in short. Eigenvalues in 1/s as [real, imaginary]; Jacobian in SI, 1/s."""
    view = view_of(found.scene)
    at = view.abscissa.name
    top = None
    if found.peak is not None:
        output, unit, scale = units(found.system)[0]
        top = {at: view.shown(found.peak[0]), f"{output}_pp_{unit}": found.peak[1] / scale}
    return {
        "scene": name,
        "parameters": parameters(found.scene),
        "resonance": None if found.resonance is None else {at: view.shown(found.resonance)},
        "peak": top,
        "states": [{"name": state.name, "unit": state.unit} for state in found.system.states],
        "at": [_point(found, k) for k in range(len(found.at))],
        "versions": {
            **{package: version(package) for package in ("orbitrace", "numpy", "scipy", "casadi")},
            "python": python_version(),
        },
    }


def _point(found: Study, k: int) -> dict[str, Any]:
    view, point = view_of(found.scene), found.modes[k]
    rest, swings = {}, {}
    for name, unit, scale in units(found.system):
        rest[f"{name}_{unit}"] = float(found.there.at_rest(name)[k] / scale)
        swing = float(found.there.peak_to_peak(name)[k] / scale)
        swings[f"{name}_pp_{unit}"] = swing if math.isfinite(swing) else None
    natural, damped = point.frequencies, point.damped_frequencies
    return {
        view.abscissa.name: view.shown(found.at[k]),
        "excitation_hz": point.omega / (2 * math.pi),
        "rest": rest,
        "jacobian": point.jacobian.tolist(),
        "eigenvalues": [[float(value.real), float(value.imag)] for value in point.eigenvalues],
        "natural_hz": (natural / (2 * math.pi)).tolist(),
        f"natural_{_suffix(view)}": _as_parameter(found, k, natural),
        "damped_hz": (damped / (2 * math.pi)).tolist(),
        f"damped_{_suffix(view)}": _as_parameter(found, k, damped),
        "damping_ratio": point.damping_ratios.tolist(),
        "linear_response": swings,
    }


def _suffix(view: View) -> str:
    return SHORT.get(view.unit_name, "rad_s")


def _as_parameter(found: Study, k: int, frequencies: Array) -> list[float]:
    """Return the values of the parameter, as shown, that excite at just these frequencies (rad/s)."""
    scale = found.at[k] / found.modes[k].omega / view_of(found.scene).unit
    return [float(frequency * scale) for frequency in frequencies]


def table(found: Study) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows for people: a quantity a row, a value of the parameter a column."""
    view = view_of(found.scene)
    points = [_point(found, k) for k in range(len(found.at))]
    headings = [view.abscissa.heading, *(f"{point[view.abscissa.name]:.8g}" for point in points)]
    quantities: list[tuple[str, Callable[[dict[str, Any]], list[str]]]] = [
        ("excitation (Hz)", lambda p: [f"{p['excitation_hz']:.6g}"]),
        *((f"{key} at rest", _picker("rest", key)) for key in _told(found, points[0]["rest"])),
        ("eigenvalues (1/s)", lambda p: _eigenvalues(p["eigenvalues"])),
        ("natural frequency (Hz)", _picker("natural_hz")),
        (f"natural frequency ({view.unit_name})", _picker(f"natural_{_suffix(view)}")),
        ("damped frequency (Hz)", _picker("damped_hz")),
        (f"damped frequency ({view.unit_name})", _picker(f"damped_{_suffix(view)}")),
        ("damping ratio", _picker("damping_ratio")),
        *((f"linear {key}", _picker("linear_response", key)) for key in points[0]["linear_response"]),
    ]
    rows = []
    for name, cells in quantities:
        rows.append([_heading(name), *("\n".join(cells(point)) or "none" for point in points)])
    return headings, rows


def _told(found: Study, rest: dict[str, float]) -> list[str]:
    """Return what is told of the rest: not the coordinates, 0 there, unless there is nothing else."""
    coordinates = {state.name for state in found.system.states}
    return [key for key in rest if key.rpartition("_")[0] not in coordinates] or list(rest)


def _heading(name: str) -> str:
    """film_pp_um -> film p-p (µm)."""
    for unit, letters in (("_um", " (µm)"), ("_m", " (m)"), ("_N", " (N)")):
        head, found, tail = name.partition(unit)
        if found and (not tail or tail.startswith(" ")):
            name = head + tail + letters
            break
    return name.replace("_pp", " p-p")


def _picker(*path: str) -> Callable[[dict[str, Any]], list[str]]:
    def cells(point: dict[str, Any]) -> list[str]:
        value: Any = point
        for key in path:
            value = value[key]
        values = value if isinstance(value, list) else [value]
        return ["unbounded" if item is None else f"{item + 0:.7g}" for item in values]

    return cells


def _eigenvalues(values: Sequence[Sequence[float]]) -> list[str]:
    return [f"{real:.6g}" + (f" ± {imag:.6g}i" if imag else "") for real, imag in values if imag >= 0]


def verdict(found: Study) -> list[str]:
    """Return the sentences on the resonance."""
    view = view_of(found.scene)
    low, high = sorted(found.scene.trace.ends)
    if found.resonance is None:
        return [f"resonance of the lowest mode: none from {low:g} to {high:g} {view.unit_name}"]
    where = f"{view.shown(found.resonance):.8g} {view.unit_name}"
    lines = [f"resonance of the lowest mode: {where} (excitation meets the natural frequency)"]
    if found.peak is None:
        return [*lines, "peak of the linear response: unbounded"]
    output, unit, scale = units(found.system)[0]
    peak, height = view.shown(found.peak[0]), found.peak[1] / scale
    letter = "µm" if unit == "um" else unit
    return [
        *lines,
        f"peak of the linear response: {output} p-p {height:.6g} {letter} at {peak:.8g} {view.unit_name}",
    ]
