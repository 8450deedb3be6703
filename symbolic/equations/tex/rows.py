"""The equations of a model: of each coordinate, of each other state, of each unknown, as LaTeX."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

import casadi as ca

from symbolic.equations.assembly import Assembly, Contributor
from symbolic.equations.terms import State
from symbolic.equations.tex.expression import sums
from symbolic.equations.tex.names import dotted, tex
from symbolic.equations.tex.products import Product, Sum, atom, one, scaled, written
from symbolic.interrupts import interruptible

LONGEST_ROW = 4000
"""Longest equation (letters) that is written out."""

OMEGA = r"\omega"


@interruptible()
def equations(parts: Iterable[Contributor]) -> str:
    """Return the equations of motion of parts, in SI units and time, as LaTeX for a mathematical display.

    Parameters
    ----------
    parts : iterable of Part
        The parts of a model.

    Returns
    -------
    str
        An environment `aligned`, one equation a line.
    """
    assembly = Assembly()
    assembly.lay(parts)
    assembly.close()
    lines = [f"{left} &= {_short(right)}" for left, right in Rows(assembly).every()]
    return "\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}"


def _short(right: str) -> str:
    return right if len(right) <= LONGEST_ROW else rf"\ldots \quad \text{{({len(right)} letters)}}"


class Rows:
    """Both sides of each equation of an assembly that is closed.

    Parameters
    ----------
    assembly : Assembly
        The assembly of a model.
    """

    def __init__(self, assembly: Assembly) -> None:
        self.assembly = assembly
        self._known = {symbol.element_hash(): terms for symbol, terms in self._leaves()}

    def _leaves(self) -> Iterator[tuple[ca.SX, Sum]]:
        assembly, angle = self.assembly, self._angle
        yield assembly.omega, atom(OMEGA)
        yield assembly.excitation.pace, [Product(1 / float(assembly.excitation.fundamental))]
        yield assembly.excitation.angle, atom(angle)
        for name, (_, symbols) in assembly.numbers.named().items():
            yield from ((symbol, atom(tex(name))) for symbol in symbols)
        for unknown in assembly.unknowns:
            yield unknown.symbol, atom(tex(unknown.name))
        for state in assembly.states:
            name, order = state.name.rstrip("'"), state.name.count("'")
            yield state.symbol, [_derivative(name, order)]
            yield state.derivative, [_derivative(name, order + 1)]
        for harmonic, waves in assembly.excitation.waves.items():
            for function, symbol in zip((r"\sin", r"\cos"), waves, strict=True):
                yield symbol, atom(rf"{function}\left({_times(harmonic)}{angle}\right)")

    @property
    def _frequency(self) -> str:
        """The name of the one parameter that is the frequency of the excitation; empty if there is none."""
        frequency = self.assembly.excitation.frequency
        if frequency is None or not frequency.is_symbolic():
            return ""
        named = self.assembly.numbers.named().items()
        own = {symbol.element_hash(): name for name, (_, symbols) in named for symbol in symbols}
        return tex(own.get(frequency.element_hash(), ""))

    @property
    def _angle(self) -> str:
        return rf"{self._frequency} \, t" if self._frequency else r"\theta"

    def every(self) -> list[tuple[str, str]]:
        """Return both sides of all equations, and what stands in them for the frequency."""
        rows = [*self._rows()]
        frequency = self.assembly.excitation.frequency
        if frequency is not None and any(OMEGA in right for _, right in rows) and self._frequency != OMEGA:
            pace = float(self.assembly.excitation.fundamental)
            rows.append((OMEGA, written(scaled(self._sum(frequency), pace))))
        return rows

    def _rows(self) -> Iterator[tuple[str, str]]:
        assembly = self.assembly
        held = {id(place.motion): place for place in assembly.places}
        moved: set[int] = set()
        for motion in assembly.motions.values():
            moved |= {id(motion.position), id(motion.velocity)}
            name = motion.position.name
            if id(motion) in held:
                yield rf"F\left({tex(name)}\right)", written(self._sum(motion.force))
            else:
                mass = one(self._sum(motion.mass)).times(Product(1.0, {dotted(name, 2): 1.0}))
                yield mass.tex, written(self._sum(motion.force))
        others = [state for state in assembly.states if id(state) not in moved]
        for state, row in zip(others, assembly.differential_rows, strict=False):
            yield self._rate(state, row)
        for row in (*assembly.differential_rows[len(others) :], *assembly.algebraic_rows):
            yield "0", written(self._sum(row))
        yield from self._frequencies()

    def _rate(self, state: State, row: ca.SX) -> tuple[str, str]:
        """A row solved for the rate of its state, where it is linear in it."""
        slope = ca.jacobian(row, state.derivative)
        rest = ca.substitute(row, state.derivative, ca.SX(0))
        if slope.nnz() == 0 or ca.depends_on(slope, state.derivative):
            return "0", written(self._sum(row))
        divisor = one(self._sum(slope)).times(Product(1.0, {OMEGA: -1.0}))
        terms = [term.times(divisor, -1.0) for term in scaled(self._sum(rest), -1.0)]
        return dotted(state.name, 1), written(terms)

    def _frequencies(self) -> Iterator[tuple[str, str]]:
        frequency = self.assembly.excitation.frequency
        if frequency is not None and not self._frequency:
            yield r"\dot{\theta}", written(self._sum(frequency))

    def _sum(self, expression: ca.SX) -> Sum:
        (found,) = sums(ca.densify(expression), self._leaf)
        return found

    def _leaf(self, symbol: ca.SX) -> Sum:
        return self._known.get(symbol.element_hash()) or atom(tex(symbol.name()))


def _derivative(name: str, order: int) -> Product:
    """d^k q / dtau^k as the derivative in time over omega^k."""
    return Product(1.0, {dotted(name, order): 1.0, **({OMEGA: -float(order)} if order else {})})


def _times(order: Fraction) -> str:
    if order == 1:
        return ""
    if order.denominator == 1:
        return str(order)
    return rf"\tfrac{{{order.numerator}}}{{{order.denominator}}} "
