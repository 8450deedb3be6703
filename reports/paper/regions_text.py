"""The words on the regions of two motions, with what was computed put in."""

from __future__ import annotations

from collections.abc import Mapping

from reports.paper.regions_curves import OTHER_OIL, SCENE, as_thin_as
from reports.paper.scenes import LUBRICATED
from reports.paper.unseen_figures import TITLES

Numbers = Mapping[str, float]


def text(n: Numbers, meets: Numbers) -> str:
    """Return the section's Markdown."""
    return "\n\n".join([_begin(), _amplitude(n), _preload(n), _viscosity(n), _doubled(n), _checks(n, meets)])


def _folds(n: Numbers, where: str) -> str:
    return f"{n[f'fold 1 at {where} rpm']:.2f} and {n[f'fold 2 at {where} rpm']:.2f} rev/min"


def _begin() -> str:
    return """Between two folds the disc has two stable motions of one period at the same speed. The folds of
section 7 are two points of the border of a region: here one speed and one other quantity vary together, with
the condition that a multiplier is 1 (a fold) or -1 (a period doubling) to keep the orbit on the border. All
for oil A at 810 N and 1.27 µm but for what is varied."""


def _amplitude(n: Numbers) -> str:
    head = "| disc | cusp: waviness | speed | averaging: waviness | speed |\n|---|---|---|---|---|\n"
    lines = [
        f"| {TITLES[name]} | {n[f'{name} cusp um']:.4g} µm | {n[f'{name} cusp rpm']:.3f} rev/min "
        f"| {n[f'{name} averaged cusp um']:.4g} µm | {n[f'{name} averaged cusp rpm']:.3f} rev/min |"
        for name in LUBRICATED
    ]
    thin = n[f"{OTHER_OIL} cusp um"]
    return f"""**Waviness.** With a smaller waviness the folds approach each other and meet in a cusp, at
{n[f"{SCENE} cusp um"]:.4f} µm and {n[f"{SCENE} cusp rpm"]:.2f} rev/min. Below it the response has one value
at every speed. The paper's 1.27 µm is {1.27 / n[f"{SCENE} cusp um"]:.0f} times as much. With 3 µm the folds
are at {_folds(n, "3 um")}, with 0.5 µm at {_folds(n, "0.5 um")}.

![Regions over speed and waviness; right: about the cusp (triangle). Dots: 360 rev/min and the paper's
waviness.
](regions-amplitude.png)

The cusp is where softening just outweighs damping. Free motion of amplitude A in a Hertz contact has the
frequency ω0 (1 - (A/δ0)²/24); with the damping ratio ζ of the Jacobian at rest, averaging to first order puts
the cusp at A²/24 = 2ζ δ0²/√3 and the waviness 4ζA/√3, without any continuation:

{head}{chr(10).join(lines)}

The waviness at the cusp is as ζ^1.5. With the thin oil {1e3 * thin:.2f} nm are enough, which no ground
surface keeps to: in practice oil B always jumps, as far as its film alone damps it.

From {n["2:1 cusp um"]:.3f} µm on there is a second pair of folds, at half the natural speed (2:1; its cusp
is at {n["2:1 cusp over amplitude rpm"]:.2f} rev/min, above the figure)."""


def _preload(n: Numbers) -> str:
    return f"""**Preload.** From 20 N to 10 000 N there is no cusp: the region's border has no end there.
The folds are at {_folds(n, "20 N")} under 20 N, at {_folds(n, "200 N")} under 200 N, at {_folds(n, "2100 N")}
under 2100 N and at {_folds(n, "1e+04 N")} under 10 000 N. More preload makes the waviness smaller against the
static deflection, but damping falls as well, and the waviness at the cusp with it (table above).

![Regions over speed and preload; right: about the paper's preloads. Dotted: largest x, dashed: x is 10 µm.
](regions-preload.png)

The dotted curve is the resonance: the highest point of the branch at every preload. It rises from
{n["peak at 20 N rpm"]:.2f} rev/min ({n["peak at 20 N um"]:.2f} µm) under 20 N over
{n["peak at 810 N rpm"]:.2f} rev/min ({n["peak at 810 N um"]:.2f} µm) under 810 N and
{n["peak at 2100 N rpm"]:.2f} rev/min ({n["peak at 2100 N um"]:.2f} µm) under 2100 N to
{n["peak at 1e+04 N rpm"]:.2f} rev/min ({n["peak at 1e+04 N um"]:.1f} µm) under 10 000 N, monotonically,
as the paper concludes (P17), and it hugs the upper fold. This is why x falls with preload at 200 rev/min,
where the resonance lies above and moves away, and rises at 360 rev/min, where it lies below and comes nearer
(P15, P16).

x is 10 µm peak to peak on the dashed curve: under 810 N at {n["level 1 at 810 N rpm"]:.2f} and
{n["level 2 at 810 N rpm"]:.2f} rev/min, under 2100 N at {n["level 1 at 2100 N rpm"]:.2f} and
{n["level 2 at 2100 N rpm"]:.2f} rev/min, and more in between. It passes the lower folds at
{n["level on fold 2 N"]:.1f} N and the upper ones at {n["level on fold 1 N"]:.2f} N. Orbits of one period
and so much ripple exist from {n["level from N"]:.2f} N on."""


def _viscosity(n: Numbers) -> str:
    oil_b = as_thin_as(OTHER_OIL)
    return f"""**Viscosity.** From {n_low(n):g} to 20 Pa s there is no cusp of the resonance's folds either.
They are at {_folds(n, "0.02 Pas")} with 0.02 Pa s, at {_folds(n, f"{oil_b:.4g} Pas")} with {oil_b:.4f} Pa
s, at {_folds(n, "5 Pas")} with 5 Pa s and at {_folds(n, "20 Pas")} with 20 Pa s. In the model the oil
enters by the steady film only; {oil_b:.4f} Pa s with oil A's piezoviscosity give the film of oil B. The
lower fold hardly moves, because contact is kept there. The upper one moves to
lower speeds the thinner the oil is. A thick film loses its own stiffness against its squeeze term, and
beyond that more viscosity changes nothing; so the region stays open.

![Regions over speed and viscosity; right: about the two resonances. Lines and dots: both oils of the paper.
](regions-viscosity.png)

The 2:1 resonance has a cusp, at {n["2:1 cusp Pas"]:.4f} Pa s and {n["2:1 cusp over viscosity rpm"]:.2f}
rev/min: thinner oils, like oil B, have two motions there, thicker ones, like oil A, one.

The paper says that more viscosity has only a slight effect (P18). At its 360 rev/min that is so. On the
resonance x is {n["peak at 0.02975 Pas um"]:.1f} µm with the film of oil B, {n["peak at 0.89 Pas um"]:.1f}
µm with oil A's and {n["peak at 20 Pas um"]:.1f} µm with 20 Pa s."""


def n_low(n: Numbers) -> float:
    """Return the least viscosity that folds are given for."""
    return min(float(key.split()[3]) for key in n if key.startswith("fold 1 at") and key.endswith("Pas rpm"))


def _doubled(n: Numbers) -> str:
    return f"""**Period doubling.** The tongue near twice the natural speed in which the motion of one
period is unstable (section 7) begins at a waviness of {n["tip um"]:.4f} µm
({n["tip over amplitude rpm"]:.2f} rev/min) and closes at a viscosity of {n["tip Pas"]:.2f} Pa s
({n["tip over viscosity rpm"]:.2f} rev/min): damping prevents it below the one and above the other. With 3
µm it reaches from {n["doubling 1 at 3 um rpm"]:.2f} to {n["doubling 2 at 3 um rpm"]:.2f} rev/min. Over
preload it has no end up to 10 000 N; under 200 N it reaches from {n["doubling 1 at 200 N rpm"]:.2f} to
{n["doubling 2 at 200 N rpm"]:.2f} rev/min. Below about 110 N its slow side comes down almost
to the folds (figure), so that with light preload the motion of one period is unstable over a wide
range of speeds.

At the paper's waviness and preload motions of two periods are stable from their own fold (orange) to the fast
side of the tongue (section 7), so left of the tongue there are again two stable motions. Elsewhere they
double again: with 3 µm they are stable from their fold at {n["two periods from at 3 um rpm"]:.2f} to
{n["two periods double at 3 um rpm"]:.2f} rev/min, under 200 N from
{n["two periods from at 200 N rpm"]:.2f} to {n["two periods double at 200 N rpm"]:.2f} rev/min, and what lies
beyond was not followed here. That fold meets the tongue's slow side at
{n["two periods shrink at um"]:.5f} µm and {n["two periods shrink at rpm"]:.3f} rev/min, where its orbits have
shrunk to one period; the doublings' own curve has {n["doublings there um"]:.5f} µm at that speed. Over
viscosity the fold joins the tongue in the same way near its tip. Under 10 000 N it still lies at
{n["two periods from at 10000 N rpm"]:.1f} rev/min."""


def _checks(n: Numbers, meets: Numbers) -> str:
    told = "; ".join(
        f"{where.replace(' um', ' µm').replace('Pas', 'Pa s')} {d:.0e}" for where, d in meets.items()
    )
    counted = [key.removesuffix(" at 0.95 of it") for key in n if key.endswith(" at 0.95 of it")]
    lines = [
        f"| {key} | {n[f'{key} at 0.95 of it']:.0f} | {n[f'{key} at 1.05 of it']:.0f} |" for key in counted
    ]
    head = "| counted on branches over speed | at 0.95 of its value | at 1.05 |\n|---|---|---|\n"
    return f"""**Checks.** Branches over speed were traced at two values of each quantity, or those of the
other discs taken where they have that value, and their folds and doublings compared with the curves; the
largest relative differences in speed are: {told}. The fast side of the 10 µm curve differs from the branch
at 2100 N by {n["level difference"]:.0e}. Just below and above each cusp and tip:

{head}{chr(10).join(lines)}"""
