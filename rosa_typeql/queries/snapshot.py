"""What a knowledge base knows, stored and inferred, as facts that patterns can be matched against; read-only."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from rosa_core.inference.network import (
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    DesignNode,
    FunctionNode,
    Node,
)
from rosa_core.kb.history import History
from rosa_core.kb.state import RuntimeState
from rosa_core.model.elements import Constraint, ElementKind, ElementRef, Scalar
from rosa_core.model.records import EndedPlan, Measurement, ReconfigurationPlan, RequiredAction
from rosa_typeql.matching.elements import ElementLoaders
from rosa_typeql.matching.facts import FactTables, Loader, Thing, cast

_Facts = dict[str, tuple[Scalar, ...]]


def snapshot(state: RuntimeState, history: History, types: Collection[str]) -> FactTables:
    """The facts of some types, and of what plays a role in them, as they are now.

    Call it while writes are locked out. The cost is proportional to the number of things of these types.

    Args:
        state: the model, the statuses of its elements, and the run-time facts.
        history: what is over, as far as memory is kept for it.
        types: labels of exact types.

    Returns:
        tables that do not change any more.
    """
    elements = ElementLoaders(state.model, _RunTimeAttributes(state)).loaders()
    tables = FactTables({**elements, **_RunTimeTables(state, history).loaders()})
    for label in sorted(types):
        tables.of(label)
    return tables


class _RunTimeAttributes:
    """The attributes that elements have at run time: statuses, and the facts that these follow from."""

    def __init__(self, state: RuntimeState) -> None:
        self._reasoner = state.reasoner
        self._constraints = {node.constraint: node for node in state.reasoner.constraints}

    def __call__(self, element: ElementRef | Constraint) -> Mapping[str, Scalar]:
        if isinstance(element, Constraint):
            return {"constraint-status": self._constraints[element].status.value}
        if element.kind in (ElementKind.MEASURE, ElementKind.CONSTRAINT):
            return {}
        node = self._reasoner.of_kind(element.kind)[element.name]
        return {f"{element.kind.value.replace('_', '-')}-status": node.status.value, **_facts(node)}


def _facts(node: Node) -> Mapping[str, Scalar]:
    match node:
        case ActionNode():
            return {"is-required": node.required}
        case FunctionNode():
            return {"is-required": node.required_by > 0}
        case ComponentNode():
            return {"is-required": node.required_by > 0, "is-active": node.active}
        case DesignNode() | ConfigurationNode():
            return {"is-selected": node.selected}
    return {}


class _RunTimeTables:
    """The tables of what is created at run time: measurements, required actions, reconfiguration plans."""

    def __init__(self, state: RuntimeState, history: History) -> None:
        self._state = state
        self._history = history

    def loaders(self) -> dict[str, Loader]:
        return {
            "measurement": self._measurements,
            "required-action": self._required_actions,
            "component-activation": lambda tables: self._adaptations(tables, "component-activation"),
            "component-deactivation": lambda tables: self._adaptations(tables, "component-deactivation"),
            "parameter-adaptation": lambda tables: self._adaptations(tables, "parameter-adaptation"),
            "reconfiguration-plan": self._plans,
        }

    def _measurements(self, tables: FactTables) -> Iterable[Thing]:
        """Oldest first; the latest of a measure is there even if the history no longer holds it."""
        latest = {
            name: Measurement(name, node.value, node.time)
            for name, node in self._state.reasoner.measures.items()
            if node.value is not None and node.time is not None
        }
        remembered = [entry for entry in self._history.of("measurements", None) if isinstance(entry, Measurement)]
        # The same value may have been measured twice at one time; the last of them is the one that counts.
        at = {measurement: index for index, measurement in enumerate(remembered)}
        dropped = [measurement for measurement in latest.values() if measurement not in at]
        entries = [*((m, True) for m in dropped)]
        entries += [(m, latest.get(m.measure) == m and at[m] == index) for index, m in enumerate(remembered)]
        for order, (measurement, is_latest) in enumerate(entries):
            measure = tables.element(ElementRef(ElementKind.MEASURE, measurement.measure))
            facts: _Facts = {
                "measurement-value": (measurement.value,),
                "measurement-time": (measurement.time,),
                "latest": (is_latest,),
            }
            yield Thing("measurement", order, facts, cast([("measured-attribute", measure)]))

    def _required_actions(self, tables: FactTables) -> Iterable[Thing]:
        ended = [entry for entry in self._history.of("required_actions", None) if isinstance(entry, RequiredAction)]
        for order, required in enumerate([*ended, *self._state.required.values()]):
            facts: _Facts = {"start-time": (required.start_time,)}
            if required.end_time is not None:
                facts["end-time"] = (required.end_time,)
            if required.result is not None:
                facts["result"] = (required.result.value,)
            action = tables.element(ElementRef(ElementKind.ACTION, required.action))
            preference = None
            if isinstance(required.preference, str):
                preference = tables.element(ElementRef(ElementKind.MEASURE, required.preference))
            players = cast([("action", action), ("preference", preference)])
            yield Thing("required-action", order, facts, players)

    def _known_plans(self) -> list[tuple[ReconfigurationPlan, EndedPlan | None]]:
        ended = [entry for entry in self._history.of("reconfiguration_plans", None) if isinstance(entry, EndedPlan)]
        plans: list[tuple[ReconfigurationPlan, EndedPlan | None]] = [(entry.plan, entry) for entry in ended]
        pending = self._state.pending_plan
        return plans if pending is None else [*plans, (pending, None)]

    def _adaptations(self, tables: FactTables, label: str) -> Iterable[Thing]:
        """One thing for each plan that has any, in the order of the plans; ``order`` says of which plan it is."""
        for order, (plan, _) in enumerate(self._known_plans()):
            kind, role, names = ElementKind.COMPONENT, "component", plan.activate
            if label == "component-deactivation":
                names = plan.deactivate
            elif label == "parameter-adaptation":
                kind, role = ElementKind.COMPONENT_CONFIGURATION, "component-configuration"
                names = plan.parameter_adaptations
            if names:
                players = cast((role, tables.element(ElementRef(kind, name))) for name in names)
                yield Thing(label, order, {}, players)

    def _plans(self, tables: FactTables) -> Iterable[Thing]:
        parts = {
            label: {thing.order: thing for thing in tables.of(label)}
            for label in ("component-activation", "component-deactivation", "parameter-adaptation")
        }
        for order, (plan, ended) in enumerate(self._known_plans()):
            facts: _Facts = {"start-time": (plan.start_time,)}
            if ended is not None:
                facts["end-time"] = (ended.end_time,)
                facts["result"] = (ended.result.value,)
            players = cast(
                [
                    ("structural-adaptation", parts["component-activation"].get(order)),
                    ("structural-adaptation", parts["component-deactivation"].get(order)),
                    ("parameter-adaptation", parts["parameter-adaptation"].get(order)),
                ]
            )
            yield Thing("reconfiguration-plan", order, facts, players)
