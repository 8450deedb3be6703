"""
Impacts
=======

A rigid wall that throws back eight tenths of the speed. The impacting orbit is found by simulation and traced
down to where the wall is grazed, at a force of c w d = 0.1.
"""

import periodic as per
import symbolic as sym

x = sym.coordinate("x")
model = (
    sym.Mass(x, 1.0)
    + sym.Damper(x, 0.1)
    + sym.Spring(x, 1.0)
    + sym.HarmonicForce(x, 1.0, 1.0)
    + sym.RigidStop(x, gap=1.0, restitution=0.8)
)
system = sym.compile(model)
motion = sym.simulate(system, settle=40)
guess = per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter, system=system)
branch = per.trace(system, "F", (0.01, 1.0), start=1.0, guess=guess)
axes = per.plot(branch)
key = branch.labelled("LP")[0].parameter  # N
print(f"no impacts below {key:.10f} N: {branch.stop}")
