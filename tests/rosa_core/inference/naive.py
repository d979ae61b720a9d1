"""The oracle: a knowledge base that recomputes everything from the model and the raw facts at every question.

It has the writes and questions of :class:`rosa_core.KnowledgeBase` that decide statuses and plans, in plain loops over
the model, without indexes, counts or events. Slow and obvious is its whole purpose.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable
from dataclasses import dataclass, field

from rosa_core.errors import InvalidValueError, RequestRefusedError, UnknownElementError
from rosa_core.inference.rules import (
    action_status,
    component_configuration_status,
    component_status,
    constraint_status,
    function_design_status,
    function_status,
    is_adaptable,
    is_selectable,
)
from rosa_core.kb import Result, Situation, Status
from rosa_core.model import ElementKind, ElementRef, KnowledgeModel

Work = tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
"""What a plan does: components to activate and to deactivate, component configurations to set."""


@dataclass
class Facts:
    """What is known at run time; everything else follows from it and the model."""

    latest: dict[str, tuple[float, float]] = field(default_factory=dict)
    """Value and time of each measure's latest measurement."""
    failed: set[str] = field(default_factory=set)
    active: set[str] = field(default_factory=set)
    required: list[str] = field(default_factory=list)
    designs: set[str] = field(default_factory=set)
    configurations: set[str] = field(default_factory=set)
    applied: set[str] = field(default_factory=set)
    """The selected configurations that their components run with."""
    pending: Work | None = None
    failed_work: Work | None = None


class NaiveKnowledgeBase:
    """The same answers as the knowledge base, found the slow way."""

    def __init__(self, model: KnowledgeModel) -> None:
        self.model = model
        self.facts = Facts()

    # -- what is required --

    def function_is_required(self, name: str) -> bool:
        return any(r.action in self.facts.required and name in r.functions for r in self.model.requirements)

    def component_is_required(self, name: str) -> bool:
        return any(d.name in self.facts.designs and name in d.components for d in self.model.function_designs)

    # -- statuses --

    def constraints(self) -> list[Status]:
        found = []
        for constraint in self.model.constraints:
            value, _ = self.facts.latest.get(constraint.measure, (None, None))
            found.append(constraint_status(constraint.operator, constraint.value, value))
        return found

    def statuses(self) -> dict[str, dict[str, Status]]:
        """All statuses by kind and name, computed from the constraints up to the actions."""
        model, facts = self.model, self.facts
        constraint_statuses = self.constraints()

        def on(kind: ElementKind, name: str) -> list[Status]:
            pairs = zip(model.constraints, constraint_statuses, strict=True)
            return [status for constraint, status in pairs if constraint.constrained == ElementRef(kind, name)]

        configurations = {
            c.name: component_configuration_status(on(ElementKind.COMPONENT_CONFIGURATION, c.name))
            for c in model.component_configurations
        }
        components = {}
        for component in model.components:
            own = [c.name for c in model.component_configurations if c.component == component.name]
            components[component.name] = component_status(
                failed=component.name in facts.failed,
                required=self.component_is_required(component.name),
                active=component.name in facts.active,
                constraints=on(ElementKind.COMPONENT, component.name),
                configurations=[configurations[name] for name in own],
                selected_configurations=[configurations[name] for name in own if name in facts.configurations],
            )
        designs = {
            design.name: function_design_status(
                selected=design.name in facts.designs,
                constraints=on(ElementKind.FUNCTION_DESIGN, design.name),
                components=[components[name] for name in design.components],
            )
            for design in model.function_designs
        }
        functions = {}
        for function in model.functions:
            own = [d.name for d in model.function_designs if d.function == function.name]
            functions[function.name] = function_status(
                required=self.function_is_required(function.name),
                designs=[designs[name] for name in own],
                selected_designs=[designs[name] for name in own if name in facts.designs],
            )
        actions = {}
        for action in model.actions:
            needed = [name for r in model.requirements if r.action == action.name for name in r.functions]
            actions[action.name] = action_status(
                required=action.name in facts.required,
                constraints=on(ElementKind.ACTION, action.name),
                functions=[functions[name] for name in needed],
            )
        return {
            "action": actions,
            "function": functions,
            "component": components,
            "function_design": designs,
            "component_configuration": configurations,
        }

    # -- questions --

    def selectable_actions(self) -> list[str]:
        return [name for name, status in self.statuses()["action"].items() if is_selectable(status)]

    def adaptable_functions(self) -> list[str]:
        statuses = self.statuses()["function"]
        return [f.name for f in self.model.functions if is_adaptable(statuses[f.name], f.always_improve)]

    def adaptable_components(self, selected_designs: Iterable[str] = ()) -> list[str]:
        statuses = self.statuses()["component"]
        chosen = {c for d in self.model.function_designs if d.name in set(selected_designs) for c in d.components}
        return [
            c.name
            for c in self.model.components
            if c.name in chosen or is_adaptable(statuses[c.name], c.always_improve)
        ]

    # -- writes --

    def add_measurement(self, measure: str, value: float, time: float) -> None:
        self._must_know(ElementKind.MEASURE, measure)
        if not (math.isfinite(value) and math.isfinite(time)):
            raise InvalidValueError("not finite")
        if measure not in self.facts.latest or time >= self.facts.latest[measure][1]:
            self.facts.latest[measure] = (value, time)

    def set_component_failure(self, name: str) -> None:
        self._must_know(ElementKind.COMPONENT, name)
        self.facts.failed.add(name)

    def clear_component_failure(self, name: str) -> None:
        self._must_know(ElementKind.COMPONENT, name)
        if name in self.facts.failed:
            self.facts.failed.remove(name)
            self.facts.failed_work = None

    def set_component_active(self, name: str, active: bool) -> None:
        self._must_know(ElementKind.COMPONENT, name)
        (self.facts.active.add if active else self.facts.active.discard)(name)

    def request_action(self, name: str) -> None:
        self._must_know(ElementKind.ACTION, name)
        if name in self.facts.required:
            return
        if self.statuses()["action"][name] is Status.UNFEASIBLE:
            raise RequestRefusedError("unfeasible")
        self.facts.required.append(name)

    def cancel_action(self, name: str) -> None:
        self._must_know(ElementKind.ACTION, name)
        self.facts.required = [other for other in self.facts.required if other != name]

    def finish_action(self, name: str, result: str) -> None:
        self.cancel_action(name)

    def suppose(self, situation: Situation, now: float) -> None:
        facts = self.facts
        facts.required += [name for name in situation.required_actions if name not in facts.required]
        facts.designs |= set(situation.selected_designs)
        facts.configurations |= set(situation.selected_configurations)
        facts.active |= set(situation.active_components)
        facts.failed |= set(situation.failed_components)
        for measure, value in situation.measurements.items():
            self.add_measurement(measure, value, now)

    def select_configuration(self, function_designs: list[str], component_configurations: list[str]) -> None:
        facts, model = self.facts, self.model
        for name in function_designs:
            self._must_know(ElementKind.FUNCTION_DESIGN, name)
        for name in component_configurations:
            self._must_know(ElementKind.COMPONENT_CONFIGURATION, name)
        functions = {d.name: d.function for d in model.function_designs}
        components = {c.name: c.component for c in model.component_configurations}
        chosen_for = {functions[name] for name in function_designs}
        configured = {components[name] for name in component_configurations}
        if len(chosen_for) < len(set(function_designs)) or len(configured) < len(set(component_configurations)):
            raise InvalidValueError("two for one")

        stay = {
            name
            for name in facts.designs
            if functions[name] not in chosen_for and self.function_is_required(functions[name])
        }
        facts.designs = stay | set(function_designs)
        stay = {
            name
            for name in facts.configurations
            if components[name] not in configured and self.component_is_required(components[name])
        }
        facts.configurations = stay | set(component_configurations)
        facts.applied &= facts.configurations
        self._plan()

    def end_plan(self, result: Result) -> None:
        """The pending plan, if there is one, ended."""
        work, facts = self.facts.pending, self.facts
        if work is None:
            return
        facts.pending = None
        facts.failed_work = work if result is Result.FAILED else None
        if result is Result.COMPLETED:
            facts.applied |= set(work[2]) & facts.configurations

    def save(self) -> Facts:
        return copy.deepcopy(self.facts)

    # -- inside --

    def _plan(self) -> None:
        facts, model = self.facts, self.model
        in_some_design = {c for d in model.function_designs for c in d.components}
        wanted = {
            c
            for d in model.function_designs
            if d.name in facts.designs and self.function_is_required(d.function)
            for c in d.components
        }
        order = [c.name for c in model.components]
        work = (
            tuple(c for c in order if c in wanted and c not in facts.active),
            tuple(c for c in order if c in facts.active and c in in_some_design and c not in wanted),
            tuple(
                c.name
                for c in model.component_configurations
                if c.name in facts.configurations and c.name not in facts.applied
            ),
        )
        if not any(work):
            facts.pending = facts.failed_work = None
        elif work != facts.pending and not _is_part(work, facts.failed_work):
            facts.pending, facts.failed_work = work, None

    def _must_know(self, kind: ElementKind, name: str) -> None:
        if name not in self.model.names[kind]:
            raise UnknownElementError(name)


def _is_part(work: Work, other: Work | None) -> bool:
    return other is not None and all(set(one) <= set(all_of_it) for one, all_of_it in zip(work, other, strict=True))
