"""Computes the report on work and precision."""

import sys

from reports.studies.pages.command import command
from reports.studies.trade.page import REPORT

sys.exit(command(REPORT))
