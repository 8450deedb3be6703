"""
Parametric resonance
====================

Mathieu's equation with a cubic spring: a stiffness that pulsates at twice the natural frequency shakes a mass
that nothing pushes. The motion has two periods of the stiffness; a simulation finds it, the trace its range.
"""

import periodic as per
import symbolic as sym

system = sym.compile(
    sym.Equations(
        lambda x, p, wave: {
            "x": x.v,
            "v": -p.c * x.v - (1 + p.depth * wave.cos) * x.x - x.x**3,
        },
        states={"x": 0.0, "v": 0.0},
        parameters={"c": 0.02, "depth": 0.2, "Omega": 1.8},
        frequency="Omega",
    )
)
knocked = sym.simulate(system, {"Omega": 2.0}, knock={"x": 0.3}, settle=200, periods=2)
guess = per.sampled(knocked.phase, knocked.state, knocked.algebraic, knocked.parameter, system=system)
branch = per.trace(system, "Omega", (1.6, 2.6), start=2.0, guess=guess)
axes = per.plot(branch)
key = branch.values.min()  # rad/s
print(f"motion from {key:.7f} rad/s on; {branch.stop}")
