"""The laws of contact that scene files can name: Hertz's, and those that a program registers."""

from __future__ import annotations

import re

from symbolic.parts.contact.law import ContactLaw, HertzLaw
from symbolic.parts.contact.palmgren import PalmgrenLaw

HERTZ, PALMGREN = "hertz", "palmgren"
NAME = re.compile(r"[a-z][a-z0-9-]{0,39}")
TAKEN = {"law", "preload"}
"""Keys of the table [contact] that are not numbers of a law."""

BUILT_IN: dict[str, type[ContactLaw]] = {HERTZ: HertzLaw, PALMGREN: PalmgrenLaw}

_laws = dict(BUILT_IN)


def register_contact_law(name: str, law: type[ContactLaw]) -> None:
    """Let scene files name a law of contact: `law = "NAME"` in the table [contact].

    The other keys of the table are then `preload` and the law's fields, each a number. A name registered
    again stands for the law given last.

    Parameters
    ----------
    name : str
        What scene files call it: small letters, digits and hyphens.
    law : type of ContactLaw
        A dataclass of numbers with `load`.

    Raises
    ------
    ValueError
        For a name that cannot be taken, and for a law that is no dataclass or has a field `law` or `preload`.
    """
    if not NAME.fullmatch(name) or name in BUILT_IN:
        own = " or ".join(map(repr, BUILT_IN))
        raise ValueError(
            f"name of a contact law is {name!r}; it must be small letters, digits and hyphens, not {own}"
        )
    fields = getattr(law, "__dataclass_fields__", None)
    if fields is None:
        raise ValueError(f"contact law {name!r} is {law!r}; it must be a dataclass")
    if TAKEN & fields.keys():
        raise ValueError(f"contact law {name!r} has {TAKEN & fields.keys()}; scenes use these names already")
    _laws[name] = law


def contact_laws() -> dict[str, type[ContactLaw]]:
    """Return the laws by name."""
    return dict(_laws)
