"""Models, random writes, and pictures of a knowledge base, for the tests of journal, growth and threads."""

from __future__ import annotations

import random
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from rosa_core import KnowledgeBase, KnowledgeBaseError, KnowledgeModel, Result, SimulationClock, Situation
from rosa_core.mape import ConfigurationPlanner
from rosa_core.model.changes import Element, elements_of
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    ComponentParameter,
    ComponentType,
    Constraint,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    Estimation,
    EstimationType,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
    ParameterType,
)
from rosa_core.model.records import TOPICS
from rosa_core.model.utility import Utility

STATUS_KINDS = ("action", "function", "component", "function_design", "component_configuration")


def robot() -> KnowledgeModel:
    """A small robot with a bit of everything: two ways to move, one of them configurable, and a shared motor."""
    action, component = ElementKind.ACTION, ElementKind.COMPONENT
    configuration = ElementKind.COMPONENT_CONFIGURATION
    return KnowledgeModel(
        measures=(Measure("battery"), Measure("light"), Measure("tick")),
        actions=(Action("explore"), Action("charge"), Action("wait")),
        functions=(Function("move", always_improve=True), Function("see")),
        components=(
            Component("motor"),
            Component("wheels", ComponentType.LIFECYCLE_NODE, always_improve=True),
            Component("legs", ComponentType.LIFECYCLE_NODE),
            Component("camera", ComponentType.LIFECYCLE_NODE),
        ),
        requirements=(FunctionalRequirement("explore", ("move", "see")), FunctionalRequirement("charge", ("move",))),
        function_designs=(
            FunctionDesign("drive", "move", ("motor", "wheels"), 1.0),
            FunctionDesign("walk", "move", ("motor", "legs"), 2.0),
            FunctionDesign("look", "see", ("camera",)),
        ),
        component_configurations=(
            ComponentConfiguration("fast", "wheels", (_speed(2.0),), 1.0),
            ComponentConfiguration("slow", "wheels", (_speed(0.5),), 2.0),
        ),
        constraints=(
            Constraint("battery", ElementRef(action, "explore"), ConstraintOperator.GREATER_OR_EQUAL, 0.25),
            Constraint("battery", ElementRef(configuration, "fast"), ConstraintOperator.GREATER, 0.5),
            Constraint("light", ElementRef(component, "camera"), ConstraintOperator.GREATER, 0.1),
            Constraint("light", ElementRef(ElementKind.FUNCTION_DESIGN, "walk"), ConstraintOperator.LESS, 0.9),
        ),
        estimations=(
            Estimation(ElementRef(configuration, "fast"), "battery", 0.5, EstimationType.NEGATIVE),
            Estimation(ElementRef(configuration, "slow"), "battery", 0.25, EstimationType.NEGATIVE),
            Estimation(ElementRef(component, "legs"), "battery", 0.125, EstimationType.NEGATIVE),
        ),
    )


def _speed(value: float) -> ComponentParameter:
    return ComponentParameter("wheels", "speed", value, ParameterType.DOUBLE)


def picture(kb: KnowledgeBase) -> dict[str, Any]:
    """All that can be known of a knowledge base, asked for in every way."""
    names = kb.model.names
    return {
        "model": kb.model,
        "facts": list(kb._state.facts()),
        "revision": kb.revision,
        "statuses": {kind: kb.statuses(kind) for kind in STATUS_KINDS},
        "constraints": kb.constraints(),
        "measurements": [kb.measurement(name) for name in names[ElementKind.MEASURE]],
        "required": kb.required_actions(),
        "selectable": kb.selectable_actions(),
        "adaptable": (kb.adaptable_functions(), kb.adaptable_components()),
        "designs": [kb.selected_function_design(name) for name in names[ElementKind.FUNCTION]],
        "configurations": [kb.selected_component_configuration(name) for name in names[ElementKind.COMPONENT]],
        "active": [kb.is_component_active(name) for name in names[ElementKind.COMPONENT]],
        "pending": kb.pending_reconfiguration_plan(),
        "explanations": [str(kb.explain("component", name)) for name in names[ElementKind.COMPONENT]],
        "history": {topic: kb.history(topic) for topic in TOPICS},
    }


@dataclass(frozen=True)
class Write:
    """One random write: what, and numbers that say on which elements and with which values."""

    kind: int
    a: int
    b: int

    def __call__(self, kb: KnowledgeBase) -> None:
        """Do it; one that is refused changes nothing, which is a write like any other here."""
        with suppress(KnowledgeBaseError):
            WRITES[self.kind % len(WRITES)](kb, self.a, self.b)


def random_writes(seed: int, count: int) -> list[Write]:
    """So many writes, the same for the same seed."""
    source = random.Random(seed)
    return [Write(source.randrange(len(WRITES)), source.randrange(50), source.randrange(50)) for _ in range(count)]


def _name(kb: KnowledgeBase, kind: ElementKind, index: int) -> str:
    names = kb.model.names[kind]
    return names[index % len(names)] if names else "nothing"


def _measure(kb: KnowledgeBase, a: int, b: int) -> None:
    time = None if b % 3 else kb.clock.now() - b
    kb.add_measurement(_name(kb, ElementKind.MEASURE, a), b / 40, time)


def _fail(kb: KnowledgeBase, a: int, b: int) -> None:
    kb.set_component_failure(_name(kb, ElementKind.COMPONENT, a), None if b % 2 else b / 7)


def _recover(kb: KnowledgeBase, a: int, b: int) -> None:
    kb.clear_component_failure(_name(kb, ElementKind.COMPONENT, a))


def _request(kb: KnowledgeBase, a: int, b: int) -> None:
    action, measure = _name(kb, ElementKind.ACTION, a), _name(kb, ElementKind.MEASURE, b)
    if b % 4 == 0:
        kb.request_action(action, measure)
    elif b % 4 == 1:
        kb.request_action(action, utility=Utility({measure: 1.0, "battery": -b / 3}, ((measure, "<=", float(a)),)))  # type: ignore[arg-type]
    else:
        kb.request_action(action)


def _end_action(kb: KnowledgeBase, a: int, b: int) -> None:
    kb.finish_action(_name(kb, ElementKind.ACTION, a), tuple(Result)[b % 3])


def _plan(kb: KnowledgeBase, a: int, b: int) -> None:
    ConfigurationPlanner(kb).plan()


def _select(kb: KnowledgeBase, a: int, b: int) -> None:
    designs = [_name(kb, ElementKind.FUNCTION_DESIGN, a)] if a % 3 else []
    configurations = [_name(kb, ElementKind.COMPONENT_CONFIGURATION, b)] if b % 3 else []
    kb.select_configuration(designs, configurations)


def _execute(kb: KnowledgeBase, a: int, b: int) -> None:
    plan = kb.pending_reconfiguration_plan()
    if plan is not None:
        with kb.transaction():
            for component in plan.deactivate:
                kb.set_component_active(component, False)
            for component in plan.activate:
                kb.set_component_active(component, True)
            kb.set_reconfiguration_result(plan, Result.FAILED if b % 4 == 0 else Result.COMPLETED)


def _activate(kb: KnowledgeBase, a: int, b: int) -> None:
    kb.set_component_active(_name(kb, ElementKind.COMPONENT, a), b % 2 == 0)


def _several(kb: KnowledgeBase, a: int, b: int) -> None:
    """A transaction; every third breaks off after all."""
    with kb.transaction():
        for write in random_writes(a * 50 + b, 4):
            if WRITES[write.kind] is not _several:
                write(kb)
        if b % 3 == 0:
            raise KnowledgeBaseError("changed my mind")


def _suppose(kb: KnowledgeBase, a: int, b: int) -> None:
    kb.suppose(
        Situation(
            measurements={_name(kb, ElementKind.MEASURE, a): b / 50},
            selected_designs=(_name(kb, ElementKind.FUNCTION_DESIGN, b),),
            active_components=(_name(kb, ElementKind.COMPONENT, a),),
        )
    )


def _pass_time(kb: KnowledgeBase, a: int, b: int) -> None:
    assert isinstance(kb.clock, SimulationClock)
    kb.clock.advance_to(kb.clock.now() + a / 8)


def _add(kb: KnowledgeBase, a: int, b: int) -> None:
    new = f"new {a % 6}"
    component = _name(kb, ElementKind.COMPONENT, b)
    additions: tuple[Callable[[], list[Element]], ...] = (
        lambda: [Component(new), FunctionDesign(new, _name(kb, ElementKind.FUNCTION, b), (component, new), float(b))],
        lambda: [Measure(new), Constraint(new, ElementRef(ElementKind.COMPONENT, component), value=b / 50)],
        lambda: [ComponentConfiguration(new, component, (ComponentParameter(component, "k", b, ParameterType.LONG),))],
        lambda: [Action(new), FunctionalRequirement(new, (_name(kb, ElementKind.FUNCTION, b),))],
        lambda: [Constraint("battery", ElementRef(ElementKind.ACTION, _name(kb, ElementKind.ACTION, a)), value=b / 50)],
        lambda: [FunctionDesign(new, "unknown", (component,))],
    )
    kb.add_elements(*additions[a % len(additions)]())


def _remove(kb: KnowledgeBase, a: int, b: int) -> None:
    """Mostly something that was added; sometimes a part of the robot. The measure "tick" stays, for tests to use."""
    original = set(elements_of(robot()))
    elements = [element for element in elements_of(kb.model) if element not in original or b % 7 == 0]
    elements = [element for element in elements if element != Measure("tick")]
    if elements:
        kb.remove_elements(elements[a % len(elements)], *elements[-1 - b % 3 :])


WRITES: tuple[Callable[[KnowledgeBase, int, int], None], ...] = (
    _measure,
    _measure,
    _measure,
    _fail,
    _recover,
    _request,
    _request,
    _end_action,
    _plan,
    _plan,
    _select,
    _execute,
    _execute,
    _activate,
    _several,
    _suppose,
    _pass_time,
    _add,
    _remove,
)
