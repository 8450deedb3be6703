"""What a branch is made with, as plain data: settings, conditions and functionals, compared by value.

Data are None, booleans, numbers, texts, lists and dictionaries with texts for keys, as JSON has them. An
object becomes a dictionary of its fields, with its type's name under "is", a keyword that no field can have.
A function becomes its name and the digest of its code.
"""

from __future__ import annotations

import functools
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np

from periodic.checks import printable
from periodic.results.files import digest

IS, CODE = "is", "code"
"""Keys of a description: the name of a type or function, and the digest of its code."""

DIGESTED_FROM = 32
"""Arrays of more numbers than these are described by a digest."""

PLAIN = (bool, int, float, str)


def described(value: object) -> Any:
    """Return a description of a value as plain data; equal values have equal descriptions.

    Parameters
    ----------
    value : object
        Numbers, texts, arrays, enums, mappings, sequences, dataclasses, functions, and objects made of such.
        Fields whose names begin with an underscore are left out.

    Returns
    -------
    None, bool, int, float, str, list or dict
        See the module.
    """
    return _described(value, ())


def _described(value: object, inside: tuple[int, ...]) -> Any:
    if id(value) in inside:
        return {IS: _name(type(value))}
    within = (*inside, id(value))
    if value is None:
        return None
    if isinstance(value, Enum):
        return f"{type(value).__name__}.{value.name}"
    if isinstance(value, np.ndarray | np.generic):
        return _array(np.asarray(value), within)
    if isinstance(value, PLAIN):
        return next(kind(value) for kind in PLAIN if isinstance(value, kind))
    if isinstance(value, Mapping):
        return {str(key): _described(item, within) for key, item in value.items()}
    if isinstance(value, set | frozenset):
        return sorted((_described(item, within) for item in value), key=repr)
    if isinstance(value, Sequence):
        return [_described(item, within) for item in value]
    if isinstance(value, type):
        return _name(value)
    if callable(value) and hasattr(value, "__name__"):
        return _function(value, within)
    return _object(value, within)


def _array(value: np.ndarray, inside: tuple[int, ...]) -> Any:
    if value.dtype.hasobject or value.size <= DIGESTED_FROM:
        return _described(value.tolist(), inside)
    return {IS: f"array {value.shape}", CODE: digest(np.ascontiguousarray(value).tobytes())}


def _function(value: Callable[..., object], inside: tuple[int, ...]) -> dict[str, Any]:
    """A function by its name, code, defaults and the variables of its closure; a method with its object."""
    plain = getattr(value, "__func__", value)
    found: dict[str, Any] = {IS: f"{plain.__module__}.{plain.__qualname__}"}
    if isinstance(plain, types.FunctionType):
        cells = [cell.cell_contents for cell in plain.__closure__ or ()]
        held = {"of": cells, "defaults": [plain.__defaults__, plain.__kwdefaults__]}
        found |= {} if _ours(plain.__module__) else {CODE: _code(plain.__code__)}
        found |= {name: _described(item, inside) for name, item in held.items()}
    if plain is not value:
        found["self"] = _described(getattr(value, "__self__", None), inside)
    return found


def _object(value: object, inside: tuple[int, ...]) -> dict[str, Any]:
    """An object by its type and its public fields; the code of types that are not ours counts as well."""
    kind = type(value)
    found: dict[str, Any] = {IS: _name(kind)}
    if isinstance(value, functools.partial):
        held: dict[str, object] = {"function": value.func, "args": value.args, "keywords": value.keywords}
    elif is_dataclass(value):
        held = {field.name: getattr(value, field.name) for field in fields(value)}
    else:
        held = dict(getattr(value, "__dict__", {}))
    if not _ours(kind.__module__):
        own = [item for base in kind.__mro__ for item in vars(base).values()]
        codes = [_code(item.__code__) for item in own if isinstance(item, types.FunctionType)]
        found |= {CODE: digest("".join(codes).encode())[:16]} if codes else {}
    return found | {n: _described(item, inside) for n, item in held.items() if not n.startswith("_")}


def _code(code: types.CodeType) -> str:
    """Digest of a function's instructions, names and constants, whatever its place in the file."""
    constants = [_constant(c) for c in code.co_consts]
    return digest(code.co_code, repr((code.co_names, code.co_varnames, constants)).encode())[:16]


def _constant(value: object) -> str:
    if isinstance(value, types.CodeType):
        return _code(value)
    return repr(sorted(map(repr, value)) if isinstance(value, frozenset) else value)


def _ours(module: str) -> bool:
    return module.partition(".")[0] == __name__.partition(".")[0]


def _name(kind: type) -> str:
    return kind.__qualname__ if _ours(kind.__module__) else f"{kind.__module__}.{kind.__qualname__}"


def differences(before: Any, now: Any, free: Sequence[str] = ()) -> list[str]:
    """Return a sentence for each field in which two descriptions differ.

    Parameters
    ----------
    before, now : dict
        Descriptions by field, as `described` makes them.
    free : sequence of str
        Places that may differ, "settings.step.max_points".

    Returns
    -------
    list of str
        "settings step.ds = 0.02; now they are step.ds = 0.01", field by field.
    """
    found = []
    for name in dict.fromkeys((*before, *now)):
        apart = [d for d in _apart(before.get(name), now.get(name), name) if d[0] not in free]
        if apart:
            old, new = (", ".join(_text_of(d[0], name, d[k]) for d in apart) for k in (1, 2))
            found.append(printable(f"{name} {old}; now they are {new}"))
    return found


def _apart(before: Any, now: Any, place: str) -> Iterator[tuple[str, Any, Any]]:
    """Where two descriptions differ, and what stands there."""
    both = isinstance(before, dict) and isinstance(now, dict)
    if both and before.get(IS) == now.get(IS):
        for name in dict.fromkeys((*before, *now)):
            yield from _apart(before.get(name), now.get(name), f"{place}.{name}")
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        if any(True for a, b in zip(before, now, strict=True) for _ in _apart(a, b, place)):
            yield place, before, now
    elif before != now and repr(before) != repr(now):  # not a number is not equal to itself
        yield place, before, now


def _text_of(place: str, name: str, value: Any) -> str:
    inner = place.removeprefix(name).removeprefix(".")
    return f"{inner} = {_shown(value)}" if inner else _shown(value)


def _shown(value: Any) -> str:
    """A description as one would write the value."""
    if isinstance(value, dict):
        held = {k: v for k, v in value.items() if k not in (IS, CODE)}
        inner = ", ".join(f"{k}={_shown(v)}" for k, v in held.items())
        return f"{str(value[IS]).rpartition('.')[2]}({inner})" if IS in value else f"{{{inner}}}"
    if isinstance(value, list):
        return f"({', '.join(map(_shown, value))})"
    return "none" if value is None else repr(value) if isinstance(value, float) else str(value)
