"""A situation: raw facts to suppose, in order to ask what would follow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from rosa_core.kb.lookup import Lookup
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import Transaction
from rosa_core.model.elements import ElementKind
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.numbers import finite


@dataclass(frozen=True, slots=True)
class Situation:
    """Facts as they might be. Nothing is planned or checked for sense: statuses just follow from the rules.

    Args:
        measurements: by measure, in the measure's unit.
        failed_components: names.
        required_actions: names.
        selected_designs: names of function designs.
        selected_configurations: names of component configurations.
        active_components: names.
    """

    measurements: Mapping[str, float] = field(default_factory=dict)
    failed_components: tuple[str, ...] = ()
    required_actions: tuple[str, ...] = ()
    selected_designs: tuple[str, ...] = ()
    selected_configurations: tuple[str, ...] = ()
    active_components: tuple[str, ...] = ()


def assert_situation(situation: Situation, state: RuntimeState, tx: Transaction, lookup: Lookup) -> None:
    """Write the facts of a situation; all names and values are checked before anything is changed.

    Args:
        situation: the facts; failures and measurements get the present time.
        state: changed in place.
        tx: in which it is written.
        lookup: of the state's nodes.

    Raises:
        UnknownElementError: if the model has no such element.
        InvalidValueError: if a measured value is not a finite number.
    """
    now = state.clock.now()
    actions = [lookup.action(name) for name in situation.required_actions]
    designs = [lookup.design(name) for name in situation.selected_designs]
    configurations = [lookup.configuration(name) for name in situation.selected_configurations]
    active = [lookup.component(name) for name in situation.active_components]
    failed = [lookup.component(name) for name in situation.failed_components]
    measured = [
        (lookup.measure(name), finite(value, f"a measurement of {name}"))
        for name, value in situation.measurements.items()
    ]
    for action in actions:
        state.require(tx, action)
    for design in designs:
        state.select_design(tx, design, True)
    for configuration in configurations:
        state.select_configuration(tx, configuration, True)
    for component in active:
        state.set_active(tx, component, True)
    for component in failed:
        state.set_failure(tx, component, now)
    for measure, value in measured:
        state.measure(tx, measure, value, now)


def stated_situation(model: KnowledgeModel) -> Situation:
    """The run-time facts that TypeQL files state along with the model, such as ``is-active true`` or a measurement.

    A knowledge base starts without them; give them to :meth:`~rosa_core.kb.KnowledgeBase.suppose` if they are to hold.

    Args:
        model: read from files; one made from elements states nothing.
    """
    measurements: dict[str, float] = {}
    names: dict[tuple[ElementKind, str, object], list[str]] = {}
    for annotation in model.annotations:
        element = annotation.element
        if annotation.attribute == "measurement-value":
            measurements[element.name] = float(annotation.value)
        else:
            names.setdefault((element.kind, annotation.attribute, annotation.value), []).append(element.name)

    def stated(kind: ElementKind, attribute: str, value: object = True) -> tuple[str, ...]:
        return tuple(dict.fromkeys(names.get((kind, attribute, value), ())))

    return Situation(
        measurements=measurements,
        failed_components=stated(ElementKind.COMPONENT, "component-status", "failure"),
        required_actions=stated(ElementKind.ACTION, "is-required"),
        selected_designs=stated(ElementKind.FUNCTION_DESIGN, "is-selected"),
        selected_configurations=stated(ElementKind.COMPONENT_CONFIGURATION, "is-selected"),
        active_components=stated(ElementKind.COMPONENT, "is-active"),
    )
