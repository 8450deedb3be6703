"""The command `orbitrace linear`: table, files, and what it refuses."""

from __future__ import annotations

import csv
import io
import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import symbolic.motion.linear
from reports.app.cli import main
from symbolic.motion.linear import NoRestError

Capture = pytest.CaptureFixture[str]

REFUSALS = {
    "linear vitrea80": 'scene is "vitrea80"; it must be one of ',
    "linear duffing --set force=-1": "oscillator.force is -1; it must be a number from 1e-12 to 1e+12 (N)",
    "linear duffing --set force": '--set is "force"; it must be KEY=VALUE',
    "linear dry-810N --at 50": '--at is "50"; it must be numbers from 100 to 500 (rev/min) with commas',
    "linear dry-810N --at fast": '--at is "fast"; it must be numbers from 100 to 500 (rev/min) with commas',
    "linear duffing --at 5": '--at is "5"; it must be numbers from 0.3 to 3 (rad/s) with commas',
    "linear": "Missing argument 'SCENE'.",
    "linear duffing --from 1": "No such option: --from",
}


def ran(capsys: Capture, folder: Path, *arguments: str) -> str:
    """Run the command into a folder and return what it prints."""
    assert main(["linear", *arguments, "--out", str(folder)]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    return told.out


def rows_of(folder: Path) -> list[dict[str, float]]:
    """Read linear.csv."""
    text = (folder / "linear.csv").read_text("utf-8")
    return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(io.StringIO(text))]


def summary_of(folder: Path) -> dict[str, Any]:
    """Read linear.json."""
    found: dict[str, Any] = json.loads((folder / "linear.json").read_text("utf-8"))
    return found


def test_files(tmp_path: Path, capsys: Capture) -> None:
    """Assert that three files are written beside their settings, nothing else is left, and all are named."""
    told = ran(capsys, tmp_path, "vitrea79-810N")
    files = {"linear.csv", "linear.json", "linear.png"}
    assert {file.name for file in tmp_path.iterdir()} == files | {"settings.json"}
    assert (tmp_path / "linear.png").read_bytes().startswith(b"\x89PNG")
    assert all(str(tmp_path / name) in told for name in ("linear.csv", "linear.json", "linear.png"))


def test_table_of_the_disc(tmp_path: Path, capsys: Capture) -> None:
    """Assert what the table says at 360 rev/min and at the resonance asked for beside it."""
    told = ran(capsys, tmp_path, "vitrea79-810N", "--at", "360,281")
    lines = {line.split("  ")[0]: line.split("  ")[-1].strip() for line in told.splitlines()}
    assert lines["speed (rev/min)"] == "360"
    assert lines["excitation (Hz)"] == "720"
    assert float(lines["film at rest (µm)"]) == pytest.approx(3.85, abs=1e-4)
    assert float(lines["deflection at rest (µm)"]) == pytest.approx(9.4236, abs=1e-4)
    assert float(lines["natural frequency (Hz)"]) == pytest.approx(561.425, abs=1e-3)
    assert float(lines["natural frequency (rev/min)"]) == pytest.approx(280.713, abs=1e-3)
    assert float(lines["damping ratio"]) == pytest.approx(0.0067633, abs=1e-7)
    assert float(lines["linear x p-p (µm)"]) == pytest.approx(3.97266, abs=1e-5)
    assert lines["eigenvalues (1/s)"] == "-23.8579 ± 3527.46i"
    assert "resonance of the lowest mode: 281.18146 rev/min" in told
    assert "x p-p 217.962 µm at 281.16624 rev/min" in told


def test_default_is_the_resonance(tmp_path: Path, capsys: Capture) -> None:
    """Assert that without --at the modes are those at the resonance, where frequencies meet."""
    ran(capsys, tmp_path, "turbo33-810N")
    found = summary_of(tmp_path)
    (point,) = found["at"]
    assert point["speed_rpm"] == found["resonance"]["speed_rpm"]
    assert point["excitation_hz"] == pytest.approx(point["natural_hz"][0], rel=1e-10)
    assert point["natural_rpm"][0] == pytest.approx(point["speed_rpm"], rel=1e-10)


def test_json(tmp_path: Path, capsys: Capture) -> None:
    """Assert that --json prints the file, and that it holds states, Jacobian and eigenvalues."""
    told = ran(capsys, tmp_path, "vitrea79-810N", "--at", "300", "--json")
    assert told == (tmp_path / "linear.json").read_text("utf-8")
    (point,) = json.loads(told)["at"]
    assert [state["name"] for state in json.loads(told)["states"]] == ["x", "x'", "h"]
    assert len(point["jacobian"]) == len(point["eigenvalues"]) == 3
    trace = sum(point["jacobian"][i][i] for i in range(3))
    assert trace == pytest.approx(sum(real for real, _ in point["eigenvalues"]), rel=1e-12)


def test_csv_of_the_disc(tmp_path: Path, capsys: Capture) -> None:
    """Assert columns and range of the response, and that it is in phase below and opposed above."""
    ran(capsys, tmp_path, "vitrea79-810N")
    rows = rows_of(tmp_path)
    assert list(rows[0])[:4] == ["speed_rpm", "excitation_hz", "x_pp_um", "x_phase_deg"]
    assert {"film_pp_um", "deflection_pp_um", "load_pp_N", "load_phase_deg"} < set(rows[0])
    speeds = [row["speed_rpm"] for row in rows]
    assert (speeds[0], speeds[-1]) == (100, 500) and speeds == sorted(set(speeds))
    assert all(row["excitation_hz"] == pytest.approx(2 * row["speed_rpm"], rel=1e-12) for row in rows)
    assert abs(rows[0]["x_phase_deg"]) < 0.1 and abs(abs(rows[-1]["x_phase_deg"]) - 180) < 2
    top = max(rows, key=lambda row: row["x_pp_um"])
    assert top["x_pp_um"] == pytest.approx(217.962, rel=1e-3)


def test_csv_of_the_oscillator(tmp_path: Path, capsys: Capture) -> None:
    """Assert every line against F / (k - m Omega^2 + i c Omega)."""
    told = ran(capsys, tmp_path, "duffing")
    for row in rows_of(tmp_path):
        omega = row["frequency"]
        exact = 0.5 / complex(1 - omega**2, 0.1 * omega)
        assert row["x_pp_m"] == pytest.approx(2 * abs(exact), rel=1e-12)
        phase = math.degrees(math.atan2(exact.imag, exact.real))
        assert row["x_phase_deg"] == pytest.approx(phase, rel=1e-9, abs=1e-9)
    assert "peak of the linear response: x p-p 10.0125 m at 0.99749687 rad/s" in told


def test_undamped_oscillator(tmp_path: Path, capsys: Capture) -> None:
    """Assert that an unbounded response is said to be so, and is no number in the file."""
    told = ran(capsys, tmp_path, "duffing", "--set", "damping=")
    assert "peak of the linear response: unbounded" in told
    assert summary_of(tmp_path)["peak"] is None
    assert "unbounded" in next(line for line in told.splitlines() if line.startswith("linear x p-p"))


def test_no_resonance(tmp_path: Path, capsys: Capture) -> None:
    """Assert that a range without resonance is said to have none, and its first end is shown."""
    told = ran(capsys, tmp_path, "dry-810N", "--set", "trace.to_rpm=400")
    assert "resonance of the lowest mode: none from 400 to 500 rev/min" in told
    assert summary_of(tmp_path)["resonance"] is None
    assert [point["speed_rpm"] for point in summary_of(tmp_path)["at"]] == [500]


def test_oscillator_without_stiffness(tmp_path: Path, capsys: Capture) -> None:
    """Assert that nothing is said to oscillate where there is no linear spring."""
    told = ran(capsys, tmp_path, "duffing", "--set", "stiffness=0")
    line = next(line for line in told.splitlines() if line.startswith("natural frequency (Hz)"))
    assert line.split()[-1] == "none"


@pytest.mark.parametrize("arguments", REFUSALS)
def test_refusal(arguments: str, capsys: Capture) -> None:
    """Assert that bad input ends in exit code 2 and one sentence."""
    assert main(arguments.split()) == 2
    told = capsys.readouterr()
    assert told.out == "" and told.err.count("\n") == 1
    assert told.err.startswith(f"orbitrace: {REFUSALS[arguments]}")


def test_no_rest(tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a scene without rest ends in exit code 3, one sentence and no file."""

    def refuse(*_: object) -> None:
        raise NoRestError("no equilibrium was found at speed = 1")

    monkeypatch.setattr(symbolic.motion.linear.RestFinder, "modes", refuse)
    assert main(["linear", "duffing", "--out", str(tmp_path)]) == 3
    told = capsys.readouterr()
    assert told.err == "orbitrace: no equilibrium was found at speed = 1; nothing was saved\n"
    assert told.out == "" and not list(tmp_path.iterdir())


def test_unwritable_folder(tmp_path: Path, capsys: Capture) -> None:
    """Assert that a folder that cannot be made is refused before the work starts."""
    (tmp_path / "file").touch()
    assert main(["linear", "duffing", "--out", str(tmp_path / "file" / "out")]) == 2
    assert capsys.readouterr().err.startswith(f'orbitrace: --out is "{tmp_path / "file" / "out"}" (')


def test_help_is_quick() -> None:
    """Assert that help imports none of the large libraries."""
    code = "import sys; from reports.app.cli import main; main(['linear', '--help']); print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True
    )
    assert "linear.csv" in run.stdout
    assert not {"numpy", "casadi", "xarray", "matplotlib", "rich"} & set(run.stdout.split())
