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
from ..trace.run import JOURNAL, Effort, trace
from ..view import view_of


@dataclass(frozen=True, kw_only=True)
class Proven:
    """A point of a branch, by its label and its value of the parameter (SI), and what is proven of it."""

    label: str
    value: float
    proof: per.Proof

    @property
    def says(self) -> str:
        """The theorem, or why there is none."""
        return self.proof.says or f"not decided: {self.proof.reason}"

    @property
    def verdict(self) -> str:
        """In a word."""
        if not self.proof:
            return "not decided"
        return {True: "proven, stable", False: "proven, unstable", None: "proven"}[self.proof.stable]

    @property
    def size(self) -> str:
        """How far the computed orbit is from the proven one, over its size."""
        return f"{self.proof.distance:.1e}" if self.proof else ""


def proven(task: Task, folder: Path, *, folds: bool) -> tuple[per.Branch, list[Proven]]:
    """Trace the branch of a scene, and prove what is asked for. Raises KeyboardInterrupt, InputError."""
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
    values = [point.parameter for point in branch]
    passed = [v for v in (value * view.unit for value in task.at) if min(values) <= v <= max(values)]
    chosen = [(point, None) for value in passed for point in branch.at(**{view.parameter: value})]
    special = [point for point in branch if point.label in (per.Label.FOLD, per.Label.DOUBLING)] * folds
    both = [*chosen, *((point, view.parameter) for point in special)]
    found: list[Proven] = []
    with console.counting("proving", len(both)) as counted:
        for point, parameter in both:
            proof = per.proved(system, point, parameter)
            found.append(Proven(label=point.label.value, value=point.parameter, proof=proof))
            if counted is not None:
                counted(found[-1])
    return branch, found


def save(folder: Path, found: list[Proven]) -> list[Path]:
    """Write the certificates, and what checks them. Raises InputError where that cannot be."""
    from periodic.proof import check

    proofs = [each.proof for each in found if each.proof]
    writers: dict[str, Callable[[Path], object]] = {
        f"proof-{k}.json": proof.save for k, proof in enumerate(proofs, start=1)
    }
    if proofs:
        writers["check.py"] = lambda path: shutil.copyfile(str(check.__file__), path)
    return write(folder, writers)
