"""From a scene to the compiled system of its equations: each table of the scene becomes its parts."""

from __future__ import annotations

import math
import os

import symbolic as sym
from reports.errors import InputError, listed, refused, shown
from reports.schema import Discs, DiscScene, Film, Oscillator, OscillatorScene, Scene
from reports.view import RPM
from symbolic.choice import VARIABLE, chosen
from symbolic.native import CompilerError


def build(scene: Scene) -> sym.CompiledSystem:
    """Return the system of a scene. Its states, unknowns and outputs are those that its parts need.

    Raises InputError where the environment asks for kernels that cannot be.
    """
    model = disc_model(scene) if isinstance(scene, DiscScene) else oscillator_model(scene)
    return sym.compile(model, _kernels())


def _kernels() -> sym.Kernels:
    """The environment's choice of a back end."""
    given = os.environ.get(VARIABLE)
    try:
        return chosen(given)
    except CompilerError as error:
        why = " ".join(str(error).split())[:150]
        raise InputError(VARIABLE, f"is {shown(given)}", f"it needs a working C compiler ({why})") from None
    except ValueError:
        raise refused(VARIABLE, given, listed([shown(k.value) for k in sym.Kernels])) from None


def disc_model(scene: DiscScene) -> sym.Model:
    """Return two discs in rolling contact, x the sum of their outward displacements.

    m x'' = 2 (W - Q) for equal discs of mass m (Mehdigoli et al. 1990, eqs. 11 and 12); with a support see
    `inertia`. The parameter `speed` is the discs' in rad/s.
    """
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    contact, waviness = scene.contact, scene.waviness
    speed = sym.parameter("speed", scene.trace.from_rpm * RPM, "rad/s")
    parts: list[sym.Part] = [
        *inertia(scene, x),
        sym.Preload(pair, contact.preload),
        sym.Hertz(pair, contact.stiffness, contact.exponent),
        sym.Waviness(pair, waviness.amplitude, waviness.waves, speed),
    ]
    if scene.film is not None:
        parts.append(film_part(scene.film, scene.discs, pair, speed))
    if scene.damping is not None:
        parts.append(sym.ContactDamping(pair, scene.damping.ratio))
    model = sym.combine(parts)
    if scene.film is not None and scene.film.law == "third-order":
        return sym.Model((sym.ThirdOrder(model),))
    return model


def inertia(scene: DiscScene, x: sym.Coordinate) -> list[sym.Part]:
    """Return the masses that move with x, and what a support puts behind them.

    Rigid: the whole mass m of each side moves with x. With a support the share f m moves with x, the rest
    with y, the sum of the housings' displacements; each disc is joined to its housing by k and c, each
    housing to ground by k_l. With W - Q on every disc and mu = m/2, the two sides add up to

        f mu x'' = W - Q - (k (x - y) + c (x' - y'))/2,   (1 - f) mu y'' = (k (x - y) + c (x' - y') - k_l y)/2
    """
    support, total = scene.support, scene.discs.mass
    if support is None:
        mass = sym.parameter("mass", total, "kg")
        return [sym.ReducedMass(x, mass, mass)]
    disc = sym.parameter("disc_mass", support.disc_share * total, "kg")
    housing = sym.parameter("housing_mass", (1 - support.disc_share) * total, "kg")
    contact = scene.contact
    y = sym.coordinate("y", scale=(contact.preload / contact.stiffness) ** (1 / contact.exponent))
    stiffness = sym.parameter("bearing_stiffness", support.stiffness, "N/m")
    damping = sym.parameter("bearing_damping", support.damping, "N s/m")
    parts: list[sym.Part] = [
        sym.ReducedMass(x, disc, disc),
        sym.ReducedMass(y, housing, housing),
        sym.Coupling(x, y, stiffness, damping, in_series=2),
    ]
    if support.leaf is not None:
        parts.append(sym.Support(y, sym.parameter("leaf_stiffness", support.leaf, "N/m"), in_series=2))
    return parts


def film_part(film: Film, discs: Discs, pair: sym.ContactPair, speed: sym.Parameter) -> sym.Part:
    """Return the film between the discs."""
    law, radius = thickness_law(film, discs, speed), discs.diameter / 2
    if film.squeeze is None:
        return sym.QuasistaticFilm(pair, law, film.beta)
    if film.floor is not None:
        return sym.CavitatingFilm(pair, law, speed, radius, film.beta, film.squeeze, film.floor)
    return sym.SqueezeFilm(pair, law, speed, radius, film.beta, film.squeeze)


def thickness_law(film: Film, discs: Discs, speed: sym.Parameter) -> sym.ThicknessLaw:
    """Return the law of the steady film thickness that a scene names."""
    radius, oil = discs.diameter / 2, (film.viscosity, film.piezoviscosity)
    if film.thickness == "calibrated":
        return sym.CalibratedThickness(speed, radius, *oil)
    given = {"crown": discs.crown, "modulus": discs.modulus, "poisson": discs.poisson}
    known = {name: value for name, value in given.items() if value is not None}
    rolling = sym.Rolling(speed, radius, *oil, **known)
    laws: dict[str, sym.ThicknessLaw] = {
        "equation-5": sym.RegressionThickness(rolling),
        "constant-one-body": sym.ConstantThickness(rolling),
        "constant-two-body": sym.ConstantThickness(rolling, sym.Compliance.TWO_BODY),
        "hamrock-dowson": sym.HamrockDowsonThickness(rolling),
    }
    return laws[film.thickness]


def oscillator_model(scene: OscillatorScene) -> sym.Model:
    """Return the forced oscillator; its parameter `Omega` is the angular frequency of the force."""
    part = scene.oscillator
    x = sym.coordinate("x", scale=static_deflection(part))
    parts: list[sym.Part] = [
        sym.Mass(x, part.mass),
        sym.Spring(x, part.stiffness),
        sym.HarmonicForce(x, part.force, scene.trace.from_frequency),
    ]
    if part.damping is not None:
        parts.append(sym.Damper(x, part.damping))
    if part.cubic is not None:
        parts.append(sym.CubicSpring(x, part.cubic))
    return sym.combine(parts)


def static_deflection(part: Oscillator) -> float:
    """Return about what the force bends the springs by when it is steady: the scale of x."""
    linear = part.force / part.stiffness if part.stiffness else math.inf
    cubic = (part.force / abs(part.cubic)) ** (1 / 3) if part.cubic else math.inf
    return min(linear, cubic)
