"""Records of benchmarks: JSON files with machine, versions and date, and the ratios of two of them."""

from __future__ import annotations

import json
import os
import platform
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

from reports.bench import others
from reports.bench.suite import Numbers

PACKAGES = ("orbitrace", "numpy", "scipy", "casadi")


class RecordError(ValueError):
    """A file that is no record of benchmarks."""


@dataclass(frozen=True, kw_only=True)
class Record:
    """date (UTC, ISO), machine, versions, results by benchmark, and why some were `skipped`.

    load: of the machine when the run began, in processes; busy machines spoil even processor times.
    """

    date: str
    machine: dict[str, str]
    versions: dict[str, str]
    load: float
    results: dict[str, Numbers]
    skipped: dict[str, str]

    def save(self, folder: Path) -> Path:
        """Write the record into a folder, under its date."""
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{self.date.replace(':', '')}.json"
        path.write_text(json.dumps(asdict(self), indent=1) + "\n", "utf-8")
        return path


def begun(results: dict[str, Numbers], skipped: dict[str, str], load: float) -> Record:
    """Return the record of results got here and now."""
    versions = {name: _version(name) for name in PACKAGES} | {
        name: others.version(name) for name in others.PACKAGES
    }
    date = datetime.now(UTC).isoformat(timespec="seconds").removesuffix("+00:00")
    return Record(
        date=date, machine=machine(), versions=versions, load=load, results=results, skipped=skipped
    )


def machine() -> dict[str, str]:
    """Return what this machine is."""
    return {
        "system": platform.platform(),
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "python": platform.python_version(),
    }


def last(folder: Path) -> dict[str, Numbers]:
    """Return the latest results of each benchmark in a folder of records. Raises RecordError."""
    known: dict[str, Numbers] = {}
    for path in sorted(folder.glob("*.json")):
        known |= loaded(path).results
    return known


def loaded(path: Path) -> Record:
    """Read a record. Raises RecordError, in one sentence, for a file that is none."""
    try:
        return Record(**json.loads(path.read_text("utf-8")))
    except (TypeError, ValueError) as error:
        raise RecordError(f"{path} is no record of benchmarks ({error})") from error


def compared(new: dict[str, Numbers], old: dict[str, Numbers]) -> list[tuple[str, float, float | None]]:
    """Return every new result, with its ratio to the old one where there is one."""
    lines: list[tuple[str, float, float | None]] = []
    for name, numbers in new.items():
        for quantity, value in numbers.items():
            known = old.get(name, {}).get(quantity)
            lines.append((f"{name}: {quantity}", value, value / known if known else None))
    return lines


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    models = [x for x in info.read_text().splitlines() if x.startswith("model name")] if info.exists() else []
    return models[0].partition(":")[2].strip() if models else platform.processor()


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "not installed"
