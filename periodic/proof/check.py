"""Check a certificate of a periodic orbit: python check.py certificate.json

Needs python-flint (ball arithmetic) and nothing else. A certificate has equations x' = f(x, t) as text, boxes Y
at nodes along an orbit, and claims. That the boxes hold one orbit, and one only, is shown by an interval Newton
step on multiple shooting,

    c - DF(Y)^-1 F(c)  inside  Y,    F_k = flow(y_k) - y_k+1,

with flows by Taylor series whose remainders are bounded over an enclosure of the motion (Nedialkov, Jackson &
Corliss, Appl. Math. Comput. 105, 1999), in pieces between events, at which what a max, min, abs, sign or less
compares is equal. That this happens nowhere else is shown too.
"""

import hashlib
import json
import re
import sys

from flint import acb, acb_mat, arb, arb_mat, arb_series, ctx, fmpq

FORMAT = "orbitrace proof 1"
DEPTH, TRIES = 40, 6  # halvings of a step to find a sign, attempts to enclose a motion; no truth hangs on them

class NotProvedError(Exception):
    """What could not be shown."""

def show(truth, what):
    if not truth:
        raise NotProvedError(what)

def ratio(text):
    return fmpq(*map(int, text.split("/")))

def matrix(rows, columns, entry):
    return arb_mat([[entry(i, j) for j in range(columns)] for i in range(rows)])

class Dual:
    """A value and its derivatives by direction; those of a lower level are constants to a higher one."""

    def __init__(self, level, value, slopes):
        self.level, self.value, self.slopes = level, value, slopes

def split(a, level):
    return (a.value, a.slopes) if isinstance(a, Dual) and a.level == level else (a, {})

def combined(f, a, b, by_a, by_b):
    """f(a, b), whose derivative is by_a(a, b, a') + by_b(a, b, b')."""
    level = max(getattr(a, "level", 0), getattr(b, "level", 0))
    if not level:
        return f(a, b)
    (u, du), (v, dv) = split(a, level), split(b, level)
    slopes = {j: by_a(u, v, s) for j, s in du.items()}
    for j, s in dv.items():
        slopes[j] = add(slopes[j], by_b(u, v, s)) if j in slopes else by_b(u, v, s)
    return Dual(level, combined(f, u, v, by_a, by_b), slopes)

def add(a, b):
    return combined(lambda u, v: u + v, a, b, lambda u, v, s: s, lambda u, v, s: s)

def sub(a, b):
    return combined(lambda u, v: u - v, a, b, lambda u, v, s: s, lambda u, v, s: mul(arb(-1), s))

def mul(a, b):
    return combined(lambda u, v: u * v, a, b, lambda u, v, s: mul(s, v), lambda u, v, s: mul(u, s))

def power(a, p):
    """a^p, p constant; where p > 0, numbers below 0 of a ball count as 0."""
    show(isinstance(p, arb), "an exponent varies")
    if isinstance(a, Dual):
        slope = mul(p, power(a.value, p - 1))
        return Dual(a.level, power(a.value, p), {j: mul(slope, s) for j, s in a.slopes.items()})
    if p.is_integer():
        return a ** int(p.unique_fmpz())
    first = nth(a, 0)
    if first > 0 or not p > 0:
        return a**p
    hull = arb(0).union(first.nonnegative_part().upper() ** p)
    return arb_series([hull] + [arb("nan")] * (ctx.cap - 1)) if isinstance(a, arb_series) else hull

SLOPES = {  # derivatives of f(u), whose value is v
    "sin": lambda u, v: unary("cos", u),
    "cos": lambda u, v: mul(arb(-1), unary("sin", u)),
    "exp": lambda u, v: v,
    "log": lambda u, v: unary("inv", u),
    "sqrt": lambda u, v: unary("inv", mul(arb(2), v)),
    "atan": lambda u, v: unary("inv", add(arb(1), mul(u, u))),
    "inv": lambda u, v: mul(arb(-1), mul(v, v)),
}
BINARY = {"+": add, "-": sub, "*": mul, "/": lambda a, b: mul(a, unary("inv", b)), "^": power}
BRANCHES = {  # by the side of a - b
    "max": lambda a, b, side: a if side > 0 else b,
    "min": lambda a, b, side: b if side > 0 else a,
    "less": lambda a, b, side: arb(0 if side > 0 else 1),
    "sign": lambda a, b, side: arb(1 if side > 0 else -1),
    "abs": lambda a, b, side: a if side > 0 else mul(arb(-1), a),
}
LINE = re.compile(r"(\w+) = (?:(\S+) ([-+*/^]) (\S+)|(\w+)\((\S+?)(?:, (\S+))?\))")

def unary(name, a):
    if isinstance(a, Dual):
        value = unary(name, a.value)
        slope = SLOPES[name](a.value, value)
        return Dual(a.level, value, {j: mul(slope, s) for j, s in a.slopes.items()})
    show(name != "inv" or not nth(a, 0).contains(0), "a denominator may be 0")
    return 1 / a if name == "inv" else getattr(a, name)()

class Problem:
    """The equations, in a time s that goes from 0 to 1 in each piece.

    Unknowns y: states x0.., unknown values, for folds and doublings v of the linearised equations, and where
    there are events the time t and the length of the piece.
    """

    def __init__(self, given):
        text = given["equations"]
        self.values = {name: arb(number) for name, number in text["values"].items()}
        self.unknown, self.lines, self.compared, self.jumping = given["unknown"], [], {}, set()
        known = {*self.values, *self.unknown, "t", *(f"x{i}" for i in range(len(text["rates"]) + ("constraint" in text)))}
        for line in text["lines"]:
            found = LINE.fullmatch(line)
            show(found, f"cannot read {line!r}")
            name, a, sign, b, function, first, second = found.groups()
            show((sign or function) in {**BINARY, **BRANCHES, **SLOPES} and name not in known, f"cannot read {line!r}")
            texts = a or first, b or second or "0.0"
            self.lines.append((name, sign or function, *(each if each in known else arb(each) for each in texts)))
            known.add(name)
            if function in BRANCHES:
                self.compared[name] = frozenset(texts)
            if function in ("less", "sign") or self.jumping & {*texts}:
                self.jumping.add(name)
        self.rates = [name if name in known else arb(name) for name in text["rates"]]
        self.kinds = {name: kind for name, kind, *_ in self.lines}
        self.sign = {"orbit": 0, "fold": 1, "doubling": -1}[given["claim"]]
        self.events, self.period = len(given["pieces"]) > 1, 2 * arb.pi() * int(given["turns"])
        show(self.period > 0, "the orbit takes no time")
        self.free_running = not any(re.search(r"\bt\b", line) for line in (*text["lines"], *text["rates"]))
        self.constraint, self.n = text.get("constraint"), len(text["rates"])
        self.first = self.n + bool(self.constraint)
        self.free = self.first + len(self.unknown)
        self.size = self.free + self.first * abs(self.sign) + 2 * self.events
        show(not (self.jumping and (self.sign or self.constraint)), "the equations jump, and with them what must not")

    def at(self, y, s, sides):
        """Every value of the text at y; `?name` is the difference that a branch compares with 0."""
        x = y[: self.first]
        if self.sign:
            x = [Dual(3, a, {0: v}) for a, v in zip(x, y[self.free :])]
        return self.run(x, y[self.first :], y[-2] if self.events else self.period * s, sides)

    def run(self, x, unknown, t, sides):
        at = self.values | {f"x{i}": a for i, a in enumerate(x)} | dict(zip(self.unknown, unknown)) | {"t": t}
        for name, kind, *operands in self.lines:
            a, b = (at[each] if isinstance(each, str) else each for each in operands)
            if kind in BRANCHES:
                at[f"?{name}"], at[name] = sub(a, b), BRANCHES[kind](a, b, sides[name])
            else:
                at[name] = unary(kind, a) if kind in SLOPES else BINARY[kind](a, b)
        return at

    def field(self, y, s, sides):
        """dy/ds; what the constraint g(x, z, t) = 0 determines has z' = -(g_x x' + g_t t') / g_z."""
        at, length = self.at(y, s, sides), y[-1] if self.events else self.period
        rates = [mul(length, at[name] if isinstance(name, str) else name) for name in self.rates]
        if self.constraint:
            x = [Dual(4, at[f"x{i}"], {0: rate} if i < self.n else {1: arb(1)}) for i, rate in enumerate([*rates, 0])]
            along = split(self.run(x, y[self.first :], Dual(4, at["t"], {0: length}), sides)[self.constraint], 4)[1]
            rates.append(mul(arb(-1), BINARY["/"](along[0], along[1])))
        both = [split(rate, 3) for rate in rates]
        found = [a for a, _ in both] + [arb(0)] * len(self.unknown)
        found += [slopes.get(0, arb(0)) for _, slopes in both] * abs(self.sign)
        return found + [length, arb(0)] * self.events

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

def slope(coefficients):
    return [k * c for k, c in enumerate(coefficients)][1:] or [arb(0)]

class Step:
    """A step of length h from boxes y at s: its motions, their derivatives, and all values along them."""

    def __init__(self, problem, y, s, h, order, sides):
        self.problem, self.s, self.h, self.order, self.sides = problem, s, h, order, sides
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

    def end(self, y=None):
        """Where motions are at its end: all of them, or that from a point y among them."""
        motion = self.motion if y is None else taylor(self.problem, y, self.s, self.sides, self.order - 1)
        both = zip(motion, self.later)
        return [value([*(nth(a, k) for k in range(self.order)), nth(b, self.order)], self.h) for a, b in both]

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

def keeps(p, sign, begin, h, first, last, depth=0):
    """Show sign p > 0 between begin and h, where p may vanish at begin (first) or at h (last)."""
    at, middle = begin.union(h), (begin + h) / 2
    rises = sign * value(slope(p), at)
    if sign * value(p, at) > 0 or (first and rises > 0) or (last and rises < 0):
        return
    show(depth < DEPTH and sign * value(p, middle) > 0, "an event may have been missed")
    keeps(p, sign, begin, middle, first, False, depth + 1)
    keeps(p, sign, middle, h, False, last, depth + 1)

def greatest(p, begin, h, bound, depth=0):
    """Show p < bound from begin to h; returns a value that p takes, about its greatest."""
    at, middle = begin.union(h), (begin + h) / 2
    rises, centre = value(slope(p), at), value(p, middle)
    if rises > 0 or rises < 0 or centre + rises * (at - middle) < bound:
        some = [value(p, begin), centre, value(p, h)]
        show(all(a < bound for a in some), "an output may be beyond what is claimed")
        return max(a.lower() for a in some)
    show(depth < DEPTH and centre < bound, "an output may be beyond what is claimed")
    return max(greatest(p, begin, middle, bound, depth + 1), greatest(p, middle, h, bound, depth + 1))

def upright(a):
    """Orthonormal columns, but for rounding, that span those of a, the longest first."""
    n, found = a.nrows(), []
    columns = sorted(([a[i, j].mid() for i in range(n)] for j in range(n)), key=lambda c: -sum(float(x) ** 2 for x in c))
    for column in columns:
        for other in found * 2:
            along = sum((x * y for x, y in zip(column, other)), arb(0)).mid()
            column = [(x - along * y).mid() for x, y in zip(column, other)]
        size = sum((x * x for x in column), arb(0)).sqrt()
        show(size > 0, "the multipliers are too far apart")
        found.append([(x / size).mid() for x in column])
    return matrix(n, n, lambda i, j: found[j][i])

class Orbit:
    """What a certificate is about: flows from node to node, and what follows from them."""

    def __init__(self, given):
        ctx.prec = given["bits"]
        self.given, self.problem = given, Problem(given)
        self.centres = [[arb(ratio(c)) for c in node["centre"]] for node in given["nodes"]]
        show(all(ratio(r) >= 0 for node in given["nodes"] for r in node["radius"]), "a box has no size")
        radii = [[arb(0, arb(ratio(r)).upper()) for r in node["radius"]] for node in given["nodes"]]
        self.boxes = [[c + r for c, r in zip(*each)] for each in zip(self.centres, radii)]
        show(not self.problem.events or all(box[-1] > 0 for box in self.boxes), "a piece takes no time")
        self.flows, self.steps, self.kind, edge = [], [], None, None
        for piece, after in zip(given["pieces"], [*given["pieces"][1:], None]):
            edge = self._followed(piece, after, edge)
        show(len(self.flows) == len(self.boxes) and edge is None, "nodes and steps do not match")

    def _followed(self, piece, after, edge):
        """Follow a piece from node to node; edge is what vanishes where it begins. Returns that of its end."""
        s, d, until = fmpq(0), self.problem.size, self.problem.compared[piece["until"]] if after else None
        show(not until or not until & self.problem.jumping, "what vanishes at an event jumps there")
        show(sum(ratio(h) for node in piece["steps"] for h, _ in node) == 1, "the steps do not add up to a piece")
        for k, node in enumerate(piece["steps"]):
            point, box = self.centres[len(self.flows)], self.boxes[len(self.flows)]
            whole = matrix(d, d, lambda i, j: int(i == j))
            for text, order in node:
                h, edge = ratio(text), edge if s == 0 else None
                show(h > 0, "a step has no length")
                step = Step(self.problem, box, arb(s), arb(h), order, piece["sides"])
                point, box, whole, s = step.end(point), step.end(), step.derivative * whole, s + h
                self.steps.append((step, edge, until if s == 1 else None))
            self.flows.append((point, box, whole, (piece, after) if k == len(piece["steps"]) - 1 else None))
        return until

    def slopes(self, name, y=None, s=0, sides=None):
        """A value of the text at y (the first box), with its slopes in y, and those of its derivative along v."""
        ctx.cap, y, sides = 1, y or self.boxes[0], sides or self.given["pieces"][0]["sides"]
        seeds = [Dual(2, a, {i: arb(1)}) for i, a in enumerate(y)]
        own, along = split(self.problem.at(seeds, arb(s), sides)[name], 3)
        found = split(own, 2), split(along.get(0, arb(0)), 2)
        return [(a, matrix(1, len(y), lambda _, j: b.get(j, arb(0)))) for a, b in found]

    def _event(self, piece, y):
        """What vanishes at the end of a piece at y, and its slopes."""
        return self.slopes(f"?{piece['until']}", y, 1, piece["sides"])[0]

    def newton(self):
        """The Newton step c - DF(Y)^-1 F(c), node by node."""
        own, d, m = self.problem, self.problem.size, len(self.boxes)
        every, right, anchors = arb_mat(d * m, d * m), arb_mat(d * m, 1), list(self.given["anchors"])
        for k, (point, box, by, ends) in enumerate(self.flows):
            after, last = (k + 1) % m, k == m - 1
            for i in range(d):
                row, length = k * d + i, own.events and i == d - 1
                v, determined = i - own.free, own.constraint and i in (own.n, own.free + own.first - 1)
                if last and (own.first <= i < own.free or length):  # given values in place of what does not change
                    index, text = anchors.pop(0)
                    right[row, 0], every[row, index] = self.centres[0][index] - arb(ratio(text)), arb(1)
                elif last and determined:
                    right[row, 0] = self.slopes(own.constraint, self.centres[0])[i != own.n][0]
                    slopes = self.slopes(own.constraint)[i != own.n][1]
                    for j in range(d):
                        every[row, j] = slopes[0, j]
                elif ends and length:
                    right[row, 0], slopes = self._event(ends[0], point)[0], self._event(ends[0], box)[1] * by
                    for j in range(d):
                        every[row, k * d + j] = slopes[0, j]
                else:
                    sign = own.sign if last and own.sign and 0 <= v < own.first else 1
                    turn = own.period if last and own.events and i == d - 2 else 0
                    right[row, 0] = point[i] - sign * self.centres[after][i] - turn
                    for j in range(d):
                        every[row, k * d + j] += by[i, j]
                    every[row, after * d + i] -= sign
        show(not anchors, "too many values are given")
        try:
            step = every.solve(right)
        except ZeroDivisionError:
            raise NotProvedError("the orbit may not be isolated: Newton's matrix may be singular") from None
        return [[c - step[k * d + i, 0] for i, c in enumerate(row)] for k, row in enumerate(self.centres)]

    def multipliers(self):
        """Balls with the Floquet multipliers, those of the product of saltation and flow matrices."""
        n, m = self.problem.first, self.problem.n
        basis = product = matrix(n, n, lambda i, j: int(i == j))
        for _, box, by, ends in self.flows:
            moved = matrix(n, n, lambda i, j: by[i, j]) * basis
            if ends and ends[1]:
                slopes, (f, g) = self._event(ends[0], box)[1], (self.problem.field(box, 1, p["sides"]) for p in ends)
                speed = sum((slopes[0, i] * f[i] for i in range(len(box))), arb(0))
                jump, edge = matrix(n, 1, lambda i, _: (g[i] - f[i]) / speed), matrix(1, n, lambda _, j: slopes[0, j])
                moved += jump * (edge * moved)
            basis = upright(moved)
            product = basis.solve(moved) * product
        whole = basis * product
        if self.problem.constraint:
            edge = self.slopes(self.problem.constraint)[0][1]
            whole = whole * matrix(n, m, lambda i, j: arb(int(i == j)) if i < m else -edge[0, j] / edge[0, m])
        whole = acb_mat(matrix(m, m, lambda i, j: whole[i, j]))
        try:
            return whole.eig(multiple=True)
        except ValueError:  # some cannot be told apart: all are less than a norm about their vectors
            _, vectors = whole.mid().eig(right=True, algorithm="approx")
            alike = vectors.mid().solve(whole * vectors.mid())
            norm = max(sum(abs(alike[i, j]).upper() for j in range(m)) for i in range(m))
            return [acb(arb(0, norm), arb(0, norm))] * m

    def verify(self):
        """Show all that is claimed."""
        claims, solution = self.given["claims"], self.newton()
        inside = (b.contains_interior(a) for both in zip(self.boxes, solution) for b, a in zip(*both))
        show(all(inside), "that the boxes hold an orbit could not be shown")
        values = [step.polynomials() for step, *_ in self.steps]
        for (step, first, last), own in zip(self.steps, values):
            for name, edge in self.problem.compared.items():
                p, bent = own[f"?{name}"], self.problem.kinds[name] in ("max", "min", "abs")
                if not (bent and all(c == 0 for c in p)):
                    keeps(p, step.sides[name], arb(0), step.h, edge == first, edge == last)
        for name, both in claims["outputs"].items():
            for sign, (inner, outer) in zip((-1, 1), both):
                bound, every = sign * arb(ratio(outer)), zip(values, self.steps)
                found = [greatest([sign * c for c in own[name]], arb(0), one[0].h, bound) for own, one in every]
                show(max(found) > sign * arb(ratio(inner)), "an output may not reach what is claimed")
        if "multipliers" in claims:
            self._stability(claims)
            self.kind = claims["stable"]

    def _stability(self, claims):
        balls = self.multipliers()
        discs = [acb(*(arb(ratio(c), arb(ratio(disc[2])).upper()) for c in disc[:2])) for disc in claims["multipliers"]]
        show(len(discs) == len(balls), "there are more or fewer multipliers")
        show(all(any(disc.contains(ball) for disc in discs) for ball in balls), "a multiplier may be elsewhere")
        show(all(any(disc.contains(ball) for ball in balls) for disc in discs), "a disc may have no multiplier")
        show(claims["stable"] in (None, self.stable()), "the stability is not as claimed, or not known")

    def stable(self):
        """True or False, or None where that is not known."""
        balls = self.multipliers()
        if self.problem.free_running:  # one of a free oscillation is 1
            at = [k for k, ball in enumerate(balls) if ball.overlaps(acb(1))]
            balls = [ball for k, ball in enumerate(balls) if [k] != at]
        inside = all(abs(ball) < 1 for ball in balls)
        return inside or (False if any(abs(ball) > 1 for ball in balls) else None)

    def says(self):
        """What is proven, in a sentence; unknown values have the names that the certificate gives them."""
        names, first, box = self.given["names"]["values"], self.problem.first, self.boxes[0]
        known = [f"{names[u]} = {c.str(25)}" for u, c in zip(self.problem.unknown, box[first:])]
        kind = {True: ", stable", False: ", unstable", None: ""}[self.kind]
        half = max(float(b.rad()) for node in self.boxes for b in node[: self.problem.n])
        what = {"orbit": "periodic orbit", "fold": "fold", "doubling": "period doubling"}[self.given["claim"]]
        what = f"in boxes of half width {half:.1e} at the most there is one {what}, and one only"
        return "".join([what, kind, *(f", {each}" for each in known)])

def digest(given):
    rest = {name: each for name, each in given.items() if name != "digest"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()

def main(path):
    try:
        with open(path, encoding="utf-8") as file:
            given = json.load(file)
        show(given["digest"] == digest(given), "the certificate was changed")
        show(given["format"] == FORMAT, f"its format is not {FORMAT!r}")
        orbit = Orbit(given)
        orbit.verify()
    except (NotProvedError, ArithmeticError, LookupError, TypeError, ValueError, AttributeError, OSError) as error:
        print(f"refused: {error}")
        return 1
    print(f"proved: {orbit.says()}")
    return 0

if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
