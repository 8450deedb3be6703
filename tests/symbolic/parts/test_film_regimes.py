"""Films of any law: the four regimes, lines, squeeze of any law, what a film leaves of a waviness."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym


def joined(m: float, l_: float, d: float = 1.0) -> float:
    """Nijenbanning, Venner and Moes' formula, written out once more."""
    ri = 145 * (1 + 0.796 * d ** (14 / 15)) ** (-15 / 7) / d / m**2
    b = 1 + 0.006 * math.log(d) + 0.63 * d ** (4 / 7)
    ei = 3.18 * b ** (-14 / 25) * d ** (-1 / 15) * m ** (-2 / 15)
    ep = 1.48 * b ** (-7 / 20) * d ** (-1 / 24) * m ** (-1 / 12) * l_**0.75
    rp = 1.29 * (1 + 0.691 * d) ** (-2 / 3) * l_ ** (2 / 3)
    s = 1.5 * (1 + math.exp(-1.2 * ei / ri))
    isoviscous = (ri**1.5 + (ei**-4 + (1.8 / d) ** -4) ** (-3 / 8)) ** (2 * s / 3)
    return float((isoviscous + (rp**-8 + ep**-8) ** (-s / 8)) ** (1 / s))


@pytest.mark.parametrize(("m", "l_", "d"), [(100, 10, 1), (5, 2, 1), (1e-3, 1, 0.3), (3000, 20, 0.25)])
def test_film_is_that_of_the_formula(m: float, l_: float, d: float) -> None:
    """Assert H to rounding."""
    assert sym.films.film_regime(m, l_, d).thickness == pytest.approx(joined(m, l_, d), rel=1e-12)


@pytest.mark.parametrize(
    ("m", "l_", "name"),
    [
        (1e-2, 1e-3, "isoviscous-rigid"),
        (1e6, 1e-3, "isoviscous-elastic"),
        (60.0, 0.2e3, "piezoviscous-rigid"),
        (1e7, 1e3, "piezoviscous-elastic"),
    ],
)
def test_film_tends_to_each_regime(m: float, l_: float, name: str) -> None:
    """Assert the name, and that H is the asymptote of its regime far inside it."""
    found = sym.films.film_regime(m, l_)
    assert found.name == name
    assert found.thickness == pytest.approx(found.asymptotes[name], rel=0.08)


ROLLING = sym.films.Rolling(speed=37.7, radius=0.051, viscosity=0.89, piezoviscosity=25.9e-9)


def thickness(law: sym.films.FilmLaw, load: float) -> float:
    """h of a law under a load, in m."""
    assembly = sym.Assembly()
    return assembly.nominal(law.thickness(assembly, assembly.parameter(load, "W")))


def test_regime_of_the_papers_disc() -> None:
    """Assert film and Moes' numbers at 360 rev/min, 810 N, of numbers put in by hand."""
    e = 207e9 / (1 - 0.3**2)
    u = 0.89 * 2 * 37.7 * 0.051 / (e * 0.0255)
    m, l_ = 810 / (e * 0.0255**2) * u**-0.75, 25.9e-9 * e * u**0.25
    found = sym.films.RegimeFilm(ROLLING).regime(810.0)
    assert found.name == "piezoviscous-rigid"
    assert found.thickness == pytest.approx(joined(m, l_, 0.25), rel=1e-12)
    film = found.thickness * 0.0255 * u**0.5
    assert thickness(sym.films.RegimeFilm(ROLLING), 810.0) == pytest.approx(film, rel=1e-12)
    assert 6e-6 < film < 8e-6  # central; the paper prints 3.85 um, the minimum of Hamrock and Dowson is 4.26


def test_line_film() -> None:
    """Assert Dowson and Toyoda's formula by hand, and Palmgren's deflection of 810 N on 10 mm."""
    e = 207e9 / (1 - 0.3**2)
    film = 3.06 * 0.0255 * (0.89 * 37.7 * 0.051 / (e * 0.0255)) ** 0.69
    film *= (25.9e-9 * e) ** 0.56 * (810 / (e * 0.0255 * 0.01)) ** -0.10
    assert thickness(sym.films.LineFilm(ROLLING, 0.01), 810.0) == pytest.approx(film, rel=1e-12)
    assembly = sym.Assembly()
    law = sym.PalmgrenLaw(0.01)
    deflection = assembly.nominal(law.preloaded(assembly, assembly.parameter(810.0, "Q")).delta0)
    # Harris: delta = 3.84e-5 W^0.9/l^0.8 in N and mm.
    assert deflection == pytest.approx(3.84e-8 * 810**0.9 / 10**0.8, rel=2e-3)
    assert assembly.nominal(law.load(assembly, assembly.parameter(deflection, "d"))) == pytest.approx(810)


def disc(film: sym.Part, *more: sym.Part, pair: sym.ContactPair, x: sym.Coordinate) -> sym.CompiledSystem:
    """The paper's disc with a film."""
    parts = [
        sym.ReducedMass(x, 20.4, 20.4),
        sym.Preload(pair, 810.0),
        sym.Hertz(pair, 28e9),
        sym.Waviness(pair, 1.27e-6, 120, SPEED),
    ]
    return sym.compile(sym.combine([*parts, film, *more]))


SPEED = sym.parameter("speed", 37.7, "rad/s")
RPM = 2 * math.pi / 60


def test_power_law_is_the_squeeze_film() -> None:
    """Assert the same branch of the disc through loss of contact, to 1e-8, from either part."""
    branches = []
    for general in (False, True):
        x = sym.coordinate("x")
        pair = sym.ContactPair(x)
        film: sym.Part = sym.SqueezeFilm(pair, sym.films.GivenThickness(3.85e-6), SPEED, 0.051, 20.0, 2460.0)
        if general:
            film = sym.LubricantFilm(pair, sym.films.PowerFilm(3.85e-6, 810.0, 20.0), SPEED, 0.051, 123.0)
        system = disc(film, pair=pair, x=x)
        branches.append(
            per.trace(system, "speed", (230 * RPM, 400 * RPM), start=400 * RPM, at=[300 * RPM, 280 * RPM])
        )
    folds = [branch.labelled("LP")[0] for branch in branches]
    assert folds[0].parameter == pytest.approx(folds[1].parameter, rel=1e-12)
    for rpm in (300, 280):
        a, b = (next(p for p in branch if p.parameter == rpm * RPM) for branch in branches)
        assert a.peak_to_peak("x") == pytest.approx(b.peak_to_peak("x"), rel=1e-12)
        largest = [np.abs(p.multipliers).max() for p in (a, b)]
        assert largest[0] == pytest.approx(largest[1], rel=1e-11)


def ripple(load: float, rolling_speed: float) -> float:
    """What the film of the line contact below keeps of its waviness, by hand."""
    e, length, radius = 207e9 / (1 - 0.3**2), 0.01, 0.0255
    u = 0.89 * 2 * rolling_speed / (e * radius)
    m, l_ = load / (e * radius * length) / u**0.5, 25.9e-9 * e * u**0.25
    half_width = math.sqrt(8 * load * radius / (math.pi * e * length))
    n = 2 * math.pi * 0.051 / 120 / half_width * m**0.75 / l_**0.5
    return 1 / (1 + 0.125 * n + 0.04 * n**2)


@pytest.mark.parametrize("reduction", [False, True])
def test_line_contact_closes_in_time(reduction: bool) -> None:
    """Assert that SciPy's Radau on equations written out here leads orbits back to their start, to 1e-6."""
    system = sym.scene("line-contact-810N", {"reduction": "true"} if reduction else None)
    places = [RPM * rpm for rpm in (850, 700, 580, 450, 300)]
    branch = per.trace(system, "speed", (290 * RPM, 900 * RPM), start=900 * RPM, at=places, tol=1e-8)
    found = branch.labelled(per.Label.USER)
    assert {point.parameter for point in found} == set(places)
    for point in found:
        assert point.orbit is not None
        closes_in_time(point.parameter, point.orbit, reduction)


def closes_in_time(speed: float, orbit: per.Orbit, reduction: bool) -> None:
    """Assert that an orbit of the line contact comes back to its start."""
    omega, u, mass, q = 120 * speed, 0.051 * speed, 20.4, 810.0
    stiffness = 8.06e10 * 0.01 ** (8 / 9)
    delta0, h0 = (q / stiffness) ** 0.9, thickness(sym.films.LineFilm(rolling(speed), 0.01), q)
    height = 1.27e-6 * (1 - (ripple(q, u) if reduction else 0.0))

    def rates(t: float, y: Any) -> list[float]:
        delta = delta0 + y[2] - h0 + height * math.sin(omega * t) - y[0]
        load = stiffness * delta ** (10 / 9)
        film = math.log(h0 * (load / q) ** -0.10 / y[2])
        return [y[1], 2 * (load - q) / mass, u / 96.775 * film]

    begin = [float(orbit[name](0.0)) for name in ("x", "x'", "h")]
    period = 2 * math.pi / omega
    end = solve_ivp(rates, (0, period), begin, method="Radau", rtol=1e-10, atol=1e-16).y[:, -1]
    size = np.array([delta0, omega * delta0, delta0])
    np.testing.assert_allclose((end - begin) / size, 0, atol=1e-6)


def rolling(speed: float) -> sym.films.Rolling:
    """The paper's discs and oil at a speed in rad/s."""
    return sym.films.Rolling(speed=speed, radius=0.051, viscosity=0.89, piezoviscosity=25.9e-9)


def test_circular_reduction() -> None:
    """Assert A_d/A_i of a circular contact by hand, Hertz' a = (3 W r/(2 E'))^(1/3) of r = R_x to 0.2 %."""
    wavy = sym.films.PointReduction(sym.films.Rolling(37.7, 0.051, 0.89, 25.9e-9, crown=0.0255))
    assembly = sym.Assembly()
    wave = assembly.parameter(2.67e-3, "wavelength", "m")
    found = assembly.nominal(wavy.ripple(assembly, assembly.parameter(810.0, "W"), wave))
    e = 207e9 / (1 - 0.3**2)
    u = 0.89 * 2 * 37.7 * 0.051 / (e * 0.0255)
    m, l_ = 810 / (e * 0.0255**2) * u**-0.75, 25.9e-9 * e * u**0.25
    n = 2.67e-3 / (3 * 810 * 0.0255 / (2 * e)) ** (1 / 3) * math.sqrt(m / l_)
    assert found == pytest.approx(1 / (1 + 0.15 * n + 0.015 * n**2), rel=5e-3)


def test_hunt_crossley_stop() -> None:
    """Assert a rebounding orbit against SciPy's DOP853 on its own equations, to 1e-6."""
    x = sym.coordinate("x")
    model = sym.combine(
        [
            sym.Mass(x, 1.0),
            sym.Spring(x, 1.0),
            sym.Damper(x, 0.05),
            sym.HarmonicForce(x, 0.5, 0.8),
            sym.HuntCrossleyStop(x, sym.HertzLaw(20.0, 1.5), gap=0.5, dissipation=0.4),
        ]
    )
    branch = per.trace(sym.compile(model), "Omega", (0.8, 0.82), start=0.8, tol=1e-7)
    orbit = branch[0].orbit
    assert orbit is not None

    def rates(t: float, y: Any) -> list[float]:
        stop = 20 * max(y[0] - 0.5, 0) ** 1.5 * (1 + 0.4 * y[1])
        return [y[1], 0.5 * math.cos(0.8 * t) - 0.05 * y[1] - y[0] - stop]

    begin = [float(orbit[name](0.0)) for name in ("x", "x'")]
    end = solve_ivp(rates, (0, 2 * math.pi / 0.8), begin, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    np.testing.assert_allclose(end, begin, atol=1e-6)
    assert orbit["x"](np.linspace(0, 2 * math.pi, 200)).max() > 0.55


def test_what_makes_no_film_is_refused() -> None:
    """Assert one sentence for each."""
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    film = sym.LubricantFilm(pair, sym.films.PowerFilm(3.85e-6, 810.0), SPEED, 0.051, 0.0)
    with pytest.raises(ValueError, match="^squeeze is 0; it must be a positive number$"):
        disc(film, pair=pair, x=x)
    number: object = 100.0
    with pytest.raises(ValueError, match="^law is 100.0; it must be a ContactLaw, as HertzLaw"):
        sym.Stop(x, number)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="^below is 'no'; it must be True or False$"):
        sym.OneSidedSpring(x, 1.0, below="no")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="^M is -1; it must be a positive number$"):
        sym.films.film_regime(-1, 1)
    changes: list[tuple[str, dict[str, str | float | None], str]] = [
        (
            "vitrea79-810N",
            {"film.thickness": "line"},
            '^film.thickness is "line"; only contact.law = "palmgren"',
        ),
        (
            "dry-810N",
            {"waviness.reduction": "true"},
            "^waviness.reduction is true; only a scene with a film may",
        ),
        (
            "line-contact-810N",
            {"contact.length": -1},
            "^contact.length is -1; it must be a number from 1e-05 to",
        ),
        ("line-contact-810N", {"contact.stiffness": 1e9}, '^key is "contact.stiffness"; it must be one of '),
    ]
    for name, change, said in changes:
        with pytest.raises(sym.InputError, match=said):
            sym.scene(name, change)
