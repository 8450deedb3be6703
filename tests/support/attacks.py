"""Texts that would run, fetch, link, end or stand for something, if they were read as more than text."""

from __future__ import annotations

from functools import cache

import periodic as per
import symbolic as sym

RUN = "window.broken=1;alert(1)"

ATTACKS = {
    "image": f"<img src=x onerror={RUN}>",
    "image of SVG": f'<image href="x" onerror="{RUN}">',
    "drawing": f'"/><svg onload="{RUN}"><animate onbegin="{RUN}" attributeName=x dur=1s>',
    "end of a script": f"</script><script>{RUN}</script>",
    "comment before a script": "<!--<script>",
    "end of a title": f"</title></style></textarea></h1><script>{RUN}</script>",
    "place of the data": "@@DATA@@@@LIBRARY@@@@STYLE@@",
    "template": "{{ data }}{% raw %}{{ script }}{# ",
    "link": f'<a href="javascript:{RUN}">x</a><a href="https://example.org">y</a>',
    "style": '<style>*{display:none}</style><span style="font-size:99px">z</span>',
    "frame": '<iframe srcdoc="<script>parent.broken=1</script>"></iframe><meta http-equiv=refresh content=0>',
    "entities": "&lt;b&gt;&amp;lt;&#60;i&#62;",
    "prototype": "__proto__",
    "inherited": "constructor",
    "hover": "%{x}<extra>%{fullData.name}</extra><br>${x}`${window.broken=1}`",
    "formula": r"$\frac{$ $$\href{javascript:alert(1)}{x}$$ \(y\) \[z\]",
    "ends": ']]>;"\\u003c\\"); --> */',
}
"""By what each tries; a name may have no line ends, and no ' either."""


@cache
def hostile(attack: str) -> tuple[sym.CompiledSystem, per.Branch]:
    """A Duffing oscillator with a text for names and units, and a branch to an event so called."""
    x, spring = sym.coordinate(attack, unit=attack), sym.parameter(f"{attack} k", 1.0, attack)
    frequency = sym.parameter(f"{attack} f", 0.8)
    model = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, spring) + sym.CubicSpring(x, 1.0)
    system = sym.compile(model + sym.HarmonicForce(x, 0.5, frequency))
    events = {f"{attack} e": per.Level(per.PeakToPeak(attack), 1.0)}
    watch = per.Watch(events=events, stop={f"{attack} e": 1}, columns={f"{attack} c": per.Maximum(attack)})
    return system, per.trace(system, spring.name, (1.0, 3.0), start=1.0, tol=1e-3, watch=watch)
