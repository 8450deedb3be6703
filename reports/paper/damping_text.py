"""The words on linear damping; every number of ours in them is one of `damping.key_numbers`."""

from __future__ import annotations

from collections.abc import Mapping

from reports.paper.causes import PAPER_A, PAPER_B

Numbers = Mapping[str, float]

MEASURES = {
    "Jacobian at rest": "jacobian",
    "multipliers, waviness a/1000": "orbit_vanishing",
    "multipliers, waviness a": "orbit",
    "multipliers, waviness 2a": "orbit_double",
    "transient, waviness a/100": "transient_small",
    "transient, waviness a": "transient",
    "transient, waviness 2a": "transient_double",
    "beats, less the mean late crest": "read_mean",
    "beats, less the highest late crest": "read_highest",
}
"""Lines of the table of damping ratios and the keys of their numbers."""

CAPTIONS = {
    "damping-transients": (
        "Transients at 360 rev/min and 810 N from the paper's start (a, b), and what is left of them "
        "without the steady motion (c, d), with our fit and the decay that the paper's factor would give."
    ),
    "damping-amplitude": (
        "Damping ratio against the size of the motion at 360 rev/min and 810 N. Free decay: smooth discs "
        "let go closer than at rest, over three cycles. About forced orbits: from the multipliers, as the "
        "waviness is raised, as far as the orbit is stable and free motion about it oscillates. Dotted: "
        "the Jacobian's ratio."
    ),
    "damping-response": (
        "Linear response and traced orbits at 810 N; dots are computed orbits. The peak of oil B's linear "
        "response lies far above the picture. At half the resonance speed the second harmonic of the "
        "excitation is in resonance; the linear response knows nothing of it."
    ),
}
"""Captions of the figures by name."""


def text(n: Numbers) -> str:
    """Return the section's Markdown."""
    return "\n\n".join([_asked(), _ratios(n), _size(), _response(n), _causes(n), _within_the_paper(n)]) + "\n"


def _figure(name: str) -> str:
    return f"![{CAPTIONS[name]}]({name}.png)"


def _asked() -> str:
    return f"""The paper subtracts the steady amplitude from its transients at 360 rev/min and 810 N and
states an equivalent linear damping factor of {PAPER_A:g} for oil A (Shell Vitrea 79, row P10) and of
{PAPER_B:g} for oil B (Shell Turbo 33, row P11). We find the damping ratio ζ = -Re λ/|λ| in three
independent ways. λ is

- an eigenvalue of the Jacobian of equations (1) to (4) at rest, differentiated exactly;
- from a multiplier μ = exp(λT) of the periodic orbit, T the period of the excitation. The waviness
  changes the orbit's size, and the branch of the logarithm is followed from the linear frequency on;
- from a transient: stiff time integration (tolerance 1e-10) from the paper's start, which is in effect
  rest at the crest of the wave with X = a, W = Q and h = h0. The periodic orbit is subtracted, and a line
  is fitted to the logarithm of the crests of what is left from 0 to 90 ms, the part that the paper shows.

The last two lines read the record as the paper describes it: an amplitude is subtracted from the highest
crest of each beat. It is the mean, or the highest, of the crests between 100 and 140 ms, which the paper
shows as steady for oil A."""


def _ratios(n: Numbers) -> str:
    lines = ["| ζ at 360 rev/min, 810 N | oil A | oil B |", "|---|---|---|"]
    for name, key in MEASURES.items():
        lines.append(f"| {name} | {n[f'oil_a_zeta_{key}']:.4g} | {n[f'oil_b_zeta_{key}']:.4g} |")
    lines.append(f"| paper | {PAPER_A:g} | {PAPER_B:g} |")
    pairs = [(n[f"{oil}_zeta_orbit_vanishing"], n[f"{oil}_zeta_jacobian"]) for oil in ("oil_a", "oil_b")]
    apart = max(abs(orbit / linear - 1) for orbit, linear in pairs)
    more = n["oil_a_zeta_transient"] / n["oil_a_zeta_jacobian"] - 1
    linear, read = (100 * (n[f"oil_a_zeta_{key}"] / PAPER_A - 1) for key in ("jacobian", "transient"))
    return (
        "\n".join(lines)
        + f"""

The multipliers tend to the Jacobian's ratio: at a/1000 they differ from it by {apart:.0e} of its value.
Rows P10 and P11 compare the Jacobian's ratio, the equivalent of linear damping. For oil A it gives the one
digit that the paper prints ({linear:+.1f} %); the transient of the paper's size has {more:.0%} more damping
than the linear motion, and read off it the factor would differ by {read:+.1f} %. For oil B it is not
reproduced by any of the three: off the transient we read {n["oil_b_zeta_transient"]:.3g} in the first 90 ms
and {n["oil_b_zeta_second"]:.3g} in the whole second.

{_figure("damping-transients")}"""
    )


def _size() -> str:
    return f"""{_figure("damping-amplitude")}

Damping rises slowly with size as long as the discs stay in contact, and steeply once contact is lost.
About forced orbits that happens at a smaller x: above resonance x moves against the wave, and the
deflection takes up both."""


def _response(n: Numbers) -> str:
    band = " to ".join(f"{n[f'oil_a_tension_{end}_rpm']:.0f}" for end in ("begin", "end"))
    other = " to ".join(f"{n[f'oil_b_tension_{end}_rpm']:.0f}" for end in ("begin", "end"))
    return f"""The excitation meets the natural frequency at {n["oil_a_resonance_rpm"]:.1f} rev/min (oil
A) and {n["oil_b_resonance_rpm"]:.1f} rev/min (oil B). At 360 rev/min the linear response has x p-p
{n["oil_a_x_linear_um"]:.3f} and {n["oil_b_x_linear_um"]:.3f} µm, the orbits {n["oil_a_x_um"]:.3f} and
{n["oil_b_x_um"]:.3f} µm. From {band} rev/min (oil B: {other}) the linear load would be negative in a part
of each period: there the linear response means nothing, and the branch bends to lower speeds instead.

{_figure("damping-response")}"""


def _causes(n: Numbers) -> str:
    return "\n".join(
        [
            "### The factor of ten for oil B",
            "",
            "| cause considered | what it gives for oil B | could it be? |",
            "|---|---|---|",
            *(
                f"| {cause} | {gives} | {verdict} |"
                for cause, gives, verdict in (*_of_the_motion(n), *_of_the_step(n), *_of_the_film(n))
            ),
        ]
    )


def _of_the_motion(n: Numbers) -> list[tuple[str, str, str]]:
    size = (
        f"{n['oil_b_zeta_transient']:.3g} for the paper's transient (x p-p "
        f"{n['oil_b_x_transient_um']:.1f} µm); free motion decays with {PAPER_B:g} only at x p-p "
        f"{n['oil_b_x_needed_um']:.0f} µm, with contact lost"
    )
    read = (
        f"read at oil A's times: {n['oil_b_zeta_read_mean']:.3g} (mean crest) to "
        f"{n['oil_b_zeta_read_highest']:.3g} (highest crest); {PAPER_B:g} if "
        f"{n['oil_b_level_needed_um']:.2f} µm is subtracted where the steady motion has "
        f"{n['oil_b_level_um']:.2f}; {n['oil_b_zeta_second_read']:.3g} off a second less the highest "
        f"crest of its last 50 ms"
    )
    return [
        ("size of the motion", size, "no"),
        ("amplitude subtracted before the motion was steady", read, "possible: right sign and size"),
    ]


def _of_the_step(n: Numbers) -> list[tuple[str, str, str]]:
    fourth = (
        f"{n['oil_b_zeta_rk4']:.3g} in the slow motion (oil A: {n['oil_a_zeta_rk4']:.3g}); but the film's "
        f"own motion grows by a factor of {n['oil_b_film_growth_rk4']:.1f} in each step, and a run of eq. "
        f"(17) fails in step {n['oil_b_failing_step_rk4']:.0f}"
    )
    smaller = (
        f"read off such runs: {n['oil_b_zeta_transient_rk4_80us']:.3g} at 0.08 ms, and for oil A "
        f"{n['oil_a_zeta_transient_rk4']:.3g} at 0.1 ms"
    )
    third = (
        f"{n['oil_b_zeta_rk3']:.3g}, but {n['oil_a_zeta_rk3']:.3g} for oil A, and the film's motion "
        f"grows by a factor of {n['oil_b_film_growth_rk3']:.1f}"
    )
    linear = (
        f"{n['oil_b_zeta_linear_acceleration']:.3g}, but {n['oil_a_zeta_linear_acceleration']:.3g} for oil A "
        f"if the equation is met at the step's end; {n['oil_b_zeta_linear_acceleration_mean']:.3g} (growth) "
        f"if on the mean of its ends"
    )
    otherwise = "only if oil A was stepped otherwise"
    return [
        ("Runge-Kutta of fourth order, step 0.1 ms", fourth, "no"),
        ("the same, step 0.08 ms", smaller, "no"),
        ("third order, step 0.1 ms", third, otherwise),
        ("second order, step 0.1 ms", f"{n['oil_b_zeta_rk2']:.3g}: the motion would grow", "no"),
        ("film's acceleration linear in a step of 0.1 ms (paper, introduction)", linear, otherwise),
    ]


def _of_the_film(n: Numbers) -> list[tuple[str, str, str]]:
    thicker = (
        f"{PAPER_B:g} needs {n['oil_b_film_needed_um']:.2f} µm in place of {n['oil_b_film_um']:.2f}, that is "
        f"viscosity to the power {n['viscosity_exponent_needed']:.2f} in place of 0.625"
    )
    softer = (
        f"{PAPER_B:g} needs β = {n['beta_needed']:.2f} in place of 22.23; oil A would then have "
        f"{n['oil_a_zeta_at_that_beta']:.3g}"
    )
    squeeze = (
        f"at most {n['oil_b_zeta_most_from_squeeze']:.3g}, at γu = {n['squeeze_of_most']:.0f} "
        f"in place of 2734.3"
    )
    both = (
        f"β = {n['beta_for_both']:.1f} and γu = {n['squeeze_for_both']:.0f}; oil A's film ripple would be "
        f"{n['oil_a_film_ripple_for_both_um']:.2f} µm, still further from the paper's 0.35 (P3)"
    )
    return [
        ("thicker steady film", thicker, "not with the paper's law of the film"),
        ("softer film: load exponent β", softer, "no"),
        ("squeeze coefficient γ", squeeze, "no"),
        ("β and γ together, both oils' factors as printed", both, "not with the printed constants"),
    ]


def _within_the_paper(n: Numbers) -> str:
    return f"""The paper's own record speaks against {PAPER_B:g}. With so much damping oil B's free motion
would be down to {n["oil_b_free_left_paper_um"]:.3f} µm after 0.95 s, too little to be seen in a figure;
yet the paper says that the motion is not steady then (P7). With our ratio {n["oil_b_free_left_um"]:.1f}
µm are left. Oil A is shown as steady from 100 ms on, when by our fit
{n["oil_a_free_taken_for_steady_um"]:.2f} µm of free motion are left. To be unsteady by that measure at
0.95 s, oil B must have ζ below {n["oil_b_zeta_unsteady_bound"]:.3g}. On the other hand the lowest label
of the axis of Fig. 7 in the text is -3.0 µm. If the whole curve lies above it, ζ exceeds
{n["oil_b_zeta_axis_bound"]:.3g}, more than the equations give. By either measure P7 and P11 do not go
together.

An amplitude subtracted before the motion was steady needs no change of the equations, the constants or the
step, and it spoils oil B's factor far more than oil A's. Between the mean and the highest late crest oil B's
runs from {n["oil_b_zeta_read_mean"]:.3g} to {n["oil_b_zeta_read_highest"]:.3g}, through the paper's value,
oil A's from {n["oil_a_zeta_read_mean"]:.3g} to {n["oil_a_zeta_read_highest"]:.3g}. Neither of the two
readings gives both printed factors at once. The text does not say which amplitude was subtracted, and the
record cannot be had, so this stays a supposition."""
