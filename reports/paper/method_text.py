"""Words of the section on the paper's method, with its numbers put in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reports.paper.breakdown import real_limit
from reports.paper.contact import LOST
from reports.paper.equivalence import SPEEDS


def text(n: Mapping[str, float]) -> str:
    """Return the section in Markdown."""
    return _form(n) + _band(n) + _oil_b(n)


def _form(n: Mapping[str, float]) -> str:
    return f"""\
**The equation.** The paper eliminates everything but the film thickness: eq. (17) is of the third order
in h. Its functions ψ cannot be read in our copy, so we had them derived anew: the film law gives the
deflection as a function of h and dh/dt, geometry gives x = δ0 + h - h0 + a sin ωt - δ(h, dh/dt), this is
differentiated twice in time (symbolically) and put into m x'' = 2 (W - Q), and the result is solved for
the third derivative of h. It is the scene `third-order-810N`. It is the same system as three states x,
dx/dt and h: the eigenvalues at rest differ by {n["eigenvalue_difference"]:.0e} of their size, the
periodic orbits at {_listed(sorted(SPEEDS[1:], reverse=True))} rev/min by
{n["orbit_difference"]:.0e}, and x over 20 ms from the paper's start by
{n["motion_difference_coarse_um"]:.3f} µm with the paper's step of 0.1 ms and by
{n["motion_difference_um"]:.0e} µm with 0.01 ms.

It is a poor form where contact is lost. The coefficient of the third derivative is γδ/n and vanishes with
the deflection. Continuation in this form is at {n["third_reached_rpm"]:.2f} rev/min after
{n["third_points"]:.0f} points and creeps ("largest number of points reached"); the form with an algebraic
unknown has passed it and is at {n["three_reached_rpm"]:.0f} rev/min after {n["three_points"]:.0f}.

"""


def _band(n: Mapping[str, float]) -> str:
    return f"""\
**The band.** We stepped that equation as the paper did, by the classical Runge-Kutta method for 1 s from
its ramp, at every fifth speed from 100 to 500 rev/min, for both oils and preloads, with steps from 0.2 to
0.01 ms. With Shell Vitrea 79 and 0.1 ms (10 000 steps, the paper's number) the calculation breaks down at
{n["oil_a_failed"]:.0f} of the {n["oil_a_inside"]:.0f} speeds from {n["oil_a_low_rpm"]:.0f} to
{n["oil_a_high_rpm"]:.0f} rev/min under 810 N, and at {n["heavy_failed"]:.0f} of {n["heavy_inside"]:.0f}
from {n["heavy_low_rpm"]:.0f} to {n["heavy_high_rpm"]:.0f} rev/min under 2100 N, always within
{max(n["oil_a_latest_ms"], n["heavy_latest_ms"]):.1f} ms from the start. Everywhere else it settles, and
all {n["survivors"]:.0f} amplitudes lie within {n["survivors_off_percent"]:.1f} % of the branch. This is
the picture that the paper describes: flanks on both sides and no peak between them.

![Amplitude by the paper's method and step, beside the branch](method-response.png)

The band does not close with smaller steps. With 0.01 ms it runs from {n["oil_a_fine_low_rpm"]:.0f} to
{n["oil_a_fine_high_rpm"]:.0f} and from {n["heavy_fine_low_rpm"]:.0f} to {n["heavy_fine_high_rpm"]:.0f}
rev/min. With 0.2 ms {n["coarse_wrong"]:.0f} of the amplitudes, mostly above resonance, are off by more
than 1 %.

![What becomes of the calculation, over speed and step](method-map.png)

**Why.** At fixed x the film empties or fills at the rate (β/h + n/δ)/γ, and an explicit step must be
shorter than {real_limit():.3f} over that rate. As δ falls by many powers of ten, so does the step that is
allowed. So of {n["failures"]:.0f} failures with a step that is stable at rest we asked what came first.
{n["failures_contact_lost"]:.0f} begin with the loss of contact, as the paper says: all steps until the load
fell below {LOST:g} Q began within that limit, and the exact motion from the same start (CVODES) has lost
contact by the end of the step after the failing one. Then dh/dt grows and exp(γ dh/dt) overflows in the
third-order form; in the three-state form, which fails at nearly the same speeds, a step ends at a negative
deflection. {n["failures_step_unstable"]:.0f} had a step beyond the limit while there was contact, and
{n["failures_early"]:.0f} failed before the exact motion loses contact, {n["failures_early_coarse"]:.0f} of
them with steps of 0.2 ms.

![The first loss of contact at 270 rev/min](method-breakdown.png)

![Longest stable step of the classical Runge-Kutta method](method-step.png)

The band has two parts. Above {n["contact_lost_rpm"]:.0f} rev/min (810 N) the periodic orbit itself keeps
contact, and only the free vibration of the start takes the load to zero: started on the periodic orbit,
the method with 0.1 ms stays on it at every such speed. From {n["orbit_low_rpm"]:.0f} to
{n["orbit_high_rpm"]:.0f} rev/min it leaves the upper sheet even from there, with 0.1 ms, and from
{n["orbit_fine_low_rpm"]:.0f} to {n["orbit_fine_high_rpm"]:.0f} with 0.01 ms, because contact is lost in
every cycle. CVODES, with error control, goes through from the same start: at every speed tried inside the
bands it settles within {n["trusted_off"]:.0e} of a stable orbit of the branch. The response is finite
throughout; the largest x is {n["largest_um"]:.1f} µm peak to peak.

"""


def _oil_b(n: Mapping[str, float]) -> str:
    return f"""\
**The thin oil.** With Shell Turbo 33 the step of 0.1 ms is too long from the start: at 360 rev/min λΔt =
{n["oil_b_lambda_dt"]:.2f} (limit {real_limit():.3f}) and any disturbance grows {n["oil_b_growth"]:.1f}
times per step. It is unstable at rest from {n["oil_b_unstable_rpm"]:.0f} rev/min (810 N) and
{n["oil_b_heavy_unstable_rpm"]:.0f} rev/min (2100 N) on, and {n["unstable_lasting"]:.0f} of the
{n["unstable_runs"]:.0f} runs there last. For the paper's Fig. 7, with 10 000 steps in 1 s at 360 rev/min,
this says that its film, its step or its method was another one (its section 4 speaks of Runge-Kutta, its
introduction of an acceleration that varies linearly over a step). A film of
{n["oil_b_stable_film_um"]:.2f} µm instead of {n["oil_b_film_um"]:.2f} µm would be enough for the step to
be stable; the paper does not print its film for this oil, and its damping factor of 0.0018 asks for a
thicker one too. With steps that are stable the band of this oil is {n["oil_b_fine_low_rpm"]:.0f} to
{n["oil_b_fine_high_rpm"]:.0f} rev/min (810 N) and {n["oil_b_heavy_fine_low_rpm"]:.0f} to
{n["oil_b_heavy_fine_high_rpm"]:.0f} rev/min (2100 N), and what lies outside is mostly not settled after 1
s.
"""


def _listed(values: Sequence[float]) -> str:
    """Name values one by one."""
    return ", ".join(f"{value:g}" for value in values[:-1]) + f" and {values[-1]:g}"
