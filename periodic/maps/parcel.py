"""How a task travels to other processes: pickled once, with functions of a script or notebook by value."""

from __future__ import annotations

import pickle

from periodic.maps.task import Task


def packed(task: Task) -> bytes:
    """Return a task as bytes that any process with the same packages can open. Raises ValueError."""
    import cloudpickle

    try:
        content: bytes = cloudpickle.dumps(task)
    except (pickle.PicklingError, TypeError, AttributeError, NotImplementedError) as error:
        said = " ".join(str(error).split())
        raise ValueError(
            f"task cannot travel to other processes ({said}); its system and numbers must be made of data "
            f"and functions, or executor must be 1, which computes here"
        ) from error
    return content
