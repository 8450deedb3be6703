"""Files made to do harm, one by one: what is said of each, how long it takes, and what it cannot do."""

from __future__ import annotations

import ast
import io
import json
import os
import pickle
import sqlite3
import struct
import time
import tracemalloc
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
import scipy
from support.commands import Capture, check_sentence, refusal

import periodic as per
import symbolic as sym
from periodic.maps.store import MapFileError, Store
from periodic.results import guarded, journal, netcdf
from periodic.results.files import digest

ROOT = Path(__file__).resolve().parents[2]
GOOD = np.eye(2)


@pytest.fixture(autouse=True)
def bounded() -> Iterator[None]:
    """No attack takes more than ten seconds of this process's time, or 256 MB, those of the test included."""
    tracemalloc.start()
    begun = time.process_time()
    yield
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 256e6 and time.process_time() - begun < 10


def said(path: Path) -> str:
    """The sentence with which a file of matrices is refused."""
    with pytest.raises(ValueError) as caught:
        sym.read_matrices(M=path, K=path) if path.suffix == ".mtx" else sym.read_matrices(path)
    text = str(caught.value)
    assert type(caught.value) is ValueError and text.isprintable()
    start = f"{str(path)!r} cannot be read as a {path.suffix} file: "
    assert text.startswith(start), text
    return text.removeprefix(start)


@pytest.mark.parametrize("ending", [".npz", ".mat", ".mtx", ".op4"])
def test_pipes_devices_and_folders(ending: str, tmp_path: Path) -> None:
    """Assert that nothing waits for a pipe or reads a device, also behind a link."""
    pipe, link, folder = (tmp_path / f"{name}{ending}" for name in ("pipe", "link", "folder"))
    os.mkfifo(pipe)
    folder.mkdir()
    link.symlink_to("/dev/zero")
    assert said(pipe) == said(link) == "it is no regular file"
    assert said(folder) == os.strerror(21)


def test_a_file_that_is_too_large(tmp_path: Path) -> None:
    """Assert it of 6.7 GiB that take no place on the disk."""
    for ending in (".npz", ".mat", ".mtx", ".op4"):
        path = tmp_path / f"large{ending}"
        with path.open("wb") as file:
            file.truncate(int(6.7 * 2**30))
        assert said(path) == f"it is larger than {guarded.LARGEST} bytes"


def npy(shape: tuple[int, ...], held: bytes = b"") -> bytes:
    """An array of NumPy's that declares a shape."""
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + held


def zipped(members: dict[str, bytes], kind: int = zipfile.ZIP_DEFLATED) -> bytes:
    """An archive."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", kind) as archive:
        for name, held in members.items():
            archive.writestr(f"{name}.npy", held)
    return made.getvalue()


def test_archives(tmp_path: Path) -> None:
    """Assert what is said of arrays of 6.7 GiB, of bombs, of other methods and of pickles."""
    path, larger = tmp_path / "a.npz", "it declares an array that is larger than what it holds"
    objects = io.BytesIO()
    np.savez(objects, M=np.array([None, {}], dtype=object))
    for held, why in [
        (zipped({"M": npy((30_000, 30_000)), "K": npy((2, 2), bytes(32))}), larger),
        (zipped({"M": npy((10**12, 10**12))}), larger),
        (zipped({"M": npy((-1, 2))}), larger),
        (
            zipped({"M": npy((2, 2), bytes(32))}, zipfile.ZIP_LZMA),
            "it is compressed in a way that",
        ),
        (objects.getvalue(), "it has an array of objects"),
        (pickle.dumps({"M": GOOD}), "it is no archive of arrays, or damaged"),
    ]:
        path.write_bytes(held)
        assert said(path).startswith(why)
    head = bytearray(zipped({"M": npy((2, 2), bytes(32))}))
    place = head.index(b"PK\x01\x02") + 24  # the size that the directory promises
    head[place : place + 4] = struct.pack("<I", 2**30)
    path.write_bytes(head)
    assert said(path) == f"its arrays take more than {guarded.LARGEST} bytes"


def test_a_sparse_matrix_whose_indices_lie(tmp_path: Path) -> None:
    """Assert that rows and columns outside a matrix, which compiled code would trust, are refused."""
    path, good = tmp_path / "a.npz", scipy.sparse.csr_array(np.eye(3))
    for name, array in [("indices", np.array([0, 1, 10**6])), ("indptr", np.array([0, 1, 2**31 - 1, 3]))]:
        given = {"indices": good.indices, "indptr": good.indptr, "data": good.data, name: array}
        np.savez(path, format=b"csr", shape=(3, 3), **given)
        why = {"indices": "it is damaged", "indptr": "it has a sparse matrix whose rows or columns are out"}
        assert said(path).startswith(why[name])
    np.savez(path, format=b"csr", shape=(3, 10**12), indices=good.indices, indptr=good.indptr, data=good.data)
    assert said(path) == "it declares a matrix that is larger than what it holds"


def element(kind: int, held: bytes) -> bytes:
    """An element of MATLAB's files."""
    return struct.pack("<II", kind, len(held)) + held + bytes(-len(held) % 8)


def variable(rows: int, columns: int, kind: int = 9) -> bytes:
    """A matrix M that declares a size and has four numbers of a type."""
    flags, size = struct.pack("<II", 6, 0), struct.pack("<ii", rows, columns)
    return element(14, element(6, flags) + element(5, size) + element(1, b"M") + element(kind, bytes(32)))


def test_matlab(tmp_path: Path) -> None:
    """Assert what is said of pickles by that name, sizes that lie, types that there are not, and bombs."""
    path, head = tmp_path / "a.mat", b"MATLAB 5.0".ljust(124) + b"\x00\x01IM"
    larger = "it declares a matrix that is larger than what it holds"
    typed = "it has an element of no known type, or one that ends beyond it"
    for held, why in [
        (pickle.dumps({"M": GOOD}), "it is damaged or of another kind"),
        (head + variable(30_000, 30_000), larger),
        (head + variable(10**6, 10**6), larger),
        (head + variable(2, 2, kind=0), typed),  # with these SciPy ends the process
        (head + variable(2, 2, kind=4711), typed),
        (head + element(15, zlib.compress(variable(30_000, 30_000))), larger),
        (head + variable(2, 2)[:-8], "it ends before what it declares"),
        (struct.pack("<5i", 0, 10**9, 10**3, 0, 2) + b"M\0", "it ends before what it declares"),
        (struct.pack("<5i", 0, -4, 4, 0, 2) + b"M\0", "it ends before what it declares"),
        (b"MATLAB 7.3".ljust(124) + b"\x00\x02IM", "it is of MATLAB's version 7.3; save it there with -v7"),
    ]:
        path.write_bytes(held)
        assert said(path).startswith(why)


def test_text(tmp_path: Path) -> None:
    """Assert it of 10^12 entries, of numbers that SciPy's reader ends at, and of another program's file."""
    path, first = tmp_path / "a.mtx", "%%MatrixMarket matrix coordinate real general\n"
    larger, other = (
        "it declares a matrix that is larger than what it holds",
        "it is damaged or of another kind",
    )
    for text, why in [
        (f"{first}1000000000000 1000000000000 1\n1 1 1.0\n", larger),
        (f"{first}2 2 1000000000000\n1 1 1.0\n", larger),
        (f"{first}2 2 2\n1 1 1.0\n2 2 \0\0\n", f"{other} (row 1)"),
        (f"{first}2 2 1\n9 9 1.0\n", "it has indices that are not whole numbers, or larger than what it"),
        (first.replace("coordinate", "array") + "1000000 1000000\n1.0\n", larger),
        ("1000000000000 1 1.0\n", "it has indices that are not whole numbers, or larger than what it holds"),
        ("1 nan 1.0\n", "it has indices that are not whole numbers, or larger than what it holds"),
        ("root:x:0:0:root:/root:/bin/sh\n", other),
    ]:
        path.write_text(text)
        assert said(path).startswith(why) and "root" not in said(path)


def test_a_substructure_that_would_take_for_ever(tmp_path: Path) -> None:
    """Assert that a line of digits that ends in a letter is refused at once; a regular expression hung."""
    path = tmp_path / "a.mtx"
    path.write_text("*USER ELEMENT,NODES=2,LINEAR\n*MATRIX,TYPE=STIFFNESS\n" + "1" * 5000 + "x\n")
    assert said(path) == "it is damaged or of another kind"


@pytest.mark.parametrize("order", ["<", ">"])
def test_nastran(order: str, tmp_path: Path) -> None:
    """Assert it of matrices that are larger than their file, and of records that lead back."""
    path = tmp_path / "a.op4"
    head = struct.pack(f"{order}4i", 10**8, 10**8, 1, 2) + b"M       "
    mark = struct.pack(f"{order}i", len(head))
    for held, why in [
        (mark + head + mark, "it is"),
        (
            mark
            + head
            + mark
            + struct.pack(f"{order}4i", 12, 10**8 + 1, 1, 0)
            + struct.pack(f"{order}i", 12),
            "it decl",
        ),
        (mark + head + mark + struct.pack(f"{order}5i", -12, 1, 1, 0, -12), "it ends within a record"),
    ]:
        path.write_bytes(held)
        assert said(path).startswith(why)


def test_orders_as_text(tmp_path: Path, capsys: Capture) -> None:
    """Assert that no number written as text is written out in digits, in a file or on the command line."""
    x = sym.coordinate("x")
    for order in ("1e100000000", "1E-100000000", "-1e99999999", "9" * 5000, "1/" + "9" * 5000, 10**5000):
        with pytest.raises(ValueError, match="^order is .*; it must be a positive rational number"):
            sym.compile(sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 1.0, 1.0, order=order))
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    check_sentence(refusal(capsys, "trace", str(path)))


SCENE = """
title = "a"
kind = "model"
[[coordinate]]
name = "x"
[[part]]
kind = "Mass"
q = "x"
m = 1.0
[[part]]
kind = "HarmonicForce"
q = "x"
amplitude = 1.0
frequency = 1.0
order = "1e100000000"
[trace]
parameter = "Omega"
from = 1.0
to = 2.0
"""


def test_scenes_name_files(tmp_path: Path, capsys: Capture) -> None:
    """Assert that a scene whose structure is a pipe is refused by the command line, with exit code 2."""
    os.mkfifo(tmp_path / "pipe.mat")
    path = tmp_path / "scene.toml"
    path.write_text(SCENE + '[[structure]]\nname = "s"\nfile = "pipe.mat"\n')
    assert "it is no regular file" in refusal(capsys, "linear", str(path))


def test_toml_is_not_quoted(tmp_path: Path, capsys: Capture) -> None:
    """Assert that of a file that is no scene neither keys nor signs are told."""
    path = tmp_path / "a.toml"
    for text in ("[secret]\na = 1\n[secret]\n", "secret = \x01\n", 'secret = "\x02"\n', "secret\n"):
        path.write_text(text)
        assert "secret" not in refusal(capsys, "trace", str(path)).replace(str(path), "")


def test_journals_and_stores(tmp_path: Path) -> None:
    """Assert that pipes in their place are refused, to read and to write to."""
    pipe = tmp_path / "pipe.nc"
    os.mkfifo(pipe)
    with pytest.raises(per.BranchFileError, match="it cannot be read .it is no regular file.$"):
        per.recovered(pipe)
    with pytest.raises(per.BranchFileError, match="it cannot be read .it is no regular file.$"):
        per.Branch.load(pipe)
    with pytest.raises(OSError, match="it is no regular file"):
        journal.Journal(pipe, None)  # type: ignore[arg-type]
    with pytest.raises(MapFileError, match="which is no ordinary file"):
        Store(pipe, {}, True)


def test_a_step_of_a_journal_that_is_a_bomb(tmp_path: Path) -> None:
    """Assert that arrays take no more than their step has, whatever its archive declares."""
    path = tmp_path / "a.journal"
    held = zipped({"said": npy((10**7,), bytes(8 * 10**6))})
    with closing(sqlite3.connect(path)) as base:
        base.execute(journal.TABLE)
        base.execute("INSERT INTO steps VALUES (0, ?, ?)", (held, digest(held)))
        base.commit()
    with pytest.raises(per.BranchFileError, match="it is damaged or not a journal$"):
        per.recovered(path)


def test_netcdf_that_leads_out_of_itself(tmp_path: Path) -> None:
    """Assert that links and arrays in other files, and deep attributes, are not followed."""
    import h5py

    path, other = tmp_path / "a.nc", tmp_path / "secret"
    other.write_bytes(bytes(800))

    def linked(file: h5py.File) -> None:
        file["value"] = h5py.ExternalLink(str(other), "/x")

    def external(file: h5py.File) -> None:
        file.create_dataset("value", (100,), float, external=[(str(other), 0, 800)])

    def virtual(file: h5py.File) -> None:
        layout = h5py.VirtualLayout((100,), float)
        layout[:] = h5py.VirtualSource(str(other), "x", (100,))
        file.create_virtual_dataset("value", layout)

    def grouped(file: h5py.File) -> None:
        file.create_group("value")

    def filtered(file: h5py.File) -> None:
        file.create_dataset("value", data=np.zeros(100), compression="lzf")

    said = {
        grouped: "it has what is no array",
        filtered: "it is compressed in a way that needs another library",
    }
    for make in (linked, external, virtual, grouped, filtered):
        with h5py.File(path, "w") as file:
            file.attrs["format"] = netcdf.FORMAT
            make(file)
        why = said.get(make, "it leads into other files")
        with pytest.raises(per.BranchFileError, match=f"is damaged .{why}.$"):
            per.Branch.load(path)


def test_a_map_that_does_not_say_what_it_is(tmp_path: Path) -> None:
    """Assert that a store without its description, or with one too deep, is refused."""
    import xarray as xr

    for made in (None, "[" * 5000, "{", "1e999999"):
        attributes = {"format": "orbitrace map 1"} | ({} if made is None else {"made": made})
        (tmp_path / "a.nc").write_bytes(netcdf.packed(xr.Dataset(attrs=attributes)))
        with pytest.raises(MapFileError):
            Store(tmp_path / "a.nc", {"of": 1}, True)


def test_settings_that_are_too_deep(tmp_path: Path) -> None:
    """Assert that a record that JSON's reader gives up at is none."""
    from reports.app import settings

    for text in ("[" * 100_000, "{", json.dumps([1]), "9" * 5000):
        (tmp_path / "settings.json").write_text(text)
        assert settings._known(tmp_path) == {}


def test_the_reader_is_one() -> None:
    """Assert that both packages have the same text; neither can import the other's."""
    texts = {
        (ROOT / package / "guarded.py").read_text("utf-8") for package in ("symbolic", "periodic/results")
    }
    assert len(texts) == 1


PICKLES = {
    "periodic/maps/chunks.py": ["loads"],
    "periodic/phasespace/following/shared.py": ["loads"],
    "periodic/workers/parcel.py": ["dumps"],
}
"""Where anything is pickled: a task, on its way to processes that this one has started or asked."""


def test_nothing_is_unpickled() -> None:
    """Assert that no file is: no module but those for workers calls a pickle, eval or an allowing reader."""
    found: dict[str, list[str]] = {}
    for package in ("symbolic", "periodic", "reports/app"):
        for path in sorted((ROOT / package).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(node, ast.Call) and (name := forbidden(node)):
                    found.setdefault(path.relative_to(ROOT).as_posix(), []).append(name)
    assert found == PICKLES


def forbidden(call: ast.Call) -> str:
    """The name of a call that makes objects of bytes; "" for any other."""
    allowing = [k for k in call.keywords if k.arg == "allow_pickle"]
    if any(not (isinstance(k.value, ast.Constant) and k.value.value is False) for k in allowing):
        return "allow_pickle"
    if isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Name):
        module = call.func.value.id
        if module in ("pickle", "cloudpickle", "marshal", "shelve") and not call.func.attr.endswith("Error"):
            return call.func.attr
        if module == "np" and call.func.attr == "load":
            return "load"
    return call.func.id if isinstance(call.func, ast.Name) and call.func.id == "eval" else ""
