"""What a shell is offered to complete a command line with."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from symbolic.scenes.names import built_in

PROGRAM = """
import sys
from reports.app.cli import main
try:
    main()
except SystemExit:
    print(*sys.modules, file=sys.stderr)
"""


def completed(line: str, folder: Path) -> tuple[list[str], str]:
    """What bash is offered for the last word of a line, and the modules that were imported for it."""
    words = {"_ORBITRACE_COMPLETE": "complete_bash", "COMP_WORDS": f"orbitrace {line}"}
    count = {"COMP_CWORD": str(len(line.split()) + line.endswith(" "))}
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        capture_output=True, text=True, cwd=folder, env={**os.environ, **words, **count}, check=True,
    )  # fmt: skip
    return run.stdout.split(), run.stderr


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("tra", ["trace"]),
        ("trace duf", ["duffing"]),
        ("trace min", ["mine.toml"]),
        ("trace duffing --set oscillator.m", ["oscillator.mass="]),
        ("trace --to 2 gear-pair --set trace.f", ["trace.from="]),
        ("trace duffing --axis r", ["rev/min", "rad/s"]),
        ("trace duffing --accuracy d", ["draft"]),
        ("parts GearM", ["GearMesh"]),
        ("new gear", ["gear-pair"]),
        ("export bra", ["branch.nc"]),
        ("export sub/", ["sub/other.nc"]),
        ("trace nothing-of-the-kind --set x", []),
    ],
)
def test_offered(line: str, offered: list[str], tmp_path: Path) -> None:
    """Assert what is offered."""
    (tmp_path / "sub").mkdir()
    for name in ("mine.toml", "branch.nc", "sub/other.nc", "sub/.hidden.nc"):
        (tmp_path / name).touch()
    assert completed(line, tmp_path)[0] == offered


def test_what_a_shell_would_run_is_not_offered(tmp_path: Path) -> None:
    """Assert that no file, and no key of a scene, is offered that bash would not take as it stands."""
    for name in ("$(reboot).toml", "`id`.toml", "a;b.toml", "a b.toml", "a\x1b[31m.toml", "plain.toml"):
        (tmp_path / name).touch()
    assert completed("trace ./", tmp_path)[0] == ["./plain.toml"]
    scene = built_in("gear-pair").replace("[parameters]", '[parameters]\n"$(reboot)" = 1.0')
    assert scene != built_in("gear-pair")
    (tmp_path / "own.toml").write_text(scene)
    offered = completed("trace own.toml --set parameters.", tmp_path)[0]
    assert offered and not [key for key in offered if "$" in key]


def test_names_of_scenes_import_nothing_large(tmp_path: Path) -> None:
    """Assert that scenes are offered without CasADi and NumPy: a key press waits for them."""
    offered, modules = completed("trace vit", tmp_path)
    assert offered and not {"casadi", "numpy"} & set(modules.split())
