"""Computes the report on extremes."""

import sys

from reports.studies.extremes.page import REPORT
from reports.studies.pages.command import command

sys.exit(command(REPORT))
