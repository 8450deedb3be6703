"""Small functions of condensed orbits: values by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.condensed import recursion, refinement, repeating, settling
from periodic.condensed.circle import Circle
from periodic.condensed.condensedcollocation import CondensedCollocation
from periodic.condensed.memory import HALVED, KEPT, SOLVING, Memory
from periodic.condensed.modal.moments import SERIES_UP_TO, Moments
from periodic.condensed.operator import CondensedOperator
from periodic.condensed.refinement import CondensedRefinement
from periodic.condensed.timestep import Step
from periodic.condensed.timestepping import Changed
from periodic.condensed.variations import CondensedVariations
from periodic.linear.variation import Tangent
from periodic.orbit.row import Row
from periodic.orbit.scheme import Scheme
from periodic.system import HELD, STUCK


def test_orbit_moved_along_a_linearised_motion() -> None:
    """Assert every part of it: states, unknowns and parameters."""
    orbit = along(lambda tau: np.sin(tau)[:, None], intervals=3)
    one = np.ones_like
    motion = Tangent(
        one(orbit.nodes), 2 * one(orbit.stages), 3 * np.ones((*orbit.stages.shape[:2], 1)), np.array([4.0])
    )
    given = replace(orbit, algebraic=np.zeros((*orbit.stages.shape[:2], 1)))
    found = motion.moved(given, 0.5)
    assert found.nodes == pytest.approx(orbit.nodes + 0.5)
    assert found.stages == pytest.approx(orbit.stages + 1.0)
    assert found.algebraic == pytest.approx(1.5)
    assert found.parameter.tolist() == [3.0]


def repeated(parameter: float, along_y: float) -> tuple[Any, Any]:
    """Equations of motions about an orbit of one interval and point, and the motion that changes y."""
    orbit = SimpleNamespace(
        parameter=np.array([parameter]),
        grid=SimpleNamespace(width_gradient=np.zeros((1, 0))),
        stages=np.zeros((1, 1, 1)),
    )
    given = SimpleNamespace(orbit=orbit, part=SimpleNamespace(forces=[0]), forces=np.zeros((1, 1, 1)))
    own = repeating.CondensedRepeating(None, given, (0,), 1.0)  # type: ignore[arg-type]
    motion = Tangent(np.zeros((2, 1)), np.zeros((1, 1, 1)), np.zeros((1, 1, 1)), np.array([along_y]))
    return own, motion


@pytest.mark.parametrize("way", [1.0, -2.0])
def test_response_that_softens_with_the_parameter(way: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert 3 (2 a v + 10) of slopes a^2 in the parameter a = 5, v along it, beside 10 of the tangent's."""
    monkeypatch.setattr(repeating, "answer", lambda system, orbit, y, free: (float(y[0]), None))

    def slopes(response: float, forces: Any, stretch: Any, changes: Any, mu: Any = None) -> Any:
        return (np.full((1, 1, 1, 1), 10.0 if mu is not None else response**2),)

    monkeypatch.setattr(repeating, "slopes", slopes)
    own, motion = repeated(5.0, way)
    found = own._softer(motion, np.array([[3.0]]), (0,))
    assert found == pytest.approx([3 * (10.0 + 2 * 5.0 * way)], rel=1e-8)
    still = Tangent(motion.nodes, motion.stages, motion.algebraic, np.zeros(1))
    assert own._softer(still, np.array([[3.0]]), (0,)) == pytest.approx([30.0])


def test_flexibility_that_changes_with_the_parameter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert 2 a v times the weights of a flexibility a^2 at a = 5."""
    monkeypatch.setattr(repeating, "answer", lambda system, orbit, y, free: (float(y[0]), None))
    bent = SimpleNamespace(repeating=lambda response: SimpleNamespace(pulled=lambda pull: response**2 * pull))
    monkeypatch.setattr(repeating, "Flexibility", bent)
    own, motion = repeated(5.0, -2.0)
    assert own._stiffer(motion, np.array([[3.0]])) == pytest.approx(np.array([[-60.0]]), rel=1e-8)


def test_parts_of_complex_products() -> None:
    """Assert the real part of (a + ib)(c + id), from those of both."""
    from periodic.orbit.gradients import Slopes

    real, imag = (Slopes(*(np.array([float(k) * n]) for n in range(1, 6))) for k in (5, 2))
    found = repeating._difference(real, imag)
    assert [found.rate[0], found.state[0], found.algebraic[0], found.phase[0], found.parameter[0]] == [
        3,
        6,
        9,
        12,
        15,
    ]


@pytest.mark.parametrize(
    ("before", "after", "tears"),
    [
        ((-1.0, 1.0), (1.0, 2.0), True),
        ((-1.0, 1.0), (-1.0, 1.0), False),
        ((1.0, 2.0), (1.0, 2.0), False),
        ((-1.0, 1.0), (-2.0, -1.0), True),
    ],
)
def test_joint_that_is_torn_loose(
    before: tuple[float, float], after: tuple[float, float], tears: bool
) -> None:
    """Assert that it could stick in the modes before another's change, and not in those right after it."""
    limits = {-1: before, 1: after, 9: (0.0, 0.0)}

    def values(state: Any, phase: float, side: Any) -> list[float]:
        assert side[1] == STUCK
        return list(limits[int(side[0])])

    motion: Any = SimpleNamespace(
        sides=[np.array(side) for side in ((-1, STUCK), (1, 0), (9, 9), (9, 9))],
        states=[None] * 4,
        phase=np.zeros(4),
        values=values,
    )
    joint: Any = SimpleNamespace(column=1, up=0, down=1)
    cause, release = SimpleNamespace(step=0), SimpleNamespace(step=0)
    assert settling._tears(motion, cause, release, joint) is tears  # type: ignore[arg-type]


def test_slips_of_one_step_are_errors_of_time_steps() -> None:
    """Assert that a slip of one step is left out, and one of two steps is kept."""
    slip = [Changed(0, STUCK, 1, 1.0, 10), Changed(0, 1, STUCK, 1.1, 11)]
    longer = [Changed(0, STUCK, 1, 2.0, 20), Changed(0, 1, STUCK, 2.2, 22)]
    joint = SimpleNamespace(index=0, slides=True, switch=0, up=0, down=1, column=0)
    sides = [np.zeros(1)] * 24
    motion: Any = SimpleNamespace(events=[*slip, *longer], joints=[joint], sides=sides, system=None)
    assert settling._lasting(motion) == longer


@pytest.mark.parametrize(
    ("limits", "passes"), [((1.0, 2.0), True), ((-1.0, 1.0), False), ((-2.0, -1.0), True)]
)
def test_stops_of_one_step_where_the_motion_passes(limits: tuple[float, float], passes: bool) -> None:
    """Assert that a stop is a passage where rates on both sides have one sign, or nothing."""
    joint = SimpleNamespace(index=0, slides=True, switch=0, up=0, down=1, column=0)
    stop, over, back = (
        Changed(0, 1, STUCK, 1.0, 0),
        Changed(0, STUCK, -1, 1.1, 1),
        Changed(0, STUCK, 1, 1.1, 1),
    )
    for release, left in ((over, [replace(stop, after=-1)]), (back, [])):
        motion: Any = SimpleNamespace(
            events=[stop, release],
            joints=[joint],
            states=[None] * 3,
            phase=np.zeros(3),
            sides=[np.zeros(1)] * 3,
            system=None,
            values=lambda *_: list(limits),
        )
        assert settling._lasting(motion) == (left if passes else [stop, release])


def test_settles_where_a_period_repeats() -> None:
    """Assert that a motion settles once a period changes by less than a part of its peak to peak."""

    class Decaying:
        """Each period halves the distance from a wave of peak to peak 2."""

        side, states, periods = np.zeros(1), [np.zeros(1)], 0

        def period(self) -> None:
            self.periods += 1
            gap = 0.5**self.periods
            self.states = [np.array([-1.0]), np.array([1.0]), np.array([-1.0 + gap])]

    motion: Any = Decaying()
    assert settling._settles(motion, 1e-3)
    assert motion.periods == 9  # 2^-9 = 0.00195 < 1e-3 * 2


def test_middle_of_the_longest_segment() -> None:
    """Assert the mesh point in the middle of the longest segment; the first without event nodes."""
    from periodic.orbit.mesh import EventNode

    nodes = [(EventNode(0, 1), 1.0), (EventNode(0, -1), 2.0), (EventNode(0, 1), 5.0)]
    orbit = along(lambda tau: np.sin(tau)[:, None], nodes, intervals=12)
    assert settling._amid_segment(orbit) == 4 + 2
    assert settling._amid_segment(along(lambda tau: np.sin(tau)[:, None])) == 0


@pytest.mark.parametrize(
    ("own", "nodes", "kinked"), [(0, 0, False), (1, 0, True), (0, 2, True), (1, 2, True)]
)
def test_memory_of_orbits_with_kinks(
    own: int, nodes: int, kinked: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the halved mesh is counted where there are own states or event nodes."""
    part = SimpleNamespace(states=[0, 1], forces=[0])
    monkeypatch.setattr(refinement, "linear_of", lambda _: part)
    mesh = SimpleNamespace(scheme=SimpleNamespace(ncol=3))
    orbit = SimpleNamespace(nodes=np.zeros((2, 2 + own)), phases=np.zeros(nodes), mesh=mesh)
    given: Any = SimpleNamespace(system=SimpleNamespace(switches=()), orbit=orbit)
    found = CondensedRefinement._memory(given, 5, 0.5)
    assert found == Memory(3, 2, 1, own, 5, 0.5, kinked, even=True)


def test_memory_by_hand() -> None:
    """Assert the bytes of 2 points, 1 place, 1 force and 1 mode, all active, with 10 even intervals.

    20 equations, as one matrix: 8 * 20^2 * (2 KEPT + SOLVING). Tables of an interval: 16 * 1 * 2 * 2 of
    modes, 8 * 4 of places, 2 * 8 * 2 * 2 of rows; motion of the 2 coordinates 8 * 2 * 2, and forces
    and states of both at the 4 points of its halves, 8 * 4 * 2 * 2.
    """
    memory = Memory(2, 1, 1, 0, 1, 1.0, kinked=False, even=True)
    tables, motion = 64 + 32 + 64, 32
    each = KEPT * (tables + motion) + max(5 * motion, 2 * tables) + HALVED * 128
    assert memory.peak(10) == pytest.approx(8 * 400 * (2 * KEPT + SOLVING) + 10 * each)
    assert memory.most(100, memory.peak(10)) == 10
    assert memory.most(100, memory.peak(10) - 1) == 9
    assert memory.most(5, memory.peak(10)) == 5


@pytest.mark.parametrize(
    ("size", "coordinates", "intervals", "each", "way", "cheap"),
    [
        (100.0, 10, 1.0, 1, 0.0, True),  # 700,000 > 60,400
        (40.0, 2, 1.0, 1, 9.0, False),  # 59,200 < 60,016
        (40.0, 2, 1.0, 1, 10.0, True),  # 60,800
        (40.0, 2, 2.0, 1, 10.0, False),  # < 120,032
        (40.0, 20, 1.0, 1, 10.0, False),  # < 61,600
    ],
)
def test_cheaper_interval_by_interval(
    size: float, coordinates: int, intervals: float, each: int, way: float, cheap: bool
) -> None:
    """Assert size^2 (0.7 size + way) > intervals (6e4 + 4 each coordinates^2)."""
    assert recursion.cheaper(size, coordinates, intervals, each, way) is cheap


@pytest.mark.parametrize("x", [0.0, 1.0, -2.5 + 1j, SERIES_UP_TO + 0.5, -20.0 + 3j])
def test_moments_of_polynomials(x: complex) -> None:
    """Assert int_0^e exp(x (e - s)) s^p ds = sum of what Lagrange polynomials give, by Gauss quadrature."""
    scheme = Scheme()
    table = Moments(scheme).table(np.array([x], dtype=complex))
    nodes, weights = np.polynomial.legendre.leggauss(40)
    for a, end in enumerate(scheme.points):
        s = (nodes + 1) * end / 2
        for p in range(scheme.ncol):
            exact = (weights * np.exp(x * (end - s)) * s**p).sum() * end / 2
            assert (table.moment[0, a] * scheme.points**p).sum() == pytest.approx(exact, rel=1e-9, abs=1e-12)
            steep = (weights * (end - s) * np.exp(x * (end - s)) * s**p).sum() * end / 2
            assert (table.slope[0, a] * scheme.points**p).sum() == pytest.approx(steep, rel=1e-7, abs=1e-11)
        assert table.growth[0, a] == pytest.approx(np.exp(x * end), rel=1e-13)


class Polynomial:
    """A determinant (mu - z) of each zero over (mu - p) of each pole."""

    def __init__(self, zeros: list[complex], poles: list[complex]) -> None:
        self.zeros, self.own = zeros, poles
        exponents = np.log(np.array([p for p in poles if p.imag >= 0], dtype=complex))
        self.given = SimpleNamespace(
            response=SimpleNamespace(modes=SimpleNamespace(exponents=exponents), period=1.0)
        )

    def repeating(self, mu: complex) -> Any:
        value = np.prod([mu - z for z in self.zeros]) / np.prod([mu - p for p in self.own])
        return SimpleNamespace(coupled=SimpleNamespace(matrix=np.array([[value]])))


@pytest.mark.parametrize(
    ("zeros", "radius", "outside"),
    [
        ([0.5, -0.2], 1.0, 0),
        ([1.5, -0.2], 1.0, 1),
        ([1.5, -1.2], 1.0, 2),
        ([0.8 + 0.7j, 0.8 - 0.7j], 1.0, 2),
        ([1.01, 0.99], 1.0, 1),
        ([0.5, -0.2], 0.4, 1),
        ([0.5, -0.2], 0.1, 2),
    ],
)
def test_multipliers_outside_a_circle(zeros: list[complex], radius: float, outside: int) -> None:
    """Assert how many zeros of a known determinant lie outside, with poles at 0.6 +- 0.6i."""
    found: Any = Polynomial(zeros, [0.6 + 0.6j, 0.6 - 0.6j])
    assert Circle(found, radius).outside() == outside


def test_a_multiplier_on_the_circle_is_told() -> None:
    """Assert that the number is not made up where a zero lies on the circle."""
    found: Any = Polynomial([1.0, 0.5], [0.6 + 0.6j, 0.6 - 0.6j])
    with pytest.raises(FloatingPointError, match="a multiplier lies on the circle of radius 1"):
        Circle(found).outside()


@pytest.mark.parametrize(
    ("error", "order", "times"),
    [(1e-7, 4, 1.0), (16e-7, 4, 2.0), (1.0, 4, 2.5), (0.0, 4, 0.5), (1e-7 / 16, 4, 0.5)],
)
def test_factor_on_intervals(error: float, order: int, times: float) -> None:
    """Assert (error / aim)^(1/order), the aim a tenth of the tolerance, from 1/2 to 2.5."""
    given: Any = SimpleNamespace(method=SimpleNamespace(tolerance=1e-6))
    assert CondensedRefinement._times(given, error, order) == pytest.approx(times)


def test_intervals_of_a_condensed_orbit() -> None:
    """Assert the least and the first number of intervals, and the degree, one more than elsewhere up to 7."""
    from periodic.collocation.meshmethod import scheme_for

    method = CondensedCollocation()
    assert (method.ntst, method.ntst_min) == (12, 6)
    for tolerance in (1e-2, 1e-6, 1e-11):
        assert method._scheme_at(tolerance).ncol == min(scheme_for(tolerance).ncol + 1, 7)


@pytest.mark.parametrize(
    ("held", "after", "signs", "back"),
    [
        (STUCK, -1, {10: 1}, True),
        (STUCK, 1, {10: 1}, False),
        (STUCK, 1, {10: -1}, True),
        (STUCK, STUCK, {10: 1}, False),
        (HELD, -1, {10: 1}, False),
        (1, -1, {}, False),
    ],
)
def test_slip_that_friction_takes_back(
    held: int, after: int, signs: dict[int, int], back: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that friction which held a slider, and lets go the other way as it slips, takes the slip back.

    Friction is in column 1 before and after the step of the slip, to which a slider in column 0 begins up.
    """
    asked = []

    def holding(system: Any, switch: int, friction: list[int]) -> dict[int, int]:
        asked.append(friction)
        return signs if friction else {}

    monkeypatch.setattr(settling, "holding", holding)
    slider: Any = SimpleNamespace(slides=False, switch=3, column=0)
    friction = SimpleNamespace(slides=True, switch=10, column=1)
    sides = [np.array([9, 9]), np.array([STUCK, held]), np.array([1, after]), np.array([9, 9])]
    motion: Any = SimpleNamespace(sides=sides, joints=[friction, slider], system=None)
    assert settling._goes_back(motion, slider, Changed(0, STUCK, 1, 1.0, 1)) is back
    assert asked == [[10] if held == STUCK else []]
    assert not settling._goes_back(motion, friction, Changed(0, STUCK, 1, 1.0, 1))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("values", "near", "pair"),
    [
        ([3.0, 0.5, 1.9, 0.2], None, (1, 2)),
        ([3.0, 0.5, 1.9, 0.2], (3.0, 0.25), (0, 3)),
        ([3.0, 0.5, 1.9, 0.2], (0.25, 3.0), (0, 3)),
        ([0.6 + 0.8j, 0.5, 0.6 - 0.8j, 1.7], None, (0, 2)),
        ([0.6 + 0.8j, 0.5, 0.6 - 0.8j, 1.7], (0.6 - 0.7j, 0.6 + 0.7j), (0, 2)),
        ([0.99 + 0.1j, 1.0, 0.9, 1.05], None, (1, 3)),
    ],
)
def test_pair_of_multipliers(
    values: list[complex], near: tuple[complex, complex] | None, pair: tuple[int, int]
) -> None:
    """Assert the pair of which the product is nearest to 1, or that nearest to another, in either order.

    Of a complex multiplier only its conjugate makes a pair. The gradient is that of the product.
    """

    def multiplier(which: int, factor: complex, free: tuple[int, ...]) -> Row:
        return Row(0.0, np.full((1, 1), float(which)), np.array([complex(factor).real, 0.0]))

    given: Any = SimpleNamespace(multipliers=np.array(values, dtype=complex), multiplier=multiplier)
    known = None if near is None else np.array([np.real(near), np.imag(near)])
    row, found = CondensedVariations.pair(given, known, (0,))
    i, j = pair
    assert found.tolist() == [
        np.real([values[i], values[j]]).tolist(),
        np.imag([values[i], values[j]]).tolist(),
    ]
    assert row.value == pytest.approx((values[i] * values[j]).real - 1)
    assert row.nodes[0, 0] == i + j
    assert row.outer[0] == pytest.approx((complex(values[i]) + complex(values[j])).real)


@pytest.mark.parametrize("exponent", [0.0, -0.3, 0.2 + 1.0j])
def test_time_step_of_a_mode(exponent: complex) -> None:
    """Assert z+ = e^{xh} z + (e^{xh} - 1)/x b f and the output, also of a mode that nothing holds."""
    modes: Any = SimpleNamespace(
        exponents=np.array([exponent], dtype=complex),
        inputs=np.array([[2.0 + 1.0j]]),
        outputs=np.array([[3.0 - 1.0j]]),
        direct=np.array([[0.25]]),
    )
    step = Step.over(0.5, modes)
    mean = (np.exp(0.5 * exponent) - 1) / exponent if exponent else 0.5
    assert step.grown == pytest.approx([np.exp(0.5 * exponent)])
    assert step.kicked[0, 0] == pytest.approx(mean * (2 + 1j))
    assert step.local[0, 0] == pytest.approx((mean * (2 + 1j) * (3 - 1j)).real + 0.25)
    assert step.width == 0.5


@pytest.mark.parametrize("nodes", [0, 1])
def test_effect_of_parameters_by_hand(nodes: int) -> None:
    """Assert the largest of what forces, the motion begun and own states do, each of two parameters.

    Of one state, one force and one own state on two intervals of one point; columns before are none of it.
    """
    columns = 1 + 2 + nodes
    forces, own, affine = (
        np.zeros((2, 1, columns + 2)),
        np.zeros((2, 1, columns + 2)),
        np.zeros((2, 1, 1 + nodes + 2)),
    )
    forces[:, :, :columns] = own[:, :, :columns] = 9.0
    affine[:, :, : 1 + nodes] = 9.0
    forces[1, 0, columns:], own[0, 0, columns:], affine[1, 0, 1 + nodes :] = (-3, 1), (2, -4), (-0.5, 0.25)
    given = SimpleNamespace(
        local=SimpleNamespace(forces=forces, own=own),
        affine=affine,
        flexibility=SimpleNamespace(applied=lambda weights: 10.0 * weights.reshape(2, 1, 1, 2)),
    )
    orbit = SimpleNamespace(phases=np.zeros(nodes), stages=np.zeros((2, 1, 1)))
    operator: Any = SimpleNamespace(given=given, orbit=orbit)
    effect = CondensedOperator.effect
    assert isinstance(effect, property) and effect.fget is not None
    assert effect.fget(operator).tolist() == [30.0 + 0.5 + 2.0, 10.0 + 0.25 + 4.0]


@pytest.mark.parametrize(("taken", "most"), [(0.99, 1000), (1.0, 1000), (1.01, 40)])
def test_most_intervals_by_memory(taken: float, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the settings' number where a mesh 2.5 times as fine has room, else what memory allows."""
    part, asked = SimpleNamespace(size=50), list[Any]()
    monkeypatch.setattr(refinement, "linear_of", lambda _: part)
    response = SimpleNamespace(modes=SimpleNamespace(exponents=np.zeros(7)))
    monkeypatch.setattr(refinement, "answer", lambda *_: (response, []))

    def memory(modes: int, share: float) -> Any:
        asked.append((modes, share))
        return SimpleNamespace(
            peak=lambda count: taken * refinement.LARGEST if count == 25 else np.nan,
            most=lambda most, largest: 40 if (most, largest) == (1000, refinement.LARGEST) else -1,
        )

    given: Any = SimpleNamespace(
        system=None,
        method=SimpleNamespace(ntst_max=1000, ntst_min=6, tolerance=1e-6),
        orbit=SimpleNamespace(mesh=SimpleNamespace(ntst=10), parameter=None),
        _memory=memory,
        _active=np.array([True, False, False, False]),
    )
    own = CondensedRefinement._most.func
    assert own(given) == most
    assert asked == ([(50, 1.0)] if most == 1000 else [(50, 1.0), (7, 0.25)])
    given.method.ntst_max = 12
    given._memory = lambda modes, share: SimpleNamespace(peak=lambda count: 0.0 if count == 12 else np.inf)
    assert own(given) == 12


@pytest.mark.parametrize(
    ("wrong", "most", "wanted", "limited"),
    [
        (False, 40, 41.0, True),
        (False, 40, 40.0, False),
        (True, 40, 41.0, False),
        (False, 1000, 2000.0, False),
    ],
)
def test_orbits_for_which_there_is_no_memory(wrong: bool, most: int, wanted: float, limited: bool) -> None:
    """Assert it where more intervals are wanted than memory allows, in the right mode."""
    given: Any = SimpleNamespace(
        _in_wrong_mode=wrong,
        _most=most,
        method=SimpleNamespace(ntst_max=1000),
        system=SimpleNamespace(switches=("s",)),
        _wanted=np.array([wanted / 4, wanted / 2]),
        orbit=SimpleNamespace(grid=SimpleNamespace(width=np.array([2.0, 1.0]))),
    )
    own = CondensedRefinement._limited
    assert isinstance(own, property) and own.fget is not None and own.fget(given) is limited
