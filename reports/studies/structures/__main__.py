"""Computes the report on structures."""

import sys

from reports.studies.pages.command import command
from reports.studies.structures.page import REPORT

sys.exit(command(REPORT))
