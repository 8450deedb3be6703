"""The cache of compiled kernels and the choice of a back end: what goes wrong, and what then happens."""

from __future__ import annotations

import logging
import os
import stat
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from support.models import Array, duffing_parts

import symbolic as sym
from symbolic.kernels import built, choice, kernel, native, privacy
from symbolic.kernels.choice import ChosenKernel, Kernels
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError
from symbolic.scenes.reading import load

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)

X, P = ca.SX.sym("x"), ca.SX.sym("p")
AT = np.linspace(0.1, 2.0, 7)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of the test's own, and no library in memory."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    native.forget()
    native.compiler.cache_clear()
    yield tmp_path / "orbitrace" / "kernels"
    native.forget()
    native.compiler.cache_clear()


def made(kernels: Kernels, factor: float = 3.0) -> ChosenKernel:
    """A kernel of factor sin x."""
    run = kernel.build([kernel.points(X, "x")], [factor * ca.sin(X)], kernels)
    assert isinstance(run, ChosenKernel)
    return run


def at_points(run: ChosenKernel) -> Array:
    """What it gives."""
    out = np.zeros((len(AT), 1))
    run(AT, out)
    return out[:, 0]


def right(run: ChosenKernel, factor: float = 3.0) -> bool:
    """Whether its values are."""
    return bool(np.allclose(at_points(run), factor * np.sin(AT), rtol=1e-14, atol=0))


def no_compiler(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Hide every compiler."""
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(native.sysconfig, "get_config_var", lambda name: None)
    monkeypatch.setattr(native, "packaged", lambda: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    native.compiler.cache_clear()


def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let compiling pay after some calls."""
    monkeypatch.setattr(choice, "COMPILER", 2e-5)
    monkeypatch.setattr(choice, "STATEMENT", 0.0)


def test_library_is_kept_and_taken(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that C is compiled once, and that AUTO takes it from the cache without compiling."""
    assert not made(Kernels.AUTO).compiled
    assert made(Kernels.C).compiled
    (file,) = cache.iterdir()
    assert stat.S_IMODE(cache.stat().st_mode) == 0o700
    assert stat.S_IMODE(file.stat().st_mode) & 0o077 == 0
    native.forget()
    monkeypatch.setattr(native, "_made", lambda source: pytest.fail("compiled again"))
    for kernels in (Kernels.AUTO, Kernels.C):
        run = made(kernels)
        assert run.compiled and right(run)


def test_another_source_or_compiler_has_its_own_library(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that nothing made otherwise is taken."""
    made(Kernels.C)
    assert not made(Kernels.AUTO, 4.0).compiled
    native.forget()
    monkeypatch.setattr(native, "FLAGS", (*native.FLAGS, "-g"))
    assert not made(Kernels.AUTO).compiled
    assert right(made(Kernels.C)) and right(made(Kernels.C, 4.0), 4.0)
    assert len(list(cache.iterdir())) == 3


@pytest.mark.parametrize(
    "damage", ["truncated", "empty", "changed", "foreign", "text", "directory", "unreadable"]
)
def test_damaged_library_is_made_again(cache: Path, damage: str) -> None:
    """Assert that it is not loaded, whatever happened to it, and that C makes a new one."""
    made(Kernels.C)
    (file,) = cache.glob("*.so")
    content, key = file.read_bytes(), file.name.partition("-")[0]
    file.unlink()
    if damage == "directory":
        file.mkdir()
    elif damage == "foreign":  # whole, but of nothing that loads here
        other = b"MZ" + content
        (cache / f"{key}-{native._digest(other)}.so").write_bytes(other)
    else:
        changed = bytes([content[0] ^ 1]) + content[1:]
        file.write_bytes(
            {"truncated": content[:3000], "empty": b"", "changed": changed, "text": b"no library"}.get(
                damage, content
            )
        )
        if damage == "unreadable":
            file.chmod(0)
            if os.access(file, os.R_OK):  # the superuser's tests read all
                file.write_bytes(b"")
    native.forget()
    assert not made(Kernels.AUTO).compiled
    run = made(Kernels.C)
    assert run.compiled and right(run)


OPEN = {"cache, all": ("kernels", 0o777), "cache, group": ("kernels", 0o770), "above, all": ("", 0o757)}


@pytest.mark.parametrize("place", [*OPEN, "above, group"])
def test_nothing_is_loaded_from_where_others_write(
    cache: Path, place: str, caplog: pytest.LogCaptureFixture
) -> None:
    """Assert that a directory open to others is not used, which is told once, and that C does without."""
    made(Kernels.C)
    native.forget()
    name, mode = OPEN.get(place, ("", 0o775))
    (cache.parent / name).chmod(mode)
    with caplog.at_level(logging.WARNING):
        assert native.directory() is None
        assert not made(Kernels.AUTO).compiled
        assert right(made(Kernels.C)) and right(made(Kernels.C, 4.0), 4.0)
    (said,) = [record.message for record in caplog.records]
    assert said.endswith(f"others can write to {str(cache.parent / name).rstrip('/')!r} (mode {mode:o})")
    assert said.startswith(f"kernels are compiled for this run alone, not kept in {str(cache)!r}: ")
    assert native.refused() and len(list(cache.glob("*.so"))) == 1  # as it was


def test_a_group_writes_above_with_the_sticky_bit(cache: Path) -> None:
    """Assert that a folder like /tmp may stand above: there nobody moves what is another's."""
    made(Kernels.C)
    cache.parent.chmod(0o1777)
    assert native.directory() == cache and not native.refused()


def test_folders_are_made_for_this_user_alone(cache: Path) -> None:
    """Assert the modes of what is made, whatever the umask gives to a group."""
    before = os.umask(0o002)
    try:
        assert native.directory() == cache
    finally:
        os.umask(before)
    assert [stat.S_IMODE(path.stat().st_mode) for path in (cache, cache.parent)] == [0o700, 0o700]


@pytest.mark.parametrize("fault", ["group", "all", "link", "pipe", "owner"])
def test_library_that_is_not_ours_alone(cache: Path, fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a library of another owner or mode, or behind a link, is made again and not loaded."""
    made(Kernels.C)
    (file,) = [
        path for path in cache.glob("*.so") if path.name.startswith(native._key(made(Kernels.C).source))
    ]
    native.forget()
    if fault in ("group", "all"):
        file.chmod(0o620 if fault == "group" else 0o602)
    elif fault == "owner":
        monkeypatch.setattr(privacy.os, "getuid", lambda: os.geteuid() + 1)
        assert privacy.own_bytes(file) is None
        return
    else:
        content = file.read_bytes()
        file.unlink()
        if fault == "link":
            (cache.parent / "elsewhere.so").write_bytes(content)
            file.symlink_to(cache.parent / "elsewhere.so")
        else:
            os.mkfifo(file)
    assert not made(Kernels.AUTO).compiled
    assert right(made(Kernels.C))
    assert stat.S_ISREG(file.lstat().st_mode) and stat.S_IMODE(file.lstat().st_mode) == 0o600


def test_a_cache_of_another_user(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is not used, nor any below a folder of somebody else."""
    assert native.directory() == cache
    uid = os.getuid()
    monkeypatch.setattr(privacy.os, "getuid", lambda: uid + 1)
    assert native.refused() == f"{str(cache)!r} belongs to another user"


def test_a_temporary_directory_of_others(
    cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that nothing is loaded from one that others can change, and what is said."""
    made(Kernels.C)
    native.forget()
    cache.chmod(0o777)
    (tmp_path / "open").mkdir()
    (tmp_path / "open").chmod(0o777)
    monkeypatch.setattr(native.tempfile, "tempdir", str(tmp_path / "open"))
    with pytest.raises(native.CompilerError, match="^there is no safe place to compile in: others can write"):
        made(Kernels.C)


def test_shared_source_where_a_cache_is_refused(cache: Path) -> None:
    """Assert that AUTO compiles it for this run."""
    assert shared("numpy") is None
    cache.mkdir(parents=True)
    cache.chmod(0o777)
    assert shared("auto") == 42
    assert list(cache.iterdir()) == []


@pytest.mark.parametrize("obstacle", ["file", "no home"])
def test_without_a_cache_c_still_works(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, obstacle: str
) -> None:
    """Assert that C compiles for this run alone where no cache can be made."""
    if obstacle == "file":
        (tmp_path / "orbitrace").write_text("in the way")
    else:
        monkeypatch.delenv("XDG_CACHE_HOME")
        monkeypatch.setenv("HOME", "/proc/nowhere")
    assert native.directory() is None
    run = made(Kernels.C)
    assert run.compiled and right(run)


def test_read_only_cache(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that C works where nothing can be written, and takes what is there."""
    made(Kernels.C)
    native.forget()

    def refused(*_: object, **__: object) -> None:
        raise PermissionError(30, "Read-only file system")

    monkeypatch.setattr(native.os, "access", lambda *_: False)
    for name in ("utime", "replace"):
        monkeypatch.setattr(native.os, name, refused)
    assert right(made(Kernels.C, 4.0), 4.0)
    assert right(made(Kernels.AUTO)) and made(Kernels.AUTO).compiled


def test_oldest_go_first(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert how many libraries are kept, and which."""
    monkeypatch.setattr(native, "KEPT", 2)
    for age, factor in enumerate((2.0, 3.0, 4.0)):
        made(Kernels.C, factor)
        for file in cache.iterdir():
            os.utime(file, (0, file.stat().st_mtime - 10))
        assert len(list(cache.iterdir())) == min(age + 1, 2)
    native.forget()
    assert [made(Kernels.AUTO, factor).compiled for factor in (2.0, 3.0, 4.0)] == [False, True, True]


def test_without_a_compiler_numpy_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that AUTO says nothing, and that C says what is missing."""
    no_compiler(monkeypatch, tmp_path)
    soon(monkeypatch)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = made(Kernels.AUTO)
        for _ in range(run.pays + 1):
            assert right(run)
    assert not run.compiled
    with pytest.raises(native.CompilerError, match="^no C compiler was found; install one .pip install"):
        made(Kernels.C)
    with pytest.raises(native.CompilerError, match="^no C compiler was found"):
        sym.compile(sym.combine(duffing_parts()), kernels="c")


def test_command_line_names_the_variable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a scene is refused in one sentence for a wrong word, and for C without a compiler."""
    monkeypatch.setenv("ORBITRACE_KERNELS", "fortran")
    wrong = '^ORBITRACE_KERNELS is "fortran"; it must be "auto", "numpy" or "c"$'
    with pytest.raises(InputError, match=wrong):
        build(load("duffing"))
    monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    no_compiler(monkeypatch, tmp_path)
    with pytest.raises(
        InputError,
        match='^ORBITRACE_KERNELS is "c"; it needs a working C compiler .no C compiler was found',
    ):
        build(load("duffing"))


def test_compiler_that_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Assert that AUTO warns once and goes on with NumPy, and that C gives the compiler's words."""
    broken = tmp_path / "cc"
    broken.write_text('#!/bin/sh\n[ "$1" = --version ] && exit 0\necho no licence >&2\nexit 1\n')
    broken.chmod(0o700)
    monkeypatch.setenv("CC", str(broken))
    native.compiler.cache_clear()
    soon(monkeypatch)
    run = made(Kernels.AUTO)
    with caplog.at_level(logging.WARNING):
        for _ in range(2 * run.pays):
            assert right(run)
    assert [record.message for record in caplog.records] == [
        f"NumPy does what C would do: {broken} failed: no licence"
    ]
    with pytest.raises(native.CompilerError, match="no licence$"):
        made(Kernels.C)


def shared(kernels: str, source: str = "int answer(void) { return 42; }\n") -> int | None:
    """What a source that every system needs answers, or None where it is not to be compiled."""
    library = sym.compile(sym.combine(duffing_parts()), kernels=kernels).library(source)
    return None if library is None else int(library.answer())


def test_shared_source_is_compiled_at_once(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that AUTO compiles it if it can be kept, and who goes without."""
    assert shared("numpy") is None
    assert shared("auto") == 42
    assert len(list(cache.iterdir())) == 1
    native.forget()
    monkeypatch.setattr(native, "directory", lambda: None)
    assert shared("auto") is None
    assert shared("c") == 42
    assert shared("auto") == 42


def test_auto_compiles_when_it_has_paid(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert at which call, and that the values stay."""
    soon(monkeypatch)
    run = made(Kernels.AUTO)
    assert run.pays > 1
    for _ in range(run.pays - 1):
        assert right(run) and not run.compiled
    assert right(run) and run.compiled
    assert len(list(cache.iterdir())) == 1


PROCESS = """
import numpy as np, symbolic as sym, sys
sys.path.insert(0, "tests")
from support.models import Disc, draw
system = sym.compile(sym.combine(Disc().parts()), kernels="c")
at = draw(system)
print(system.linearise(*at.arguments, (0,)).d_state.tobytes().hex())
"""


def test_processes_at_once(cache: Path) -> None:
    """Assert that processes that make the same library at once all work, and leave one that does."""
    run = [sys.executable, "-c", PROCESS]
    several = [subprocess.Popen(run, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    answers = [process.communicate(timeout=100)[0] for process in several]
    assert [process.returncode for process in several] == [0, 0, 0]
    assert len(set(answers)) == 1 and answers[0]
    files = list(cache.iterdir())
    assert {file.suffix for file in files} == {".so"}
    assert len({file.name.partition("-")[0] for file in files}) == 2  # with the probe


def test_choice_is_the_programs_then_the_environments(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the order, and what is refused."""
    model = sym.combine(duffing_parts())
    monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    assert sym.compile(model).kernels is Kernels.C
    assert sym.compile(model, kernels="numpy").kernels is Kernels.NUMPY
    monkeypatch.setenv("ORBITRACE_KERNELS", "")
    assert sym.compile(model).kernels is Kernels.AUTO
    with pytest.raises(ValueError, match="^kernels is 'fortran'; it must be auto, numpy or c$"):
        sym.compile(model, kernels="fortran")
    monkeypatch.setenv("ORBITRACE_KERNELS", "C++")
    with pytest.raises(ValueError, match=r"^ORBITRACE_KERNELS is 'C\+\+'; it must be auto, numpy or c$"):
        sym.compile(model)


def test_compiler_from_the_package_index(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Assert that the compiler that pip installs is found where the machine has none."""
    no_compiler(monkeypatch, tmp_path)
    assert native.compiler() is None
    monkeypatch.undo()
    if native.packaged() is None:
        pytest.skip("the package ziglang is not installed")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("CC", str(native.packaged()))
    native.compiler.cache_clear()
    assert right(made(Kernels.C))


def stand_in(folder: Path, name: str, does: str) -> Path:
    """A program of that name."""
    file = folder / name
    file.write_text(f"#!/bin/sh\n{does}\n")
    file.chmod(0o755)
    return file


def test_first_compiler_that_answers(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Assert the order of names, what one says of its version, and that one that fails is passed over."""
    no_compiler(monkeypatch, tmp_path)
    stand_in(tmp_path, "clang", 'echo "clang, $1"')
    assert native.compiler() == (("clang",), "clang, --version\n")
    stand_in(tmp_path, "gcc", 'echo "gcc, $1"')
    native.compiler.cache_clear()
    assert native.compiler() == (("gcc",), "gcc, --version\n")
    stand_in(tmp_path, "cc", "echo broken; exit 1")
    native.compiler.cache_clear()
    assert native.compiler() == (("gcc",), "gcc, --version\n")


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        ("own -O1 'a b'", (("own", "-O1", "a b"), "own, -O1, a b, --version\n")),
        ("missing", None),
        ("missing own", None),
        ("'own", None),
        (" ", None),
    ],
)
def test_compiler_that_is_asked_for(
    asked: str, found: object, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Assert that CC may have arguments, and that no other is taken in its place."""
    no_compiler(monkeypatch, tmp_path)
    stand_in(tmp_path, "own", 'echo "own, $1, $2, $3"')
    stand_in(tmp_path, "cc", "echo cc")
    monkeypatch.setenv("CC", asked)
    native.compiler.cache_clear()
    assert native.compiler() == found


@pytest.mark.parametrize("does", ["echo wrong >&2; exit 3", "echo wrong >&2; kill -9 $$"])
def test_compiler_that_stops(does: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Assert its words, whether it fails or is ended by a signal."""
    no_compiler(monkeypatch, tmp_path)
    monkeypatch.setenv(
        "CC", str(stand_in(tmp_path, "own", f'[ "$1" = --version ] && echo own && exit 0; {does}'))
    )
    native.compiler.cache_clear()
    with pytest.raises(native.CompilerError, match="own failed: wrong$"):
        native._made("int main;")


def test_library_that_came_with_the_package(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Assert that the one of a source is loaded, one of another machine passed over and logged."""
    source, known = "int seven(void) { return 7; }", native.compiler()
    assert known is not None
    monkeypatch.setattr(built, "FOLDER", tmp_path)
    (tmp_path / "own.c").write_text(source)
    made = tmp_path / built.file_name(source)
    subprocess.run([*known[0], *built.FLAGS, "-o", str(made), str(tmp_path / "own.c")], check=True)
    with caplog.at_level(logging.DEBUG, logger="symbolic.kernels.built"):
        found = built.built(source)
        assert found is not None and found.seven() == 7 and not caplog.messages
        assert built.built("int other;") is None and not caplog.messages
        (tmp_path / built.file_name("int broken;")).write_bytes(b"no library")
        assert built.built("int broken;") is None
    (said,) = caplog.messages
    assert said.startswith(f"{tmp_path / built.file_name('int broken;')} is not used: ")
