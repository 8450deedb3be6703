"""What a scene file may say: tables, keys, units and ranges. The description of a field is what it allows."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import MISSING, fields
from functools import cache
from importlib import resources
from typing import Any, Literal, cast

from pydantic import Field, create_model, model_validator

from symbolic.parts.contact.law import ContactLaw
from symbolic.scenes.errors import InputError, listed, refused, shown
from symbolic.scenes.laws import HERTZ, PALMGREN, TAKEN, contact_laws
from symbolic.scenes.model.scene import ModelScene
from symbolic.scenes.ranges import FrequencyRange, SpeedRange
from symbolic.scenes.scenetables import Table, Title, number, whole


class Discs(Table):
    """Two equal discs. Crown radius and elastic constants matter to some laws of film thickness only."""

    mass: float = number(1e-6, 1e6, "kg")
    diameter: float = number(1e-4, 100, "m")
    crown: float | None = Field(
        None, ge=1e-4, le=1e3, description="a number from 0.0001 to 1000 (m; 0.102 where absent)"
    )
    modulus: float | None = Field(
        None, ge=1e6, le=1e13, description="a number from 1e+06 to 1e+13 (Pa; 2.07e+11 where absent)"
    )
    poisson: float | None = Field(None, ge=0, le=0.5, description="a number from 0 to 0.5 (0.3 where absent)")


class AnyContact(Table):
    """A contact of any law under a constant preload; the law's own numbers are keys beside these."""

    law: str | None = Field(None, description="the name of a contact law")
    preload: float = number(1e-2, 1e8, "N")

    @property
    def numbers(self) -> dict[str, float]:
        """The numbers of the law."""
        return self.model_dump(exclude=TAKEN)


class Contact(AnyContact):
    """Hertz contact: load = stiffness * deflection^exponent."""

    stiffness: float = number(1, 1e24, "N/m^exponent")
    exponent: float = number(1, 4)


class LineContact(AnyContact):
    """Cylinders along a line: Palmgren's law."""

    length: float = number(1e-5, 10, "m")


class Waviness(Table):
    """Sinusoidal corrugations on one disc; with `reduction` the film keeps its part of them."""

    amplitude: float = number(1e-10, 1e-3, "m")
    waves: int = whole(1, 100_000)
    reduction: bool = Field(False, description="true or false")


FILM_NEEDS: dict[str, tuple[str, ...]] = {
    "squeeze": ("squeeze",),
    "quasistatic": (),
    "cavitating": ("squeeze", "floor"),
    "third-order": ("squeeze",),
}
"""Numbers that a film law needs and others may not have."""


class Film(Table):
    """The lubricant film; a viscosity given beside a lubricant replaces the lubricant's."""

    law: Literal["squeeze", "quasistatic", "cavitating", "third-order"] = Field(
        description='"squeeze", "quasistatic", "cavitating" or "third-order"'
    )
    thickness: Literal[
        "calibrated",
        "equation-5",
        "constant-one-body",
        "constant-two-body",
        "hamrock-dowson",
        "regimes",
        "line",
    ] = Field(
        "calibrated",
        description='"calibrated", "equation-5", "constant-one-body", "constant-two-body", '
        '"hamrock-dowson", "regimes" or "line"',
    )
    lubricant: str | None = Field(None, description="the name of a lubricant")
    viscosity: float = number(1e-5, 1e3, "Pa s")
    piezoviscosity: float = number(1e-10, 1e-6, "m^2/N")
    beta: float = number(0.5, 200)
    squeeze: float | None = Field(
        None, ge=1e-3, le=1e7, description='a number from 0.001 to 1e+07 (law = "quasistatic" has none)'
    )
    floor: float | None = Field(
        None, ge=1e-8, le=0.5, description='a number from 1e-08 to 0.5 (law = "cavitating" only)'
    )

    @model_validator(mode="before")
    @classmethod
    def _lubricated(cls, table: Any) -> Any:
        if not isinstance(table, dict) or not isinstance(table.get("lubricant"), str):
            return table
        known = lubricants()
        if table["lubricant"] not in known:
            raise refused("film.lubricant", table["lubricant"], listed(sorted(known)))
        return {**known[table["lubricant"]], **table}

    @model_validator(mode="after")
    def _complete(self) -> Film:
        for key in ("squeeze", "floor"):
            value, needed = getattr(self, key), key in FILM_NEEDS[self.law]
            if needed and value is None:
                allowed = type(self).model_fields[key].description
                raise InputError(f"film.{key}", "is missing", f"it must be {allowed}")
            if value is not None and not needed:
                raise InputError(f"film.{key}", f"is {value:g}", f'law = "{self.law}" must have none')
        return self


class Damping(Table):
    """Viscous damping of the contact's approach, relative to critical damping."""

    ratio: float = number(0, 5)


class Support(Table):
    """Each disc sits in a bearing of finite stiffness, the housing behind it on a leaf spring."""

    stiffness: float = number(1e2, 1e15, "N/m, of each disc's bearing")
    damping: float = number(0, 1e12, "N s/m, of each disc's bearing")
    disc_share: float = number(1e-7, 0.9999999, "part of discs.mass before the bearing")
    leaf: float | None = Field(
        None, ge=0, le=1e15, description="a number from 0 to 1e+15 (N/m, from each housing to ground)"
    )


class DiscScene(Table):
    """Two discs in rolling contact, one of them wavy."""

    title: Title
    kind: Literal["disc"]
    discs: Discs
    contact: AnyContact
    waviness: Waviness
    film: Film | None = None
    damping: Damping | None = None
    support: Support | None = None
    trace: SpeedRange

    @model_validator(mode="after")
    def _reducible(self) -> DiscScene:
        if self.support is not None and self.film is not None and self.film.law == "third-order":
            raise InputError("support", "is given", 'film.law = "third-order" must have none')
        return self

    @model_validator(mode="after")
    def _reduced(self) -> DiscScene:
        if self.waviness.reduction and self.film is None:
            raise InputError("waviness.reduction", "is true", "only a scene with a film may have it")
        return self

    @model_validator(mode="after")
    def _line(self) -> DiscScene:
        """Refuse a film of lines in a contact that is none."""
        if self.film is not None and self.film.thickness == "line" and self.contact.law != PALMGREN:
            raise InputError("film.thickness", 'is "line"', 'only contact.law = "palmgren" may have it')
        return self

    @model_validator(mode="after")
    def _elastic(self) -> DiscScene:
        """Refuse elastic constants that nothing in the scene depends on."""
        calibrated = self.film is None or self.film.thickness == "calibrated"
        if calibrated and not self.waviness.reduction:
            for key in ("crown", "modulus", "poisson"):
                if (value := getattr(self.discs, key)) is not None:
                    allowed = "only a film whose thickness is not calibrated may have one"
                    raise InputError(f"discs.{key}", f"is {value:g}", allowed)
        return self


class Oscillator(Table):
    """mass x'' + damping x' + stiffness x + cubic x^3 = force cos(Omega t)."""

    mass: float = number(1e-12, 1e12, "kg")
    damping: float | None = Field(None, ge=0, le=1e12, description="a number from 0 to 1e+12 (N s/m)")
    stiffness: float = number(0, 1e18, "N/m")
    cubic: float | None = Field(None, ge=-1e24, le=1e24, description="a number from -1e+24 to 1e+24 (N/m^3)")
    force: float = number(1e-12, 1e12, "N")

    @model_validator(mode="after")
    def _restored(self) -> Oscillator:
        if self.stiffness == 0 and (self.cubic or 0) <= 0:
            raise InputError("oscillator.stiffness", "is 0", "it must be greater than 0 where cubic is not")
        return self


class HertzDiscScene(DiscScene):
    """Two discs in Hertzian rolling contact."""

    contact: Contact


class LineDiscScene(DiscScene):
    """Two cylinders in rolling contact along a line, one of them wavy."""

    contact: LineContact


class OscillatorScene(Table):
    """A forced oscillator with a linear and a cubic spring."""

    title: Title
    kind: Literal["oscillator"]
    oscillator: Oscillator
    trace: FrequencyRange


Scene = DiscScene | OscillatorScene | ModelScene

KINDS: dict[str, type[Scene]] = {
    "disc": HertzDiscScene,
    "oscillator": OscillatorScene,
    "model": ModelScene,
    "structure": ModelScene,
}


def schema_of(tables: Mapping[str, Any]) -> type[Scene]:
    """Return what a scene must be, by its kind and its law of contact. Raises InputError."""
    kind, contact = tables.get("kind"), tables.get("contact")
    if kind is None:
        raise InputError("kind", "is missing", f"it must be {listed([shown(name) for name in KINDS])}")
    if not isinstance(kind, str) or kind not in KINDS:
        raise refused("kind", kind, listed([shown(name) for name in KINDS]))
    law = contact.get("law", HERTZ) if isinstance(contact, dict) else HERTZ
    if kind != "disc" or law == HERTZ:
        return KINDS[kind]
    if law == PALMGREN:
        return LineDiscScene
    laws = contact_laws()
    if not isinstance(law, str) or law not in laws:
        raise refused("contact.law", law, listed([shown(name) for name in laws]))
    return _disc_scene(laws[law])


def _disc_scene(law: type[ContactLaw]) -> type[DiscScene]:
    """The scene of discs whose table [contact] has the fields of a registered law."""
    numbers: dict[str, Any] = {
        field.name: (float, Field(... if field.default is MISSING else field.default, description="a number"))
        for field in fields(cast(Any, law))
    }
    contact = create_model("Contact", __base__=AnyContact, **numbers)
    return create_model("DiscScene", __base__=DiscScene, contact=(contact, ...))


@cache
def lubricants() -> dict[str, dict[str, float]]:
    """Return viscosity (Pa s) and piezoviscosity (m^2/N) of the lubricants that scenes can name."""
    return tomllib.loads(resources.files("symbolic.scenes").joinpath("lubricants.toml").read_text("utf-8"))
