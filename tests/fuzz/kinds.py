"""Kinds of files: sound ones, how they are spoilt with their seals made anew, and how they are read."""

from __future__ import annotations

import hashlib
import io
import json
import sqlite3
import struct
import warnings
import zipfile
import zlib
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from support.maps import task
from support.traces import DUFFING_A, duffing_system

import periodic as per
import symbolic as sym
from fuzz.spoil import REALS, SECRET, Random, one_of, spoilt
from periodic.maps.store import MapFileError, Store
from periodic.results import netcdf
from periodic.results.files import digest
from reports.app.settings import folder_for
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError
from symbolic.scenes.names import built_in, scene_names
from symbolic.scenes.reading import load

Spoil = Callable[[bytes, Random], bytes]


@dataclass(frozen=True)
class Kind:
    """A kind of files: its ending, sound files, what spoils and what reads one, and what may be raised."""

    ending: str
    sound: Callable[[Path], list[bytes]]
    spoil: Spoil
    read: Callable[[Path], object]
    refusal: type[Exception]
    tells: bool = False
    """Whether a sentence quotes values: of a scene those that a key may not have, of a map its settings."""


def _matrices() -> sym.Matrices:
    beam = sym.beam(length=2.0, bending=3.0, mass_per_length=5.0, elements=3)
    return sym.Matrices(beam.M, 0.01 * beam.K, beam.K)


def _written(folder: Path, name: str, write: Callable[[Path], object]) -> bytes:
    path = folder / name
    write(path)
    held = path.read_bytes()
    path.unlink()
    return held


def npz_files(folder: Path) -> list[bytes]:
    """Archives of dense matrices, and one of a sparse one."""
    given, known = io.BytesIO(), _matrices()
    np.savez_compressed(given, M=known.M, K=known.K, note=np.array([1, 2]))
    sparse = []
    for form in ("csr", "csc", "coo", "bsr", "dia"):
        file = io.BytesIO()
        scipy.sparse.save_npz(file, scipy.sparse.coo_array(known.M).asformat(form))
        sparse.append(file.getvalue())
    return [given.getvalue(), *sparse]


def zipped(held: bytes, random: Random) -> bytes:
    """Spoil the members of an archive, each with its own sum made anew, or the archive itself."""
    if random.random() < 0.3:
        return spoilt(held, random)
    made = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(held)) as old, zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            member = old.read(name)
            new.writestr(name, spoilt(member, random, texts=True) if random.random() < 0.3 else member)
    return made.getvalue()


def mat_files(folder: Path) -> list[bytes]:
    """Files of MATLAB's versions 4, 5 and 7."""
    known, found = _matrices(), []
    given = {"M": known.M, "K": scipy.sparse.csc_array(known.K), "text": SECRET.decode()}
    cell = np.array([[1.0], "a"], dtype=object)
    for more, options in [({}, {"format": "4"}), ({"c": cell}, {}), ({}, {"do_compression": True})]:
        file = io.BytesIO()
        scipy.io.savemat(file, given | more, **options)
        found.append(file.getvalue())
    return found


def compressed(held: bytes, random: Random) -> bytes:
    """Spoil a file of MATLAB, what it has compressed before it is compressed again."""
    if held[124:126] not in (b"\x00\x01",) or struct.unpack_from("<I", held, 128)[0] != 15:
        return spoilt(held, random)
    made, place = held[:128], 128
    while place < len(held):
        count = struct.unpack_from("<I", held, place + 4)[0]
        inner = zlib.compress(spoilt(zlib.decompress(held[place + 8 : place + 8 + count]), random))
        made += struct.pack("<II", 15, len(inner)) + inner
        place += 8 + count
    return made if random.random() < 0.9 else spoilt(made, random)


SUBSTRUCTURE = """** ABAQUS/STANDARD SUBSTRUCTURE MATRIX OUTPUT
*USER ELEMENT,NODES=2,LINEAR
** ELEMENT NODES
**   1,   2
2
*MATRIX,TYPE=STIFFNESS
4.0, -1.0, 3.0,
*MATRIX,TYPE=MASS
2.0, 5.0e-1, 1.0,
"""


def mtx_files(folder: Path) -> list[bytes]:
    """Matrix Market, dense and sparse, and Abaqus' forms."""
    known, found = _matrices(), [SUBSTRUCTURE.encode()]
    for matrix in (known.M, scipy.sparse.coo_array(known.K)):
        file = io.BytesIO()
        scipy.io.mmwrite(file, matrix, comment=SECRET.decode())
        found.append(file.getvalue())
    entries = [(i, j, float(known.K[i, j])) for i, j in zip(*np.nonzero(known.K), strict=True)]
    found.append("".join(f"{i + 1} {j + 1} {v!r}\n" for i, j, v in entries).encode())
    found.append("".join(f"{i + 1},1, {j + 1},1, {v:.17e}\n" for i, j, v in entries if i >= j).encode())
    return found


def op4_files(folder: Path) -> list[bytes]:
    """Nastran's OUTPUT4, binary and text, dense and sparse."""
    from pyyeti.nastran import op4

    known, found = _matrices(), []
    for binary in (True, False):
        for sparse in ("dense", "bigmat", "nonbigmat"):
            path, given = folder / "a.op4", {"M": known.M, "K": known.K}
            op4.write(str(path), given, binary=binary, sparse=sparse)
            found.append(path.read_bytes())
    return found


def _from(path: Path) -> object:
    """The matrices of a file, or of one for each where it holds one."""
    single = path.suffix == ".mtx" and not path.read_bytes().startswith(b"**")
    return sym.read_matrices(M=path, K=path) if single else sym.read_matrices(path)


def _branch(watch: per.Watch | None = None) -> per.Branch:
    system = duffing_system(*DUFFING_A)
    return per.trace(system, "Omega", (0.3, 0.6), tol=per.Accuracy.DRAFT, watch=watch or per.Watch())


def branch_files(folder: Path) -> list[bytes]:
    """A branch in a NetCDF file."""
    return [_written(folder, "b.nc", lambda path: _branch().save(path))]


def sealed(held: bytes, random: Random) -> bytes:
    """Spoil a file of NetCDF under its seal, or what it says and its checksum."""
    length = len(netcdf.SEAL) + len(digest())
    if random.random() < 0.5:
        return netcdf.sealed(spoilt(held[:-length], random))
    if random.random() < 0.2:
        return spoilt(held, random)
    import xarray as xr

    asked: dict[str, Any] = {"decode_times": False, "phony_dims": "access"}
    with xr.open_dataset(io.BytesIO(held), engine="h5netcdf", **asked) as data:
        changed = data.load()
    names = [name for name in changed.attrs if isinstance(changed.attrs[name], str)]
    name = str(random.choice(names))
    if random.random() < 0.6:
        text = spoilt(changed.attrs[name].encode(), random, texts=True).decode(errors="replace")
        changed.attrs[name] = text.replace("\0", "0")
    else:
        name = one_of([n for n, a in changed.variables.items() if a.dtype.kind in "fi" and a.size], random)
        values = changed[name].values.copy()
        odd = [0, -1, 10**12, 2**62] if values.dtype.kind == "i" else REALS
        values.flat[int(random.integers(values.size))] = one_of(odd, random)
        changed[name] = (changed[name].dims, values)
    changed.attrs.pop("checksum", None)
    if "made" in changed.attrs and "complete" not in changed.attrs:
        changed.attrs["checksum"] = netcdf.checksum(changed)
    return netcdf.packed(changed)


def journals(folder: Path) -> list[bytes]:
    """The journal of a trace."""
    return [_written(folder, "t.journal", lambda path: _branch(per.Watch(journal=path)))]


def _rows(table: str, content: Callable[[bytes, Random], bytes], held: bytes, random: Random) -> bytes:
    """Spoil what a row of a database says, with its digest made anew, or the database."""
    if random.random() < 0.4:
        return spoilt(held, random)
    with closing(sqlite3.connect(":memory:")) as base:
        base.deserialize(held)
        rows = base.execute(f"SELECT number, content FROM {table}").fetchall()
        number, said = rows[int(random.integers(len(rows)))]
        raw = content(said if isinstance(said, bytes) else said.encode(), random)
        new = raw if isinstance(said, bytes) else raw.decode(errors="replace")
        seal = digest(new if isinstance(new, bytes) else new.encode())
        base.execute(f"UPDATE {table} SET content = ?, digest = ? WHERE number = ?", (new, seal, number))
        base.commit()
        return base.serialize()


def _made() -> dict[str, object]:
    return {"of": "a map", "number": 1.5, "numbers": {"peak": 1, "folds": 2}}


def map_files(folder: Path) -> list[bytes]:
    """A complete map in a NetCDF file."""

    def write(path: Path) -> None:
        data = per.design_map(task(), {"F": [0.5, 1.0]}, 1)
        with Store(path, _made(), False) as store:
            store.write(data, True)

    return [_written(folder, "m.nc", write)]


def map_journals(folder: Path) -> list[bytes]:
    """The journal of a map."""
    path = folder / "j.nc"
    per.design_map(task(), {"F": [0.5, 1.0]}, 1)
    from periodic.maps.cell import Outcome

    with Store(path, _made(), False) as store:
        for f in (0.5, 1.0):
            store.add([Outcome((f,), {"peak": 1.0, "folds": [1.0, 2.0]}, "", False, 5, 9, 0.1)])
    held = (folder / "j.nc.journal").read_bytes()
    (folder / "j.nc.journal").unlink()
    return [held]


def _map(path: Path) -> object:
    with Store(path, _made(), True) as store:
        return store.finished


def _map_journal(path: Path) -> object:
    store = path.with_suffix("")
    store.unlink(missing_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # that a journal without a form cannot be written to
        return _map(store)


def scene_files(folder: Path) -> list[bytes]:
    """Scenes that are built in."""
    return [built_in(name).encode() for name in scene_names()]


def records(folder: Path) -> list[bytes]:
    """What a directory says of its results."""
    return [json.dumps({"scene": "duffing", "parameters": {"mass": 1.0}, "trace": {"tol": 1e-6}}).encode()]


def _settings(path: Path) -> object:
    out = path.parent / "out"
    out.mkdir(exist_ok=True)
    (out / "settings.json").write_bytes(path.read_bytes())
    with folder_for(out, {"scene": "duffing", "parameters": {"mass": 1.0}, "trace": {"tol": 1e-6}}) as found:
        return found


TEXTS = partial(spoilt, texts=True)

KINDS: dict[str, Kind] = {
    "toml": Kind("toml", scene_files, TEXTS, lambda path: build(load(str(path))), InputError, True),
    "npz": Kind("npz", npz_files, zipped, _from, ValueError),
    "mat": Kind("mat", mat_files, compressed, _from, ValueError),
    "mtx": Kind("mtx", mtx_files, TEXTS, _from, ValueError),
    "op4": Kind("op4", op4_files, TEXTS, _from, ValueError),
    "branch": Kind("nc", branch_files, sealed, lambda path: repr(per.Branch.load(path)), per.BranchFileError),
    "journal": Kind(
        "journal",
        journals,
        partial(_rows, "steps", zipped),
        lambda path: repr(per.recovered(path)),
        per.BranchFileError,
    ),
    "map": Kind("nc", map_files, sealed, _map, MapFileError, True),
    "map journal": Kind(
        "nc.journal", map_journals, partial(_rows, "chunks", TEXTS), _map_journal, MapFileError, True
    ),
    "settings": Kind("json", records, TEXTS, _settings, InputError, True),
}


def seed_of(kind: str, number: int) -> list[int]:
    """Return the seed of a file: none of another kind's."""
    return [int.from_bytes(hashlib.sha256(kind.encode()).digest()[:4]), number]
