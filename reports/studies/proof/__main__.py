"""Computes the report on proofs."""

import sys

from reports.studies.pages.command import command
from reports.studies.proof.page import REPORT

sys.exit(command(REPORT))
