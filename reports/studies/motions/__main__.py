"""Computes the report on motions."""

import sys

from reports.studies.motions.page import REPORT
from reports.studies.pages.command import command

sys.exit(command(REPORT))
