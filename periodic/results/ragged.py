"""Orbits as ragged arrays: all points in one array, with the number of entries of each point.

The dimensions segment, break, node, stage and event run over all points; the variables `*_count` are the
share of each. Sums of shares that are not the arrays' lengths raise ValueError.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from periodic.harmonic.series import SAMPLES, FourierOrbit
from periodic.orbit.layout import Layout
from periodic.orbit.mesh import EventNode, Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Family, Scheme

Tables = dict[str, tuple[tuple[str, ...], np.ndarray]]
"""Arrays by name, with the names of their dimensions."""

Arrays = Mapping[str, np.ndarray]
"""The same without their dimensions."""

FOURIER = "Fourier series"
"""Stands for the scheme of orbits that are such series."""


def scheme_said(orbits: Sequence[Orbit]) -> dict[str, Any]:
    """Return the scheme that all orbits share, as text and number."""
    schemes = {orbit.mesh.scheme for orbit in orbits}
    scheme = schemes.pop() if schemes else Scheme()
    return {"scheme": FOURIER if scheme == SAMPLES else scheme.family.value, "ncol": scheme.ncol}


def orbit_tables(orbits: Sequence[Orbit], layout: Layout) -> Tables:
    """Return the arrays of some orbits.

    Parameters
    ----------
    orbits : sequence of Orbit
        Orbits of one scheme.
    layout : Layout
        Their layout.

    Returns
    -------
    dict
        Name: (dimensions, array).
    """
    n, m, p = len(layout.states), len(layout.algebraics), len(layout.parameters)
    events = [a for o in orbits for a in o.mesh.events]
    breaks = [b for o in orbits for b in o.mesh.breaks]

    def counts(found: list[int]) -> np.ndarray:
        return np.array(found, dtype=int)

    return {
        "parameters": (("point", "parameter"), _rows([o.parameter for o in orbits], (p,))),
        "period": (("point",), np.array([o.mesh.period for o in orbits], dtype=float)),
        "equilibrium": (("point",), np.array([o.equilibrium for o in orbits], dtype=bool)),
        "held_count": (("point",), counts([len(o.mesh.modes) for o in orbits])),
        "held_surface": (("held",), counts([k for o in orbits for k, _ in o.mesh.modes])),
        "held_mode": (("held",), counts([mode for o in orbits for _, mode in o.mesh.modes])),
        "segment_count": (("point",), counts([len(o.mesh.breaks) for o in orbits])),
        "event_count": (("point",), counts([len(o.mesh.events) for o in orbits])),
        "break_count": (("segment",), counts([len(b) for b in breaks])),
        "sigma": (("break",), _rows(breaks)),
        "event_switch": (("event",), counts([a.switch for a in events])),
        "event_direction": (("event",), counts([a.direction for a in events])),
        "event_level": (("event",), np.array([a.level for a in events], dtype=float)),
        "event_modes": (("event",), counts([len(a.modes) for a in events])),
        "mode_surface": (("mode",), counts([k for a in events for k, _ in a.modes])),
        "mode_value": (("mode",), counts([mode for a in events for _, mode in a.modes])),
        "event_phase": (("event",), _rows([o.phases for o in orbits])),
        "node_state": (("node", "state"), _rows([o.nodes for o in orbits], (n,))),
        "stage_state": (("stage", "state"), _rows([o.stages for o in orbits], (n,))),
        "stage_algebraic": (("stage", "algebraic"), _rows([o.algebraic for o in orbits], (m,))),
    }


def _rows(arrays: Sequence[np.ndarray], tail: tuple[int, ...] = ()) -> np.ndarray:
    def flat(a: np.ndarray) -> np.ndarray:
        return a.reshape(math.prod(a.shape[: a.ndim - len(tail)]), *tail)

    return np.concatenate([np.zeros((0, *tail)), *map(flat, arrays)])


def orbits_of(arrays: Arrays, said: Mapping[str, Any], layout: Layout) -> list[Orbit]:
    """Cut the ragged arrays into orbits.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        As from `orbit_tables`, without dimensions.
    said : mapping
        As from `scheme_said`.
    layout : Layout
        Names, units and scales.

    Returns
    -------
    list of Orbit
        One for each point.

    Raises
    ------
    ValueError
        Where shares do not add up.
    """
    series = said["scheme"] == FOURIER
    scheme = SAMPLES if series else Scheme(Family(said["scheme"]), int(said["ncol"]))
    meshes = _meshes(arrays, scheme)
    intervals = [mesh.ntst for mesh in meshes]
    nodes = _cut(arrays["node_state"], [count + 1 for count in intervals])
    stages = _cut(arrays["stage_state"], [count * scheme.ncol for count in intervals])
    unknowns = _cut(arrays["stage_algebraic"], [count * scheme.ncol for count in intervals])
    phases = _cut(arrays["event_phase"], arrays["event_count"])
    kind = FourierOrbit if series else Orbit
    return [
        kind(
            mesh,
            nodes[i],
            stages[i].reshape(mesh.ntst, scheme.ncol, len(layout.states)),
            unknowns[i].reshape(mesh.ntst, scheme.ncol, len(layout.algebraics)),
            phases[i],
            arrays["parameters"][i],
            bool(arrays["equilibrium"][i]),
            layout,
        )
        for i, mesh in enumerate(meshes)
    ]


def _meshes(arrays: Arrays, scheme: Scheme) -> list[Mesh]:
    breaks = _cut(arrays["sigma"], arrays["break_count"])
    columns = zip(*(arrays[f"event_{name}"] for name in ("switch", "direction", "level")), strict=True)
    modes = _modes(arrays)
    events = [
        EventNode(int(switch), int(way), float(level), own)
        for (switch, way, level), own in zip(columns, modes, strict=True)
    ]
    segments = _spans(arrays["segment_count"], len(breaks))
    tied = _spans(arrays["event_count"], len(events))
    return [
        Mesh(scheme, tuple(breaks[own]), tuple(events[ties]), float(period), held)
        for own, ties, period, held in zip(segments, tied, arrays["period"], _held(arrays), strict=True)
    ]


def _held(arrays: Arrays) -> list[tuple[tuple[int, int], ...]]:
    """The modes of surfaces that no event node changes; none in files that were written before."""
    if "held_count" not in arrays:
        return [()] * len(arrays["period"])
    both = zip(arrays["held_surface"], arrays["held_mode"], strict=True)
    pairs = [(int(k), int(mode)) for k, mode in both]
    return [tuple(pairs[span]) for span in _spans(arrays["held_count"], len(pairs))]


def _modes(arrays: Arrays) -> list[tuple[tuple[int, int], ...]]:
    """The modes of event nodes; none in files that were written before there were any."""
    if "event_modes" not in arrays:
        return [()] * len(arrays["event_switch"])
    pairs = [
        (int(k), int(mode)) for k, mode in zip(arrays["mode_surface"], arrays["mode_value"], strict=True)
    ]
    return [tuple(pairs[span]) for span in _spans(arrays["event_modes"], len(pairs))]


def _cut(array: np.ndarray, counts: Sequence[int] | np.ndarray) -> list[np.ndarray]:
    return [array[span] for span in _spans(counts, len(array))]


def _spans(counts: Sequence[int] | np.ndarray, length: int) -> list[slice]:
    """Consecutive slices of given lengths. Raises ValueError unless they make up the whole."""
    ends = np.cumsum(np.append(0, counts)).astype(int)
    if ends[-1] != length or (np.diff(ends) < 0).any():
        raise ValueError(f"shares add up to {ends[-1]}; they must make {length}")
    return [slice(int(a), int(b)) for a, b in zip(ends[:-1], ends[1:], strict=True)]
