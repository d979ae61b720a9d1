"""How a mission in PDDL is carried out on the knowledge base."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest

from rosa_core import InputError, KnowledgeBase, Result, SimulationClock
from rosa_core.kb import ActionUpdate, Limit
from task_layer.pddl import (
    ExecutionLimits,
    ExecutionStatus,
    FeasibilityBridge,
    PlanExecutor,
    Planner,
    StepOutcome,
    parse_task,
)
from task_layer.skill import Skill, SkillStatus
from tests.task_layer.pddl.kit import SUAVE_DOMAIN, Scripted, knowledge, names, set_feasible, suave_problem

ACTIONS = ("search_pipeline", "inspect_pipeline", "recharge")
FAILURE = SkillStatus.FAILURE


class Fixture:
    """The SUAVE mission with scripted skills; each takes 1 s."""

    def __init__(
        self, *, targets: int = 1, sensed: tuple[str, ...] = (), parallel: bool = False, **options: Any
    ) -> None:
        self.clock = SimulationClock()
        self.kb = knowledge(ACTIONS, self.clock)
        self.skills = {name: Scripted(11) for name in ACTIONS}
        self.skills["start_robot"] = Scripted(1)
        self.skills["recharge"].on_success = self.charge
        task = parse_task(SUAVE_DOMAIN, suave_problem(targets=targets), sensed=sensed)
        self.planner = Planner(task, parallel=parallel)
        self.executor = PlanExecutor(self.planner, self.kb, {**self.skills, **options.pop("skills", {})}, **options)

    def charge(self) -> None:
        for name in ACTIONS[:2]:
            set_feasible(self.kb, name, True)

    def at(self, when: float, action: str, feasible: bool) -> None:
        self.clock.call_at(when, lambda: set_feasible(self.kb, action, feasible))

    def low_battery(self, when: float) -> None:
        for name in ACTIONS[:2]:
            self.at(when, name, False)

    def times(self, outcome: StepOutcome) -> list[tuple[float, str]]:
        return [(round(s.time, 3), *names([s.step])) for s in self.executor.steps if s.outcome is outcome]  # type: ignore[misc]

    def results(self) -> list[tuple[str, Result]]:
        return [(entry.action, entry.result) for entry in self.kb.history("required_actions")]  # type: ignore[union-attr,misc]


def test_a_mission_is_carried_out_step_by_step_and_its_actions_are_requested() -> None:
    f = Fixture()
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert f.times(StepOutcome.STARTED) == [
        (0.0, "start_robot"),
        (0.0, "search_pipeline"),
        (1.0, "inspect_pipeline"),
    ]
    assert f.times(StepOutcome.COMPLETED)[-1] == (2.0, "inspect_pipeline")
    assert f.results() == [("search_pipeline", Result.COMPLETED), ("inspect_pipeline", Result.COMPLETED)]
    assert f.kb.required_actions() == []
    assert [plan.reason for plan in f.executor.plans] == ["the mission begins"]
    assert f.skills["search_pipeline"].calls == ["start", "success", "stop"]


def test_the_end_of_a_step_and_the_start_of_the_next_are_one_change() -> None:
    f = Fixture()
    seen: list[list[str]] = []
    updates: list[ActionUpdate] = []
    f.kb.subscribe(lambda _: seen.append([a.action for a in f.kb.required_actions()]))
    f.kb.subscribe(updates.append, (ActionUpdate,))
    f.executor.run(timeout=1.5)
    assert all(len(required) <= 1 for required in seen)
    assert updates[1].ended[0].action == "search_pipeline"
    assert updates[1].requested[0].action == "inspect_pipeline"


def test_an_action_that_becomes_unfeasible_while_it_runs_is_stopped_at_that_moment_and_resumed_after_recovery() -> None:
    f = Fixture()
    f.low_battery(0.53)
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert f.times(StepOutcome.INTERRUPTED) == [(0.53, "search_pipeline")]
    assert [name for _, name in f.times(StepOutcome.STARTED)[2:]] == [
        "recharge",
        "search_pipeline",
        "inspect_pipeline",
    ]
    assert f.times(StepOutcome.STARTED)[2][0] == 0.53
    assert [names(plan.steps) for plan in f.executor.plans][1] == ["recharge", "search_pipeline", "inspect_pipeline"]
    assert "search_pipeline is unfeasible" in f.executor.plans[1].reason
    assert f.results()[0] == ("search_pipeline", Result.ABANDONED)


def test_an_action_that_becomes_unfeasible_before_its_step_changes_the_plan_and_keeps_what_runs() -> None:
    f = Fixture()
    f.at(0.42, "inspect_pipeline", False)
    f.executor.run(timeout=0.5)
    replanned = f.executor.plans[-1]
    assert replanned.time == 0.42
    assert replanned.kept == 1
    assert names(replanned.steps) == ["search_pipeline", "recharge", "inspect_pipeline"]
    assert replanned.reason == "inspect_pipeline unfeasible"
    assert f.skills["search_pipeline"].calls[0] == "start"
    assert f.skills["search_pipeline"].calls.count("start") == 1


def test_changes_that_do_not_concern_the_plan_leave_it_alone() -> None:
    f = Fixture()
    f.at(0.3, "recharge", False)
    f.at(1.2, "search_pipeline", False)  # after its step
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert len(f.executor.plans) == 1


def test_without_a_plan_it_waits_for_feasibility_and_says_why() -> None:
    f = Fixture()
    f.at(0.5, "recharge", False)
    f.low_battery(0.6)
    f.at(7.25, "recharge", True)
    f.clock.call_at(5.0, lambda: statuses.append((f.executor.status, f.executor.feedback)))
    statuses: list[tuple[ExecutionStatus, str]] = []
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    ((status, why),) = statuses
    assert status is ExecutionStatus.WAITING
    assert "in the way is recharge (unfeasible)" in why
    assert (7.25, "recharge") in f.times(StepOutcome.STARTED)
    without = [plan for plan in f.executor.plans if plan.no_plan]
    assert len(without) <= 2  # it is not planned again before something changes


def test_its_patience_ends() -> None:
    f = Fixture(limits=ExecutionLimits(patience=10.0))
    for name in ACTIONS:
        f.at(0.5, name, False)
    assert f.executor.run(timeout=100.0) is ExecutionStatus.FAILURE
    assert f.clock.now() == pytest.approx(10.5, abs=0.11)
    assert f.executor.feedback.startswith("no plan for 10 s: (pipeline_found p1)")
    assert f.executor.tick() is ExecutionStatus.FAILURE


def test_a_step_that_fails_is_tried_again_later_and_not_for_ever() -> None:
    f = Fixture(limits=ExecutionLimits(attempts=3, retry_delay=4.0, patience=20.0))
    f.skills["search_pipeline"].outcomes.extend([FAILURE, FAILURE])
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert [time for time, _ in f.times(StepOutcome.FAILED)] == pytest.approx([1.0, 6.0], abs=0.11)
    assert "its skill failed" in f.executor.plans[1].reason
    g = Fixture(limits=ExecutionLimits(attempts=3, retry_delay=4.0, patience=20.0))
    g.skills["search_pipeline"].outcomes.extend([FAILURE] * 9)
    assert g.executor.run(timeout=100.0) is ExecutionStatus.FAILURE
    assert len(g.times(StepOutcome.FAILED)) == 3
    assert "(failed 3 times)" in g.executor.feedback
    assert [result for _, result in g.results()] == [Result.FAILED] * 3


def test_a_step_that_takes_too_long_or_raises_has_failed(caplog: pytest.LogCaptureFixture) -> None:
    def broken() -> None:
        raise OSError("no propeller")

    f = Fixture(limits=ExecutionLimits(step_timeout=0.5, attempts=1, patience=1.0))
    assert f.executor.run(timeout=100.0) is ExecutionStatus.FAILURE
    assert f.executor.steps[-1].reason == "it took longer than 0.5 s"
    g = Fixture(limits=ExecutionLimits(attempts=1, patience=1.0))
    g.skills["search_pipeline"].on_start = broken
    assert g.executor.run(timeout=100.0) is ExecutionStatus.FAILURE
    assert g.executor.steps[-1].reason == "its skill raised OSError: no propeller"
    assert g.skills["search_pipeline"].calls == ["start", "stop"]
    assert "no propeller" in caplog.text


def test_an_action_that_somebody_else_ends_has_failed() -> None:
    f = Fixture(limits=ExecutionLimits(retry_delay=1.0))
    f.clock.call_at(0.35, lambda: f.kb.cancel_action("search_pipeline"))
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert f.times(StepOutcome.FAILED) == [(0.35, "search_pipeline")]
    assert "was ended in the knowledge base" in f.executor.plans[1].reason


def test_an_action_that_becomes_unfeasible_as_it_starts_is_stopped_in_the_same_tick() -> None:
    f = Fixture()
    f.skills["search_pipeline"].on_start = lambda: set_feasible(f.kb, "search_pipeline", False)
    f.executor.tick()
    assert [action.action for action in f.kb.required_actions()] == ["recharge"]
    assert f.times(StepOutcome.INTERRUPTED) == [(0.0, "search_pipeline")]
    assert f.skills["search_pipeline"].calls == ["start", "stop"]


def test_the_skill_of_a_step_starts_when_its_action_is_required_and_goes_on_in_the_same_tick() -> None:
    f = Fixture()
    seen: list[list[str]] = []
    f.skills["search_pipeline"].on_start = lambda: seen.append([a.action for a in f.kb.required_actions()])
    f.skills["search_pipeline"].updates = 1
    f.executor.tick()
    assert seen == [["search_pipeline"]]
    assert f.times(StepOutcome.COMPLETED) == [(0.0, "start_robot"), (0.0, "search_pipeline")]
    assert [action.action for action in f.kb.required_actions()] == ["inspect_pipeline"]


def test_a_step_whose_start_spoils_what_it_needs_is_never_requested() -> None:
    domain = """(define (domain d) (:requirements :strips :durative-actions) (:predicates (dry) (there))
      (:durative-action swim :parameters () :duration (= ?duration 1)
       :condition (over all (dry)) :effect (and (at start (not (dry))) (at end (there)))))"""
    task = parse_task(domain, "(define (problem p) (:domain d) (:init (dry)) (:goal (there)))")
    kb, skill = knowledge(("swim",)), Scripted()
    executor = PlanExecutor(Planner(task), kb, {"swim": skill}, limits=ExecutionLimits(attempts=1, patience=0.0))
    executor.tick()
    reasons = [step.reason for step in executor.steps if step.outcome is not StepOutcome.STARTED]
    assert reasons == ["its start makes untrue what it needs throughout"]
    assert skill.calls == []
    assert kb.history("required_actions") == ()


def test_a_request_that_is_refused_when_it_is_written_is_a_failed_step() -> None:
    """Another part of the look's transaction makes the action unfeasible before the request is written."""
    f = Fixture(limits=ExecutionLimits(retry_delay=1.0))
    requests = f.executor._requests
    assert requests is not None
    with requests.together():
        f.executor.tick()
        set_feasible(f.kb, "search_pipeline", False)
        set_feasible(f.kb, "recharge", True)
    assert f.kb.required_actions() == []
    set_feasible(f.kb, "search_pipeline", True)
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert f.times(StepOutcome.FAILED) == [(0.0, "search_pipeline")]
    assert "the request is refused" in f.executor.plans[1].reason


def test_the_number_of_plans_is_bounded() -> None:
    """Recharging never helps: every time it is done, searching stays unfeasible."""
    f = Fixture(limits=ExecutionLimits(replans=7, effect_delay=0.2, attempts=1000, retry_delay=0.0))
    f.skills["recharge"].on_success = lambda: None
    f.low_battery(0.5)
    assert f.executor.run(timeout=1000.0) is ExecutionStatus.FAILURE
    assert f.executor.feedback == "7 new plans were made, and none reached the goal"


def test_an_effect_that_does_not_come_true_is_a_failure_of_its_step() -> None:
    f = Fixture(limits=ExecutionLimits(effect_delay=2.0, retry_delay=1.0, patience=30.0, attempts=2))
    f.skills["recharge"].on_success = lambda: None
    f.low_battery(0.5)
    assert f.executor.run(timeout=100.0) is ExecutionStatus.FAILURE
    assert (3.5, "recharge") not in f.times(StepOutcome.STARTED)
    reasons = [plan.reason for plan in f.executor.plans]
    assert any("(action_feasible search_pipeline) did not become as" in reason for reason in reasons)
    assert "recharge recharge search_pipeline inspect_pipeline bluerov) (failed 2 times)" in f.executor.feedback


def test_an_effect_may_take_a_while_to_be_seen() -> None:
    f = Fixture(limits=ExecutionLimits(effect_delay=2.0))
    f.skills["recharge"].on_success = lambda: None
    f.low_battery(0.5)
    for name in ACTIONS[:2]:
        f.at(2.75, name, True)
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert len(f.executor.plans) == 2
    assert (2.75, "search_pipeline") in f.times(StepOutcome.STARTED)


def test_a_sensed_fact_is_what_the_sensor_says() -> None:
    """The pipeline comes into sight while the search is going on: what is left is to inspect it."""
    seen = {"p1": False}
    f = Fixture(sensed=("pipeline_found",), sensors={"pipeline_found": lambda pipeline: seen[pipeline]})
    f.skills["search_pipeline"].updates = 1000
    f.clock.call_at(3.0, lambda: seen.update(p1=True))
    f.clock.call_at(3.0, f.executor.wake)
    f.clock.call_at(4.0, lambda: f.skills["search_pipeline"].__setattr__("_left", 1))
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert f.times(StepOutcome.COMPLETED)[1][1] == "search_pipeline"


def test_a_search_that_finds_nothing_is_repeated() -> None:
    seen: set[str] = set()
    limits = ExecutionLimits(effect_delay=0.5, retry_delay=0.0)
    f = Fixture(sensed=("pipeline_found",), sensors={"(pipeline_found p1)": lambda: "p1" in seen}, limits=limits)
    f.clock.call_at(2.0, lambda: seen.add("p1"))
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    searches = [time for time, name in f.times(StepOutcome.STARTED) if name == "search_pipeline"]
    assert len(searches) == 2
    assert "(pipeline_found p1) did not become as" in f.executor.plans[1].reason


def test_a_measure_with_a_limit_can_stand_for_a_fact() -> None:
    f = Fixture(sensed=("robot_started",), sensors={"robot_started": Limit("ok recharge", ">=", 0.5)})  # type: ignore[arg-type]
    f.kb.add_measurement("ok recharge", 0.7)
    f.clock.call_at(0.55, lambda: f.kb.add_measurement("ok recharge", 0.2))
    f.executor.run(timeout=0.57)
    assert names(f.executor.plans[0].steps)[0] == "search_pipeline"
    assert f.times(StepOutcome.INTERRUPTED)[0] == (0.55, "search_pipeline")
    assert "it needs (robot_started bluerov) throughout" in f.executor.plans[1].reason


def test_independent_steps_run_at_once_but_no_skill_twice() -> None:
    f = Fixture(targets=3, parallel=True)
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    started = f.times(StepOutcome.STARTED)
    searches = [time for time, name in started if name == "search_pipeline"]
    inspections = [time for time, name in started if name == "inspect_pipeline"]
    assert searches == [0.0, 1.0, 2.0]
    assert inspections == [1.0, 2.0, 3.0]
    assert f.clock.now() == pytest.approx(4.0)


def test_a_function_makes_the_skill_for_the_objects_of_a_step() -> None:
    made: list[tuple[str, ...]] = []

    def search(*objects: str) -> Scripted:
        made.append(objects)
        return Scripted(1)

    f = Fixture(targets=2, skills={"SEARCH-PIPELINE": search, "search_pipeline": search})
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert made == [("search_pipeline", "p1", "bluerov"), ("search_pipeline", "p2", "bluerov")]


def test_actions_may_be_mapped_where_names_differ() -> None:
    kb = knowledge(("look around", "go along", "Recharge"))
    task = parse_task(SUAVE_DOMAIN, suave_problem())
    mapping = {"search_pipeline": "look around", "inspect_pipeline": "go along"}
    bridge = FeasibilityBridge(kb, task, mapping)
    assert bridge.actions(task.operators[1]) == ("look around",)
    assert set(bridge.obstacles()) == set()
    set_feasible(kb, "look around", False)
    assert list(task.facts_in(bridge.feasible())) == [
        "(action_feasible inspect_pipeline)",
        "(action_feasible recharge)",
    ]
    for wrong, words in (
        ({}, "'search_pipeline' is no action of the knowledge base"),
        ({**mapping, "recharge": "refuel"}, "'refuel', which is no action"),
        ({**mapping, "serch": "look around"}, "'serch' is mapped, but is neither"),
    ):
        with pytest.raises(InputError, match=words):
            FeasibilityBridge(kb, task, wrong)


def test_a_domain_that_does_not_ask_for_feasibility_keeps_to_it_all_the_same() -> None:
    domain = """(define (domain d) (:requirements :strips) (:predicates (there))
      (:action walk :parameters () :effect (there)) (:action swim :parameters () :effect (there)))"""
    task = parse_task(domain, "(define (problem p) (:domain d) (:init) (:goal (there)))")
    kb = knowledge(("walk", "swim"))
    set_feasible(kb, "walk", False)
    executor = PlanExecutor(Planner(task), kb, {"walk": Scripted(3), "swim": Scripted(3)})
    kb.clock.call_at(0.15, lambda: (set_feasible(kb, "swim", False), set_feasible(kb, "walk", True)))  # type: ignore[attr-defined]
    assert executor.run(timeout=10.0) is ExecutionStatus.SUCCESS
    assert [names(plan.steps) for plan in executor.plans] == [["swim"], ["walk"]]


def test_what_does_not_fit_together_is_bad_input() -> None:
    f = Fixture()
    with pytest.raises(InputError, match="the action 'recharge' has no skill"):
        PlanExecutor(f.planner, f.kb, {name: Scripted() for name in ("start_robot", *ACTIONS[:2])})
    with pytest.raises(InputError, match="'pipline_found' cannot be sensed"):
        Fixture(sensors={"pipline_found": lambda *_: True})
    with pytest.raises(ValueError, match="period"):
        Fixture(period=0.0)
    with pytest.raises(ValueError, match="negative"):
        ExecutionLimits(patience=-1.0)


def test_what_runs_at_the_end_is_stopped_and_nothing_stays_required() -> None:
    f = Fixture()
    assert f.executor.run(timeout=0.5) is ExecutionStatus.RUNNING
    assert f.skills["search_pipeline"].calls == ["start", "stop"]
    assert f.kb.required_actions() == []
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS  # it may go on later


def test_a_closed_executor_hears_nothing_more() -> None:
    f = Fixture(period=5.0)
    with f.executor:
        pass
    f.at(0.5, "search_pipeline", False)
    f.executor.run(timeout=1.0)
    assert f.executor.steps[-1].time == 1.0


def test_on_the_wall_clock_another_thread_wakes_and_interrupts_it() -> None:
    kb: KnowledgeBase = knowledge(ACTIONS)
    from rosa_core import WallClock

    skills = {name: Scripted(10**6) for name in (*ACTIONS, "start_robot")}
    skills["start_robot"].updates = 1
    executor = PlanExecutor(
        Planner(parse_task(SUAVE_DOMAIN, suave_problem())), kb, skills, clock=WallClock(), period=60.0
    )

    def soon(what: Callable[[], object], delay: float) -> threading.Timer:
        timer = threading.Timer(delay, what)
        timer.start()
        return timer

    timers = [soon(lambda: set_feasible(kb, "search_pipeline", False), 0.1), soon(executor.interrupt, 0.4)]
    assert executor.run(timeout=30.0) is ExecutionStatus.RUNNING
    for timer in timers:
        timer.join()
    assert names(executor.plans[1].steps)[0] == "recharge"


class Broken(Skill):
    """Raises in one of its methods, or says what nobody understands."""

    def __init__(self, where: str) -> None:
        self.where = where

    def _perhaps(self, where: str) -> None:
        if self.where == where:
            raise OSError(f"no propeller to {where}")

    def start(self) -> None:
        self._perhaps("start")

    def update(self) -> SkillStatus:
        self._perhaps("update")
        return SkillStatus.SUCCESS if self.where == "stop" else "done"  # type: ignore[return-value]

    def stop(self) -> None:
        self._perhaps("stop")


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        (Broken("start"), "OSError: no propeller to start"),
        (Broken("update"), "OSError: no propeller to update"),
        (Broken("nothing"), "TypeError: update() must return a SkillStatus, not 'done'"),
        (lambda *_: {}["missing"], "KeyError: 'missing'"),
        (lambda _: Broken("start"), "TypeError:"),
        (lambda *_: None, "TypeError: what makes the skill must return a Skill, not None"),
    ],
)
def test_whatever_a_skill_raises_its_step_has_failed_and_somebody_hears_of_it(source: Any, reason: str) -> None:
    raised: list[tuple[str, Exception]] = []
    f = Fixture(
        skills={"search_pipeline": source},
        limits=ExecutionLimits(attempts=1, patience=1.0),
        on_raise=lambda who, error: raised.append((who.name, error)),
    )
    assert f.executor.run(timeout=100.0) is ExecutionStatus.FAILURE
    (failed,) = [step for step in f.executor.steps if step.outcome is StepOutcome.FAILED]
    assert failed.reason.startswith(f"its skill raised {reason}")
    ((who, error),) = raised
    assert who == "(search_pipeline search_pipeline p1 bluerov)"
    assert f"{type(error).__name__}: {error}".startswith(reason)
    assert f.kb.required_actions() == []


def test_a_skill_that_raises_when_it_is_stopped_has_done_its_work() -> None:
    raised: list[str] = []
    f = Fixture(
        skills={"search_pipeline": Broken("stop")}, on_raise=lambda who, error: raised.append(f"{who.name} {error}")
    )
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert raised == ["(search_pipeline search_pipeline p1 bluerov) no propeller to stop"]


def test_what_a_sensor_that_raises_should_see_is_not_known_and_reported_once_each_time_it_begins_to() -> None:
    raised: list[str] = []
    blind = False

    def found(_pipeline: str) -> bool | None:
        if blind:
            raise OSError("no camera")
        return None

    f = Fixture(
        sensed=("pipeline_found",),
        sensors={"pipeline_found": found},
        on_raise=lambda who, error: raised.append(f"{who.name}: {error}"),
    )

    def set_blind(value: bool) -> None:
        nonlocal blind
        blind = value

    for when, value in ((0.2, True), (0.6, False), (1.1, True)):
        f.clock.call_at(when, lambda v=value: set_blind(v))  # type: ignore[misc]
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    assert raised == ["(pipeline_found p1): no camera"] * 2


def test_an_action_that_is_ended_by_who_hears_of_its_request_has_failed_too() -> None:
    f = Fixture(limits=ExecutionLimits(retry_delay=1.0))

    def veto(event: ActionUpdate) -> None:
        if f.clock.now() < 0.5 and any(action.action == "search_pipeline" for action in event.requested):
            f.kb.cancel_action("search_pipeline")

    f.kb.subscribe(veto, (ActionUpdate,))
    assert f.executor.run(timeout=100.0) is ExecutionStatus.SUCCESS
    ((when, name),) = f.times(StepOutcome.FAILED)
    assert name == "search_pipeline"
    assert when < 0.5
