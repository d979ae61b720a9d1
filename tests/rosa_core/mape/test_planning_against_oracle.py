"""The planner, which plans only for a reason, configures a robot as one that plans at every single event does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import ElementKind, KnowledgeBase, KnowledgeBaseError, KnowledgeModel, SimulationClock
from rosa_core.kb import Event, ReconfigurationPlan, Utility
from rosa_core.mape import AdaptationLoop, ConfigurationPlanner, Executor
from rosa_core.model.changes import referring_to
from rosa_core.model.elements import (
    ESTIMABLE,
    Component,
    ComponentConfiguration,
    ComponentType,
    Constraint,
    ElementRef,
    Estimation,
    EstimationType,
    FunctionDesign,
)
from tests.rosa_core.inference.random_knowledge import LIMITS, NOW, models
from tests.rosa_core.sample_models import KINDS, PretendedRobot

MEASURE, ACTION, COMPONENT = ElementKind.MEASURE, ElementKind.ACTION, ElementKind.COMPONENT


@dataclass(frozen=True)
class Write:
    """One write by the name of its method; ``parts`` are those of a transaction."""

    what: str
    arguments: tuple[Any, ...] = ()
    parts: tuple[Write, ...] = ()

    def __call__(self, kb: KnowledgeBase) -> None:
        """Do it; one that is refused changes nothing."""
        try:
            if self.parts:
                with kb.transaction():
                    for part in self.parts:
                        part(kb)
            elif self.what == "remove":
                kb.remove_elements(*self.arguments, *referring_to(kb.model, self.arguments[0]))
            else:
                getattr(kb, self.what)(*self.arguments)
        except KnowledgeBaseError:
            pass


@st.composite
def scenarios(draw: Callable[..., Any]) -> tuple[KnowledgeModel, frozenset[str], list[Write]]:
    """A model with estimations, the components that cannot be called, and what is written."""
    model = draw(models())
    names = model.names
    causers = [ElementRef(kind, name) for kind in sorted(ESTIMABLE) for name in names[kind]]
    estimates = st.tuples(st.sampled_from(causers), st.sampled_from(names[MEASURE]))
    model = replace(
        model,
        components=tuple(replace(component, type=ComponentType.LIFECYCLE_NODE) for component in model.components),
        estimations=tuple(
            Estimation(causer, measure, draw(st.sampled_from((0.25, 1.0, 2.0))), draw(st.sampled_from(EstimationType)))
            for causer, measure in draw(st.lists(estimates, max_size=8, unique=True))
        ),
    )
    broken = draw(st.frozensets(st.sampled_from(names[COMPONENT]), max_size=1))
    return model, broken, draw(st.lists(_writes(model), min_size=3, max_size=25))


def _writes(model: KnowledgeModel) -> st.SearchStrategy[Write]:
    names = model.names
    measure, action = st.sampled_from(names[MEASURE]), st.sampled_from(names[ACTION])
    component, function = st.sampled_from(names[COMPONENT]), st.sampled_from(names[ElementKind.FUNCTION])
    utility = st.builds(
        Utility,
        st.dictionaries(measure, st.sampled_from((-1.0, 0.5, 1.0)), max_size=2),
        st.lists(st.tuples(measure, st.sampled_from((">=", "<=")), st.sampled_from(LIMITS)), max_size=1).map(tuple),
    )
    priority = st.none() | st.sampled_from((0.0, 1.0, 2.0))
    parts = st.lists(component, min_size=1, max_size=2, unique=True).map(tuple)
    removable = [
        ElementRef(kind, name)
        for kind in (ElementKind.FUNCTION_DESIGN, ElementKind.COMPONENT_CONFIGURATION, COMPONENT)
        for name in names[kind]
    ]
    added = st.one_of(
        st.builds(FunctionDesign, st.sampled_from(("new0", "new1")), function, parts, priority),
        st.builds(ComponentConfiguration, st.sampled_from(("new0", "new1")), component, st.just(()), priority),
        st.builds(
            Constraint, measure, component.map(lambda name: ElementRef(COMPONENT, name)), value=st.sampled_from(LIMITS)
        ),
        st.builds(Component, st.just("new")),
    )

    def write(what: str, *arguments: st.SearchStrategy[Any]) -> st.SearchStrategy[Write]:
        return st.tuples(*arguments).map(lambda drawn: Write(what, drawn))

    measurement = write("add_measurement", measure, st.sampled_from(LIMITS), st.sampled_from((NOW, NOW, NOW - 1)))
    together = st.one_of(
        measurement,
        write("set_component_failure", component),
        write("set_component_active", component, st.booleans()),
        write("request_action", action),
        write("request_action", action, st.none(), utility),
        write("request_action", action, measure),
        write("cancel_action", action),
        write("finish_action", action),
        write("add_elements", added),
        write("remove", st.sampled_from(removable)),
    )
    alone = write("clear_component_failure", component)
    several = st.lists(together, min_size=2, max_size=4).map(lambda writes: Write("transaction", (), tuple(writes)))
    return st.one_of(together, together, alone, measurement, several)


class EagerPlanner:
    """The oracle: plans at every event, be it a measurement that changes nothing or its own selection."""

    def __init__(self, kb: KnowledgeBase, robot: PretendedRobot) -> None:
        self._planner = ConfigurationPlanner(kb)
        executor = Executor(kb, robot)
        kb.subscribe(self.on_event)
        kb.subscribe(executor.on_event, Executor.EVENTS)

    def on_event(self, event: Event) -> None:
        """Plan."""
        self._planner.plan()


def _work(plan: ReconfigurationPlan | None) -> object:
    return plan and (plan.activate, plan.deactivate, plan.parameter_adaptations)


def _configured(kb: KnowledgeBase, robot: PretendedRobot) -> dict[str, Any]:
    """How the robot is configured."""
    names = kb.model.names
    return {
        "statuses": {kind: kb.statuses(kind) for kind in KINDS},
        "designs": {name: kb.selected_function_design(name) for name in names[ElementKind.FUNCTION]},
        "configurations": {name: kb.selected_component_configuration(name) for name in names[COMPONENT]},
        "active": [name for name in names[COMPONENT] if kb.is_component_active(name)],
        "plan": _work(kb.pending_reconfiguration_plan()),
        "running": robot.running,
        "parameters": robot.parameters,
    }


@given(scenarios())
@settings(max_examples=100, deadline=None)
def test_planning_only_for_a_reason_configures_as_planning_always(
    scenario: tuple[KnowledgeModel, frozenset[str], list[Write]],
) -> None:
    model, broken, writes = scenario
    robots = [PretendedRobot(tuple(broken)) for _ in range(2)]
    kb, eager = (KnowledgeBase(model, SimulationClock(NOW)) for _ in range(2))
    AdaptationLoop(kb, robots[0])
    EagerPlanner(eager, robots[1])
    for write in writes:
        write(kb)
        write(eager)
        assert _configured(kb, robots[0]) == _configured(eager, robots[1])
