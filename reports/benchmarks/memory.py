"""Memory that Newton needs on a large system: prints MB before and at the peak of this process."""

from __future__ import annotations

import json
import resource
import sys

import symbolic as sym
from reports.benchmarks.work import OFF_RESONANCE, chain_model, converged

OSCILLATORS, NTST = 50, 400
UNIT = 1.0 if sys.platform == "darwin" else 1024.0
"""Bytes that ru_maxrss counts in."""


def peak() -> float:
    """Return the most memory that this process has held so far, in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * UNIT / 1e6


def main() -> None:
    """Solve for an orbit of the chain from rest."""
    system = sym.compile(chain_model(OSCILLATORS))
    before = peak()
    converged(system, OFF_RESONANCE, NTST)
    print(json.dumps((before, peak())))


if __name__ == "__main__":
    main()
