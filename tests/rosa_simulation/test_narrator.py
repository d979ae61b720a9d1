"""A mission is described as causes and what followed from them."""

from __future__ import annotations

import pytest

from rosa_core import KnowledgeBase, SimulationClock
from rosa_simulation.narrator import Narrator
from rosa_simulation.run_record import MissionEvent
from task_layer.bt.testing import FakeKnowledgeBase
from task_layer.pddl import PlanRecord


class Narrated:
    """A narrator and the events that it makes."""

    def __init__(self, **options: object) -> None:
        self.clock = SimulationClock()
        self.events: list[MissionEvent] = []
        self.narrator = Narrator(self.clock, self.events.append, effect_time=0.01, **options)  # type: ignore[arg-type]

    @property
    def lines(self) -> list[tuple[float, str]]:
        self.narrator.close()
        return [(event.time_s, event.text) for event in self.events]


@pytest.fixture
def narrated() -> Narrated:
    return Narrated()


def test_what_follows_at_once_is_reported_with_its_cause(narrated: Narrated) -> None:
    narrated.narrator.cause("the lamp breaks")
    narrated.narrator.effect("it is dark")
    narrated.narrator.effect("it is dark")
    narrated.narrator.effect("the robot stops")
    assert narrated.lines == [(0.0, "the lamp breaks: it is dark, the robot stops")]


def test_a_measurement_from_which_nothing_follows_is_not_reported(narrated: Narrated) -> None:
    narrated.narrator.measurement("light 0.9")
    narrated.clock.advance_to(1.0)
    narrated.narrator.measurement("light 0.1")
    narrated.narrator.effect("the lamp goes on")
    narrated.clock.advance_to(2.0)
    narrated.narrator.measurement("light 0.8")
    assert narrated.lines == [(1.0, "light 0.1: the lamp goes on")]


def test_what_a_component_does_belongs_to_the_call_that_made_it(narrated: Narrated) -> None:
    narrated.narrator.cause("it gets dark")
    narrated.narrator.call("lamp")
    narrated.clock.advance_to(0.003)
    narrated.narrator.effect("lamp activated", "lamp")
    narrated.narrator.effect("a dog barks", "dog")
    assert narrated.lines == [(0.0, "it gets dark: lamp activated"), (0.003, "a dog barks")]


def test_an_entry_is_published_when_it_is_over(narrated: Narrated) -> None:
    narrated.narrator.cause("it gets dark")
    narrated.clock.advance_to(0.005)
    assert narrated.events == []
    narrated.clock.advance_to(0.02)
    assert [event.text for event in narrated.events] == ["it gets dark"]


def test_facts_are_kept_and_alone_are_not_worth_telling(narrated: Narrated) -> None:
    narrated.narrator.fact("seen", colour="red")
    narrated.clock.advance_to(1.0)
    narrated.narrator.cause("it gets dark")
    narrated.narrator.fact("light", level=0.1)
    assert narrated.lines == [(1.0, "it gets dark")]
    assert narrated.events[0].facts == ({"fact": "light", "level": 0.1},)


def test_times_count_from_the_beginning_of_the_mission() -> None:
    narrated = Narrated(start_time=lambda: 5.0)
    narrated.clock.advance_to(3.0)
    narrated.narrator.cause("preparation")
    narrated.clock.advance_to(7.5)
    narrated.narrator.cause("something")
    assert narrated.lines == [(0.0, "preparation"), (2.5, "something")]


def test_it_hears_what_follows_in_a_knowledge_base(narrated: Narrated) -> None:
    kb: KnowledgeBase = FakeKnowledgeBase("search", clock=narrated.clock)
    kb.subscribe(narrated.narrator.on_kb_event)
    kb.request_action("search")
    narrated.clock.advance_to(1.0)
    narrated.narrator.cause("something breaks")
    kb.set_component_failure("search part")
    kb.cancel_action("search")
    assert narrated.lines == [
        (0.0, "search requested"),
        (1.0, "something breaks: search unfeasible, search abandoned"),
    ]
    facts = [fact["fact"] for event in narrated.events for fact in event.facts]
    assert facts.count("actions") == 2


def test_plans_are_reported_by_their_actions_and_none_with_its_reason(narrated: Narrated) -> None:
    def plan(*steps: str, no_plan: str = "") -> PlanRecord:
        return PlanRecord(0.0, "why", steps, 0, no_plan, cached=False, engine="x", cost_s=0.1)

    narrated.narrator.on_plan(plan("(search a)", "(land)"))
    narrated.clock.advance_to(1.0)
    narrated.narrator.on_plan(plan(no_plan="land is unfeasible"))
    assert narrated.lines == [(0.0, "plan: search, land"), (1.0, "no plan: land is unfeasible")]
