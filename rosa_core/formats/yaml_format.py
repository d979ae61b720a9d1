"""Knowledge models written in YAML. The types here both validate a file and generate its JSON Schema."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import ConfigDict, Field

from rosa_core.errors import KnowledgeModelError, Location, Problem
from rosa_core.formats.builder import ModelBuilder
from rosa_core.formats.checked_file import Entry, Flag, Number, Text, checked
from rosa_core.formats.yaml_source import KeyPath, YamlSource
from rosa_core.model.elements import (
    ComponentParameter,
    ComponentType,
    Constraint,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    Estimation,
    EstimationType,
    MeasureKind,
    ParameterType,
    ParameterValue,
)

YamlScalar = (
    Annotated[bool, Field(strict=True)]
    | Annotated[int, Field(strict=True)]
    | Annotated[float, Field(strict=True, allow_inf_nan=False)]
    | Annotated[str, Field(strict=True)]
)


class ConstraintEntry(Entry):
    """A measure that must hold for the element under which this stands."""

    measure: Text
    operator: ConstraintOperator = ConstraintOperator.GREATER_OR_EQUAL
    value: Number | None = None


class EstimationEntry(Entry):
    """The impact on a measure that selecting this element is expected to have."""

    measure: Text
    value: Number
    type: EstimationType = EstimationType.POSITIVE


class TypedParameter(Entry):
    """A parameter value whose type is not the one that its spelling suggests."""

    value: YamlScalar | list[YamlScalar]
    type: ParameterType


class MeasureEntry(Entry):
    """A measure: of the system (quality) or of the environment."""

    kind: MeasureKind | None = None


class ActionEntry(Entry):
    """An action and the functions that it requires."""

    requires: list[Text] | None = None
    constraints: tuple[ConstraintEntry, ...] = ()


class FunctionEntry(Entry):
    """A function of the system."""

    always_improve: Flag | None = None


class ComponentEntry(Entry):
    """A hardware or software part."""

    type: ComponentType | None = None
    package: Text | None = None
    executable: Text | None = None
    always_improve: Flag | None = None
    constraints: tuple[ConstraintEntry, ...] = ()
    estimations: tuple[EstimationEntry, ...] = ()


class FunctionDesignEntry(Entry):
    """A set of components that solves a function. Lowest priority number first."""

    function: Text | None = None
    components: list[Text] | None = None
    priority: Number | None = None
    constraints: tuple[ConstraintEntry, ...] = ()
    estimations: tuple[EstimationEntry, ...] = ()


class ComponentConfigurationEntry(Entry):
    """Parameters that a component can run with. Lowest priority number first."""

    component: Text | None = None
    parameters: dict[Text, YamlScalar | list[YamlScalar] | TypedParameter] = Field({})
    priority: Number | None = None
    constraints: tuple[ConstraintEntry, ...] = ()
    estimations: tuple[EstimationEntry, ...] = ()


class ModelDocument(Entry):
    """A ROSA knowledge model, or a part that extends another file; an element may have nothing after its colon."""

    model_config = ConfigDict(extra="forbid", title="ROSA knowledge model")

    measures: dict[Text, MeasureEntry | None] = Field({})
    actions: dict[Text, ActionEntry | None] = Field({})
    functions: dict[Text, FunctionEntry | None] = Field({})
    components: dict[Text, ComponentEntry | None] = Field({})
    function_designs: dict[Text, FunctionDesignEntry | None] = Field({})
    component_configurations: dict[Text, ComponentConfigurationEntry | None] = Field({})


def json_schema() -> dict[str, Any]:
    """The JSON Schema of a YAML knowledge model, for editors."""
    schema = ModelDocument.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


SECTIONS: dict[str, ElementKind] = {
    "measures": ElementKind.MEASURE,
    "actions": ElementKind.ACTION,
    "functions": ElementKind.FUNCTION,
    "components": ElementKind.COMPONENT,
    "function_designs": ElementKind.FUNCTION_DESIGN,
    "component_configurations": ElementKind.COMPONENT_CONFIGURATION,
}
_OWN_FIELDS = ("kind", "always_improve", "type", "package", "executable", "function", "priority", "component")


def read_yaml(path: str, builder: ModelBuilder) -> None:
    """Add the statements of one YAML file to the builder: the :class:`~rosa_core.formats.ModelReader` of YAML.

    Args:
        path: the file.
        builder: what takes them.

    Raises:
        InputError: if the file is not a knowledge model; file, line and hint for everything that is wrong.
    """
    source = YamlSource(path)
    if source.data is None:
        raise KnowledgeModelError(Problem("the file is empty", Location(path), "it needs at least 'actions:'"))
    document = checked(source.data, ModelDocument, source.location)
    for section, kind in SECTIONS.items():
        for name, entry in getattr(document, section).items():
            _read_entry(kind, name, entry or Entry(), source, (section, name), builder)


def _read_entry(
    kind: ElementKind, name: str, entry: Entry, source: YamlSource, path: KeyPath, builder: ModelBuilder
) -> None:
    builder.declare(kind, name, source.location(path))
    for field in _OWN_FIELDS:
        value = getattr(entry, field, None)
        if value is not None:
            builder.state(kind, name, field, value, source.location((*path, field)))
    if isinstance(entry, ActionEntry) and entry.requires is not None:
        _locate_items(builder, (kind, name, "requires"), source, (*path, "requires"), entry.requires)
        builder.requirement(name, entry.requires)
    if isinstance(entry, FunctionDesignEntry) and entry.components is not None:
        at = source.location((*path, "components"))
        builder.state(kind, name, "components", tuple(entry.components), at)
        _locate_items(builder, (kind, name, "components"), source, (*path, "components"), entry.components)
    if isinstance(entry, ComponentConfigurationEntry):
        _read_parameters(name, entry, source, path, builder)
    _read_heuristics(ElementRef(kind, name), entry, source, path, builder)


def _locate_items(
    builder: ModelBuilder, at: tuple[str, ...], source: YamlSource, path: KeyPath, items: list[str]
) -> None:
    builder.locate(at, source.location(path))
    for index, item in enumerate(items):
        builder.locate((*at, item), source.location((*path, index)))


def _read_heuristics(ref: ElementRef, entry: Entry, source: YamlSource, path: KeyPath, builder: ModelBuilder) -> None:
    constraints: tuple[ConstraintEntry, ...] = getattr(entry, "constraints", ())
    for index, c in enumerate(constraints):
        place = source.location((*path, "constraints", index))
        builder.locate((ref.kind, ref.name, "constraints", c.measure), place)
        builder.constraint(Constraint(c.measure, ref, c.operator, None if c.value is None else float(c.value)))
    estimations: tuple[EstimationEntry, ...] = getattr(entry, "estimations", ())
    for index, e in enumerate(estimations):
        place = source.location((*path, "estimations", index))
        builder.locate((ref.kind, ref.name, "estimations", e.measure), place)
        builder.estimation(Estimation(ref, e.measure, float(e.value), e.type))


def _read_parameters(
    name: str, entry: ComponentConfigurationEntry, source: YamlSource, path: KeyPath, builder: ModelBuilder
) -> None:
    for key, given in entry.parameters.items():
        at = source.location((*path, "parameters", key))
        raw = given.value if isinstance(given, TypedParameter) else given
        value = tuple(raw) if isinstance(raw, list) else raw
        suggested = _type_of(value)
        wanted = given.type if isinstance(given, TypedParameter) else suggested
        if wanted is None:
            what = f"parameter '{key}' is a list whose type is not clear"
            hint = "use elements of one type, or {value: [...], type: double_array}"
            builder.problems.append(Problem(what, at, hint))
            continue
        converted = _as_type(value, wanted, suggested)
        if converted is None:
            what = f"parameter '{key}' is not a {wanted.value.replace('_', ' ')}: {raw!r}"
            builder.problems.append(Problem(what, at, "give a value of that type, or another type"))
            continue
        # The component may be named in an earlier file; validation compares the two once all are read.
        component = entry.component or builder.stated(ElementKind.COMPONENT_CONFIGURATION, name, "component")
        builder.parameter(name, ComponentParameter(str(component or ""), key, converted, wanted), at)


_SCALAR_TYPES = {
    bool: ParameterType.BOOLEAN,
    int: ParameterType.LONG,
    float: ParameterType.DOUBLE,
    str: ParameterType.STRING,
}


def _type_of(value: ParameterValue) -> ParameterType | None:
    if not isinstance(value, tuple):
        return _SCALAR_TYPES[type(value)]
    types = {type(item) for item in value}
    if types == {int, float}:
        types = {float}
    return ParameterType(f"{_SCALAR_TYPES[types.pop()].value}_array") if len(types) == 1 else None


def _as_type(value: ParameterValue, wanted: ParameterType, suggested: ParameterType | None) -> ParameterValue | None:
    """The value as the wanted type, or None where that would change it."""
    if wanted is ParameterType.DOUBLE and suggested is ParameterType.LONG:
        return float(value)  # type: ignore[arg-type]
    if wanted is ParameterType.DOUBLE_ARRAY and isinstance(value, tuple):
        numbers = all(type(item) in (int, float) for item in value)
        return tuple(float(item) for item in value) if numbers else None
    if wanted is suggested or (suggested is None and value == () and wanted.value.endswith("_array")):
        return value
    return None
