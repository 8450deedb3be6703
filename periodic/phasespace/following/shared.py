"""Parts of motions shared out: to threads, processes or machines, those that are kept already to nobody."""

from __future__ import annotations

import pickle
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Protocol

from periodic.phasespace.following.onebyone import OneByOne
from periodic.phasespace.following.parts import Part, arrays_of, of_arrays
from periodic.phasespace.following.working import Work, WorkStoppedError, work
from periodic.system.ensembles import EnsembleLike, FollowedLike
from periodic.workers.cores import cores
from periodic.workers.execution import DIED, Execution, ExecutorGoneError
from periodic.workers.executors import Workers

Found = tuple[int, FollowedLike]
"""Which part, and what became of its motions."""


class Crowded(Protocol):
    """Whose motions they are."""

    @property
    def ensemble(self) -> EnsembleLike: ...
    @property
    def identity(self) -> str: ...

    def parcel(self) -> bytes:
        """What travels to other processes; opened it is the same again."""


def followed(crowd: Crowded, parts: Sequence[Part]) -> list[FollowedLike]:
    """Return what becomes of some parts of the motions of a crowd.

    Raises WorkStoppedError where an executor goes away, ValueError where a system cannot travel to it.
    """
    where = work()
    keys = [part.key(crowd.identity) for part in parts] if where.kept else []
    known = {k: of_arrays(held) for k, key in enumerate(keys) if where.kept and (held := where.kept.get(key))}
    found: dict[int, FollowedLike] = {**known}
    for k, what in _fresh(crowd, {k: part for k, part in enumerate(parts) if k not in known}, where):
        found[k] = what
        if where.kept:
            where.kept.add(keys[k], arrays_of(what))
    return [found[k] for k in range(len(parts))]


def _fresh(crowd: Crowded, parts: dict[int, Part], where: Work) -> Iterator[Found]:
    """Follow parts, wherever that is done."""
    if where.workers is not None and len(parts) > 1:
        yield from _elsewhere(crowd, parts, where.workers)
    elif len(parts) < 2 or cores() == 1 or isinstance(crowd.ensemble, OneByOne):
        yield from ((k, part.followed(crowd.ensemble)) for k, part in parts.items())
    else:
        with ThreadPoolExecutor(cores()) as pool:
            each = pool.map(lambda part: part.followed(crowd.ensemble), parts.values())
            yield from zip(parts, each, strict=True)


def _elsewhere(crowd: Crowded, parts: dict[int, Part], workers: Workers) -> Iterator[Found]:
    """Follow parts by workers."""
    parcel = crowd.parcel()

    def job(those: tuple[int, ...]) -> tuple[object, ...]:
        return _worked, parcel, {k: parts[k] for k in those}

    try:
        for each in Execution(workers, job, _lost).outcomes([(k,) for k in parts]):
            yield from each
    except ExecutorGoneError as error:
        raise WorkStoppedError(f"the executor went away ({error}); what is kept is not lost") from error


def _worked(parcel: bytes, parts: dict[int, Part]) -> list[Found]:
    """What becomes of parts, in whichever process: this is what executors are given."""
    return [(k, of_arrays(arrays_of(part.followed(_opened(parcel).ensemble)))) for k, part in parts.items()]


@lru_cache(maxsize=4)
def _opened(parcel: bytes) -> Crowded:
    """The crowd of a parcel, compiled once in each process."""
    crowd: Crowded = pickle.loads(parcel)
    return crowd


def _lost(k: int) -> Found:
    raise WorkStoppedError(f"of the motions of part {k}, {DIED}, twice; what is kept is not lost")
