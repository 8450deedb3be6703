"""Computes the report on machines."""

import sys

from reports.studies.machines.page import REPORT
from reports.studies.pages.command import command

sys.exit(command(REPORT))
