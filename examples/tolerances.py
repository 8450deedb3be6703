"""
What tolerances do to a jump
============================

The speed at which Duffing's oscillator jumps down, and the height from which it does, where stiffness and
damping scatter as their makers say.
"""

from scipy.stats import norm, uniform

import periodic as per
import symbolic as sym

system, response = sym.scene("duffing"), per.Response("Omega", (0.5, 2.6))
jump, peak = response.place("LP"), response.highest(per.PeakToPeak("x"))
scatter = {"c": norm(0.1, 0.005), "k3": uniform(0.9, 0.2)}
found = per.scatter(system, scatter, {"jump": jump, "peak": peak}, samples=100)
print(found)
print(
    f"it jumps between 2.1 and 2.2 rad/s with a probability of {found.probability(jump >= 2.1, jump <= 2.2)}"
)
axes = found.plot("jump")
key = found.second_order("jump")[0]  # rad/s
