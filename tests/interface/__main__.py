"""Writes the interface down anew, for a change that is meant: `PYTHONPATH=tests python -m interface`."""

from pathlib import Path

import symbolic as sym
from interface.refusals import parts, refusals, settings
from interface.scenes import scene
from interface.text import PACKAGES, interface

for package in PACKAGES:
    Path(__file__).with_name(f"{package}.txt").write_text(interface(package), "utf-8")
for kind, objects in (("settings", settings()), ("parts", parts())):
    lines = [line for name, given in objects.items() for line in refusals(name, given)]
    Path(__file__).with_name(f"{kind}.txt").write_text("\n".join(lines) + "\n", "utf-8")
lines = [text for name in sym.scene_names() for text in (f"[{name}]", *scene(name))]
Path(__file__).with_name("scenes.txt").write_text("\n".join(lines) + "\n", "utf-8")
