"""How work travels to other processes: pickled once, with functions of a script or notebook by value."""

from __future__ import annotations

import pickle


def packed(name: str, work: object) -> bytes:
    """Return work as bytes that any process with the same packages can open. Raises ValueError."""
    import cloudpickle

    try:
        content: bytes = cloudpickle.dumps(work)
    except (pickle.PicklingError, TypeError, AttributeError, NotImplementedError) as error:
        said = " ".join(str(error).split())
        raise ValueError(
            f"{name} cannot travel to other processes ({said}); its system and all else it has must be "
            f"made of data and functions, or executor must be 1, which computes here"
        ) from error
    return content
