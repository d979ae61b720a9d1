"""Puts the statements of several files together into one model, and keeps where each was made."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from rosa_core.errors import KnowledgeModelError, Location, Problem
from rosa_core.model.elements import (
    Action,
    Annotation,
    Component,
    ComponentConfiguration,
    ComponentParameter,
    Constraint,
    ElementKind,
    Estimation,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from rosa_core.model.knowledge_model import FlawedModelError, KnowledgeModel


class ModelBuilder:
    """Collects statements from any file format; :meth:`build` checks them as one model.

    A later statement may add to an element. Two different values for one of its scalars contradict each other: that is
    added to ``problems``, as readers add what they find wrong themselves.

    Example:
        >>> from rosa_core.errors import Location
        >>> from rosa_core.model import ElementKind
        >>> builder = ModelBuilder()
        >>> builder.declare(ElementKind.ACTION, "fly", Location("drone.yaml", 2))
        >>> builder.requirement("fly", ["stabilise"])
        >>> builder.locate(("action", "fly", "requires", "stabilise"), Location("drone.yaml", 3))
        >>> builder.build()
        Traceback (most recent call last):
        rosa_core.errors.KnowledgeModelError: drone.yaml:3: action 'fly' names the unknown function 'stabilise' ...
    """

    def __init__(self) -> None:
        self.problems: list[Problem] = []
        self._locations: dict[tuple[str, ...], Location] = {}
        self._declared: dict[ElementKind, dict[str, dict[str, Any]]] = {kind: {} for kind in ElementKind}
        self._parameters: dict[str, list[ComponentParameter]] = {}
        self._requirements: list[FunctionalRequirement] = []
        self._constraints: list[Constraint] = []
        self._estimations: list[Estimation] = []
        self._annotations: list[Annotation] = []

    def declare(self, kind: ElementKind, name: str, at: Location) -> None:
        """The element exists; declaring it again adds nothing.

        Args:
            kind: any but a constraint.
            name: unique within the kind.
            at: the place in the file.
        """
        self._locations.setdefault((kind, name), at)
        self._declared[kind].setdefault(name, {})

    def state(self, kind: ElementKind, name: str, field: str, value: object, at: Location) -> None:
        """One scalar of a declared element, such as its priority, or its list of components as a whole.

        Args:
            kind: of the element.
            name: of the element.
            field: of the element's dataclass.
            value: of that field's type; a tuple for a list.
            at: the place in the file.
        """
        fields = self._declared[kind][name]
        path = (kind, name, field)
        if field in fields and fields[field] != value:
            words = kind.value.replace("_", " ")
            first = self._locations[path]
            what = f"{field} of {words} '{name}' is {_shown(value)} here and {_shown(fields[field])} at {first}"
            self.problems.append(Problem(what, at, "keep one of the two"))
            return
        fields[field] = value
        self._locations.setdefault(path, at)

    def stated(self, kind: ElementKind, name: str, field: str) -> object:
        """What has been stated of a scalar, or None if nothing has yet.

        Args:
            kind: of the element.
            name: of the element, declared or not.
            field: of the element's dataclass.
        """
        return self._declared[kind].get(name, {}).get(field)

    def locate(self, path: tuple[str, ...], at: Location) -> None:
        """Where a part of an element is stated; of several statements the latest is the one that is reported.

        Args:
            path: kind and name of the element, field, item, such as ``("action", "fly", "requires", "float")``.
            at: the place in the file.
        """
        self._locations[path] = at

    def parameter(self, configuration: str, parameter: ComponentParameter, at: Location) -> None:
        """One parameter of a declared component configuration.

        Args:
            configuration: its name.
            parameter: the same again adds nothing; another value for the same key is a contradiction.
            at: the place in the file.
        """
        known = self._parameters.setdefault(configuration, [])
        for other in known:
            if other.key == parameter.key and other != parameter:
                what = f"parameter '{parameter.key}' of component configuration '{configuration}'"
                what += f" is {_shown(parameter.value)} here and {_shown(other.value)} elsewhere"
                self.problems.append(Problem(what, at, "keep one of the two"))
        if all(other.key != parameter.key for other in known):
            known.append(parameter)

    def requirement(self, action: str, functions: Iterable[str]) -> None:
        """One functional requirement.

        Args:
            action: a name; it may be declared later.
            functions: names, likewise.
        """
        self._requirements.append(FunctionalRequirement(action, tuple(functions)))

    def constraint(self, constraint: Constraint) -> None:
        """One constraint."""
        self._constraints.append(constraint)

    def estimation(self, estimation: Estimation) -> None:
        """One estimation."""
        self._estimations.append(estimation)

    def annotate(self, annotation: Annotation) -> None:
        """A remark on an element."""
        self._annotations.append(annotation)

    def declared_at(self, kind: ElementKind, name: str) -> Location | None:
        """Where the element of that kind and name was declared first, None if it has not been.

        Args:
            kind: of the element.
            name: of the element.
        """
        return self._locations.get((kind, name)) if name in self._declared[kind] else None

    def declared(self, kind: ElementKind) -> tuple[str, ...]:
        """The names of a kind that have been declared.

        Args:
            kind: any but a constraint.
        """
        return tuple(self._declared[kind])

    # What has been stated up to now, by the fields of a model; it need not hold together yet.

    @property
    def measures(self) -> tuple[Measure, ...]:
        """The measures stated up to now."""
        return tuple(Measure(n, **f) for n, f in self._declared[ElementKind.MEASURE].items())

    @property
    def actions(self) -> tuple[Action, ...]:
        """The actions stated up to now."""
        return tuple(Action(n) for n in self._declared[ElementKind.ACTION])

    @property
    def functions(self) -> tuple[Function, ...]:
        """The functions stated up to now."""
        return tuple(Function(n, **f) for n, f in self._declared[ElementKind.FUNCTION].items())

    @property
    def components(self) -> tuple[Component, ...]:
        """The components stated up to now."""
        return tuple(Component(n, **f) for n, f in self._declared[ElementKind.COMPONENT].items())

    @property
    def function_designs(self) -> tuple[FunctionDesign, ...]:
        """The function designs stated up to now; a later file may still say of what, and with which components."""
        designs = self._declared[ElementKind.FUNCTION_DESIGN].items()
        return tuple(FunctionDesign(n, **{"function": "", "components": (), **f}) for n, f in designs)

    @property
    def component_configurations(self) -> tuple[ComponentConfiguration, ...]:
        """The component configurations stated up to now; a later file may still say of which component."""
        return tuple(
            ComponentConfiguration(n, parameters=tuple(self._parameters.get(n, ())), **{"component": "", **f})
            for n, f in self._declared[ElementKind.COMPONENT_CONFIGURATION].items()
        )

    @property
    def requirements(self) -> Sequence[FunctionalRequirement]:
        """The functional requirements stated up to now."""
        return self._requirements

    @property
    def constraints(self) -> Sequence[Constraint]:
        """The constraints stated up to now."""
        return self._constraints

    @property
    def estimations(self) -> Sequence[Estimation]:
        """The estimations stated up to now."""
        return self._estimations

    @property
    def annotations(self) -> Sequence[Annotation]:
        """The remarks stated up to now."""
        return self._annotations

    def build(self) -> KnowledgeModel:
        """The model.

        Raises:
            KnowledgeModelError: with everything that is wrong, each with its place.
        """
        self._missing(ElementKind.FUNCTION_DESIGN, "function", "components")
        self._missing(ElementKind.COMPONENT_CONFIGURATION, "component")
        if self.problems:
            raise KnowledgeModelError(self.problems)
        try:
            return KnowledgeModel(
                measures=self.measures,
                actions=self.actions,
                functions=self.functions,
                components=self.components,
                requirements=tuple(self.requirements),
                function_designs=self.function_designs,
                component_configurations=self.component_configurations,
                constraints=tuple(self.constraints),
                estimations=tuple(self.estimations),
                annotations=tuple(self.annotations),
            )
        except FlawedModelError as error:
            problems = [Problem(flaw.what, self._place(flaw.path), flaw.hint) for flaw in error.flaws]
            raise KnowledgeModelError(problems) from None

    def _missing(self, kind: ElementKind, *fields: str) -> None:
        for name, stated in self._declared[kind].items():
            for field in fields:
                if field not in stated:
                    what = f"{kind.value.replace('_', ' ')} '{name}' has no {field}"
                    self.problems.append(Problem(what, self._place((kind, name)), f"add '{field}:'"))

    def _place(self, path: tuple[str, ...]) -> Location | None:
        """The place of the path, or of the nearest part of the model around it that has one."""
        while path:
            if path in self._locations:
                return self._locations[path]
            path = path[:-1]
        return None


def _shown(value: object) -> str:
    return f"[{', '.join(map(str, value))}]" if isinstance(value, tuple) else str(value)
