"""Branch files that are damaged, foreign or missing, and saving that fails."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from support.traces import disc, duffing

import periodic as per
from periodic.results import netcdf as storage


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Content of a sound file, with tied orbits."""
    path = tmp_path_factory.mktemp("sound") / "branch.nc"
    disc(rpm=(290.0, 270.0), accuracy=per.Accuracy.DRAFT).save(path)
    return path.read_bytes()


def complaint(path: Path) -> str:
    """The one sentence with which a file is refused."""
    with pytest.raises(per.BranchFileError) as caught:
        per.Branch.load(path)
    text = str(caught.value)
    assert re.fullmatch(r"branch file [^\n]+", text) and str(path) in text
    return text


def test_missing_file(tmp_path: Path) -> None:
    """Assert that a file that is not there is said not to be."""
    assert "there is no such file" in complaint(tmp_path / "none.nc")


def test_folder_in_place_of_a_file(tmp_path: Path) -> None:
    """Assert that a folder is no branch file."""
    complaint(tmp_path)


@pytest.mark.faults
@pytest.mark.parametrize("part", [0.0, 0.001, 0.1, 0.5, 0.9, 0.999])
def test_truncated_file(saved: bytes, part: float, tmp_path: Path) -> None:
    """Assert that a file cut short anywhere is refused."""
    path = tmp_path / "branch.nc"
    path.write_bytes(saved[: int(part * len(saved))])
    complaint(path)


@pytest.mark.parametrize("content", [b"speed,x\n1,2\n", b"\x89HDF\r\n\x1a\n" + bytes(600), bytes(4096)])
def test_file_of_another_kind(content: bytes, tmp_path: Path) -> None:
    """Assert that text, a bare HDF5 signature and zeros are refused."""
    path = tmp_path / "branch.nc"
    path.write_bytes(content)
    complaint(path)


def test_foreign_dataset(tmp_path: Path) -> None:
    """Assert that a NetCDF file of something else is refused for its format."""
    path = tmp_path / "weather.nc"
    xr.Dataset({"rain": ("day", np.zeros(3))}).to_netcdf(path, engine="h5netcdf")
    assert "format None" in complaint(path)


def changed(saved: bytes, path: Path) -> xr.Dataset:
    """The dataset of a sound file, to be spoilt."""
    path.write_bytes(saved)
    with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
        return data.load()


def rewrite(data: xr.Dataset, path: Path) -> None:
    """Write a dataset as one that was saved like this, with a checksum of its own."""
    data.attrs.pop("checksum", None)
    data.attrs["checksum"] = storage.checksum(data)
    data.to_netcdf(path, engine="h5netcdf")


NAMES = [
    "value",
    "label",
    "multiplier_imag",
    "parameters",
    "node_state",
    "stage_state",
    "sigma",
    "break_count",
]


@pytest.mark.faults
@pytest.mark.parametrize("name", NAMES)
def test_missing_variable(saved: bytes, name: str, tmp_path: Path) -> None:
    """Assert that a file without one of its variables is refused."""
    data = changed(saved, tmp_path / "branch.nc").drop_vars(name)
    rewrite(data, tmp_path / "spoilt.nc")
    complaint(tmp_path / "spoilt.nc")


@pytest.mark.faults
@pytest.mark.parametrize("name", ["layout", "scheme", "ncol", "stop", "versions", "parameter"])
def test_spoilt_attribute(saved: bytes, name: str, tmp_path: Path) -> None:
    """Assert that an attribute which is missing or nonsense is refused."""
    data = changed(saved, tmp_path / "branch.nc")
    for value in (None, "nonsense"):
        data.attrs = {k: v for k, v in data.attrs.items() if k != name}
        if value is not None and name != "parameter":
            data.attrs[name] = value
        rewrite(data, tmp_path / "spoilt.nc")
        complaint(tmp_path / "spoilt.nc")


@pytest.mark.faults
@pytest.mark.parametrize("name", ["break_count", "event_count", "segment_count"])
def test_counts_that_do_not_add_up(saved: bytes, name: str, tmp_path: Path) -> None:
    """Assert that orbits whose shares of the arrays do not add up are refused."""
    data = changed(saved, tmp_path / "branch.nc")
    data[name][-1] = int(data[name][-1]) + 1
    rewrite(data, tmp_path / "spoilt.nc")
    complaint(tmp_path / "spoilt.nc")


@pytest.mark.faults
def test_another_version_of_the_format(saved: bytes, tmp_path: Path) -> None:
    """Assert that a format of the future is refused by name."""
    data = changed(saved, tmp_path / "branch.nc")
    data.attrs["format"] = "orbitrace branch 99"
    rewrite(data, tmp_path / "future.nc")
    assert "orbitrace branch 99" in complaint(tmp_path / "future.nc")


@pytest.mark.parametrize("step", ["write_bytes", "replace"])
def test_saving_is_atomic(step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a failure while saving leaves the file that was there, and nothing beside it."""
    path = tmp_path / "branch.nc"
    duffing().save(path)
    before = path.read_bytes()
    whole = Path.write_bytes

    def full(self: Path, *arguments: object) -> int:
        if step == "write_bytes":
            whole(self, b"half")
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Path, step, full)
        with pytest.raises(OSError, match="No space left"):
            duffing(bounds=(3.0, 0.3)).save(path)
    assert path.read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == ["branch.nc"]


def test_saving_replaces(tmp_path: Path) -> None:
    """Assert that saving again replaces the file as a whole."""
    path = tmp_path / "branch.nc"
    duffing().save(path)
    other = duffing(bounds=(3.0, 0.3))
    other.save(str(path))
    assert per.Branch.load(str(path)).values.tolist() == other.values.tolist()
    assert [file.name for file in tmp_path.iterdir()] == ["branch.nc"]


def test_saving_to_nowhere(tmp_path: Path) -> None:
    """Assert that a folder which cannot be made is the caller's OSError, and that nothing is left."""
    (tmp_path / "none").touch()
    with pytest.raises(OSError):
        duffing().save(tmp_path / "none" / "branch.nc")
    assert [file.name for file in tmp_path.iterdir()] == ["none"]


def test_file_is_portable_text_and_numbers(saved: bytes, tmp_path: Path) -> None:
    """Assert that attributes are text, JSON or numbers, nothing pickled."""
    data = changed(saved, tmp_path / "branch.nc")
    for name in ("layout", "stop", "stop_backwards", "versions"):
        json.loads(data.attrs[name])
    assert b"pickle" not in saved and b"\x80\x04\x95" not in saved


@pytest.mark.faults
@pytest.mark.parametrize("place", np.linspace(0.02, 0.98, 13))
def test_flipped_bit(saved: bytes, place: float, tmp_path: Path) -> None:
    """Assert that a single flipped bit never loads as another branch."""
    path, spoilt = tmp_path / "branch.nc", bytearray(saved)
    spoilt[int(place * len(saved))] ^= 0x10
    path.write_bytes(bytes(spoilt))
    sound = tmp_path / "sound.nc"
    sound.write_bytes(saved)
    try:
        again = per.Branch.load(path)
    except per.BranchFileError:
        return
    # The bit lay where the file format keeps no data of ours.
    assert storage.checksum(storage.dataset(again)) == storage.checksum(
        storage.dataset(per.Branch.load(sound))
    )


@pytest.mark.faults
def test_missing_variable_is_noticed(saved: bytes, tmp_path: Path) -> None:
    """Assert that a variable which loading could do without is missed as well."""
    data = changed(saved, tmp_path / "branch.nc").drop_vars("residual")
    data.to_netcdf(tmp_path / "spoilt.nc", engine="h5netcdf")
    assert "checksum" in complaint(tmp_path / "spoilt.nc")


def test_saving_through_a_link(tmp_path: Path) -> None:
    """Assert that a link stays one, and that what is no ordinary file is refused.

    It is a pipe of its own: a device would be lost to all who use the machine where the refusal fails.
    """
    (tmp_path / "link.nc").symlink_to(tmp_path / "branch.nc")
    duffing().save(tmp_path / "link.nc")
    assert (tmp_path / "link.nc").is_symlink() and (tmp_path / "branch.nc").is_file()
    pipe = tmp_path / "pipe.nc"
    os.mkfifo(pipe)
    with pytest.raises(per.BranchFileError, match=f"^branch file is '{pipe}', which is no ordinary file"):
        duffing().save(pipe)
