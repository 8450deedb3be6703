"""From a scene to the compiled system of its equations: each table of the scene becomes its parts."""

from __future__ import annotations

import math

import symbolic as sym
from reports.schema import DiscScene, Film, Oscillator, OscillatorScene, Scene
from reports.view import RPM


def build(scene: Scene) -> sym.CompiledSystem:
    """Return the system of a scene. Its states, unknowns and outputs are those that its parts need."""
    model = disc_model(scene) if isinstance(scene, DiscScene) else oscillator_model(scene)
    return sym.compile(model)


def disc_model(scene: DiscScene) -> sym.Model:
    """Return two discs in rolling contact, x the sum of their outward displacements.

    m x'' = 2 (W - Q) for equal discs of mass m (Mehdigoli et al. 1990, eqs. 11 and 12). The parameter
    `speed` is the discs' in rad/s.
    """
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    contact, waviness = scene.contact, scene.waviness
    speed = sym.parameter("speed", scene.trace.from_rpm * RPM, "rad/s")
    mass = sym.parameter("mass", scene.discs.mass, "kg")
    parts: list[sym.Part] = [
        sym.ReducedMass(x, mass, mass),
        sym.Preload(pair, contact.preload),
        sym.Hertz(pair, contact.stiffness, contact.exponent),
        sym.Waviness(pair, waviness.amplitude, waviness.waves, speed),
    ]
    if scene.film is not None:
        parts.append(film_part(scene.film, pair, speed, scene.discs.diameter / 2))
    if scene.damping is not None:
        parts.append(sym.ContactDamping(pair, scene.damping.ratio))
    return sym.combine(parts)


def film_part(film: Film, pair: sym.ContactPair, speed: sym.Parameter, radius: float) -> sym.Part:
    """Return the film between the discs, its steady thickness calibrated to the paper's own point."""
    law = sym.CalibratedThickness(speed, radius, film.viscosity, film.piezoviscosity)
    if film.squeeze is None:
        return sym.QuasistaticFilm(pair, law, film.beta)
    return sym.SqueezeFilm(pair, law, speed, radius, film.beta, film.squeeze)


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
