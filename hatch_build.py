"""The wheel's build hook: compiles what every system shares, where there is a compiler.

Without one the wheel is made all the same and NumPy does what C would do. The libraries are plain ones, not
extensions of Python: one wheel serves every Python of a platform.
"""

from __future__ import annotations

import importlib.util
import os
import sysconfig
import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

WINDOWS = ["/O2", "/std:c11", "/fp:precise"]


class Libraries(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the libraries to a wheel; an editable install compiles for itself."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and tell the wheel's builder of the files and of the platform that they are for."""
        if version == "editable":
            return
        names = _names(Path(self.root))
        self._made = tempfile.TemporaryDirectory()
        folder = Path(self._made.name)
        try:
            for files in self.config["libraries"]:
                source = "".join(Path(self.root, file).read_text("utf-8") for file in files)
                _compile(source, folder / names.file_name(source), names.FLAGS, self.config["functions"])
        except Exception as error:
            self.app.display_warning(f"no C library is built, NumPy does what it would do: {error}")
            return
        for library in folder.glob("*.*"):
            if library.suffix in (".so", ".dll"):
                build_data["force_include"][str(library)] = f"symbolic/kernels/libraries/{library.name}"
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Take away what was compiled."""
        if hasattr(self, "_made"):
            self._made.cleanup()


def _names(root: Path) -> ModuleType:
    """The module that says how libraries are called, without the package around it."""
    spec = importlib.util.spec_from_file_location("built", root / "symbolic" / "kernels" / "built.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _compile(source: str, library: Path, flags: tuple[str, ...], functions: list[str]) -> None:
    """Compile a C source as the machine's Python was, but with our options."""
    from setuptools._distutils.ccompiler import new_compiler
    from setuptools._distutils.sysconfig import customize_compiler

    compiler, windows = new_compiler(), os.name == "nt"
    customize_compiler(compiler)
    file = library.with_suffix(".c")
    file.write_text(source, "utf-8")
    made = compiler.compile(
        [str(file)],
        output_dir=str(library.parent),
        extra_preargs=None if windows else [flag for flag in flags if flag != "-shared"],
        extra_postargs=WINDOWS if windows else None,
    )
    compiler.link_shared_object(
        made, str(library), export_symbols=functions, libraries=[] if windows else ["m"]
    )
