"""From a scene to the compiled system of its equations: each table of the scene becomes its parts."""

from __future__ import annotations

import math
import os

from symbolic.equations.model import Model, Part, combine
from symbolic.equations.variables import Coordinate, Parameter, coordinate, parameter
from symbolic.kernels.choice import VARIABLE, Kernels, chosen
from symbolic.kernels.native import CompilerError
from symbolic.parts.contact.excitation import Waviness
from symbolic.parts.contact.law import ContactLaw, deflection_under
from symbolic.parts.contact.loads import ContactDamping, ElasticContact, Preload
from symbolic.parts.contact.pair import ContactPair
from symbolic.parts.films.cavitating import CavitatingFilm
from symbolic.parts.films.flattening import (
    AmplitudeReduction,
    FlattenedWaviness,
    LineReduction,
    PointReduction,
)
from symbolic.parts.films.law import FilmLaw
from symbolic.parts.films.line import LineFilm
from symbolic.parts.films.lubricated import LubricantFilm
from symbolic.parts.films.quasistatic import QuasistaticFilm
from symbolic.parts.films.regimes import RegimeFilm
from symbolic.parts.films.regressions import (
    Compliance,
    ConstantThickness,
    HamrockDowsonThickness,
    RegressionThickness,
    Rolling,
)
from symbolic.parts.films.squeeze import SqueezeFilm
from symbolic.parts.films.thickness import CalibratedThickness, SteadyThickness, ThicknessLaw
from symbolic.parts.films.thirdorder import ThirdOrder
from symbolic.parts.mechanics.forces import HarmonicForce
from symbolic.parts.mechanics.inertia import Mass, ReducedMass
from symbolic.parts.mechanics.springs import Coupling, CubicSpring, Damper, Spring, Support
from symbolic.scenes.axes import RPM
from symbolic.scenes.errors import InputError, listed, refused, shown
from symbolic.scenes.laws import HERTZ, PALMGREN, contact_laws
from symbolic.scenes.model.scene import ModelScene, refusing
from symbolic.scenes.schema import AnyContact, DiscScene, Film, Oscillator, OscillatorScene, Scene
from symbolic.system.compile import compile
from symbolic.system.compiled import CompiledSystem


def build(scene: Scene, *, condense: bool = True) -> CompiledSystem:
    """Return the system of a scene. Its states, unknowns and outputs are those that its parts need.

    condense: whether structures are condensed to their places, or keep all that small motion needs. Raises
    InputError where the environment asks for kernels that cannot be, and for numbers that the model refuses.
    """
    if isinstance(scene, ModelScene):
        return scene.system(_kernels(), condense=condense)
    with refusing():
        model = disc_model(scene) if isinstance(scene, DiscScene) else oscillator_model(scene)
        return compile(model, _kernels())


def _kernels() -> Kernels:
    """The environment's choice of a back end."""
    given = os.environ.get(VARIABLE)
    try:
        return chosen(given)
    except CompilerError as error:
        why = " ".join(str(error).split())[:150]
        raise InputError(VARIABLE, f"is {shown(given)}", f"it needs a working C compiler ({why})") from None
    except ValueError:
        raise refused(VARIABLE, given, listed([shown(k.value) for k in Kernels])) from None


def disc_model(scene: DiscScene) -> Model:
    """Return two discs in rolling contact, x the sum of their outward displacements.

    m x'' = 2 (W - Q) for equal discs of mass m (Mehdigoli et al. 1990, eqs. 11 and 12); with a support see
    `inertia`. The parameter `speed` is the discs' in rad/s.
    """
    x = coordinate("x")
    pair = ContactPair(x)
    contact, waviness = scene.contact, scene.waviness
    speed = parameter("speed", scene.trace.from_rpm * RPM, "rad/s")
    parts: list[Part] = [
        *inertia(scene, x),
        Preload(pair, contact.preload),
        ElasticContact(pair, contact_law(contact)),
        Waviness(pair, waviness.amplitude, waviness.waves, speed),
    ]
    if scene.film is not None:
        parts.append(film_part(scene, pair, speed))
        if waviness.reduction:
            law = amplitude_reduction(scene, scene.film, speed)
            parts.append(FlattenedWaviness(pair, law, scene.discs.diameter / 2, waviness.waves))
    if scene.damping is not None:
        parts.append(ContactDamping(pair, scene.damping.ratio))
    model = combine(parts)
    if scene.film is not None and scene.film.law == "third-order":
        return Model((ThirdOrder(model),))
    return model


def inertia(scene: DiscScene, x: Coordinate) -> list[Part]:
    """Return the masses that move with x, and what a support puts behind them.

    Rigid: the whole mass m of each side moves with x. With a support the share f m moves with x, the rest
    with y, the sum of the housings' displacements; each disc is joined to its housing by k and c, each
    housing to ground by k_l. With W - Q on every disc and mu = m/2, the two sides add up to

        f mu x'' = W - Q - (k (x - y) + c (x' - y'))/2,   (1 - f) mu y'' = (k (x - y) + c (x' - y') - k_l y)/2
    """
    support, total = scene.support, scene.discs.mass
    if support is None:
        mass = parameter("mass", total, "kg")
        return [ReducedMass(x, mass, mass)]
    disc = parameter("disc_mass", support.disc_share * total, "kg")
    housing = parameter("housing_mass", (1 - support.disc_share) * total, "kg")
    y = coordinate("y", scale=deflection_under(contact_law(scene.contact), scene.contact.preload))
    stiffness = parameter("bearing_stiffness", support.stiffness, "N/m")
    damping = parameter("bearing_damping", support.damping, "N s/m")
    parts: list[Part] = [
        ReducedMass(x, disc, disc),
        ReducedMass(y, housing, housing),
        Coupling(x, y, stiffness, damping, in_series=2),
    ]
    if support.leaf is not None:
        parts.append(Support(y, parameter("leaf_stiffness", support.leaf, "N/m"), in_series=2))
    return parts


def contact_law(contact: AnyContact) -> ContactLaw:
    """Return the law of contact that a scene names, with its numbers."""
    return contact_laws()[contact.law or HERTZ](**contact.numbers)


def film_part(scene: DiscScene, pair: ContactPair, speed: Parameter) -> Part:
    """Return the film between the discs."""
    film, radius = scene.film, scene.discs.diameter / 2
    assert film is not None
    law = film_law(scene, film, speed)
    if film.law == "squeeze" and film.squeeze is not None and law is not None:
        return LubricantFilm(pair, law, speed, radius, film.squeeze / film.beta)
    steady = thickness_law(scene, film, speed) if law is None else SteadyThickness(law)
    if film.squeeze is None:
        return QuasistaticFilm(pair, steady, film.beta)
    if film.floor is not None:
        return CavitatingFilm(pair, steady, speed, radius, film.beta, film.squeeze, film.floor)
    return SqueezeFilm(pair, steady, speed, radius, film.beta, film.squeeze)


def film_law(scene: DiscScene, film: Film, speed: Parameter) -> FilmLaw | None:
    """Return the law of the film at any load, where the scene names one."""
    if film.thickness == "regimes":
        return RegimeFilm(rolling_of(scene, film, speed))
    if film.thickness == "line":
        return LineFilm(rolling_of(scene, film, speed), scene.contact.numbers["length"])
    return None


def thickness_law(scene: DiscScene, film: Film, speed: Parameter) -> ThicknessLaw:
    """Return the law of the steady film thickness that a scene names."""
    if film.thickness == "calibrated":
        radius = scene.discs.diameter / 2
        return CalibratedThickness(speed, radius, film.viscosity, film.piezoviscosity)
    rolling = rolling_of(scene, film, speed)
    laws: dict[str, ThicknessLaw] = {
        "equation-5": RegressionThickness(rolling),
        "constant-one-body": ConstantThickness(rolling),
        "constant-two-body": ConstantThickness(rolling, Compliance.TWO_BODY),
        "hamrock-dowson": HamrockDowsonThickness(rolling),
    }
    return laws[film.thickness]


def amplitude_reduction(scene: DiscScene, film: Film, speed: Parameter) -> AmplitudeReduction:
    """Return what decides how much of the waviness the film keeps."""
    rolling = rolling_of(scene, film, speed)
    if scene.contact.law == PALMGREN:
        return LineReduction(rolling, scene.contact.numbers["length"])
    return PointReduction(rolling)


def rolling_of(scene: DiscScene, film: Film, speed: Parameter) -> Rolling:
    """Return the discs and their lubricant."""
    discs = scene.discs
    given = {"crown": discs.crown, "modulus": discs.modulus, "poisson": discs.poisson}
    known = {name: value for name, value in given.items() if value is not None}
    return Rolling(speed, discs.diameter / 2, film.viscosity, film.piezoviscosity, **known)


def oscillator_model(scene: OscillatorScene) -> Model:
    """Return the forced oscillator; its parameter `Omega` is the angular frequency of the force."""
    part = scene.oscillator
    x = coordinate("x", scale=static_deflection(part))
    parts: list[Part] = [
        Mass(x, part.mass),
        Spring(x, part.stiffness),
        HarmonicForce(x, part.force, scene.trace.from_frequency),
    ]
    if part.damping is not None:
        parts.append(Damper(x, part.damping))
    if part.cubic is not None:
        parts.append(CubicSpring(x, part.cubic))
    return combine(parts)


def static_deflection(part: Oscillator) -> float:
    """Return the approximate deflection under the steady force: the scale of x."""
    linear = part.force / part.stiffness if part.stiffness else math.inf
    cubic = (part.force / abs(part.cubic)) ** (1 / 3) if part.cubic else math.inf
    return min(linear, cubic)
