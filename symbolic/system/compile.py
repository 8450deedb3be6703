"""A model becomes a System: its parts lay down their terms, and these become kernels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from symbolic.checks import refusal, typed
from symbolic.equations import kinks
from symbolic.equations.assembly import Assembly
from symbolic.equations.expressions import Expressions, expressed
from symbolic.equations.freemotion import Silence, let_go
from symbolic.equations.model import Model, Part
from symbolic.equations.variables import SwitchInfo, Variable
from symbolic.interrupts import interruptible
from symbolic.kernels.choice import Kernels, chosen
from symbolic.structures.linearpart import Held
from symbolic.structures.matrices import DENSE
from symbolic.system.compiled import CompiledSystem
from symbolic.system.splitting import condensed


@interruptible()
def compile(  # noqa: A001
    model: Model | Part, kernels: Kernels | str | None = None, *, condense: bool = True
) -> CompiledSystem:
    """Return the System of a model: scaled residual, exact derivatives and outputs, evaluated in batch.

    Parameters
    ----------
    model : Model or Part
        Parts that add up to equations of motion; their order does not matter.
    kernels : Kernels or str, optional
        The back end. "auto" takes C where there is a compiler and it pays, "numpy" needs none, "c" compiles
        at once. By default the environment's ORBITRACE_KERNELS, or else "auto".
    condense : bool
        Whether a `Structure` brings two states at each place where other parts act, its linear rest
        condensed exactly; else each of its degrees of freedom brings two. Beside a `RigidStop`, or resets of
        `Equations`, it has all of them whatever is asked, up to 40 degrees of freedom: an impulse moves the
        whole structure at once.

    Returns
    -------
    CompiledSystem
        What `periodic` traces.

    Raises
    ------
    ValueError
        In one sentence, for a model that lacks a part, gives two variables one name or leaves a coordinate
        without mass, for what is no model, and for an unknown back end.
    CompilerError
        For "c" without a working compiler.
    """
    if not isinstance(model, Model | Part):
        raise refusal("model", model, "a Model or a Part, as the sum of symbolic.Mass(x, 1.0) and others is")
    return _compiled(Recipe(model, chosen(kernels), typed("condense", condense, bool, "True or False")))


def _compiled(recipe: Recipe) -> CompiledSystem:
    assembly = Assembly(Silence()) if recipe.free else Assembly()
    assembly.lay(recipe.parts)
    assembly.close(recipe.condense)
    if recipe.free:
        let_go(assembly)
    kinks.find(assembly)
    system = _system(assembly, recipe)
    for variable in (*system.states, *system.algebraics):
        if variable.name in [p.name for p in system.parameters]:
            raise ValueError(
                f"{variable.name!r} is the name of a state and of a parameter; every variable needs its own"
            )
    return system


@dataclass(frozen=True)
class Recipe:
    """What a system is made from. It is pickled in the system's place: its parts, and functions by name.

    free: whether it is let go, without excitation (`symbolic.equations.freemotion`).
    """

    model: Model | Part
    kernels: Kernels
    condense: bool
    free: bool = False

    def __call__(self) -> CompiledSystem:
        return _compiled(self)

    @property
    def whole(self) -> Recipe:
        """The same with all states of its structures."""
        return replace(self, condense=False)

    @property
    def let_go(self) -> Recipe:
        """The same without excitation, with all states of its structures."""
        return replace(self, condense=False, free=True)

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts of the model."""
        return self.model.parts if isinstance(self.model, Model) else (self.model,)


@dataclass(frozen=True)
class Valued:
    """A recipe whose system then gets other nominal values, by name."""

    recipe: Recipe | Valued
    values: Mapping[str, float]

    def __call__(self) -> CompiledSystem:
        return with_nominal(self.recipe(), self.values)

    @property
    def whole(self) -> Valued:
        """The same with all states of its structures."""
        return replace(self, recipe=self.recipe.whole)

    @property
    def let_go(self) -> Valued:
        """The same without excitation, with all states of its structures."""
        return replace(self, recipe=self.recipe.let_go)

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts of the model, with the values that they were given first."""
        return self.recipe.parts


def all_states(system: CompiledSystem) -> CompiledSystem:
    """Return a system with all states, where its linear part is condensed; else itself.

    Raises ValueError for what is no compiled model, structures that are too large, and those whose matrices
    are functions of the speed.
    """
    if not typed("system", system, CompiledSystem, "a CompiledSystem, as symbolic.compile returns it").held:
        return system.whole
    for structure in {id(place.structure): place.structure for place in system.held}.values():
        if structure.size > DENSE:
            raise ValueError(
                f"structure {structure.name!r} has {structure.size} degrees of freedom; for all its states "
                f"it must have {DENSE} at the most, as symbolic.craig_bampton leaves of it"
            )
    assert isinstance(system.recipe, Recipe | Valued)
    return system.recipe.whole()


def with_nominal(system: CompiledSystem, values: Mapping[str, float]) -> CompiledSystem:
    """Return a compiled system with other nominal values of some parameters (SI), by name."""
    if not isinstance(system.recipe, Recipe | Valued):
        raise ValueError("the system was not compiled from a model; give it other values where it is traced")
    for parameter in system.parameters:
        parameter.check(values.get(parameter.name, parameter.value))
    parameters = tuple(replace(p, value=values.get(p.name, p.value)) for p in system.parameters)
    return replace(system, parameters=parameters, recipe=Valued(system.recipe, dict(values)))


def _system(assembly: Assembly, recipe: Recipe) -> CompiledSystem:
    expressions = expressed(assembly)  # first: a model without excitation gets its parameter omega here
    return CompiledSystem(
        states=tuple(Variable(s.name, s.unit, s.scale) for s in assembly.states),
        algebraics=tuple(Variable(u.name, u.unit, u.scale) for u in assembly.unknowns),
        parameters=assembly.variables,
        outputs=tuple(variable for variable, _ in assembly.described),
        switches=(*(info for info, _ in assembly.switches), *_releases(assembly, expressions)),
        expressions=expressions,
        kernels=recipe.kernels,
        recipe=recipe,
        held=_held(assembly),
        sketch=assembly.sketch.plain(
            list(assembly.motions), assembly.numbers.name_of, 1 / float(assembly.excitation.fundamental)
        ),
        splitting=None if assembly.places else condensed,
    )


def _releases(assembly: Assembly, expressions: Expressions) -> list[SwitchInfo]:
    """The switches at which motions stop sliding along jumps."""
    names = [assembly.switches[k][0].name for k, *_ in expressions.sided.slides]
    found = [SwitchInfo(f"{name}: slips {way}", d) for name in names for way, d in (("up", 1), ("down", -1))]
    walls = [assembly.switches[k][0].name for k in expressions.resting]
    return [*found, *(SwitchInfo(f"{name}: leaves", 1) for name in walls)]


def _held(assembly: Assembly) -> tuple[Held, ...]:
    """The places of condensed structures."""
    states = [id(s) for s in assembly.states]
    unknowns = [u.name for u in assembly.unknowns]
    return tuple(
        Held(
            structure=place.structure,
            freedom=place.freedom,
            position=states.index(id(place.motion.position)),
            velocity=states.index(id(place.motion.velocity)),
            force=unknowns.index(place.unknown.name()),
            scale=place.motion.position.scale,
            unit_force=place.unit_force,
            coasting=None if place.coasting is None else states.index(id(place.coasting)),
            coasting_scale=1.0 if place.coasting is None else place.coasting.scale,
        )
        for place in assembly.places
    )
