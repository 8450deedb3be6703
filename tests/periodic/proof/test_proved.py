"""Orbits, folds and doublings that are proven, against the engine, known numbers and DOP853."""

from __future__ import annotations

import copy
import json
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from support.kept import kept

import periodic as per
import symbolic as sym

pytest.importorskip("flint")

from periodic.proof import check  # noqa: E402 - needs python-flint


@kept
def duffing() -> per.Branch:
    """The branch of the scene, over its folds."""
    return per.trace(sym.scene("duffing"), "Omega", (0.3, 3.0), at=[2.0])


@kept
def gear() -> per.Branch:
    """Gear pair that loses contact, over its folds, at which the teeth part."""
    return per.trace(sym.scene("gear-pair"), "Omega", (0.55, 1.4), start=1.4)


@kept
def stop() -> per.Proof:
    """Oscillator before an elastic stop that it strikes."""
    system = sym.scene("stop")
    (first, *_) = per.trace(system, "Omega", (0.8, 1.6), at=[1.1]).at(Omega=1.1)
    return per.proved(system, first)


def agrees(proof: per.Proof, point: per.Point) -> None:
    """Assert that a computed point is where its proof says, within what it claims."""
    assert proof, proof.reason
    assert proof.radius < 1e-9
    assert proof.distance <= 10 * max(point.error.orbit, 1e-12)
    for disc in proof.multipliers:
        assert np.abs(point.multipliers - disc.centre).min() <= disc.radius + 1e-6
    assert proof.stable in (None, point.stable)
    for name in proof.maximum:
        low, high = proof.peak_to_peak(name)
        assert low <= high
        assert point.peak_to_peak(name) == pytest.approx((low + high) / 2, rel=1e-6)


def test_duffing_on_three_sheets() -> None:
    """Assert that three orbits at one frequency are proven, the middle one unstable."""
    points = duffing().at(Omega=2.0)
    proofs = [per.proved(sym.scene("duffing"), point) for point in points]
    assert [proof.stable for proof in proofs] == [True, False, True]
    for proof, point in zip(proofs, points, strict=True):
        agrees(proof, point)
    assert check.ctx.prec == 53  # python-flint's default, which others in this process may count on


def test_an_orbit_agrees_with_dop853() -> None:
    """Assert that DOP853 from the proven initial state closes to its own tolerance."""
    system = sym.scene("duffing")
    point = duffing().at(Omega=2.0)[0]
    proof = per.proved(system, point)
    centre = [float(check.arb(check.ratio(c))) for c in proof.certificate["nodes"][0]["centre"]]

    def rates(tau: float, x: np.ndarray) -> np.ndarray:
        """x' = f, by the compiled residual R = x' - f up to a factor."""
        zero, state = np.zeros((1, 2)), x[None]
        at = (state, np.zeros((1, 0)), np.array([tau]), point.orbit.parameter)
        rows = system.linearise(zero, *at)
        return np.linalg.solve(rows.d_rate[0], -rows.residual[0])

    end = solve_ivp(rates, (0, 2 * np.pi), centre, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    assert end == pytest.approx(centre, abs=1e-11)


def test_folds_of_duffing() -> None:
    """Assert that both folds are proven, to 14 digits, where the engine has them to 9."""
    folds = duffing().labelled(per.Label.FOLD)
    for point in folds:
        proof = per.proved(sym.scene("duffing"), point, "Omega")
        assert proof, proof.reason
        low, high = proof.parameter or (0.0, 0.0)
        assert low < high < low + 1e-14
        assert point.parameter == pytest.approx(low, rel=1e-9)
        said = r"in boxes of half width \S+ at the most there is one fold, and one only, Omega = \[(\S+) .*"
        assert (found := re.fullmatch(said, proof.says)) and low <= float(found[1]) <= high


def test_folds_of_a_gear_pair_that_loses_contact() -> None:
    """Assert that both folds are proven across the events at which teeth part and meet."""
    folds = gear().labelled(per.Label.FOLD)
    assert len(folds) == 2
    for point in folds:
        proof = per.proved(sym.scene("gear-pair"), point, "Omega")
        assert proof, proof.reason
        assert len(proof.certificate["pieces"]) == 3
        assert point.parameter == pytest.approx((proof.parameter or (0.0,))[0], rel=1e-9)


def test_doubling() -> None:
    """Assert that a doubling of a parametric oscillator, forced a little, is proven where it is found."""
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {
                "x": x.v,
                "v": -0.1 * x.v - (1 + 0.9 * wave.cos) * x.x - x.x**3 + 0.2 * wave.sin,
            },
            states={"x": 0.0, "v": 0.0},
            parameters={"Omega": 2.4},
            frequency="Omega",
        )
    )
    found = per.trace(system, "Omega", (1.4, 3.0), start=3.0).labelled(per.Label.DOUBLING)
    assert found
    proof = per.proved(system, found[0], "Omega")
    assert proof, proof.reason
    assert found[0].parameter == pytest.approx((proof.parameter or (0.0,))[0], rel=1e-8)


def test_a_contact_lost() -> None:
    """Assert that the gear pair's orbits are proven with and without loss of contact, with their events."""
    for value, counts in ((1.3, {1}), (0.7, {1, 3})):
        found = set()
        for point in gear().at(Omega=value):
            proof = per.proved(sym.scene("gear-pair"), point)
            agrees(proof, point)
            found.add(len(proof.certificate["pieces"]))
        assert found == counts


def test_a_hertzian_contact_lost() -> None:
    """Assert that the dry disc of 1990 is proven as it leaves the ground, where d^2F/dx^2 has no bound."""
    system = sym.scene("dry-810N")
    branch = per.trace(system, "speed", (15.0, 50.0))
    lost = [point for point in branch if 20 < point.parameter < 25 and point.minimum["deflection"] <= 0]
    point = lost[len(lost) // 2]
    proof = per.proved(system, point)
    agrees(proof, point)
    assert len(proof.certificate["pieces"]) == 3


def rubbing(friction: float) -> tuple[sym.CompiledSystem, per.Point]:
    """A mass under dry friction, forced."""
    x = sym.coordinate("x")
    excited = sym.HarmonicForce(x, force=1.0, frequency=sym.parameter("Omega", 1.3))
    parts = [
        sym.Mass(x, 1.0),
        sym.Damper(x, 0.1),
        sym.Spring(x, 1.0),
        sym.CoulombFriction(x, friction),
        excited,
    ]
    system = sym.compile(sym.combine(parts))
    return system, per.trace(system, "Omega", (1.2, 1.4))[0]


def test_dry_friction() -> None:
    """Assert that a mass that slips is proven, across jumps of its force, and one that sticks is not."""
    system, point = rubbing(0.3)
    proof = per.proved(system, point)
    agrees(proof, point)
    assert len(proof.certificate["pieces"]) == 3
    assert min(abs(point.multipliers[0] - disc.centre) for disc in proof.multipliers) < 1e-8
    system, point = rubbing(0.9)
    assert not per.proved(system, point)


def test_the_disc_of_1990() -> None:
    """Assert that its orbit in oil, whose film force is an unknown of the equations, is proven."""
    system = sym.scene("vitrea79-810N")
    point = per.trace(system, "speed", (52.0, 54.0))[0]
    proof = per.proved(system, point)
    agrees(proof, point)
    assert proof.certificate["equations"]["constraint"]


def test_impacts() -> None:
    """Assert that an oscillator that strikes a rigid wall is proven, and no motion that passes the wall."""
    system = sym.scene("impact-oscillator")
    point = per.trace(system, "A", (0.8, 1.0), start=1.0)[0]
    proof = per.proved(system, point)
    agrees(proof, point)
    assert len(proof.certificate["pieces"]) == 2
    for disc in proof.multipliers:
        assert np.abs(point.multipliers - disc.centre).min() < 1e-7
    given = copy.deepcopy(proof.certificate)
    (wall,) = given["equations"]["resets"]
    given["pieces"][0]["sides"][wall] = -1
    with pytest.raises(check.NotProvedError, match="a motion is behind a wall"):
        check.Orbit(given)
    given = copy.deepcopy(proof.certificate)
    given["equations"]["lines"].append(given["equations"]["lines"][-1].replace(wall, "again"))
    given["pieces"][0]["until"] = "again"
    for piece in given["pieces"]:
        piece["sides"]["again"] = 1
    with pytest.raises(check.NotProvedError, match="an impact is left out"):
        check.Orbit(given)
    given = copy.deepcopy(proof.certificate)
    given["equations"]["resets"][wall][0] = given["equations"]["resets"][wall][1]
    with pytest.raises(check.NotProvedError, match="an impact moves its own wall"):
        check.Orbit(given)


def accepted(given: dict[str, Any], path: Path) -> bool:
    """Whether the checker accepts a certificate, given a digest of its own."""
    path.write_text(json.dumps({**given, "digest": check.digest(given)}), "utf-8")
    return check.main(str(path)) == 0


def test_a_stretch(tmp_path: Path) -> None:
    """Assert that a sheet has no fold in a range, for the checker too, which lets no gap or jump pass."""
    system, path = sym.scene("duffing"), tmp_path / "proof.json"
    low = duffing().at(Omega=2.0)[2]
    proof = per.proved(system, low, "Omega", (1.9, 2.1))
    assert proof and proof.parameter == (1.9, 2.1) and proof.stable is not False
    assert "one branch without a fold" in proof.says
    proof.save(path)
    assert checked(path) == (0, f"proved: {proof.says}\n")
    given = proof.certificate
    tiles = given["tiles"]
    assert accepted(given, path) and len(tiles) > 2
    assert not accepted({**given, "tiles": [tiles[0], *tiles[2:]]}, path)
    moved = copy.deepcopy(tiles[1])
    moved["nodes"][0]["centre"][0] = "0/1"
    assert not accepted({**given, "tiles": [tiles[0], moved, *tiles[2:]]}, path)
    other = {**tiles[0], "equations": given["equations"]}
    assert not accepted({**given, "tiles": [other, *tiles[1:]]}, path)
    state = copy.deepcopy(tiles[0])
    state["anchors"][-1][0] = "x0"
    assert not accepted({**given, "tiles": [state]}, path)
    name = tiles[0]["anchors"][-1][0]
    constant = {**given["equations"], "values": {**given["equations"]["values"], name: "2.0"}}
    assert not accepted({**given, "equations": constant}, path)
    one = {**given, **tiles[0], "claim": "orbit"}
    assert not accepted(one, path)


def test_a_stretch_of_motions_with_events() -> None:
    """Assert a range in which teeth part and meet, for the unstable motion between two stable ones."""
    point = gear().at(Omega=0.7)[1]
    proof = per.proved(sym.scene("gear-pair"), point, "Omega", (0.6995, 0.7005))
    assert proof, proof.reason
    assert all(len(tile["pieces"]) == 3 for tile in proof.certificate["tiles"])


def test_a_stretch_ends_before_a_fold() -> None:
    """Assert that what is proven ends less than a hundredth of the range before the fold, and says so."""
    fold = duffing().labelled(per.Label.FOLD)[1].parameter
    point = duffing().at(Omega=1.44)[1]
    proof = per.proved(sym.scene("duffing"), point, "Omega", (1.438, 1.4405))
    assert not proof and proof.certificate
    low, high = proof.parameter or (0.0, 0.0)
    assert fold < low < fold + 2.5e-5 and high == 1.4405
    assert proof.reason.startswith(f"proven from {low:.10g} to 1.4405 only; below {low:.10g}: ")


def test_rest_is_no_fold(tmp_path: Path) -> None:
    """Assert that linearised equations whose only solution is rest make no fold of an orbit."""
    given = copy.deepcopy(per.proved(sym.scene("duffing"), duffing().at(Omega=2.0)[2]).certificate)
    (name,) = [p for p, said in given["names"]["values"].items() if said == "Omega"]
    value = given["equations"]["values"].pop(name)
    exact = str(Fraction(float(value)))
    for node in given["nodes"]:
        node["centre"] += [exact if "/" in exact else f"{exact}/1", "0/1", "0/1"]
        node["radius"] += ["1/1000000000000000000000000"] * 3
        node["radius"] = ["1/1000000000000000"] * 2 + node["radius"][2:]
    given |= {"unknown": [name], "claim": "fold", "claims": {"outputs": {}}}
    given["anchors"] = [[name, 0, given["nodes"][0]["centre"][2]]]
    with pytest.raises(check.NotProvedError, match="nothing moves in the linearised equations"):
        check.Orbit(given).verify()


def roessler(t: float, y: np.ndarray) -> list[float]:
    """The rates of his equations."""
    return [-y[1] - y[2], y[0] + 0.2 * y[1], 0.2 + y[2] * (y[0] - 5.7)]


def test_roessler() -> None:
    """Assert the simple cycle of Rössler's equations, period 5.8810884555, unstable, from a sample of it."""
    system = sym.compile(
        sym.Equations(
            lambda x, p: {"x": -x.y - x.z, "y": x.x + 0.2 * x.y, "z": 0.2 + x.z * (x.x - 5.7)},
            states={"x": 0.0, "y": 0.0, "z": 0.0},
            parameters={},
        )
    )

    def missed(u: np.ndarray) -> np.ndarray:
        """How far a motion from the section y = 0 is from it after a time."""
        end = solve_ivp(roessler, (0, u[2]), [u[0], 0.0, u[1]], rtol=1e-9, atol=1e-10).y[:, -1]
        return end - [u[0], 0.0, u[1]]

    x, z, period = fsolve(missed, [-8.39, 0.03, 5.88])
    phase = np.linspace(0, 2 * np.pi, 401)
    times = phase * period / (2 * np.pi)
    state = solve_ivp(roessler, (0, period), [x, 0.0, z], t_eval=times, rtol=1e-9, atol=1e-10).y.T
    state[-1] = state[0]
    parameter = {"omega": 2 * np.pi / period}
    orbit = per.sampled(phase, state, np.zeros((len(phase), 0)), parameter, system=system)
    proof = per.proved(system, orbit)
    assert proof, proof.reason
    assert 2 * np.pi / (proof.parameter or (0.0,))[0] == pytest.approx(5.8810884555, abs=1e-10)
    assert proof.stable is False
    assert min(abs(disc.centre + 2.4039535318) for disc in proof.multipliers) < 1e-9


def test_multipliers_that_are_not_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that an orbit whose multipliers are not known is proven to be there, and no more is said."""

    def unknown(_: object) -> None:
        raise check.NotProvedError("the multipliers are too far apart")

    monkeypatch.setattr(check.Orbit, "multipliers", unknown)
    proof = per.proved(sym.scene("duffing"), duffing().at(Omega=2.0)[0])
    assert proof and proof.stable is None and not proof.multipliers
    assert proof.says.endswith("one periodic orbit, and one only")


def test_comparisons_of_one_place(tmp_path: Path) -> None:
    """Assert that |x| and max(x, 0), which change at one place, make one event of it."""
    fabs, fmax = sym.functions.fabs, sym.functions.fmax
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {
                "x": x.v,
                "v": wave.cos - x.x - 0.2 * x.v - 0.3 * fabs(x.x) - fmax(x.x, 0.0),
            },
            states={"x": 0.0, "v": 0.0},
            parameters={"Omega": 2.0},
            frequency="Omega",
        )
    )
    point = per.trace(system, "Omega", (1.9, 2.1))[0]
    proof = per.proved(system, point)
    agrees(proof, point)
    assert len(proof.certificate["pieces"]) == 3
    proof.save(tmp_path / "proof.json")
    assert checked(tmp_path / "proof.json") == (0, f"proved: {proof.says}\n")


def test_not_decided_beside_a_grazing() -> None:
    """Assert that an orbit that hardly touches is not proven, with a reason."""
    system = sym.scene("stop")
    (point, *_) = per.trace(system, "Omega", (0.8, 1.6)).labelled(per.Label.GRAZING)
    proof = per.proved(system, point)
    assert not proof
    assert proof.reason
    assert proof.stable is None


def test_not_decided_for_want_of_text() -> None:
    """Assert the reasons of systems whose equations have no text, and that they have no certificate."""
    system = sym.scene("jenkins-damper")
    proof = per.proved(system, per.trace(system, "Omega", (0.5, 0.55))[0])
    assert proof.reason == "the system has sliders or relays; they are not written as text"
    with pytest.raises(ValueError, match="there is no certificate: the system has sliders"):
        proof.save("nowhere.json")
    with pytest.raises(ValueError, match="output is 'y'; it must be one that has bounds, x"):
        stop().peak_to_peak("y")


@pytest.mark.parametrize(
    ("what", "parameter", "sentence"),
    [
        ("orbit", None, "what is a str; it must be an Orbit or a Point"),
        ("point", "omega", "parameter is 'omega'; it must be one of "),
        ("point", "Omega", "parameter is given; what must then be a point LP or PD of its branch"),
        ("stretch", None, "between is given; parameter must then say of what"),
        ("stretch", "Omega", "between is 5, 6; it must hold the point's Omega, "),
    ],
)
def test_refused(what: str, parameter: str | None, sentence: str) -> None:
    """Assert what is said of bad input."""
    given: Any = "orbit" if what == "orbit" else duffing()[0]
    between = (5.0, 6.0) if what == "stretch" else None
    with pytest.raises(ValueError, match=re.escape(sentence)):
        per.proved(sym.scene("duffing"), given, parameter, between)


def checked(path: Path) -> tuple[int, str]:
    """What a stranger sees who runs the checker, in an isolated interpreter."""
    run = subprocess.run(
        [sys.executable, "-I", check.__file__, str(path)], capture_output=True, text=True, check=False
    )
    return run.returncode, run.stdout + run.stderr


def test_a_stranger_checks(tmp_path: Path) -> None:
    """Assert that the checker, alone, accepts a certificate and refuses it with a letter changed."""
    path = tmp_path / "proof.json"
    stop().save(path)
    assert checked(path) == (0, f"proved: {stop().says}\n")
    path.write_text(path.read_text("utf-8").replace("stable", "unstable"), "utf-8")
    assert checked(path) == (1, "refused: the certificate was changed\n")
    path.write_text("{}", "utf-8")
    code, said = checked(path)
    assert code == 1 and said.startswith("refused: ") and "Traceback" not in said


def test_no_more_is_said_than_is_shown() -> None:
    """Assert that the checker says no stability that it has not checked, and lets no jump pass for none."""
    given = copy.deepcopy(stop().certificate)
    del given["claims"]["multipliers"]
    orbit = check.Orbit(given)
    orbit.verify()
    assert "stable" not in check.says(given, [orbit])
    lines = given["equations"]["lines"]
    lines[-1:] = ["w0 = sign(x0)", "w1 = x0 + w0", "w2 = max(w1, 0)", lines[-1]]
    for piece in given["pieces"]:
        piece["sides"] |= {"w0": 1, "w2": 1}
    given["pieces"][0]["until"] = "w2"
    with pytest.raises(check.NotProvedError, match="what vanishes at an event jumps there"):
        check.Orbit(given)
    given["claim"] = "fold"
    with pytest.raises(check.NotProvedError, match="the equations jump, and with them what must not"):
        check.Orbit(given)


def test_a_step_takes_no_point_beside_its_box() -> None:
    """Assert that the mean value theorem is not used about a point where the derivatives are not known."""
    orbit = check.Orbit(stop().certificate)
    step, box = orbit.steps[0][0], orbit.boxes[0]
    step.ends(orbit.centres[0], box)
    with pytest.raises(check.NotProvedError, match="a point is beside its box"):
        step.ends([a + 1 for a in orbit.centres[0]], box)


def test_a_forced_orbit_has_no_multiplier_that_is_left_out() -> None:
    """Assert that only equations without t have a multiplier 1 that tells nothing of the stability."""
    system = sym.scene("duffing")
    given = per.proved(system, duffing().at(Omega=2.0)[0]).certificate
    assert not check.Problem(given).free_running


def places(given: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where the numbers, texts and lists of a certificate are."""
    items = given.items() if isinstance(given, dict) else enumerate(given) if isinstance(given, list) else ()
    return [at, *(place for key, each in items for place in places(each, (*at, key)))]


def falsified(given: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    """A certificate that claims what is not so, or proves nothing, with a digest of its own."""
    new = copy.deepcopy(given)
    way = rng.integers(10)
    if way == 0:  # other equations
        values = new["equations"]["values"]
        name = rng.choice([n for n, v in values.items() if float(v) != 0])
        values[name] = repr(float(values[name]) * (1 + 10.0 ** -rng.integers(1, 8)))
    elif way == 1:
        lines = new["equations"]["lines"]
        k = int(rng.choice([k for k, line in enumerate(lines) if " * " in line or " - " in line]))
        lines[k] = lines[k].replace(" * ", " + ") if " * " in lines[k] else lines[k].replace(" - ", " + ")
    elif way == 2:  # another place
        node = new["nodes"][rng.integers(len(new["nodes"]))]
        i = int(rng.integers(2))
        centre, radius = (check.ratio(node[key][i]) for key in ("centre", "radius"))
        node["centre"][i] = str(centre + int(rng.integers(4, 1000)) * int(rng.choice([-1, 1])) * radius)
    elif way == 3:  # a multiplier elsewhere
        disc = new["claims"]["multipliers"][rng.integers(len(new["claims"]["multipliers"]))]
        disc[rng.integers(2)] = str(check.ratio(disc[0]) + int(rng.integers(2, 1000)) * check.ratio(disc[2]))
    elif way == 4:  # an output that goes further than is said, or not so far
        both = new["claims"]["outputs"][rng.choice(list(new["claims"]["outputs"]))]
        side = int(rng.integers(2))
        k, place, *ends = both[side]
        inner, outer = map(check.ratio, ends)
        wide = outer - inner
        ends = [inner - wide, inner] if rng.integers(2) else [outer, outer + wide]
        both[side] = [k, place, *map(str, ends)]
    elif way == 5:
        new["claims"]["stable"] = not new["claims"]["stable"]
    elif way == 6:  # events that are not
        piece = new["pieces"][rng.integers(len(new["pieces"]))]
        piece["sides"] = {name: -side for name, side in piece["sides"].items()}
    elif way == 7:  # not the whole period
        steps = new["pieces"][rng.integers(len(new["pieces"]))]["steps"]
        steps[rng.integers(len(steps))].pop()
    elif way == 8:  # time that runs backward, or longer
        new["turns"] = str(int(rng.choice([-1, 0, 2, 3])))
    else:  # a piece that runs backward
        node = new["nodes"][rng.integers(len(new["nodes"]))]
        node["centre"][-1] = "-" + node["centre"][-1]
    new["digest"] = check.digest(new)
    return new


def test_200_mutated_certificates_are_refused(tmp_path: Path) -> None:
    """Assert that changes are noticed: by the digest, and false claims also with a digest of their own."""
    given, rng, path = stop().certificate, np.random.default_rng(28), tmp_path / "proof.json"
    where = [place for place in places(given) if place and place != ("digest",)]
    for _ in range(100):
        new = copy.deepcopy(given)
        *way, last = where[rng.integers(len(where))]
        inside = new
        for key in way:
            inside = inside[key]
        inside[last] = "0/1" if inside[last] != "0/1" else "1/1"
        path.write_text(json.dumps(new), "utf-8")
        assert check.main(str(path)) == 1
    for _ in range(100):
        path.write_text(json.dumps(falsified(given, rng)), "utf-8")
        assert check.main(str(path)) == 1
