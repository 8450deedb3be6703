"""Branches on disk: one NetCDF file per branch, orbits as ragged arrays, names and units as attributes.

Dimensions: point, parameter, output, state; and the ragged ones segment, break, node, stage, anchor, whose
shares per point are in the variables `*_count`. Loading reads numbers and strings only.
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import os
from dataclasses import fields
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr

from periodic.accuracy import ErrorEstimate
from periodic.branch import Branch, BranchFileError, Layout, Quantity
from periodic.checkpoint import Checkpoint
from periodic.closure import Direction
from periodic.fourier import SAMPLES, FourierOrbit
from periodic.label import Label
from periodic.mesh import Anchor, Mesh
from periodic.orbit import Orbit
from periodic.point import Point
from periodic.scheme import Family, Scheme
from periodic.stop import Reason, Stop

FORMAT = "orbitrace branch 4"

SEAL = b"orbitrace sha256"
"""Stands before the digest at the end of a file: what does not agree with it is not read any further."""

FOURIER = "Fourier series"
"""Stands for the scheme of orbits that are such series."""


SLACK = 100_000
"""Bytes that texts may take more in memory than in a file; numbers are not packed."""

DAMAGE = (
    *(KeyError, ValueError, IndexError, TypeError, RuntimeError, AttributeError),
    *(OverflowError, MemoryError, EOFError),
)
"""What reading numbers that make no sense raises."""


def save(branch: Branch, path: Path) -> None:
    """Write a branch; an existing file is replaced only when the new one is complete.

    The file is made in memory first: the HDF5 library does not survive a disk that fills up under it.
    """
    path = path.resolve()  # a link stays a link
    if path.exists() and not path.is_file():
        raise BranchFileError(f"branch file is {str(path)!r}, which is no ordinary file; choose another")
    memory = io.BytesIO()
    data = dataset(branch)
    data.attrs["checksum"] = checksum(data)
    data.to_netcdf(memory, engine="h5netcdf")
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(sealed(memory.getvalue()))
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def load(path: Path) -> Branch:
    """Read a branch. Raises BranchFileError if the file is missing, damaged or no branch."""
    if not path.is_file():
        raise BranchFileError(f"branch file is {str(path)!r}; there is no such file")
    try:
        if not sound(path.read_bytes()):
            raise BranchFileError(f"branch file {str(path)!r} is damaged (its seal is wrong)")
        with h5py.File(path, "r"):
            pass  # on a file that is none h5netcdf complains from its destructor, where nobody can catch it
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False, phony_dims="access") as data:
            if data.attrs.get("format") != FORMAT:
                raise BranchFileError(
                    f"branch file {str(path)!r} has format {data.attrs.get('format')!r}; expected {FORMAT!r}"
                )
            if data.nbytes > path.stat().st_size + SLACK:
                raise BranchFileError(
                    f"branch file {str(path)!r} is damaged (it is too short for its arrays)"
                )
            if data.attrs.pop("checksum", None) != checksum(data.load()):
                raise BranchFileError(f"branch file {str(path)!r} is damaged (its checksum is wrong)")
            return branch_of(data)
    except BranchFileError:
        raise
    except (OSError, *DAMAGE) as error:
        raise BranchFileError(f"branch file {str(path)!r} is damaged or not a branch") from error


def sealed(content: bytes) -> bytes:
    """Return the bytes of a file followed by their digest, which readers of HDF5 pass over."""
    return content + SEAL + hashlib.sha256(content).digest()


def sound(content: bytes) -> bool:
    """Whether the bytes of a file are those that were sealed, or never were: other tools leave no seal."""
    body, seal = content[: -len(SEAL) - 32], content[-len(SEAL) - 32 :]
    return not seal.startswith(SEAL) or seal == SEAL + hashlib.sha256(body).digest()


def checksum(data: xr.Dataset) -> str:
    """Return the SHA-256 of all variables and attributes, by name."""
    found = hashlib.sha256(json.dumps({k: str(v) for k, v in sorted(data.attrs.items())}).encode())
    for name in sorted(map(str, data.variables)):
        values = data[name].values
        found.update(f"{name} {values.shape}".encode())
        numeric = values.dtype.kind in "biuf"
        found.update(values.astype(float).tobytes() if numeric else repr(values.tolist()).encode())
    return found.hexdigest()


Tables = dict[str, tuple[tuple[str, ...], np.ndarray]]


def dataset(branch: Branch) -> xr.Dataset:
    """Return the branch as an xarray Dataset."""
    return xr.Dataset(tables(branch), attrs=attributes(branch))


def tables(branch: Branch) -> Tables:
    """Return all arrays of a branch by name, with their dimensions."""
    points = branch.points
    per_point = {
        "value": [p.parameter for p in points],
        "label": [p.label.value for p in points],
        "stable": [p.stable for p in points],
        "error_estimate": [p.error.orbit for p in points],
        "multiplier_error": [p.error.multiplier for p in points],
        "parameter_error": [p.error.parameter for p in points],
        "residual": [p.residual for p in points],
        "newton_iterations": [p.iterations for p in points],
        "slope": [p.slope for p in points],
        "equilibrium": [p.equilibrium for p in points],
        "conservative": [p.conservative for p in points],
        "trivial": [np.nan if p.trivial is None else p.trivial for p in points],
        "marginal": [p.marginal for p in points],
        "event": [p.event for p in points],
    }
    data: Tables = {name: (("point",), np.array(column)) for name, column in per_point.items()}
    outputs = [q.name for q in branch.layout.outputs]
    for name, extreme in (("minimum", [p.minimum for p in points]), ("maximum", [p.maximum for p in points])):
        data[name] = (("point", "output"), _table([[e[o] for o in outputs] for e in extreme], len(outputs)))
    columns = list(points[0].columns) if points else []
    data["columns"] = (("point", "column"), _table([[*p.columns.values()] for p in points], len(columns)))
    states = len(branch.layout.states)
    for part, take in (("real", np.real), ("imag", np.imag)):
        data[f"multiplier_{part}"] = (
            ("point", "state"),
            _table([take(p.multipliers) for p in points], states),
        )
    data["parameters"] = (
        ("point", "parameter"),
        _table([p.orbit.parameter for p in points], len(branch.layout.parameters)),
    )
    values = [part.ravel() for c in branch.checkpoints for part in _parts(c)]
    data["checkpoint_values"] = (("checkpoint_value",), _joined(values, ()))
    _add_orbits(data, branch)
    return data


def _table(rows: list[Any], width: int) -> np.ndarray:
    return np.array(rows, dtype=float).reshape(len(rows), width)


def _joined(arrays: list[np.ndarray], tail: tuple[int, ...] = ()) -> np.ndarray:
    return np.concatenate([np.zeros((0, *tail)), *[a.reshape(-1, *tail) for a in arrays]])


def _add_orbits(data: Tables, branch: Branch) -> None:
    orbits = [p.orbit for p in branch.points]
    n, m = len(branch.layout.states), len(branch.layout.algebraics)
    data["segment_count"] = (("point",), np.array([len(o.mesh.breaks) for o in orbits], dtype=int))
    data["anchor_count"] = (("point",), np.array([len(o.mesh.anchors) for o in orbits], dtype=int))
    data["period"] = (("point",), np.array([o.mesh.period for o in orbits]))
    data["break_count"] = (("segment",), np.array([len(b) for o in orbits for b in o.mesh.breaks], dtype=int))
    data["sigma"] = (("break",), _joined([b for o in orbits for b in o.mesh.breaks]))
    anchors = [a for o in orbits for a in o.mesh.anchors]
    data["anchor_switch"] = (("anchor",), np.array([a.switch for a in anchors], dtype=int))
    data["anchor_direction"] = (("anchor",), np.array([a.direction for a in anchors], dtype=int))
    data["anchor_level"] = (("anchor",), np.array([a.level for a in anchors], dtype=float))
    data["anchor_phase"] = (("anchor",), _joined([o.phases for o in orbits]))
    data["node_state"] = (("node", "state"), _joined([o.nodes for o in orbits], (n,)))
    data["stage_state"] = (("stage", "state"), _joined([o.stages for o in orbits], (n,)))
    if m:
        data["stage_algebraic"] = (("stage", "algebraic"), _joined([o.algebraic for o in orbits], (m,)))


def attributes(branch: Branch) -> dict[str, Any]:
    """Return what else is said of a branch: names, units, reasons, as texts and numbers."""
    schemes = {p.orbit.mesh.scheme for p in branch.points}
    scheme = schemes.pop() if schemes else Scheme()
    quantities = {
        group: [[q.name, q.unit, q.scale] for q in getattr(branch.layout, group)]
        for group in ("states", "algebraics", "outputs", "parameters")
    }
    backwards = branch.stop_backwards
    return {
        "format": FORMAT,
        "parameter": branch.parameter,
        "layout": json.dumps(quantities),
        "scheme": FOURIER if scheme == SAMPLES else scheme.family.value,
        "ncol": scheme.ncol,
        "stop": json.dumps([branch.stop.reason.name, branch.stop.detail]),
        "stop_backwards": json.dumps([backwards.reason.name, backwards.detail] if backwards else None),
        "newton_iterations": branch.newton_iterations,
        "elapsed_s": branch.elapsed,
        "versions": json.dumps(branch.versions),
        "columns": json.dumps(list(branch.points[0].columns) if branch.points else []),
        "checkpoints": json.dumps([_progress(c) for c in branch.checkpoints]),
        "backwards": branch.backwards,
        "made": json.dumps(branch.made),
    }


ARRAYS = ("nodes", "stages", "algebraic", "phases", "profile", "others")
"""Those of a tangent."""


def _parts(checkpoint: Checkpoint) -> list[np.ndarray]:
    """The arrays of a checkpoint."""
    return [*(getattr(checkpoint.tangent, name) for name in ARRAYS), checkpoint.fundamental]


def _progress(checkpoint: Checkpoint) -> dict[str, Any]:
    """A checkpoint without its arrays, but with their shapes."""
    plain = {f.name: getattr(checkpoint, f.name) for f in fields(checkpoint)}
    del plain["tangent"], plain["fundamental"]
    return {**plain, "slope": checkpoint.tangent.parameter, "shapes": [a.shape for a in _parts(checkpoint)]}


def branch_of(data: xr.Dataset) -> Branch:
    """Return the branch that a dataset holds."""
    groups = json.loads(data.attrs["layout"])
    layout = Layout(**{name: tuple(Quantity(*q) for q in items) for name, items in groups.items()})
    orbits = _orbits(data, layout)
    return Branch(
        parameter=data.attrs["parameter"],
        layout=layout,
        points=tuple(_point(data, layout, i, orbit) for i, orbit in enumerate(orbits)),
        stop=_stop(json.loads(data.attrs["stop"])),
        stop_backwards=_stop(back) if (back := json.loads(data.attrs["stop_backwards"])) else None,
        newton_iterations=int(data.attrs["newton_iterations"]),
        elapsed=float(data.attrs["elapsed_s"]),
        versions=json.loads(data.attrs["versions"]),
        checkpoints=_checkpoints(data),
        backwards=int(data.attrs["backwards"]),
        made=json.loads(data.attrs["made"]),
    )


def _checkpoints(data: xr.Dataset) -> tuple[Checkpoint, ...]:
    values, found = data["checkpoint_values"].values, []
    for numbers in json.loads(data.attrs["checkpoints"]):
        shapes, arrays = numbers.pop("shapes"), []
        for shape in shapes:
            arrays.append(values[: math.prod(shape)].reshape(shape))
            values = values[math.prod(shape) :]
        tangent = Direction(**dict(zip(ARRAYS, arrays[:-1], strict=True)), parameter=numbers.pop("slope"))
        found.append(Checkpoint(tangent=tangent, fundamental=arrays[-1], **numbers))
    return tuple(found)


def _stop(pair: list[str]) -> Stop:
    return Stop(Reason[pair[0]], pair[1])


def _point(data: xr.Dataset, layout: Layout, i: int, orbit: Orbit) -> Point:
    names, columns = [q.name for q in layout.outputs], json.loads(data.attrs["columns"])

    def number(name: str) -> float:
        return float(data[name].values[i])

    return Point(
        orbit=orbit,
        parameter=number("value"),
        label=Label(str(data["label"].values[i])),
        multipliers=data["multiplier_real"].values[i] + 1j * data["multiplier_imag"].values[i],
        minimum=dict(zip(names, map(float, data["minimum"].values[i]), strict=True)),
        maximum=dict(zip(names, map(float, data["maximum"].values[i]), strict=True)),
        error=ErrorEstimate(*map(number, ("error_estimate", "multiplier_error", "parameter_error"))),
        residual=number("residual"),
        iterations=int(number("newton_iterations")),
        slope=number("slope"),
        conservative=_flag(data, "conservative", i),
        trivial=None if np.isnan(number("trivial")) else number("trivial"),
        marginal=bool(data["marginal"].values[i]),
        event=str(data["event"].values[i]),
        columns=dict(zip(columns, map(float, data["columns"].values[i]), strict=True)),
    )


def _flag(data: xr.Dataset, name: str, i: int) -> bool:
    """A truth value of a point; false in files that were written before there were others."""
    return bool(data[name].values[i]) if name in data else False


def _orbits(data: xr.Dataset, layout: Layout) -> list[Orbit]:
    """Cut the ragged arrays into orbits."""
    series = data.attrs["scheme"] == FOURIER
    scheme = SAMPLES if series else Scheme(Family(data.attrs["scheme"]), int(data.attrs["ncol"]))
    n, m, ncol = len(layout.states), len(layout.algebraics), scheme.ncol
    for dimension, counts in (
        ("segment", "segment_count"),
        ("break", "break_count"),
        ("anchor", "anchor_count"),
    ):
        if int(data[counts].sum()) != data.sizes.get(dimension, 0):
            raise ValueError(f"{counts} does not add up to the {dimension}s there are")
    breaks = np.split(data["sigma"].values, np.cumsum(data["break_count"].values)[:-1])
    algebraic = data["stage_algebraic"].values if m else np.zeros((data.sizes.get("stage", 0), 0))
    segment = anchor = node = stage = 0
    kind = FourierOrbit if series else Orbit
    orbits: list[Orbit] = []
    for i in range(data.sizes["point"]):
        segments, anchors = int(data["segment_count"].values[i]), int(data["anchor_count"].values[i])
        mine = tuple(breaks[segment : segment + segments])
        span = slice(anchor, anchor + anchors)
        tied = tuple(
            Anchor(int(s), int(d), float(v))
            for s, d, v in zip(
                *(data[f"anchor_{name}"].values[span] for name in ("switch", "direction", "level")),
                strict=True,
            )
        )
        mesh = Mesh(scheme, mine, tied, float(data["period"].values[i]))
        count = mesh.ntst
        rows = slice(stage, stage + count * ncol)
        orbits.append(
            kind(
                mesh,
                data["node_state"].values[node : node + count + 1],
                data["stage_state"].values[rows].reshape(count, ncol, n),
                algebraic[rows].reshape(count, ncol, m),
                data["anchor_phase"].values[span],
                data["parameters"].values[i],
                _flag(data, "equilibrium", i),
            )
        )
        segment, anchor = segment + segments, anchor + anchors
        node, stage = node + count + 1, stage + count * ncol
    return orbits
