"""Check a certificate of periodic orbits: python check.py certificate.json

Needs python-flint (ball arithmetic) and nothing else. A certificate has equations x' = f(x, t) as text, boxes Y
at nodes along an orbit, and claims. That the boxes hold one orbit, and one only, is shown by an interval Newton
step on multiple shooting,

    c - DF(Y)^-1 F(c)  inside  Y,    F_k = flow(y_k) - y_k+1,

with flows by Taylor series whose remainders are bounded over an enclosure of the motion (Nedialkov, Jackson &
Corliss, Appl. Math. Comput. 105, 1999), in pieces between events, at which what a max, min, abs, sign or less
compares is equal. That this happens nowhere else is shown too. A stretch of a branch is a row of such boxes with
an orbit for each value of a parameter in a range; as DF is regular it has no fold.
"""

import hashlib
import json
import re
import sys
from collections import namedtuple

from flint import acb, acb_mat, arb, arb_mat, arb_series, ctx, fmpq

FORMAT = "orbitrace proof 2"
DEPTH, TRIES = 40, 6  # halvings of a step to find a sign, attempts to enclose a motion; no truth hangs on them

class NotProvedError(Exception):
    """What could not be shown."""

def show(truth, what):
    if not truth:
        raise NotProvedError(what)

def ratio(text):
    return fmpq(*map(int, text.split("/")))

def ball(centre, radius):
    show(ratio(radius) >= 0, "a box has no size")
    return arb(ratio(centre)) + arb(0, arb(ratio(radius)).upper())

def matrix(rows, columns, entry):
    return arb_mat([[entry(i, j) for j in range(columns)] for i in range(rows)])

def corner(a, n):
    return matrix(n, n, lambda i, j: a[i, j])

# A value and its derivatives by direction; those of a lower level are constants to a higher one.
Dual = namedtuple("Dual", "level value slopes")

def split(a, level):
    return (a.value, a.slopes) if type(a) is Dual and a.level == level else (a, {})

def of(kind, *operands):
    """An operation on numbers, on series in time, or on Duals of them."""
    levels = [a.level for a in operands if type(a) is Dual]
    if not levels:
        return RULES[kind][0](*operands)
    (values, slopes), found = zip(*[split(a, max(levels)) for a in operands]), {}
    result = of(kind, *values)
    for by, own in zip(RULES[kind][1:], slopes):
        factor = by(*values, result) if own and by else None
        for j, s in own.items():
            term = of("*", factor, s) if by else s
            found[j] = of("+", found[j], term) if j in found else term
    return Dual(max(levels), result, found)

def inverse(a):
    show(not nth(a, 0).contains(0), "a denominator may be 0")
    return 1 / a

def power(a, p):
    """a^p, p constant; where p > 0, numbers below 0 of a ball count as 0."""
    show(isinstance(p, arb), "an exponent varies")
    if p.is_integer():
        return a ** int(p.unique_fmpz())
    first = nth(a, 0)
    if first > 0 or not p > 0:
        return a**p
    hull = arb(0).union(first.nonnegative_part().upper() ** p)
    return arb_series([hull] + [arb("nan")] * (ctx.cap - 1)) if isinstance(a, arb_series) else hull

RULES = {  # operations, and the partial derivatives from their operands and result; None is 1
    "+": (lambda a, b: a + b, None, None),
    "-": (lambda a, b: a - b, None, lambda a, b, c: arb(-1)),
    "*": (lambda a, b: a * b, lambda a, b, c: b, lambda a, b, c: a),
    "/": (lambda a, b: a * inverse(b), lambda a, b, c: of("inv", b), lambda a, b, c: of("/", of("*", arb(-1), c), b)),
    "^": (power, lambda a, p, c: of("*", p, of("^", a, p - 1)), lambda a, p, c: show(False, "an exponent varies")),
    "sin": (lambda a: a.sin(), lambda a, c: of("cos", a)),
    "cos": (lambda a: a.cos(), lambda a, c: of("*", arb(-1), of("sin", a))),
    "exp": (lambda a: a.exp(), lambda a, c: c),
    "log": (lambda a: a.log(), lambda a, c: of("inv", a)),
    "sqrt": (lambda a: a.sqrt(), lambda a, c: of("inv", of("*", arb(2), c))),
    "atan": (lambda a: a.atan(), lambda a, c: of("inv", of("+", arb(1), of("*", a, a)))),
    "inv": (inverse, lambda a, c: of("*", arb(-1), of("*", c, c))),
}
BRANCHES = {  # by the side of a - b
    "max": lambda a, b, side: a if side > 0 else b,
    "min": lambda a, b, side: b if side > 0 else a,
    "less": lambda a, b, side: arb(0 if side > 0 else 1),
    "sign": lambda a, b, side: arb(1 if side > 0 else -1),
    "abs": lambda a, b, side: a if side > 0 else of("*", arb(-1), a),
}
OF_TWO = {*"+-*/^", "max", "min", "less"}

class Problem:
    """The equations, in a time s that goes from 0 to 1 in each piece.

    Unknowns y: states x0.., unknown values, for folds and doublings v of the linearised equations, and where
    there are events the time t and the length of the piece.
    """
    def __init__(self, given):
        text = given["equations"]
        self.unknown, self.constraint, self.resets = given["unknown"], text.get("constraint"), text.get("resets", {})
        self.values = {name: arb(number) for name, number in text["values"].items()}
        self.n, self.period = len(text["rates"]), 2 * arb.pi() * int(given["turns"])
        self.first = self.n + bool(self.constraint)
        states = [f"x{i}" for i in range(self.first)]
        every = (*self.values, *self.unknown, *states, "t")
        self.needs = {name: {name} for name in every}
        show(len(self.needs) == len(every), "a name stands for two things")
        self.lines, self.compared, self.kinds, self.jumping = [], {}, {}, set()
        for line in text["lines"]:
            self._read(line, *re.findall(r"[^\s(),=]+", line))
        self.rates = [name if name in self.needs else arb(name) for name in text["rates"]]
        every = [*self.kinds, *text["rates"], *(name for names in self.resets.values() for name in names)]
        self.free_running = not any("t" in self.needs.get(name, ()) for name in every)
        self.sign, self.events = {"fold": 1, "doubling": -1}.get(given["claim"], 0), len(given["pieces"]) > 1
        self.free, self.constraints = self.first + len(self.unknown), bool(self.constraint) * (1 + abs(self.sign))
        self.size = self.free + self.first * abs(self.sign) + 2 * self.events
        same = [self.n, self.free + self.n][: self.constraints], [*range(self.first, self.free)], [self.size - 1]
        self.open = [*same[0], *same[1], *same[2] * self.events]  # what closes without a condition of its own
        for guard, names in self.resets.items():
            kept = [a == x or x not in self.needs[guard] for a, x in zip(names, states, strict=True)]
            show(all(kept) and self.kinds[guard] == "max", "an impact moves its own wall")
        show(self.period > 0, "the orbit takes no time")
        smooth = not self.jumping and not self.resets
        show(smooth or not (self.sign or self.constraint), "the equations jump, and with them what must not")

    def _read(self, line, name, *words):
        kinds, operands = ([a for a in words if (a in RULES or a in BRANCHES) == known] for known in (True, False))
        readable = name.isidentifier() and name not in self.needs and len(kinds) == 1
        show(readable and len(operands) == 1 + (kinds[0] in OF_TWO), f"cannot read {line!r}")
        self.kinds[name], self.needs[name] = kinds[0], set().union(*(self.needs.get(a, ()) for a in operands))
        if kinds[0] in BRANCHES:
            operands = [*operands, "0.0"][:2]
            self.compared[name] = frozenset(operands)
        if kinds[0] in ("less", "sign") or self.jumping & {*operands}:
            self.jumping.add(name)
        known = [self.values[a] if a in self.values else a if a in self.needs else arb(a) for a in operands]
        if kinds[0] in RULES and not any(isinstance(a, str) for a in known):
            self.values[name] = of(kinds[0], *known)
        else:
            self.lines.append((name, kinds[0], known))

    def at(self, y, s, sides):
        """Every value of the text at y; `?name` is the difference that a branch compares with 0."""
        x = y[: self.first]
        if self.sign:
            x = [Dual(3, a, {0: v}) for a, v in zip(x, y[self.free :])]
        return self.run(x, y[self.first :], y[-2] if self.events else self.period * s, sides)

    def run(self, x, unknown, t, sides):
        at = self.values | {f"x{i}": a for i, a in enumerate(x)} | dict(zip(self.unknown, unknown)) | {"t": t}
        for name, kind, operands in self.lines:
            a = [at[each] if isinstance(each, str) else each for each in operands]
            if kind in BRANCHES:
                at[f"?{name}"] = of("-", *a)
            at[name] = BRANCHES[kind](*a, sides[name]) if kind in BRANCHES else of(kind, *a)
        return at

    def field(self, y, s, sides):
        """dy/ds; what the constraint g(x, z, t) = 0 determines has z' = -(g_x x' + g_t t') / g_z."""
        at, length = self.at(y, s, sides), y[-1] if self.events else self.period
        rates = [of("*", length, at[name] if isinstance(name, str) else name) for name in self.rates]
        if self.constraint:
            x = [Dual(4, at[f"x{i}"], {0: a} if i < self.n else {1: arb(-1)}) for i, a in enumerate([*rates, 0])]
            along = self.run(x, y[self.first :], Dual(4, at["t"], {0: length}), sides)[self.constraint].slopes
            rates.append(of("/", along[0], along[1]))
        both = [split(rate, 3) for rate in rates]
        found = [a for a, _ in both] + [arb(0)] * len(self.unknown)
        return found + [v.get(0, arb(0)) for _, v in both] * abs(self.sign) + [length, arb(0)] * self.events

def nth(a, k):
    return (a[k] if k < a.length() else arb(0)) if isinstance(a, arb_series) else a if k == 0 else arb(0)

def cut(a, count):
    return arb_series([nth(a, k) for k in range(count)])

def taylor(problem, y, s, sides, order):
    """Taylor series of the motion from y at s, of order + 1 terms."""
    motion = [arb_series([a]) for a in y]
    for k in range(1, order + 1):
        ctx.cap = k + 1
        rates = problem.field([cut(a, k) for a in motion], arb_series([s, 1]), sides)
        motion = [a + cut(r, k).integral() for a, r in zip(y, rates)]
    return motion

def variations(problem, motion, s, sides, order):
    """Taylor coefficients 0..order of the derivatives in y, and the matrix of the linearised equations."""
    ctx.cap, d = max(order, 1), problem.size
    seeds = [Dual(2, cut(a, ctx.cap), {i: arb(1)}) for i, a in enumerate(motion)]
    rates = [split(rate, 2)[1] for rate in problem.field(seeds, arb_series([s, 1]), sides)]
    slopes = [matrix(d, d, lambda i, j: nth(rates[i].get(j, arb(0)), k)) for k in range(ctx.cap)]
    found = [matrix(d, d, lambda i, j: int(i == j))]
    for k in range(order):
        terms = [slopes[j] * found[k - j] for j in range(k + 1)]
        found.append(sum(terms[1:], terms[0]) * (arb(1) / (k + 1)))
    return found, slopes[0]

def value(coefficients, h):
    total = coefficients[-1]
    for c in coefficients[-2::-1]:
        total = total * h + c
    return total

class Step:
    """A step of length h from boxes y at s: its motions, their derivatives, and all values along them."""
    def __init__(self, problem, y, s, h, order, sides):
        self.problem, self.box, self.s, self.h, self.order, self.sides = problem, y, s, h, order, sides
        self.along, self.during, d = arb(0).union(h), s + arb(0).union(h), problem.size
        self.motion = taylor(problem, y, s, sides, order - 1)
        self.later = self._enclosed()
        last, rates = variations(problem, self.later, self.during, sides, order)
        norm = max(sum(abs(rates[i, j]).upper() for j in range(d)) for i in range(d))
        grown = ((norm * h).exp() - 1).upper()  # |V - 1| by Gronwall's lemma
        found, _ = variations(problem, self.motion, s, sides, order - 1)
        self.derivative = value([*found, last[order] * matrix(d, d, lambda i, j: arb(int(i == j), grown))], h)

    def _enclosed(self):
        """Series of order + 1 terms from a box that no motion leaves within the step."""
        known = [value([nth(f, k) for k in range(self.order)], self.along) for f in self.motion]
        room = [(a.rad() + abs(a).upper() * arb(2) ** -40 + arb(2) ** -100) / 64 for a in known]
        for _ in range(TRIES):
            box = [a + arb(0, r) for a, r in zip(known, room)]
            later = taylor(self.problem, box, self.during, self.sides, self.order)
            tail = [nth(f, self.order) * self.along**self.order for f in later]
            if all(b.contains_interior(a + t) for b, a, t in zip(box, known, tail)):
                return later
            room = [2 * abs(t).upper() + r for t, r in zip(tail, room)]
        raise NotProvedError("the motion could not be enclosed during a step")

    def ends(self, *boxes):
        """Where motions from boxes within that of the step are at its end: by the mean value theorem."""
        middle = [arb(a.mid()) for a in boxes[0]]
        show(all(a.contains(m) for a, m in zip(self.box, middle)), "a point is beside its box")
        both = zip(taylor(self.problem, middle, self.s, self.sides, self.order - 1), self.later)
        ends = [value([*(nth(a, k) for k in range(self.order)), nth(b, self.order)], self.h) for a, b in both]
        moved = (self.derivative * matrix(len(y), 1, lambda i, _: y[i] - middle[i]) for y in boxes)
        return [[a + m[i, 0] for i, a in enumerate(ends)] for m in moved]

    def polynomials(self):
        """By name of every value its coefficients along the motions, the last one for the smallest remainder."""
        found = []
        for motion, s, count in (self.motion, self.s, self.order), (self.later, self.during, self.order + 1):
            ctx.cap = count
            at = self.problem.at([cut(a, count) for a in motion], arb_series([s, 1]), self.sides)
            found.append({name: split(a, 3)[0] for name, a in at.items()})
        return {name: self._shortened(a, found[1][name]) for name, a in found[0].items()}

    def _shortened(self, a, rest):
        sizes = [nth(rest, 0).rad(), *(abs(nth(rest, k)).upper() * self.h**k for k in range(1, self.order + 1))]
        best = min(range(self.order + 1), key=lambda k: float(sizes[k]) if sizes[k].is_finite() else float("inf"))
        return [*(nth(a, k) for k in range(best)), nth(rest, best)]

def keeps(p, what, begin, h, first=False, last=False, depth=0):
    """Show p > 0 between begin and h, where p may vanish at begin (first) or at h (last)."""
    at, middle = begin.union(h), (begin + h) / 2
    rises, centre = value([k * c for k, c in enumerate(p)][1:] or [arb(0)], at), value(p, middle)
    up, down = rises > 0 and (first or value(p, begin) > 0), rises < 0 and (last or value(p, h) > 0)
    if up or down or value(p, at) > 0 or centre + rises * (at - middle) > 0:
        return
    show(depth < DEPTH and centre > 0, what)
    keeps(p, what, begin, middle, first, False, depth + 1)
    keeps(p, what, middle, h, False, last, depth + 1)

class Orbit:
    """An orbit, or one for each value of a range: flows from node to node, and what follows from them."""
    def __init__(self, given):
        ctx.prec = given["bits"]
        self.given, self.problem, self.pieces = given, Problem(given), given["pieces"]
        self.centres = [[arb(ratio(c)) for c in node["centre"]] for node in given["nodes"]]
        self.boxes = [[ball(*both) for both in zip(node["centre"], node["radius"])] for node in given["nodes"]]
        self.anchors = [(name, along, [ratio(end) for end in ends]) for name, along, *ends in given["anchors"]]
        ranges = [(name, *ends) for name, _, ends in self.anchors if len(ends) == 2]
        show(len(ranges) == (given["claim"] == "stretch"), "there is no range, or more than one")
        self.over, self.begin, self.end = ranges[0] if ranges else (None, None, None)
        show(not ranges or self.over in self.problem.unknown, "a range is of no unknown value")
        show(not self.problem.events or all(box[-1] > 0 for box in self.boxes), "a piece takes no time")
        self.flows, self.steps, self.places, self.balls, edge = [], [], [], None, None
        for k, after in enumerate([*self.pieces[1:], None]):
            edge = self._followed(k, self.pieces[k], after, edge)
        show(len(self.flows) == len(self.boxes), "nodes and steps do not match")

    def _followed(self, number, piece, after, edge):
        """Follow a piece from node to node; edge is what vanishes where it begins. Returns that of its end."""
        own, s, d = self.problem, fmpq(0), self.problem.size
        until, walls = own.compared[piece["until"]] if after else None, [own.compared[name] for name in own.resets]
        show(not until or not until & own.jumping, "what vanishes at an event jumps there")
        show(until not in walls or piece["until"] in own.resets, "an impact is left out")
        show(all(piece["sides"][name] > 0 for name in own.resets), "a motion is behind a wall")
        show(sum(ratio(h) for node in piece["steps"] for h, _ in node) == 1, "the steps do not add up to a piece")
        for node in piece["steps"]:
            point, box = self.centres[len(self.flows)], self.boxes[len(self.flows)]
            whole = matrix(d, d, lambda i, j: int(i == j))
            self.places.append((number, s))
            for text, order in node:
                h, edge = ratio(text), edge if s == 0 else None
                show(h > 0, "a step has no length")
                step = Step(own, box, arb(s), arb(h), order, piece["sides"])
                (point, box), whole, s = step.ends(point, box), step.derivative * whole, s + h
                self.steps.append((step, edge, until if s == 1 else None))
            self.flows.append((point, box, whole, (piece, after) if after and s == 1 else None))
        return until

    def slopes(self, name, y=None, s=0, sides=None):
        """A value of the text at y (the first box), with its slopes in y, and those of its derivative along v."""
        ctx.cap, y, sides = 1, y or self.boxes[0], sides or self.pieces[0]["sides"]
        seeds = [Dual(2, a, {i: arb(1)}) for i, a in enumerate(y)]
        at = self.problem.at(seeds, arb(s), sides)
        own, along = split(at[name] if name in at else arb(name), 3)
        found = split(own, 2), split(along.get(0, arb(0)), 2)
        return [(a, matrix(1, len(y), lambda _, j: b.get(j, arb(0)))) for a, b in found]

    def event(self, piece, y):
        """At the end of a piece what vanishes, and its slopes; y after an impact or none, and the slopes of that."""
        names, d = [f"?{piece['until']}", *self.problem.resets.get(piece["until"], ())], len(y)
        edge, *new = [self.slopes(name, y, 1, piece["sides"])[0] for name in names]
        landed = [new[i][0] if i < len(new) else y[i] for i in range(d)]
        return *edge, landed, matrix(d, d, lambda i, j: new[i][1][0, j] if i < len(new) else int(i == j))

    def newton(self, at=None):
        """The Newton step c - DF(Y)^-1 F(c), node by node; for one value of a range where that is given."""
        own, d, m = self.problem, self.problem.size, len(self.boxes)
        every, right = arb_mat(d * m, d * m), arb_mat(d * m, 1)
        for k, (point, box, by, ends) in enumerate(self.flows):
            after, last, instead = (k + 1) % m, k == m - 1, {}
            if ends:
                (here, _, point, _), (_, slopes, _, new) = self.event(ends[0], point), self.event(ends[0], box)
                instead, by = {d - 1: (k, here, slopes * by)}, new * by
            if last:
                instead = dict(zip(own.open, self._conditions(at), strict=True))
            for i in range(d):
                sign = own.sign if last and own.sign and own.free <= i < own.free + own.first else 1
                column, right[k * d + i, 0], slopes = instead.get(i, (k, point[i] - sign * self.centres[after][i], by))
                if i not in instead:
                    right[k * d + i, 0] -= own.period if last and own.events and i == d - 2 else 0
                    every[k * d + i, after * d + i] -= sign
                for j in range(d):
                    every[k * d + i, column * d + j] += slopes[0 if i in instead else i, j]
        try:
            step = every.solve(right)
        except ZeroDivisionError:
            raise NotProvedError("the orbit may not be isolated: Newton's matrix may be singular") from None
        return [[c - step[k * d + i, 0] for i, c in enumerate(row)] for k, row in enumerate(self.centres)]

    def _conditions(self, at):
        """What holds at the first node: the constraint, also along v, and given values."""
        fixed = [(self.problem.constraint, along, [fmpq(0)]) for along in range(self.problem.constraints)]
        for name, along, ends in [*fixed, *self.anchors]:
            wanted = arb(ends[0]).union(arb(ends[-1])) if at is None or len(ends) == 1 else arb(at)
            yield 0, self.slopes(name, self.centres[0])[along][0] - wanted, self.slopes(name)[along][1]

    def transitions(self):
        """From node to node the products of saltation and flow matrices."""
        for _, box, by, ends in self.flows:
            if ends:
                _, edge, landed, new = self.event(ends[0], box)
                rates = [self.problem.field(y, 1, piece["sides"]) for y, piece in zip((box, landed), ends)]
                before, after = (matrix(len(box), 1, lambda i, _: rate[i]) for rate in rates)
                by = (new + (after - new * before) * (1 / (edge * before)[0, 0]) * edge) * by
            yield corner(by, self.problem.first)

    def multipliers(self):
        """Balls with the Floquet multipliers; bases at the nodes, any will do, keep apart what grows and decays."""
        own, n, m = self.problem, self.problem.first, self.problem.n
        whole = basis = one = matrix(n, n, lambda i, j: int(i == j))
        for by, node in zip(self.transitions(), [*self.given["nodes"][1:], {}]):
            moved = by * basis
            basis = matrix(n, n, lambda i, j: arb(node["basis"][i][j])) if "basis" in node else one
            whole = basis.solve(moved) * whole
        if own.constraint:
            edge = self.slopes(own.constraint)[0][1]
            whole = whole * matrix(n, m, lambda i, j: arb(int(i == j)) if i < m else -edge[0, j] / edge[0, m])
        whole = acb_mat(corner(whole, m))
        try:
            return whole.eig(multiple=True)
        except ValueError:  # some cannot be told apart: all are less than a norm about their vectors
            vectors = whole.mid().eig(right=True, algorithm="approx")[1].mid()
            alike = vectors.solve(whole * vectors)
            norm = max(sum(abs(alike[i, j]).upper() for j in range(m)) for i in range(m))
            return [acb(arb(0, norm), arb(0, norm))] * m

    def verify(self):
        """Show all that is claimed."""
        own, first, n = self.problem, self.boxes[0], self.problem.n
        inside = (b.contains_interior(a) for both in zip(self.boxes, self.newton()) for b, a in zip(*both))
        show(all(inside), "that the boxes hold an orbit could not be shown")
        rest = all(a.contains(0) for a in first[own.free : own.free + own.first])
        show(not own.sign or not rest, "nothing moves in the linearised equations")
        if own.constraint:
            y = [a.union(b) if i == n else a for i, (a, b) in enumerate(zip(first, self.flows[-1][1]))]
            show(not self.slopes(own.constraint, y)[0][1][0, n].contains(0), "an unknown may have two values")
        values = [step.polynomials() for step, *_ in self.steps]
        for (step, begins, ends), at in zip(self.steps, values):
            for name, edge in own.compared.items():
                p, bent = [step.sides[name] * c for c in at[f"?{name}"]], own.kinds[name] in ("max", "min", "abs")
                if not (bent and all(c == 0 for c in p)):
                    keeps(p, "an event may have been missed", arb(0), step.h, edge == begins, edge == ends)
        for name, both in self.given["claims"]["outputs"].items():
            for sign, (k, *claimed) in zip((-1, 1), both):
                place, inner, outer = (arb(ratio(text)) for text in claimed)
                for (step, *_), at in zip(self.steps, values):
                    left = [sign * (outer - c) if j == 0 else -sign * c for j, c in enumerate(at[name])]
                    keeps(left, "an output may be beyond what is claimed", arb(0), step.h)
                reached = 0 <= place <= self.steps[k][0].h and sign * (value(values[k][name], place) - inner) > 0
                show(reached, "an output may not reach what is claimed")
        if "multipliers" in self.given["claims"]:
            self.balls = self.multipliers()
            self._stability(**self.given["claims"])

    def _stability(self, multipliers, stable, **_):
        discs = [acb(ball(real, radius), ball(imaginary, radius)) for real, imaginary, radius in multipliers]
        show(len(discs) == len(self.balls), "there are more or fewer multipliers")
        show(all(any(disc.contains(a) for disc in discs) for a in self.balls), "a multiplier may be elsewhere")
        show(all(any(disc.contains(a) for a in self.balls) for disc in discs), "a disc may have no multiplier")
        show(stable in (None, self.stable()), "the stability is not as claimed, or not known")

    def stable(self):
        """True or False, or None where that is not known: from the multipliers that were found."""
        balls = self.balls or [acb(arb("nan"))]
        if self.problem.free_running:  # one of a free oscillation is 1
            at = [k for k, a in enumerate(balls) if a.overlaps(acb(1))]
            balls = [a for k, a in enumerate(balls) if [k] != at]
        return all(abs(a) < 1 for a in balls) or (False if any(abs(a) > 1 for a in balls) else None)

def linked(one, other):
    """Show that at the value where one's range ends and the other's begins both have the same orbit."""
    alike = [([(piece["until"], piece["sides"]) for piece in each.pieces], each.over, each.given["claim"],
              [anchor for anchor in each.anchors if anchor[0] != each.over]) for each in (one, other)]
    show(alike[0] == alike[1] and one.end == other.begin, "two ranges do not meet")
    for fine, coarse in (one, other), (other, one):
        there = dict(zip(fine.places, fine.newton(one.end)))
        both = [(there.get(place, ()), box) for place, box in zip(coarse.places, coarse.boxes)]
        if all(y and all(b.contains(a) for a, b in zip(y, box)) for y, box in both):
            return
    raise NotProvedError("two ranges may have two orbits where they meet")

def says(given, orbits):
    """What is proven, in a sentence; values have the names that the certificate gives them."""
    names, problem = given["names"]["values"], orbits[0].problem
    half = max(float(b.rad()) for orbit in orbits for node in orbit.boxes for b in node[: problem.n])
    known = zip(problem.unknown, orbits[0].boxes[0][problem.first :])
    kinds = {orbit.stable() for orbit in orbits}
    kind = {True: ", stable", False: ", unstable", None: ""}[kinds.pop() if len(kinds) == 1 else None]
    where = f"in boxes of half width {half:.1e} at the most there is one"
    if given["claim"] == "stretch":
        low, high = orbits[0].begin, orbits[-1].end
        show(all(fmpq(*float(end).as_integer_ratio()) == end for end in (low, high)), "an end is no double")
        ends = f"{names[orbits[0].over]} from {float(low)!r} to {float(high)!r}"
        return f"for each {ends} {where} periodic orbit, and one only{kind}; they are one branch without a fold"
    what = {"orbit": "periodic orbit", "fold": "fold", "doubling": "period doubling"}[given["claim"]]
    return "".join([f"{where} {what}, and one only", kind, *(f", {names[u]} = {c.str(25)}" for u, c in known)])

def digest(given):
    rest = {name: each for name, each in given.items() if name != "digest"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()

def main(path):
    try:
        with open(path, encoding="utf-8") as file:
            given = json.load(file)
        show(given["digest"] == digest(given), "the certificate was changed")
        show(given["format"] == FORMAT, f"its format is not {FORMAT!r}")
        tiles = given["tiles"] if given["claim"] == "stretch" else [{}]
        show(all({*tile} <= {"pieces", "nodes", "anchors", "claims"} for tile in tiles), "a range is of another system")
        orbits = [Orbit({**given, **tile}) for tile in tiles]
        for orbit in orbits:
            orbit.verify()
        for one, other in zip(orbits, orbits[1:]):
            linked(one, other)
        print(f"proved: {says(given, orbits)}")
    except (NotProvedError, ArithmeticError, LookupError, TypeError, ValueError, AttributeError, OSError) as error:
        print(f"refused: {error}")
        return 1
    return 0

if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
