"""The vectors in which the expressions of a compiled system are written."""

from __future__ import annotations

import casadi as ca

from symbolic.equations.assembly import Assembly


class Packed:
    """The vectors that take the place of an assembly's single symbols.

    Parameters
    ----------
    assembly : Assembly
        The workbench of a model, all its parts laid and closed.
    """

    def __init__(self, assembly: Assembly) -> None:
        self.assembly = assembly
        states, unknowns = assembly.states, assembly.unknowns
        parameters = [symbols for _, symbols in assembly.numbers.named().values()]
        self.phase = ca.SX.sym("tau")
        self.rate, self.state = ca.SX.sym("rate", len(states)), ca.SX.sym("state", len(states))
        self.parameter = ca.SX.sym("parameter", len(parameters))
        self.unknown = ca.SX.sym("algebraic", len(unknowns))
        self.increment = ca.SX.sym("increment", len(unknowns))
        self.waves = assembly.excitation.symbols
        self.relays = [relay.symbol for relay in assembly.relays.values()]
        scales = ca.vertcat(*[s.scale for s in states])
        old = [s.derivative for s in states] + [s.symbol for s in states]
        old += [u.symbol for u in unknowns] + [symbol for symbols in parameters for symbol in symbols]
        values = [self.parameter[k] for k, symbols in enumerate(parameters) for _ in symbols]
        self.old = ca.vertcat(*old)
        self.new = ca.vertcat(self.rate * scales, self.state * scales, self.unknown, *values)

    def scaled(self, expressions: list[ca.SX], waved: ca.SX | None = None, *, relays: bool = False) -> ca.SX:
        """Stack expressions in SI as one in the vectors.

        Parameters
        ----------
        expressions : list of casadi.SX
            In the assembly's symbols.
        waved : casadi.SX, optional
            What stands for the waves of the excitation; by default their values at the phase.
        relays : bool
            Whether relays stay their symbols; by default they are on above their upper threshold alone.

        Returns
        -------
        casadi.SX
            A column in the vectors.
        """
        excitation = self.assembly.excitation
        stacked = ca.vertcat(ca.SX(0, 1), *expressions)
        for relay in () if relays else reversed(self.assembly.relays.values()):  # those before may be in it
            stacked = ca.substitute(stacked, relay.symbol, ca.copysign(1, relay.over))
        stacked = self.assembly.with_frequency(stacked)
        stacked = excitation.timed(stacked, self.phase)
        given = excitation.values(self.phase) if waved is None else waved
        return ca.substitute(ca.substitute(stacked, self.waves, given), self.old, self.new)
