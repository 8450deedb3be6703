"""
A cantilever and a stop
=======================

Elements of Euler and Bernoulli, and a spring behind a gap at the tip, as stiff as the beam: from the speed on
at which the tip touches it the resonance leans over.
"""

import periodic as per
import symbolic as sym

beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2)
structure = sym.Structure(beam, rayleigh=(0.05, 0.01))
tip = structure["tip"]
model = structure + sym.HarmonicForce(tip, 0.01, 3.0) + sym.OneSidedSpring(tip, 3.0, gap=0.03)
system = sym.compile(model, condense=False)
branch = per.trace(system, "Omega", (3.0, 4.5), start=3.0)
axes = per.plot(branch, "tip")
key = branch.labelled("GR")[0].parameter  # rad/s
print(f"the tip reaches it from {key:.8f} rad/s on")
