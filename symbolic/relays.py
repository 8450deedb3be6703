"""Relays with hysteresis as an operation in equations: each has a mode, which the model at work keeps.

A relay is on or off, and that is no function of the state: between its thresholds it keeps what it is. So
its value is a symbol that a model gets when its equations are called, and none of numbers.
"""

from __future__ import annotations

import reprlib
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Protocol

import casadi as ca
import numpy as np


class Keeper(Protocol):
    """What keeps the modes of relays: the workbench of a model."""

    def relay(self, u: ca.SX, on: ca.SX, off: ca.SX) -> ca.SX:
        """Return the symbol of a relay: 1 where it is on, -1 where it is off.

        Parameters
        ----------
        u, on, off : casadi.SX
            What is compared, and the thresholds.

        Returns
        -------
        casadi.SX
            A symbol of its own.
        """


_AT_WORK: ContextVar[Keeper | None] = ContextVar("at work", default=None)


@contextmanager
def kept_by(keeper: Keeper) -> Iterator[None]:
    """Let relays that are called inside the block belong to a model.

    Parameters
    ----------
    keeper : Keeper
        Its workbench.

    Yields
    ------
    None
        Nothing.
    """
    token = _AT_WORK.set(keeper)
    try:
        yield
    finally:
        _AT_WORK.reset(token)


def symbol_of(u: Any, on: Any, off: Any) -> ca.SX:
    """Return the symbol of a relay of the model at work: 1 where it is on, -1 where it is off.

    Parameters
    ----------
    u, on, off : expression or float
        What is compared, and the thresholds.

    Returns
    -------
    casadi.SX
        The symbol.

    Raises
    ------
    ValueError
        Where no model is at work, and for what is no expression.
    """
    keeper = _AT_WORK.get()
    if keeper is None:
        raise ValueError(
            "relay is called outside of a model's equations; it must be called in them, as whether it is on "
            "is told by a motion alone"
        )
    given = [expression(name, value) for name, value in (("u", u), ("on", on), ("off", off))]
    return keeper.relay(*given)


def expression(name: str, value: Any) -> ca.SX:
    """Return a number or expression as one expression. Raises ValueError for anything else.

    Parameters
    ----------
    name : str
        What it is of a relay.
    value : expression or float
        It.

    Returns
    -------
    casadi.SX
        A scalar.
    """
    if isinstance(value, np.ndarray) and value.shape == ():
        value = value.item()
    if not isinstance(value, ca.SX | int | float | np.number) or isinstance(value, bool):
        raise ValueError(f"{name} of a relay is {reprlib.repr(value)}; it must be an expression or a number")
    found = value if isinstance(value, ca.SX) else ca.SX(float(value))
    if not found.is_scalar():
        raise ValueError(f"{name} of a relay is {reprlib.repr(value)}; it must be one expression or number")
    return found
