"""Computes the report on decisions."""

import sys

from reports.studies.decide.page import REPORT
from reports.studies.pages.command import command

sys.exit(command(REPORT))
