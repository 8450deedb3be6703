"""Linear structures of a scene: matrices from files, or from a builder, whose places are coordinates."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import Field

from symbolic.parts.structure import Structure
from symbolic.scenes.errors import InputError, listed, refused, shown
from symbolic.scenes.model.bench import Bench
from symbolic.scenes.model.catalogue import Entry, entry_of
from symbolic.scenes.scenetables import Table
from symbolic.structures.beam import beam
from symbolic.structures.files import read_matrices
from symbolic.structures.matrices import Matrices
from symbolic.structures.shaft import shaft

BUILDERS: dict[str, Callable[..., Matrices]] = {"beam": beam, "shaft": shaft}
SOURCES = ("file", "files", *BUILDERS)
MOST_ELEMENTS = 500
"""Elements that a builder may have in a scene."""


def builders() -> dict[str, Entry]:
    """Return what builds structures, with the keys of their tables."""
    found = {name: entry_of(function) for name, function in BUILDERS.items()}
    return {name: entry for name, entry in found.items() if entry is not None}


class StructureTable(Table):
    """A linear structure: its matrices from `file`, `files` or a builder; paths are relative to the scene."""

    name: str = Field(min_length=1, max_length=60, pattern=r"^[^.]+$", description="a name without dots")
    file: str | None = Field(None, description="the path of a file with matrices")
    files: dict[str, str] | None = Field(None, description="paths of files by M, C, K and G")
    beam: dict[str, Any] | None = Field(None, description="a table with the keys of a beam")
    shaft: dict[str, Any] | None = Field(None, description="a table with the keys of a shaft")
    at: dict[str, int | list[int]] = Field({}, description="a table of degrees of freedom, counted from 0")
    damping: float | list[float] = Field(0.0, description="a damping ratio, or a list of them")
    rayleigh: list[float] = Field([0.0, 0.0], description="a list of two numbers")
    modes: int | None = Field(None, ge=1, description="a whole number of at least 1")
    scale: float = Field(1.0, gt=0, description="a positive number (m)")

    def structure(self, folder: Path) -> Structure:
        """Return the part. Raises InputError."""
        where = f"[[structure]] {self.name}"
        try:
            return Structure(
                self._matrices(where, folder),
                at=self.at,
                damping=self.damping,
                rayleigh=(*self.rayleigh,),  # type: ignore[arg-type]
                modes=self.modes,
                name=self.name,
                scale=self.scale,
            )
        except (ValueError, ArithmeticError) as error:
            raise InputError.said(f"{where}: {error}") from None

    def _matrices(self, where: str, folder: Path) -> Matrices:
        given = [name for name in SOURCES if getattr(self, name) is not None]
        if len(given) != 1:
            what = f"has {listed(given, 'and') or 'no matrices'}"
            raise InputError(where, what, f"it must have one of {listed(SOURCES)}")
        if self.file is not None:
            return read_matrices(folder / self.file)
        if self.files is not None:
            for name in self.files.keys() - {"M", "C", "K", "G"}:
                raise InputError(f"{where} files {shown(name)}", "is not a key", "it may have M, C, K and G")
            paths: dict[str, Any] = {name: folder / path for name, path in self.files.items()}
            return read_matrices(None, **paths)
        table = getattr(self, given[0])
        elements = table.get("elements")
        if isinstance(elements, int) and elements > MOST_ELEMENTS:
            raise refused(f"{where} elements", elements, f"a whole number from 1 to {MOST_ELEMENTS}")
        built: Matrices = builders()[given[0]].made(Bench(), f"{where} {given[0]}", table)
        return built
