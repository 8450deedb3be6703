"""`python -m reports.studies.paper` computes the page."""

import sys

from reports.studies.pages.command import command
from reports.studies.paper.page import REPORT

if __name__ == "__main__":
    sys.exit(command(REPORT))
