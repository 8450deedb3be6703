"""Writes the interface down anew, for a change that is meant: `PYTHONPATH=tests python -m interface`."""

from pathlib import Path

from interface.refusals import parts, refusals, settings
from interface.text import PACKAGES, interface

for package in PACKAGES:
    Path(__file__).with_name(f"{package}.txt").write_text(interface(package), "utf-8")
for kind, objects in (("settings", settings()), ("parts", parts())):
    lines = [line for name, given in objects.items() for line in refusals(name, given)]
    Path(__file__).with_name(f"{kind}.txt").write_text("\n".join(lines) + "\n", "utf-8")
