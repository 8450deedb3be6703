"""The pages of docs/ that hold Python: each is a session of its own, and its numbers are right."""

from __future__ import annotations

import importlib
import re
import runpy
from collections import Counter
from pathlib import Path
from types import ModuleType
from typing import Any

import matplotlib.pyplot as plt
import pytest

import periodic as per
import symbolic as sym
from periodic.correction.outcome import Outcome
from symbolic.kernels import native

pytestmark = pytest.mark.gallery

DOCS = Path(__file__).resolve().parent.parent / "docs"
REFERENCE = (
    "parts",
    "symbolic",
    "films",
    "functions",
    "periodic",
    "plots",
    "maps",
    "decisions",
    "phasespace",
    "tori",
    "extend",
)
PAGES = {str(file.relative_to(DOCS)): file for file in sorted(DOCS.glob("*/*.md"))}


def run(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Run the blocks of a page one after another in a folder, and return what they have defined."""
    plt.switch_backend("Agg")
    monkeypatch.chdir(folder)
    said: dict[str, Any] = {"__name__": name}
    for block in re.findall(r"```python\n(.*?)```", PAGES[name].read_text("utf-8"), re.DOTALL):
        exec(compile(block, name, "exec", dont_inherit=True), said)
    plt.close("all")
    return said


def test_first_branch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Assert that the page prints what it shows, the folds, and its files."""
    said = run("tutorials/first-branch.md", tmp_path, monkeypatch)
    shown = re.findall(r"```text\n(.*?)```", PAGES["tutorials/first-branch.md"].read_text("utf-8"), re.DOTALL)
    assert capsys.readouterr().out.startswith(shown[0])
    folds = [p.parameter for p in said["branch"].labelled(per.Label.FOLD)]
    assert folds == pytest.approx([2.2119353, 1.4386701], rel=1e-7)
    assert (tmp_path / "duffing.png").is_file() and (tmp_path / "duffing.nc").is_file()
    assert said["over_force"].stop.reason is per.Reason.BOUND and said["point"].maximum["x"] > 1


def test_two_parameters(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the cusp, the level, and the fold's derivative against two branches."""
    said = run("tutorials/two-parameters.md", tmp_path, monkeypatch)
    assert said["cusp"].parameter == pytest.approx(1.0901095, rel=1e-7)
    assert said["border"].column("F").min() == pytest.approx(0.0513635, rel=1e-6)
    assert said["level"].peak_to_peak("x") == pytest.approx([3.0] * len(said["level"]), rel=1e-7)
    first = per.Watch(stop={"LP": 1})
    folds = [
        per.trace(said["system"], "Omega", (0.8, 3.0), values={"c": c}, watch=first, tol=1e-8).labelled("LP")[
            0
        ]
        for c in (0.0999, 0.1001)
    ]
    difference = (folds[1].parameter - folds[0].parameter) / 2e-4
    assert said["slopes"]["fold"]["c"] == pytest.approx(difference, rel=1e-4)


def test_equations(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert pitchfork, Hopf point and the pendulum's energies."""
    said = run("tutorials/equations.md", tmp_path, monkeypatch)
    assert said["hopf"].parameter == pytest.approx(470 / 19, rel=1e-10)
    assert said["pitchfork"].parameter == pytest.approx(1.0, rel=1e-10)
    for point, energy in zip(said["backbone"], said["energies"], strict=True):
        assert energy == pytest.approx(point.orbit["v"](0.0) ** 2 / 2 + 1 - cosine(point), rel=1e-6)


def cosine(point: per.Point) -> float:
    """cos q of the pendulum at the beginning of an orbit."""
    import math

    return math.cos(float(point.orbit["q"](0.0)))


def test_contact(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert grazing by the linear response's closed form, and what is drawn of the orbit."""
    said = run("tutorials/contact.md", tmp_path, monkeypatch)
    grazing = said["branch"].labelled("GR")[0].parameter
    assert (1 - grazing**2) ** 2 + (0.1 * grazing) ** 2 == pytest.approx(0.25, rel=1e-7)
    assert said["in_contact"].maximum["q"] > 1


def test_proof(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that both proofs stand, and that the certificate is written."""
    said = run("explanation/proof.md", tmp_path, monkeypatch)
    assert said["proof"] and said["fold"] and (tmp_path / "proof.json").is_file()
    assert said["fold"].parameter == pytest.approx((0.598153117286,) * 2, rel=1e-11)


def test_fitting(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the truth is within three standard errors once the jump is known, and not told before."""
    said = run("tutorials/fitting.md", tmp_path, monkeypatch)
    found = said["found"]
    for name, value in {"k": 1.0, "k3": 1.0, "c": 0.1}.items():
        assert abs(found[name] - value) < 3 * found.errors[name]
    assert found.errors["c"] < 0.002 and not found.untold


def test_everything(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert motions, basins, atlas, chaos and tori of the page by numbers that are known."""
    if native.compiler() is not None:  # many motions one by one take long
        monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    said = run("tutorials/everything.md", tmp_path, monkeypatch)
    assert [motion.stable for motion in said["found"]] == [True, True, False]
    assert sum(motion.share for motion in said["basins"].motions) == pytest.approx(1.0)
    assert len(said["atlas"].sheets) == 1 and Path("gears.db").stat().st_size > 1000
    assert said["chaos"].chaotic and said["chaos"].values.sum() == pytest.approx(-0.25, rel=1e-6)
    assert said["whirl"].rotation_number == pytest.approx(1 - 0.50120598859, rel=1e-8)
    assert "NS" in said["family"].stops[0]
    assert said["both"].rotation_number == pytest.approx(2**0.5 - 1, rel=1e-9)


def test_damper(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert onset of slip, optimum and scatter of the page."""
    said = run("tutorials/damper.md", tmp_path, monkeypatch)
    assert said["slips"].parameter == pytest.approx(0.2, rel=1e-4)
    assert said["optimum"].objective == pytest.approx(1.101655980, rel=1e-8)
    mean, deviation = said["found"].second_order("peak")
    assert mean == pytest.approx(1.11, abs=0.01)
    slope = said["optimum"].derivatives["k_slider"]  # of the peak, whose other deviation is of second order
    assert deviation == pytest.approx(abs(slope) * 0.1 / 12**0.5, rel=0.05)
    assert "above 1.15 with a probability of" in capsys.readouterr().out


def test_structures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the error of the reduction that the page prints."""
    said = run("tutorials/structures.md", tmp_path, monkeypatch)
    assert said["reduced"].error(0.0, 130.0) < 1e-4
    assert said["beam"].first_frequency == pytest.approx(1.8751040687**2 / (2 * 3.14159265359), rel=2e-5)


def test_maps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the cell at the nominal parameters has the folds of the first tutorial."""
    found = run("howto/maps.md", tmp_path, monkeypatch)["found"]
    cell = found.sel(F=0.5, c=0.1)
    assert cell["folds"].values == pytest.approx([2.2119353, 1.4386701], rel=1e-4)
    assert (cell["at 1.8 stable"] == [1, 0, 1]).all() and (found["status"] == "done").all()
    assert (tmp_path / "duffing-map.nc").is_file()


def test_methods(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the three methods find the same folds, to 1e-7."""
    one, *others = run("howto/methods.md", tmp_path, monkeypatch)["folds"]
    assert len(one) == 2
    for other in others:
        assert other == pytest.approx(one, rel=1e-7)


def test_accuracy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the peak that the page asks for is the largest of the branch, between two of its points."""
    said = run("howto/accuracy.md", tmp_path, monkeypatch)
    branch, peak = said["branch"], said["peak"]
    assert branch.peak_to_peak("x").max() == peak.peak_to_peak("x")
    assert peak.peak_to_peak("x") > max(p.peak_to_peak("x") for p in branch if p.label != "PK")
    assert len(said["speed"]) == len(said["swing"]) == 8 * (len(branch) - 1) + 1
    assert said["swing"].max() == pytest.approx(peak.peak_to_peak("x"), rel=1e-9)


@pytest.mark.parametrize("name", ["howto/own-part.md", "howto/scenes.md"])
def test_page_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that its blocks run, and that a branch there gets to its end."""
    said = run(name, tmp_path, monkeypatch)
    assert "branch" not in said or said["branch"].stop.reason is per.Reason.BOUND


def test_every_page_with_python_is_run() -> None:
    """Assert that no page is left out here."""
    text = Path(__file__).read_text("utf-8")
    for name, file in PAGES.items():
        if not name.startswith("studies/") and "```python" in file.read_text("utf-8"):
            assert f'"{name}"' in text, name


def test_every_reason_is_explained() -> None:
    """Assert that the page on stops has each reason that a branch can give."""
    text = PAGES["howto/when-a-trace-stops.md"].read_text("utf-8")
    for reason in per.Reason:
        words = reason.value.removesuffix(" reached").removesuffix("largest number of Newton iterations")
        assert words in text, reason


def test_every_detail_is_explained() -> None:
    """Assert that the page on stops has each way in which a step fails."""
    text = PAGES["howto/when-a-trace-stops.md"].read_text("utf-8")
    for outcome in set(Outcome) - {Outcome.CONVERGED, Outcome.COLLAPSED}:
        assert outcome.value.split(",")[0] in text, outcome


def test_reference_has_every_name() -> None:
    """Assert that the reference lists all that stands in the namespaces, each name of a package once."""
    said = runpy.run_path(str(DOCS / "conf.py"))
    namespaces = [importlib.import_module(name) for name in said["NAMESPACES"]]
    assert {"parts", "symbolic", "periodic", *(d.__name__.split(".")[1] for d in namespaces)} == set(
        REFERENCE
    )
    listed = Counter(name for page in REFERENCE for name in listed_on(page))
    for namespace in (sym, per, *namespaces):
        for name in dir(namespace) if namespace in (sym, per) else namespace.__all__:
            package = namespace.__name__.split(".")[0]
            assert isinstance(getattr(namespace, name), ModuleType) or listed[package, name] == 1, name


def listed_on(page: str) -> list[tuple[str, str]]:
    """Package and name of what a page of the reference lists."""
    lines = (DOCS / "reference" / f"{page}.rst").read_text("utf-8").splitlines()
    (module,) = (line.split()[-1] for line in lines if line.startswith(".. currentmodule::"))
    return [(module.split(".")[0], line.strip()) for line in lines if line.startswith("   ")]


def test_links_lead_somewhere() -> None:
    """Assert that each link within the site is to a page that is there or made by its build."""
    examples = {f"gallery/{file.stem}.rst" for file in (DOCS.parent / "examples").glob("*.py")}
    made = examples | {"gallery/index.rst"} | {f"reference/{name}.rst" for name in REFERENCE}
    for name, file in [*PAGES.items(), ("index.md", DOCS / "index.md")]:
        prose = re.sub(r"```.*?```", "", file.read_text("utf-8"), flags=re.DOTALL)
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", prose):
            there = (file.parent / target).resolve()
            inside = there.is_relative_to(DOCS) and str(there.relative_to(DOCS)) in made
            assert inside or there.exists(), (name, target)


def test_index_has_every_page() -> None:
    """Assert that no page is left out of the site's list."""
    text = (DOCS / "index.md").read_text("utf-8")
    for name in PAGES:
        assert name.removesuffix(".md") in text.splitlines(), name
