"""What the reports share: sections, computed one by one and kept, and the page put together from them."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from reports.pages.report import Report

NAMES = ("paper", "trade", "extremes")
"""The reports, each a package `reports.NAME` whose module `page` has the `REPORT`."""


def report_of(name: str) -> Report:
    """Return the report of a name."""
    found: Report = importlib.import_module(f"reports.{name}.page").REPORT
    return found
