"""
An isola
========

Damping that falls and then rises with the velocity leaves an island of large motions above the response,
which no sweep of the frequency finds. A simulation from a large swing does.
"""

import periodic as per
import symbolic as sym

system = sym.compile(
    sym.Equations(
        lambda x, p, wave: {
            "x": x.v,
            "v": p.F * wave.cos - x.x - p.c * x.v + 0.055 * x.v**3 - 0.008 * x.v**5,
        },
        states={"x": 0.0, "v": 0.0},
        parameters={"c": 0.1, "F": 0.045, "Omega": 1.0},
        frequency="Omega",
    )
)
axes = per.plot(per.trace(system, "Omega", (0.8, 1.2)), label="main branch")
large = sym.simulate(system, knock={"v": 2.3}, settle=60)
guess = per.sampled(large.phase, large.state, large.algebraic, large.parameter, system=system)
isola = per.trace(system, "Omega", (0.8, 1.2), start=1.0, guess=guess)
per.plot(isola, axes=axes, label="isola")
key = isola.labelled("LP")[0].parameter  # rad/s
print(f"the isola begins at {key:.8f} rad/s; {isola.stop}")
