"""Products of powers and sums of them, as LaTeX: what an expression is made of where it is written out."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

DIGITS = 6


@dataclass(frozen=True)
class Product:
    """A number times powers of things that are written as LaTeX already."""

    number: float = 1.0
    powers: dict[str, float] = field(default_factory=dict)

    def times(self, other: Product, exponent: float = 1.0) -> Product:
        """Return the product with a power of another; what cancels is gone."""
        powers = dict(self.powers)
        for base, power in other.powers.items():
            powers[base] = powers.get(base, 0.0) + exponent * power
        number = self.number * other.number**exponent if other.number else 0.0
        return Product(number, {base: power for base, power in powers.items() if power})

    @property
    def tex(self) -> str:
        """The product without its sign."""
        above = [_power(base, power) for base, power in self.powers.items() if power > 0]
        below = [_power(base, -power) for base, power in self.powers.items() if power < 0]
        number = _number(abs(self.number))
        shown = [number, *above] if number != "1" or not above else above
        return rf"\frac{{{_joined(shown)}}}{{{_joined(below)}}}" if below else _joined(shown)


Sum = list[Product]


def one(terms: Sum) -> Product:
    """Return a sum as one product: its own only term, or the sum in parentheses."""
    if not terms:
        return Product(0.0)
    return terms[0] if len(terms) == 1 else Product(1.0, {parenthesised(written(terms)): 1.0})


def atom(tex: str) -> Sum:
    """Return something written as the sum that it alone is."""
    return [Product(1.0, {tex: 1.0})]


def scaled(terms: Sum, by: float) -> Sum:
    """Return a sum times a number."""
    return [Product(by * term.number, term.powers) for term in terms]


def written(terms: Sequence[Product]) -> str:
    """Return a sum as LaTeX; terms of the same powers are one."""
    kept = _collected(terms)
    text = "".join(f" {'-' if term.number < 0 else '+'} {term.tex}" for term in kept)
    if not text:
        return "0"
    return text.removeprefix(" + ") if text.startswith(" + ") else f"-{text.removeprefix(' - ')}"


def parenthesised(tex: str) -> str:
    """Return something in parentheses of its height."""
    return rf"\left({tex}\right)"


def _collected(terms: Sequence[Product]) -> Sum:
    found: dict[tuple[tuple[str, float], ...], Product] = {}
    for term in terms:
        key = tuple(sorted(term.powers.items()))
        number = term.number + (found[key].number if key in found else 0.0)
        found[key] = Product(number, term.powers)
    return [term for term in found.values() if term.number]


def _power(base: str, power: float) -> str:
    if power == 1:
        return base
    if power == 0.5:
        return rf"\sqrt{{{_bare(base)}}}"
    plain = re.fullmatch(r"\\?[A-Za-z]+|\\d*dot\{\S+\}|\S+?_\{\S+\}", base)
    enclosed = base.startswith(r"\left(") or (plain and "^" not in base)
    return f"{base if enclosed else parenthesised(base)}^{{{_number(power)}}}"


def _bare(base: str) -> str:
    """What stands in parentheses that enclose all of it."""
    inner = base.removeprefix(r"\left(").removesuffix(r"\right)")
    whole = base != inner and r"\left(" not in inner
    return inner if whole else base


def _joined(factors: Sequence[str]) -> str:
    return r" \, ".join(factors) or "1"


def _number(value: float) -> str:
    if not math.isfinite(value):
        return r"\infty" if value > 0 else r"\mathrm{NaN}"
    digits, _, exponent = f"{value:.{DIGITS}g}".partition("e")
    if not exponent:
        return digits
    power = rf"10^{{{int(exponent)}}}"
    return power if digits == "1" else rf"{digits} \cdot {power}"
