"""
Backbone of a pendulum
======================

The family of a conservative system's free oscillations: the larger, the slower.
"""

import periodic as per
import symbolic as sym

pendulum = sym.compile(
    sym.Equations(
        lambda x, p: {"q": x.v, "v": -sym.functions.sin(x.q) - p.c * x.v},
        states={"q": 0.0, "v": 0.0},
        parameters={"c": 0.0},
    )
)
still = per.trace(pendulum, "c", (0.0, 1.0), start=0.0, method=per.Equilibrium())[0].orbit
guess = per.normal_mode(pendulum, still, "c")
branch = per.trace(pendulum, "omega", (0.4, 1.0), guess=guess, determined={"c": per.Conservative()})
axes = per.plot(branch)
key = max(point.maximum["q"] for point in branch)  # rad, at 0.4 of the small oscillations' frequency
print(f"amplitude {key:.6f} rad at 0.4 rad/s")
