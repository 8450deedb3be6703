"""Holds what `pyproject.toml` declares against environments with the lowest and the newest of it.

    python tests/dependencies/run.py

For each Python from 3.11 to 3.13 that this machine has: the lowest versions declared, and the newest that the
index has; and the wheel in an environment of its own without a compiler. `exercise.py` says what each must be
able to do; the lowest versions on the first Python have all the extras. Two environments at a time.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
EXERCISE = Path(__file__).with_name("exercise.py")
UV = [str(Path(sys.executable).with_name("uv"))]
PYTHONS = ("3.11", "3.12", "3.13")
EXTRAS = ("adaptive", "cc", "dask", "files", "html", "mpi", "uff")
ENVIRONMENT = {
    **{name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "ORBITRACE_"))},
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "UV_PYTHON_DOWNLOADS": "never",
    "VIRTUAL_ENV": "",
}


@dataclass(frozen=True, kw_only=True)
class Environment:
    """An environment to be made: its Python, which versions, with which extras, with a compiler or not."""

    name: str
    python: str
    lowest: bool = False
    extras: tuple[str, ...] = ()
    compiler: bool = True
    all_exercises: bool = False


def found(version: str) -> str | None:
    """Return the interpreter of a version that runs: on the path, or a version manager's."""
    managed = sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python3"))
    for candidate in [shutil.which(f"python{version}"), *map(str, managed)]:
        if candidate is None:
            continue
        probe = [candidate, "-c", f"import sys; sys.exit(sys.version_info[:2] != {version_info(version)})"]
        if subprocess.run(probe, capture_output=True, check=False).returncode == 0:
            return candidate
    return None


def version_info(version: str) -> tuple[int, ...]:
    """Return a version as numbers."""
    return tuple(map(int, version.split(".")))


def environments() -> list[Environment]:
    """Return what is to be made; says in one line each which Python is not there."""
    listed: list[Environment] = []
    for version in PYTHONS:
        python = found(version)
        if python is None:
            print(f"Python {version} is not on this machine: its versions are not held", flush=True)
            continue
        first = not listed
        extras = EXTRAS if first else ()
        listed += [
            Environment(
                name=f"lowest {version}", python=python, lowest=True, extras=extras, all_exercises=first
            ),
            Environment(name=f"newest {version}", python=python),
        ]
    if listed:
        python = listed[-1].python
        listed.append(Environment(name="newest, no compiler", python=python, compiler=False))
    return listed


def run(command: list[str], **options: object) -> str:
    """Run a command; return what it prints. Raises CalledProcessError, which has it."""
    done = subprocess.run(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=True, **options
    )  # type: ignore[call-overload]
    return str(done.stdout)


def wheel(folder: Path, environment: dict[str, str]) -> Path:
    """Build the wheel of this checkout."""
    run([*UV, "build", "--quiet", "--wheel", "--python", sys.executable, "--out-dir", str(folder), str(ROOT)],
        env=environment)  # fmt: skip
    (made,) = folder.glob("*.whl")
    return made


def installed(of: Environment, folder: Path, made: Path) -> Path:
    """Make an environment with our wheel; return its Python.

    Of wheels alone, so that no compiler is asked for; the lowest are those of what is declared, and what
    those need in turn is the newest that goes with them.
    """
    python = folder / "environment" / ("Scripts" if os.name == "nt" else "bin") / "python"
    run([*UV, "venv", "--quiet", "--python", of.python, str(folder / "environment")], env=ENVIRONMENT)
    install = [*UV, "pip", "install", "--quiet", "--only-binary", ":all:", "--python", str(python)]
    if of.lowest:
        extras = [word for extra in of.extras for word in ("--extra", extra)]
        declared = ["--resolution", "lowest-direct", "-r", str(ROOT / "pyproject.toml"), *extras]
        run([*install, *declared], env=ENVIRONMENT)
        run([*install, "--no-deps", str(made)], env=ENVIRONMENT)
    else:
        run([*install, str(made)], env=ENVIRONMENT)
    return python


def held(of: Environment, wheels: dict[bool, Path]) -> bool:
    """Make an environment, let it do the exercises, and say how that went."""
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        environment = dict(ENVIRONMENT)
        try:
            python = installed(of, folder, wheels[of.compiler])
            ready = time.perf_counter() - begun
            if not of.compiler:
                environment |= {"PATH": str(python.parent), "XDG_CACHE_HOME": str(folder / "cache"), "CC": ""}
            (folder / "empty").mkdir()
            command = [str(python), "-P", str(EXERCISE), str(ROOT / "README.md")]
            command += ["--all"] if of.all_exercises else []
            command += [] if of.compiler else ["--no-compiler"]
            said = run(command, cwd=folder / "empty", env=environment)
        except subprocess.CalledProcessError as error:
            print(f"{of.name}: FAILED\n{error.stdout}", flush=True)
            return False
    whole = time.perf_counter() - begun
    print(f"{of.name}: held, {said.splitlines()[-1]}, {ready:.0f} s to install, {whole:.0f} s", flush=True)
    return True


def main() -> int:
    """Make all environments; return 0 if all can do what they must."""
    listed = environments()
    if not listed:
        print("there is no Python from 3.11 to 3.13 to hold the versions with")
        return 1
    with tempfile.TemporaryDirectory() as name:
        bare = {**ENVIRONMENT, "PATH": str(Path(sys.executable).parent), "CC": "no-compiler"}
        folders = {True: Path(name, "compiled"), False: Path(name, "plain")}
        wheels = {kind: wheel(folders[kind], ENVIRONMENT if kind else bare) for kind in folders}
        assert wheels[False].name.endswith("-py3-none-any.whl"), wheels[False]
        with ThreadPoolExecutor(2) as pool:
            outcomes = list(pool.map(lambda each: held(each, wheels), listed))
    return 0 if all(outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
