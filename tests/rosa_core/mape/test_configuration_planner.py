"""What the planner chooses: for everything adaptable, the best that is selectable."""

from __future__ import annotations

import pytest

from rosa_core import KnowledgeBase, Situation, Status
from rosa_core.kb import ReconfigurationPlan, ReconfigurationPlanCreated
from rosa_core.mape import ConfigurationPlanner
from rosa_core.model.elements import FunctionDesign
from tests.rosa_core.sample_models import heard, knowledge_model


@pytest.fixture
def planner(kb: KnowledgeBase) -> ConfigurationPlanner:
    """A planner that is woken by the events that concern it."""
    planner = ConfigurationPlanner(kb)
    kb.subscribe(planner.on_event, ConfigurationPlanner.EVENTS)
    return planner


def settle(kb: KnowledgeBase) -> None:
    """The pending plan is carried out."""
    plan = kb.pending_reconfiguration_plan()
    if plan is not None:
        with kb.transaction():
            for component in plan.deactivate:
                kb.set_component_active(component, False)
            for component in plan.activate:
                kb.set_component_active(component, True)
            kb.set_reconfiguration_result(plan, "completed")


def selected(kb: KnowledgeBase) -> tuple[str | None, str | None, str | None]:
    """How the drone flies, sees, and sets its camera."""
    design = kb.selected_function_design
    return design("fly"), design("see"), kb.selected_component_configuration("camera")


class CountingPlanner(ConfigurationPlanner):
    """A planner that counts how often it plans."""

    def __init__(self, kb: KnowledgeBase) -> None:
        super().__init__(kb)
        self.plannings = 0
        kb.subscribe(self.on_event, ConfigurationPlanner.EVENTS)

    def plan(self) -> ReconfigurationPlan | None:
        self.plannings += 1
        return super().plan()


def test_the_planner_plans_when_something_has_changed_that_choices_follow_from(kb: KnowledgeBase) -> None:
    planner = CountingPlanner(kb)

    def plannings() -> int:
        settle(kb)
        count, planner.plannings = planner.plannings, 0
        return count

    kb.add_measurement("light", 60)  # not evaluated before
    assert plannings() == 1
    kb.request_action("deliver")
    assert plannings() == 1
    kb.add_measurement("light", 40)
    assert plannings() == 1
    kb.set_component_failure("camera")
    assert plannings() == 1
    kb.clear_component_failure("camera")
    assert plannings() == 1
    kb.set_component_active("autopilot", False)
    assert plannings() == 1
    kb.set_component_active("lidar", True)
    assert plannings() == 1
    kb.add_elements(FunctionDesign("see by beacon", "see", ("beacon",)))
    assert plannings() == 1
    kb.finish_action("deliver")
    assert plannings() == 1


def test_the_planner_does_not_plan_for_what_no_choice_follows_from(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 60)
    kb.request_action("deliver")
    planner = CountingPlanner(kb)
    planner.plan()
    settle(kb)  # the selection and the plan, when they are carried out, are no reason to plan again
    kb.add_measurement("light", 61)
    kb.add_measurement("wind", 3, time=-1.0)
    assert planner.plannings == 2  # the wind was not known before
    kb.add_measurement("wind", 4)
    kb.select_configuration(["see by lidar"], [])
    assert kb.selected_function_design("see") == "see by lidar"
    assert planner.plannings == 2


def test_a_plan_that_is_carried_out_one_component_at_a_time_is_not_made_again(kb: KnowledgeBase) -> None:
    planner = CountingPlanner(kb)
    kb.request_action("deliver")
    plan = kb.pending_reconfiguration_plan()
    assert plan is not None
    for component in plan.activate:
        kb.set_component_active(component, True)
    assert kb.set_reconfiguration_result(plan, "completed")
    assert planner.plannings == 1


@pytest.mark.usefixtures("planner")
def test_a_request_selects_the_best_designs_and_their_best_configurations(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    assert selected(kb) == ("fly fast", "see by camera", "sharp")
    plan = kb.pending_reconfiguration_plan()
    assert plan is not None
    assert (plan.activate, plan.parameter_adaptations) == (("rotors", "autopilot", "camera"), ("sharp",))


@pytest.mark.usefixtures("planner")
def test_only_what_is_required_is_configured(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    assert selected(kb) == ("fly fast", None, None)


@pytest.mark.usefixtures("planner")
def test_the_unfeasible_is_not_chosen(kb: KnowledgeBase) -> None:
    kb.add_measurement("wind", 10)
    kb.add_measurement("light", 20)
    kb.request_action("deliver")
    assert selected(kb) == ("fly gently", "see by camera", "grainy")


@pytest.mark.usefixtures("planner")
def test_a_selected_design_that_becomes_unfeasible_is_replaced(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    settle(kb)
    kb.set_component_failure("camera")
    assert selected(kb) == ("fly fast", "see by lidar", None)


@pytest.mark.usefixtures("planner")
def test_a_selected_configuration_that_becomes_unfeasible_is_replaced(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    settle(kb)
    kb.add_measurement("light", 20)
    assert selected(kb) == ("fly fast", "see by camera", "grainy")


@pytest.mark.usefixtures("planner")
def test_what_always_improves_takes_up_something_better_when_it_can(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 20)
    kb.set_component_failure("camera")
    kb.request_action("deliver")
    settle(kb)
    assert selected(kb) == ("fly fast", "see by lidar", None)
    kb.clear_component_failure("camera")
    settle(kb)
    assert selected(kb) == ("fly fast", "see by camera", "grainy")
    kb.add_measurement("light", 80)
    assert selected(kb) == ("fly fast", "see by camera", "sharp")


@pytest.mark.usefixtures("planner")
def test_what_is_solved_and_does_not_always_improve_is_left_as_it_is(kb: KnowledgeBase) -> None:
    kb.add_measurement("wind", 10)
    kb.request_action("deliver")
    settle(kb)
    events = heard(kb, ReconfigurationPlanCreated)
    kb.add_measurement("wind", 1)
    assert selected(kb)[0] == "fly gently"
    assert events == []


@pytest.mark.usefixtures("planner")
def test_when_nothing_better_is_there_nothing_is_planned(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    settle(kb)
    events = heard(kb, ReconfigurationPlanCreated)
    for light in (60, 70, 80):
        kb.add_measurement("light", light)
    assert events == []


@pytest.mark.usefixtures("planner")
def test_an_action_that_ends_leaves_nothing_selected(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    settle(kb)
    kb.finish_action("deliver")
    assert selected(kb) == (None, None, None)
    settle(kb)
    assert not any(kb.is_component_active(name) for name in kb.statuses("component"))


@pytest.mark.usefixtures("planner")
def test_one_action_after_the_other_in_one_write_keeps_running_what_both_need(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    settle(kb)
    with kb.transaction():
        kb.finish_action("deliver")
        kb.request_action("hover")
    plan = kb.pending_reconfiguration_plan()
    assert plan is not None
    assert (plan.activate, plan.deactivate, plan.parameter_adaptations) == ((), ("camera",), ())


def test_when_nothing_can_be_chosen_nothing_is(kb: KnowledgeBase, planner: ConfigurationPlanner) -> None:
    kb.suppose(Situation(failed_components=("camera", "lidar", "rotors"), required_actions=("deliver",)))
    assert planner.plan() is None
    assert selected(kb) == (None, None, None)


RUNNERS = """
actions: {{run: {{requires: [move]}}}}
functions: {{move: {{always_improve: {improve}}}}}
components: {{a: , b: , c: , d: }}
function_designs:
  by a: {{function: move, components: [a]{a}}}
  by b: {{function: move, components: [b]{b}}}
  by c: {{function: move, components: [c]{c}}}
  by d: {{function: move, components: [d]{d}}}
component_configurations:
  setting of d: {{component: d}}
"""


def runner(improve: bool = False, **priorities: float) -> KnowledgeBase:
    """A robot that can move in four ways; their priorities."""
    stated = {way: f", priority: {priorities[way]}" if way in priorities else "" for way in "abcd"}
    kb = KnowledgeBase(knowledge_model(RUNNERS.format(improve=str(improve).lower(), **stated)))
    kb.subscribe(ConfigurationPlanner(kb).on_event, ConfigurationPlanner.EVENTS)
    return kb


@pytest.mark.parametrize(
    ("priorities", "best"),
    [
        ({"a": 3, "b": 2, "c": 1, "d": 4}, "by c"),
        ({"b": 0.5, "a": 1}, "by b"),
        ({"a": 0, "b": -1}, "by b"),
        ({"d": 1000000}, "by d"),
        ({"c": 5, "b": 5}, "by b"),
        ({}, "by a"),
    ],
    ids=["lowest number", "fraction", "negative", "none is last", "tie by declaration", "no priorities"],
)
def test_the_best_has_the_lowest_number_then_the_first_declaration(priorities: dict[str, float], best: str) -> None:
    kb = runner(**priorities)
    kb.request_action("run")
    assert kb.selected_function_design("move") == best


def test_the_best_of_the_configurations_is_chosen_the_same_way() -> None:
    kb = KnowledgeBase(
        knowledge_model(
            """
            actions: {run: {requires: [move]}}
            functions: {move: }
            components: {legs: }
            function_designs: {on foot: {function: move, components: [legs]}}
            component_configurations:
              stroll: {component: legs}
              walk: {component: legs, priority: 2}
              hop: {component: legs, priority: 1.5}
              jump: {component: legs, priority: 1.5}
            """
        )
    )
    kb.subscribe(ConfigurationPlanner(kb).on_event, ConfigurationPlanner.EVENTS)
    kb.request_action("run")
    assert kb.selected_component_configuration("legs") == "hop"


def test_a_solved_function_does_not_change_for_an_equally_good_design() -> None:
    kb = runner(improve=True, a=1, b=1, c=2)
    kb.set_component_failure("a")
    kb.request_action("run")
    settle(kb)
    assert kb.selected_function_design("move") == "by b"
    kb.clear_component_failure("a")
    assert kb.status("function", "move") is Status.SOLVED
    assert kb.selected_function_design("move") == "by b"


def test_planning_twice_selects_the_same_and_keeps_the_plan(kb: KnowledgeBase, planner: ConfigurationPlanner) -> None:
    kb.request_action("deliver")
    revision, plan = kb.revision, kb.pending_reconfiguration_plan()
    assert planner.plan() == plan
    assert kb.revision == revision


def test_when_a_better_design_takes_over_the_component_left_is_not_configured() -> None:
    kb = KnowledgeBase(
        knowledge_model(
            """
            actions: {run: {requires: [move]}}
            functions: {move: {always_improve: true}}
            components: {wheels: , legs: {always_improve: true}}
            function_designs:
              on wheels: {function: move, components: [wheels], priority: 1}
              on foot: {function: move, components: [legs], priority: 2}
            component_configurations:
              walk: {component: legs}
            """
        )
    )
    kb.subscribe(ConfigurationPlanner(kb).on_event, ConfigurationPlanner.EVENTS)
    kb.set_component_failure("wheels")
    kb.request_action("run")
    settle(kb)
    assert kb.selected_component_configuration("legs") == "walk"
    kb.clear_component_failure("wheels")
    assert kb.selected_function_design("move") == "on wheels"
    assert kb.selected_component_configuration("legs") is None
