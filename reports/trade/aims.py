"""Section of the report: the aims for speed, measured in one run beside other tools."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from reports.bench.others import PACKAGES, PEERS, MissingError, version
from reports.bench.record import machine
from reports.bench.suite import NTST, OWN, Numbers
from reports.pages.report import table
from reports.pages.section import Section, Tell
from reports.trade import aims_figures
from reports.trade.words import power, seconds

AUTO = "AUTO-07p by bifpy, ntst 50"
DISC, CHAIN = "disc iteration", "chain iteration"
STANDARD, DUFFING = "disc branch, standard", "Duffing A branch"
ALIKE = 1e-10
"""Error of the folds up to which Duffing A counts as accurate as AUTO has it."""

MACHINE = "machine"

STATED = {"per point ms": 1.0, "s": 0.24}
"""AUTO's times where it is not installed, from a run of its own Fortran driver."""


@dataclass(frozen=True, kw_only=True)
class Result:
    """What a benchmark gave, or in words why it was left out."""

    name: str
    numbers: Numbers = field(default_factory=dict)
    skipped: str = ""

    def kept(self) -> dict[str, Any]:
        """Return what is kept of it."""
        return asdict(self)


@dataclass(frozen=True)
class Aim:
    """A number that is to be at most `limit`; `shown` puts both in words."""

    what: str
    found: float
    limit: float
    shown: Callable[[float], str]

    @property
    def cells(self) -> tuple[str, ...]:
        """A row of the table."""
        ratio = f"{self.found / self.limit:.2f}"
        met = "yes" if self.found <= self.limit else "**no**"
        return self.what, self.shown(self.limit), self.shown(self.found), ratio, met


def section(tell: Tell) -> Section:
    """Run all benchmarks, one after the other."""
    here = machine()
    place = f"{here['processor']}, {here['cores']} cores, load {os.getloadavg()[0]:.1f} when it began"
    rows = [Result(name=MACHINE, skipped=place)]
    with threadpool_limits(limits=1, user_api="blas"):
        for benchmark in (*OWN, *PEERS):
            tell(benchmark.name)
            try:
                rows.append(Result(name=benchmark.name, numbers=benchmark.run()))
            except MissingError as error:
                rows.append(Result(name=benchmark.name, skipped=str(error)))
    rows += [Result(name=f"version of {name}", skipped=version(name)) for name in PACKAGES]
    numbers = {f"{r.name}: {quantity}": value for r in rows for quantity, value in r.numbers.items()}
    figures = {"aims": aims_figures.growth(by_name(rows)), "peers": aims_figures.peers(compared(rows))}
    return Section(
        title="Aims, beside other tools", text=text(rows), numbers=numbers, rows=rows, figures=figures
    )


def by_name(rows: Sequence[Result]) -> dict[str, Numbers]:
    """Return the numbers of what was run."""
    return {r.name: r.numbers for r in rows if r.numbers}


def aims(n: Mapping[str, Numbers]) -> list[Aim]:
    """Return the aims with what was found."""
    auto = n.get(AUTO, STATED)
    own = alike(n)
    disc, chain, start = n[DISC], n[CHAIN], n["start"]
    return [
        Aim(f"{own}, per point; AUTO's time at ntst 50", n[own]["per point ms"], auto["per point ms"], _ms),
        Aim(f"{own}, whole; half of AUTO's", n[own]["s"], auto["s"] / 2, seconds),
        Aim("disc branch, 500 to 100 rev/min, `standard`", n[STANDARD]["s"], 0.3, seconds),
        Aim("disc, Newton iteration at ntst 100, ncol 4", disc["ntst 100 ms"], 0.7, _ms),
        Aim("chain of 50 (n = 100), iteration at ntst 20", chain["50 oscillators ms"], 60.0, _ms),
        Aim("power of ntst that the cost grows with", in_ntst(disc), 1.0, _power),
        Aim("power of n that the cost grows with", in_states(chain), 3.0, _power),
        Aim("`import periodic, symbolic`", start["import s"], 0.6, seconds),
        Aim("`orbitrace --help`", start["help s"], 0.4, seconds),
        Aim(
            "first `orbitrace trace` of a disc, process and files included",
            start["first trace s"],
            3.0,
            seconds,
        ),
    ]


def alike(n: Mapping[str, Numbers]) -> str:
    """Return the quickest branch of Duffing A whose folds are as accurate as AUTO's."""
    own = [name for name in n if name.startswith(DUFFING) and n[name]["fold error"] <= ALIKE]
    return min(own, key=lambda name: n[name]["s"])


def in_ntst(disc: Numbers) -> float:
    """Return the power of ntst that the cost of an iteration grows with from 100 intervals on."""
    counts = [c for c in NTST if c >= 100]
    return _exponent(counts, [disc[f"ntst {c} ms"] for c in counts])


def in_states(chain: Numbers) -> float:
    """Return the power of n that it grows with between the two longest chains."""
    counts = [50, 100]
    return _exponent(counts, [chain[f"{c} oscillators ms"] for c in counts])


def _exponent(counts: Sequence[float], times: Sequence[float]) -> float:
    return float(np.polyfit(np.log(counts), np.log(times), 1)[0])


def compared(rows: Sequence[Result]) -> dict[str, Numbers]:
    """Return who traced Duffing A, both folds included."""
    peers = {b.name for b in PEERS}
    found = by_name(rows)
    return {k: v for k, v in found.items() if k.startswith(DUFFING) or k in peers}


def text(rows: Sequence[Result]) -> str:
    """Return the section in Markdown."""
    n = by_name(rows)
    wanted = table(("aim", "at most", "measured", "ratio", "met"), [aim.cells for aim in aims(n)])
    memory, place = n["memory"], _said(rows, MACHINE)
    return f"""\
All of this was measured in one run, one thread, each number the median of up to five: processor time, and
wall time of fresh processes for the last three aims. The machine: {place}.
`orbitrace report trade --only aims` repeats it (after `pip install 'orbitrace[peers]'`, or with the path of a
Python that has these tools in ORBITRACE_PEERS); `make bench` measures the same and keeps a record that the
next run is compared with. Where AUTO is missing its times are those once measured with its Fortran driver.

{wanted}

Memory: Newton's iterations on the chain of 50 oscillators (n = 100) at ntst 400, ncol 4, need
{memory["of which Newton MB"]:.0f} MB at their peak, the whole process {memory["peak MB"]:.0f} MB.

![One Newton iteration over mesh intervals and over states; crosses are the aims](aims.png)

### Duffing A from 0.3 to 3 rad/s

{_beside(rows)}

![Duffing A: error of the folds over the time of the branch](peers.png)

AUTO-07p is run through bifpy, which compiles the model (transpiled); what it spends before the first step is
taken off. Its orbits, ours and nobody else's come with Floquet multipliers that can be used. The folds of
pyHarm and bice are interpolated between their points. SKHiPPR is not in the package index, so it is not
measured here.{_missing(rows)}
"""


def _beside(rows: Sequence[Result]) -> str:
    versions = {package: _said(rows, f"version of {package}") for package in PACKAGES}
    heads = ("tool", "points", "whole branch", "per point", "error of the folds", "multipliers")
    body = [_cells(name, numbers, versions) for name, numbers in compared(rows).items()]
    return table(heads, body)


def _cells(name: str, n: Numbers, versions: Mapping[str, str]) -> tuple[str, ...]:
    package = next((p for p in PACKAGES if p.partition("-")[0].lower() in name.lower()), None)
    label = (
        name.replace(DUFFING, "orbitrace") if package is None else f"{name} ({package} {versions[package]})"
    )
    error = power(n["fold error"]) if "fold error" in n else "not reached"
    multipliers = "yes" if package in (None, "bifpy") else "no"
    whole = seconds(n["s"]) if "fold error" in n else "-"
    return label, f"{n['points']:.0f}", whole, _ms(n["per point ms"]), error, multipliers


def _missing(rows: Sequence[Result]) -> str:
    peers = {b.name for b in PEERS}
    lines = [f"{r.name}: {r.skipped}" for r in rows if r.skipped and r.name in peers]
    return f"\n\nNot measured: {'; '.join(lines)}." if lines else ""


def _said(rows: Sequence[Result], name: str) -> str:
    return next((r.skipped for r in rows if r.name == name), "not known")


def _ms(value: float) -> str:
    return seconds(value / 1e3)


def _power(value: float) -> str:
    return f"{value:.2f}"
