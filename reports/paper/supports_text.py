"""What the section on supports says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

Numbers = Mapping[str, float]


def text(n: Numbers, shares: Sequence[float], targets: Sequence[float]) -> str:
    """Return the Markdown of the section, all numbers formatted in."""
    return "\n\n".join((_asked(n), _model(), _linear(n, shares, targets), _nonlinear(n), _limits()))


def _asked(n: Numbers) -> str:
    return f"""Fig. 11 of the paper lays the measurements of Dareing & Johnson (1975) beside the computed
curve. The measured resonance lies lower. The paper takes the reason to be that the real supports are not
rigid, so that the effective stiffness is less (P14). We asked what stiffness that takes, and what it does
to the whole response. The measured points themselves are in neither the text nor any source that we have;
none are drawn here, and no number below is fitted to them. On rigid supports our resonance is at
{n["rigid resonance rpm"]:.1f} rev/min, where the corrugations meet the natural frequency of that same
speed."""


def _model() -> str:
    return """**Model.** A spring from the disc to ground would act beside the contact and raise the
frequency. What lowers it is compliance *in series*: between the disc, which the contact pushes, and the
mass behind it. So each side of mass m = 20.4 kg is split into disc and shaft, f m, and housing, (1 - f)
m, joined by a bearing of stiffness k and damping c. The housing hangs on the leaf spring, which the paper
calls negligible. With x and y the sums of both discs' and both housings' displacements, and µ = m/2,

    f µ x'' = W - Q - (k (x - y) + c (x' - y'))/2
    (1 - f) µ y'' = (k (x - y) + c (x' - y'))/2

Both bearings lie in series in these sums, hence k/2. The text gives no split of the mass: f is an
assumption, and we show what it does. Without damping, with k_c the stiffness of the contact and r =
µω²/k_c, a resonance at ω needs

    k/2 = k_c (1 - f) r (1 - f r)/(1 - r)

For f → 0 contact and bearings are simply in series, µω² = 1/(1/k_c + 2/k). For r → 1 the stiffness has no
bound: bearings can bring the first resonance to any speed below the rigid one, and to none above it."""


def _linear(n: Numbers, shares: Sequence[float], targets: Sequence[float]) -> str:
    head = "| share f | " + " | ".join(f"{rpm:g} rev/min" for rpm in targets) + " |"
    rule = "|---" * (len(targets) + 1) + "|"
    rows = [
        f"| {share:g} | "
        + " | ".join(f"{n[f'stiffness for {rpm:g} rpm share {share:g} N/m'] / 1e6:.0f}" for rpm in targets)
        + " |"
        for share in shares
    ]
    table = "\n".join([head, rule, *rows])
    return f"""**Linear resonance.** Stiffness of each bearing in MN/m that brings the first resonance to
a speed:

{table}

![First (left) and second resonance (right) against the stiffness of each bearing.](supports-stiffness.png)

The contact's own stiffness under 810 N is {n["contact stiffness N/m"] / 1e6:.0f} MN/m. Bearings ten times
as stiff put the resonance at {n["resonance with bearings of 10 contacts rpm"]:.1f} rev/min, bearings a
hundred times as stiff at {n["resonance with bearings of 100 contacts rpm"]:.1f} (f = 0.3). The paper says
in its section 2.1 that the housings are very stiff compared with the contact, and in section 6.2 that the
supports' compliance lowers the resonance. Both hold only for a shift of a few per cent; a measured
resonance at 250 rev/min would need bearings of
{n["stiffness for 250 rpm share 0.3 N/m"] / n["contact stiffness N/m"]:.1f} times the contact's stiffness,
if nothing else shifted it. Leaf springs act the other way, and little: 1 MN/m under each housing raises
the scene's {n["scene resonance rpm"]:.2f} to {n["resonance with leaf springs rpm"]:.2f} rev/min.

A compliant bearing also brings a second mode, in which disc and housing move against each other: at
{n["scene second resonance rpm"]:.0f} rev/min in the scene `supports-810N` (f = 0.3,
{n["scene bearing stiffness N/m"] / 1e6:.0f} MN/m). With large shares and soft bearings it comes down into
the paper's range of speeds. At
{n["scene antiresonance rpm"]:.0f} rev/min the scene's discs hardly move: there each housing and its
bearing are tuned to the corrugations and take up the motion."""


def _nonlinear(n: Numbers) -> str:
    worst = max(value for key, value in n.items() if key.startswith("return error"))
    return f"""**Nonlinear response.** Bearing damping is not in the text either;
{n["scene bearing damping N s/m"] / 1e3:g} kN s/m per bearing is an example. At 250 rev/min it makes the
damping ratio of the first mode {n["scene damping ratio"]:.4f}
(rigid supports: {n["rigid damping ratio"]:.4f}), that of the second
{n["scene second damping ratio"]:.3f}.

| | rigid supports | scene supports-810N |
|---|---|---|
| linear resonance (rev/min) | {n["rigid resonance rpm"]:.2f} | {n["scene resonance rpm"]:.2f} |
| upper fold (rev/min; x p-p in µm) | {_fold(n, "rigid", 1)} | {_fold(n, "scene", 1)} |
| lower fold | {_fold(n, "rigid", 2)} | {_fold(n, "scene", 2)} |
| period doubling, rev/min | {_zone(n, "rigid")} | {_zone(n, "scene")} |

![Left: several stiffnesses. Right: shares and bearing dampings. Dashed: unstable.](supports-branches.png)

Supports move the whole resonance down, bent as before: the band between the folds is
{n["rigid fold 2 rpm"] - n["rigid fold 1 rpm"]:.1f} rev/min wide on rigid supports and
{n["scene fold 2 rpm"] - n["scene fold 1 rpm"]:.1f} in the scene. At the upper fold the housings move by
{n["scene housings at fold 1 um"]:.1f} µm, more than the discs. The band in which the small motion is
unstable to a motion of twice its period, near twice the resonance, moves down too, into the paper's
range.

Checks: one period of time integration (CVODES) from the orbits at 300 and 225 rev/min, the latter on all
three sheets, comes back to its start within {worst:.0e} of the static deflection. Two coupled linear
oscillators in closed form agree with the linear modes to rounding (tests/test_supports.py)."""


def _fold(n: Numbers, name: str, i: int) -> str:
    return f"{n[f'{name} fold {i} rpm']:.2f}; {n[f'{name} fold {i} um']:.2f}"


def _zone(n: Numbers, name: str) -> str:
    found = sorted(value for key, value in n.items() if key.startswith(f"{name} doubling"))
    return " and ".join(f"{value:.2f}" for value in found)


def _limits() -> str:
    return """**What this does not show.** It shows that supports can bring the resonance to any lower
speed and how stiff they must be; it does not show that they did. With the measured speed, the table gives
the stiffness up to the unknown share f."""
