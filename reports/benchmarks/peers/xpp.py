"""xpplab: XPPAUT with its AUTO, the equations interpreted, by pip without a compiler."""

from __future__ import annotations

import math
import sys

import xpplab

from reports.benchmarks.peers.answers import median, tell

BEGIN, PERIODS = 0.3, 20
MODEL = f"""
x'=v
v'=-.1*v-x-x^3+.5*u
u'=u-om*w-u*(u^2+w^2)
w'=om*u+w-w*(u^2+w^2)
par om={BEGIN}
init x=.55,v=0,u=1,w=0
@ total={2 * math.pi / BEGIN},dt=.002,meth=stiff,maxstor=200000,tol=1e-9
done
"""
"""Duffing A, excited by an oscillator."""

NEWTON = {"epsl": 1e-8, "epsu": 1e-8, "epss": 1e-6, "ds": 0.01, "dsmax": 0.05}
BRANCH = {"parmin": 0.25, "parmax": 3.0, "nmax": 1000, "npr": 1000}


def main(ntst: int) -> None:
    """Measure the branch from an orbit that a simulation has settled on."""
    model = xpplab.Model.from_text(MODEL)
    model.run(total=2 * math.pi / BEGIN * PERIODS)
    model.ic_last()

    def branch() -> xpplab.auto.Diagram:
        model.run(total=2 * math.pi / BEGIN)
        model.auto.reset()
        return model.auto.start("periodic", "om", ntst=ntst, **NEWTON, **BRANCH)

    found = branch()
    tell(median(branch), len(found), [point.value for point in found.special("LP")])


if __name__ == "__main__":
    main(int(sys.argv[1]))
