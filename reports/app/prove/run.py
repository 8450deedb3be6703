"""What is proven of a scene, from a validated task to certificates on disk."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import periodic as per
from periodic.proof.proof import EXTRA
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError

from .. import console
from ..files import write
from ..request import Task
from ..rest import check_rest
from ..trace.html import write_page
from ..trace.run import JOURNAL, Effort, trace
from ..view import view_of


@dataclass(frozen=True, kw_only=True)
class Proven:
    """A point of a branch, or a stretch of it between two values (SI), and what is proven."""

    point: per.Point
    proof: per.Proof
    ends: tuple[float, float] | None = None

    @property
    def label(self) -> str:
        """The kind of point."""
        return "stretch" if self.ends else self.point.label.value

    def place(self, shown: Callable[[float], float]) -> str:
        """Where it is, in the unit of the scene's axis."""
        return " to ".join(f"{shown(value):.10g}" for value in self.ends or (self.point.parameter,))

    @property
    def says(self) -> str:
        """The theorem, or why there is none."""
        proof = self.proof
        if proof.says and proof.reason:
            return f"{proof.says}; {proof.reason}"
        return proof.says or f"not decided: {proof.reason}"

    @property
    def verdict(self) -> str:
        """In a word."""
        if not self.proof:
            return "proven in part" if self.proof.says else "not decided"
        return {True: "proven, stable", False: "proven, unstable", None: "proven"}[self.proof.stable]

    @property
    def size(self) -> str:
        """How far the computed orbit is from the proven one, over its size."""
        return f"{self.proof.distance:.1e}" if self.proof and not self.ends else ""


def proven(
    task: Task, folder: Path, *, folds: bool, between: tuple[float, ...] = ()
) -> tuple[per.Branch, list[Proven]]:
    """Trace the branch of a scene, and prove what is asked for; `between` is in the unit of its axis, as at.

    Raises KeyboardInterrupt, InputError.
    """
    if find_spec("flint") is None:
        raise InputError("prove", "needs python-flint", f"{EXTRA} brings it")
    view, system = view_of(task.scene), build(task.scene)
    branch = trace(task, Effort(accuracy="STANDARD", method="collocation"), folder)
    (folder / JOURNAL).unlink(missing_ok=True)
    if branch.stop.reason is per.Reason.INTERRUPTED:
        raise KeyboardInterrupt
    if not len(branch):
        check_rest(task)
        return branch, []
    values = [value * view.unit for value in task.at]
    chosen: list[Asked] = [(point, None, None) for value in values for point in _at(branch, value)]
    special = [point for point in branch if point.label in (per.Label.FOLD, per.Label.DOUBLING)] * folds
    chosen += [(point, view.parameter, None) for point in special]
    if between:
        low, high = (value * view.unit for value in between)
        chosen += [(point, view.parameter, (low, high)) for point in _at(branch, (low + high) / 2)]
    found: list[Proven] = []
    with console.counting("proving", len(chosen)) as counted:
        for point, parameter, ends in chosen:
            proof = per.proved(system, point, parameter, ends)
            found.append(Proven(point=point, proof=proof, ends=ends))
            if counted is not None:
                counted(found[-1])
    return branch, found


Asked = tuple[per.Point, str | None, tuple[float, float] | None]
"""What `proved` is asked for: a point, a parameter, and ends of a stretch."""


def _at(branch: per.Branch, value: float) -> tuple[per.Point, ...]:
    """The points of a branch at a value, none where it does not come so far."""
    values = [point.parameter for point in branch]
    return branch.at(**{branch.parameter: value}) if min(values) <= value <= max(values) else ()


def save(task: Task, folder: Path, branch: per.Branch, found: list[Proven], *, html: bool) -> list[Path]:
    """Write the certificates, what checks them, and a page of the branch with what is proven marked on it.

    Raises InputError where that cannot be.
    """
    from periodic.proof import check

    proofs = [each.proof for each in found if each.proof.certificate]
    writers: dict[str, Callable[[Path], object]] = {
        f"proof-{k}.json": proof.save for k, proof in enumerate(proofs, start=1)
    }
    if proofs:
        writers["check.py"] = lambda path: shutil.copyfile(str(check.__file__), path)
    if html and len(branch):
        notes = {each.point: each.verdict for each in found if each.proof and not each.ends}
        writers["branch.html"] = lambda path: write_page(path, task.scene, branch, notes)
    return write(folder, writers)
