"""
A map over two parameters
=========================

The height of the resonance over force and damping: each cell is a whole branch.
"""

import periodic as per
import symbolic as sym

task = per.maps.Task(
    sym.scene("duffing"),
    "Omega",
    (0.3, 3.0),
    numbers={"peak": per.maps.Highest(per.PeakToPeak("x"))},
    tol=1e-4,
)
grid = {"F": [0.1, 0.2, 0.3, 0.4], "c": [0.1, 0.15, 0.2]}
found = per.design_map(task, grid, executor=1, store=None)
axes = found["peak"].plot().axes
key = found["peak"].sel(F=0.4, c=0.1).item()  # m
print(f"highest peak {key:.5f} m")
