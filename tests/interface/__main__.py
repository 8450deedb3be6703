"""Writes the interface down anew, for a change that is meant: `PYTHONPATH=tests python -m interface`."""

from pathlib import Path

from interface.text import PACKAGES, interface

for package in PACKAGES:
    Path(__file__).with_name(f"{package}.txt").write_text(interface(package), "utf-8")
