"""A mission is told as causes and what followed from them."""

from __future__ import annotations

import pytest

from rosa_core import KnowledgeBase, SimulationClock
from rosa_simulation.narrator import Narrator
from rosa_simulation.run_record import MissionEvent
from task_layer.bt.testing import FakeKnowledgeBase
from task_layer.pddl import PlanRecord


class Told:
    """A narrator and what it tells."""

    def __init__(self, **options: object) -> None:
        self.clock = SimulationClock()
        self.events: list[MissionEvent] = []
        self.narrator = Narrator(self.clock, self.events.append, effect_time=0.01, **options)  # type: ignore[arg-type]

    @property
    def lines(self) -> list[tuple[float, str]]:
        self.narrator.close()
        return [(event.time_s, event.text) for event in self.events]


@pytest.fixture
def told() -> Told:
    return Told()


def test_what_follows_at_once_is_told_with_its_cause(told: Told) -> None:
    told.narrator.cause("the lamp breaks")
    told.narrator.effect("it is dark")
    told.narrator.effect("it is dark")
    told.narrator.effect("the robot stops")
    assert told.lines == [(0.0, "the lamp breaks: it is dark, the robot stops")]


def test_a_measurement_from_which_nothing_follows_is_not_told(told: Told) -> None:
    told.narrator.measurement("light 0.9")
    told.clock.advance_to(1.0)
    told.narrator.measurement("light 0.1")
    told.narrator.effect("the lamp goes on")
    told.clock.advance_to(2.0)
    told.narrator.measurement("light 0.8")
    assert told.lines == [(1.0, "light 0.1: the lamp goes on")]


def test_what_a_component_does_belongs_to_the_call_that_made_it(told: Told) -> None:
    told.narrator.cause("it gets dark")
    told.narrator.call("lamp")
    told.clock.advance_to(0.003)
    told.narrator.effect("lamp activated", "lamp")
    told.narrator.effect("a dog barks", "dog")
    assert told.lines == [(0.0, "it gets dark: lamp activated"), (0.003, "a dog barks")]


def test_a_moment_is_told_when_it_is_over(told: Told) -> None:
    told.narrator.cause("it gets dark")
    told.clock.advance_to(0.005)
    assert told.events == []
    told.clock.advance_to(0.02)
    assert [event.text for event in told.events] == ["it gets dark"]


def test_facts_are_kept_and_alone_are_not_worth_telling(told: Told) -> None:
    told.narrator.fact("seen", colour="red")
    told.clock.advance_to(1.0)
    told.narrator.cause("it gets dark")
    told.narrator.fact("light", level=0.1)
    assert told.lines == [(1.0, "it gets dark")]
    assert told.events[0].facts == ({"fact": "light", "level": 0.1},)


def test_times_count_from_the_beginning_of_the_mission() -> None:
    told = Told(start_time=lambda: 5.0)
    told.clock.advance_to(3.0)
    told.narrator.cause("preparation")
    told.clock.advance_to(7.5)
    told.narrator.cause("something")
    assert told.lines == [(0.0, "preparation"), (2.5, "something")]


def test_it_hears_what_follows_in_a_knowledge_base(told: Told) -> None:
    kb: KnowledgeBase = FakeKnowledgeBase("search", clock=told.clock)
    kb.subscribe(told.narrator.on_kb_event)
    kb.request_action("search")
    told.clock.advance_to(1.0)
    told.narrator.cause("something breaks")
    kb.set_component_failure("search part")
    kb.cancel_action("search")
    assert told.lines == [
        (0.0, "search requested"),
        (1.0, "something breaks: search unfeasible, search abandoned"),
    ]
    facts = [fact["fact"] for event in told.events for fact in event.facts]
    assert facts.count("actions") == 2


def test_plans_are_told_by_their_actions_and_none_with_its_reason(told: Told) -> None:
    def plan(*steps: str, no_plan: str = "") -> PlanRecord:
        return PlanRecord(0.0, "why", steps, 0, no_plan, cached=False, engine="x", cost_s=0.1)

    told.narrator.on_plan(plan("(search a)", "(land)"))
    told.clock.advance_to(1.0)
    told.narrator.on_plan(plan(no_plan="land is unfeasible"))
    assert told.lines == [(0.0, "plan: search, land"), (1.0, "no plan: land is unfeasible")]
