"""The RoCS blocks: topology, order, both routes at once, and the same program under each runner."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.model.elements import Action as KnowledgeAction
from rosa_core.model.elements import Measure
from rosa_reflexes import CommandGate, Reflex, SensorLimits
from rosa_reflexes.rocs import (
    Action,
    ActionStatus,
    Activity,
    Actuator,
    Analyze,
    EventRunner,
    Execute,
    GateActuator,
    Knowledge,
    KnowledgeBaseAnalyze,
    MacroAction,
    MissionPlan,
    Monitor,
    Pipeline,
    Plan,
    PublishedLoop,
    PublishedPipeline,
    Queued,
    ReactiveModel,
    Robot,
    RobotModel,
    Sensor,
    ThreadRunner,
    TopologyError,
    WorldModel,
    build_robot,
    decomposition,
)
from task_layer.skill import Skill, SkillStatus


class Range(Sensor[float]):
    """A range in m that a test sets."""

    def __init__(self, name: str = "front", value: float = 5.0) -> None:
        super().__init__(name)
        self.value = value

    def get_data(self) -> float:
        return self.value


class Wheel(Actuator[float]):
    def __init__(self, name: str = "wheel") -> None:
        super().__init__(name)
        self.commands: list[float] = []
        self.on_command: Callable[[float], None] = lambda _: None

    def actuate(self, command: float) -> None:
        self.commands.append(command)
        self.on_command(command)


class Drive(Action):
    """Sets the wheel; goes on for so many updates."""

    def __init__(self, wheel: Wheel, speed: float, updates: int = 1) -> None:
        self._wheel, self._speed, self._left = wheel, speed, updates

    def start(self) -> None:
        self._wheel.actuate(self._speed)

    def act(self) -> ActionStatus:
        self._left -= 1
        return ActionStatus.RUNNING if self._left > 0 else ActionStatus.SUCCESS


class Nearest(Monitor[float]):
    def interpret(self) -> float:
        return min(float(sensor.get_data()) for sensor in self.sensors)


class Free(Analyze[float, bool]):
    """Whether there is room everywhere."""

    def __init__(self, name: str = "free") -> None:
        super().__init__(name)
        self.processed = 0

    def process(self, values: Mapping[str, float]) -> bool | None:
        self.processed += 1
        return min(values.values()) > 1.0 if values else None


class GoOn(Plan[bool]):
    def __init__(self, decide: Callable[[], Activity], priority: float = 0.0) -> None:
        super().__init__(priority=priority)
        self.changes: list[Mapping[str, bool]] = []
        self._decide = decide

    def run(self, changes: Mapping[str, bool]) -> Iterable[Activity]:
        self.changes.append(changes)
        return [self._decide()]


class KeepClear(ReactiveModel):
    """Commands 0 when a range is below its limit, for some updates."""

    def __init__(self, sensor: Sensor[float], wheel: Wheel, limit: float, **more: Any) -> None:
        super().__init__(
            **{"name": f"keep clear {sensor.name}", "period": 0.05, "priority": 15.0, **more}, sensors=[sensor]
        )
        self._sensor, self._wheel, self._limit = sensor, wheel, limit

    def run(self) -> Activity | None:
        return Drive(self._wheel, 0.0, updates=5) if self._sensor.get_data() < self._limit else None


class Program:
    """A robot with two ranges, one wheel, both routes."""

    def __init__(self, updates: int = 1_000, priority: float = 0.0) -> None:
        self.front, self.down, self.wheel = Range(), Range("down"), Wheel()
        self.monitor = Nearest("ranges", [self.front, self.down], period=0.02)
        self.analyze = Free()
        self.plan = GoOn(lambda: Drive(self.wheel, 1.0, updates), priority=priority)
        self.monitor.attach(self.analyze)
        self.analyze.attach(self.plan)
        self.actions: list[Queued] = []
        execute = Execute(Pipeline(), on_action=self.actions.append)
        reactive = (KeepClear(self.front, self.wheel, 0.5), KeepClear(self.down, self.wheel, 0.3))
        knowledge = Knowledge(RobotModel([self.front, self.down], [self.wheel]), reactive=reactive)
        self.robot = build_robot("robot", knowledge, execute, monitors=[self.monitor], plan=self.plan)


# -- topology --


def test_a_robot_that_is_not_complete_is_refused_and_the_block_is_named() -> None:
    front, other = Range(), Range("other")
    lonely, analyze, plan = Nearest("lonely", [front], period=1.0), Free(), GoOn(lambda: Drive(Wheel(), 0.0))
    attached = Nearest("attached", [other], period=1.0)
    attached.attach(analyze)
    knowledge = Knowledge(RobotModel([front], []), reactive=(KeepClear(front, Wheel(), 1.0, priority=-1.0),))
    with pytest.raises(TopologyError) as error:
        build_robot("r", knowledge, Execute(Pipeline()), monitors=[lonely, attached], plan=plan)
    for said in (
        "it has no Actuator",
        "the Monitor 'lonely' is attached to no Analyze",
        "the Monitor 'attached' reads the Sensor 'other', which the RobotModel does not have",
        "the Analyze 'free' is not attached to the robot's Plan",
        "the ReactiveModel 'keep clear front' is not more urgent than the Plan",
    ):
        assert said in str(error.value)
    with pytest.raises(TopologyError, match="neither a Plan nor a ReactiveModel"):
        build_robot("r", Knowledge(RobotModel([front], [Wheel()])), Execute(Pipeline()))
    with pytest.raises(TopologyError, match="no Analyze is attached to the Plan 'plan'"):
        build_robot("r", Knowledge(RobotModel([front], [Wheel()])), Execute(Pipeline()), plan=plan)
    with pytest.raises(TopologyError, match="the name 'front' stands twice"):
        build_robot("r", Knowledge(RobotModel([front, Range()], [Wheel()])), Execute(Pipeline()), plan=plan)


def test_blocks_connect_only_to_the_next_one() -> None:
    monitor, analyze, plan = Nearest("m", [Range()], period=1.0), Free(), GoOn(lambda: Drive(Wheel(), 0.0))
    wrong: Any = plan
    with pytest.raises(TopologyError, match="the Monitor 'm' publishes to an Analyze, not to the GoOn 'plan'"):
        monitor.attach(wrong)
    wrong = analyze
    with pytest.raises(TopologyError, match="the Analyze 'free' publishes to the Plan, not to the Free 'free'"):
        analyze.attach(wrong)
    with pytest.raises(TopologyError, match="Execute is concrete"):
        type("Mine", (Execute,), {})


@pytest.mark.slow
def test_the_types_refuse_what_attach_refuses(tmp_path: Path) -> None:
    code = """
from rosa_reflexes.rocs import Analyze, Monitor, Plan
def wire(m: Monitor[float], a: Analyze[float, str], b: Analyze[str, str], p: Plan[str], q: Plan[int]) -> None:
    m.attach(a)
    a.attach(p)
    m.attach(p)
    m.attach(b)
    a.attach(a)
    a.attach(q)
"""
    file = tmp_path / "wiring.py"
    file.write_text(code, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", str(file)]
    said = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False).stdout
    assert [line.split(":")[1] for line in said.splitlines() if "error" in line] == ["6", "7", "8", "9"]


def test_what_is_left_out_of_a_block_fails_when_it_is_built() -> None:
    for block in (Sensor, Actuator, Action, MacroAction, Monitor, Analyze, Plan, ReactiveModel):
        incomplete: Any = type("Incomplete", (block,), {})
        with pytest.raises(TypeError, match="abstract"):
            incomplete()


# -- routes --


def test_a_change_travels_through_all_blocks_in_the_call_that_publishes_it() -> None:
    program, clock = Program(), SimulationClock()
    EventRunner(program.robot, clock).start()
    clock.advance_to(0.0)
    assert program.wheel.commands == [1.0]
    assert {"free": True} in program.plan.changes


def test_an_analyze_is_silent_when_nothing_has_changed() -> None:
    program, clock = Program(), SimulationClock()
    heard: list[None] = []
    EventRunner(program.robot, clock).start()
    program.plan.inbox.on_delivery = lambda: heard.append(None)
    clock.advance_to(1.0)
    program.front.value = 0.9
    clock.advance_to(2.0)
    assert (program.analyze.processed, len(heard)) == (101, 2)


def test_one_analyze_listens_to_several_monitors() -> None:
    near, far, analyze = Nearest("near", [Range(value=0.5)], period=1.0), Nearest("far", [Range()], period=1.0), Free()
    near.attach(analyze)
    far.attach(analyze)
    far.publish()
    near.publish()
    assert analyze.inbox.values() == {"near": 0.5, "far": 5.0}


def test_a_reactive_action_interrupts_what_runs_clears_what_waits_and_then_the_plan_goes_on() -> None:
    program, clock = Program(), SimulationClock()
    EventRunner(program.robot, clock).start()
    clock.advance_to(0.5)
    program.front.value, program.down.value = 0.4, 0.2
    clock.advance_to(0.53)
    assert program.wheel.commands == [1.0, 0.0]
    program.front.value = program.down.value = 5.0
    clock.advance_to(1.0)
    assert [action.source for action in program.actions] == [
        "plan",
        "keep clear front",
        "keep clear down",
        "plan",
    ]


def test_what_was_decided_on_before_a_reactive_action_never_runs() -> None:
    wheel, pipeline = Wheel(), Pipeline()
    execute = Execute(pipeline)

    class Late(Plan[bool]):
        def run(self, _changes: Mapping[str, bool]) -> Iterable[Activity]:
            pipeline.preempt(Queued(Drive(wheel, 0.0), 15.0, "reflex"))
            return [Drive(wheel, 1.0)]

    Late().decide(pipeline)
    execute.step()
    assert (wheel.commands, pipeline.refused) == ([0.0], 1)


@given(st.lists(st.integers(0, 3), max_size=12))
def test_higher_priorities_first_and_in_order_among_equals(priorities: list[int]) -> None:
    pipeline, wheel = Pipeline(), Wheel()
    for number, priority in enumerate(priorities):
        pipeline.put(Queued(Drive(wheel, number), priority, str(number)), 0)
    taken = [queued.source for queued in iter(pipeline.next, None)]
    expected = sorted(enumerate(priorities), key=lambda pair: -pair[1])
    assert taken == [str(number) for number, _ in expected]


class Square(MacroAction):
    def __init__(self, wheel: Wheel) -> None:
        super().__init__()
        self._wheel = wheel

    def decompose(self) -> Sequence[Activity]:
        return [Drive(self._wheel, 1.0, 3), Drive(self._wheel, 2.0), Drive(self._wheel, 3.0)]


def test_a_macro_action_carries_out_its_atoms_in_order() -> None:
    wheel, pipeline = Wheel(), Pipeline()
    execute = Execute(pipeline)
    pipeline.put(Queued(Square(wheel), 0.0, "plan"), 0)
    seen = []
    for _ in range(3):
        execute.step()
        seen.append(list(wheel.commands))
    assert seen == [[1.0], [1.0], [1.0, 2.0, 3.0]]
    assert execute.idle
    assert decomposition(Square(wheel)) == "Drive; Drive; Drive"


def test_a_skill_of_the_task_layer_is_an_activity() -> None:
    class Count(Skill):
        left, stopped = 2, False

        def update(self) -> SkillStatus:
            self.left -= 1
            return SkillStatus.RUNNING if self.left else SkillStatus.SUCCESS

        def stop(self) -> None:
            self.stopped = True

    skill, pipeline = Count(), Pipeline()
    activity: Activity = skill
    pipeline.put(Queued(activity, 0.0, "plan"), 0)
    execute = Execute(pipeline)
    execute.step()
    assert not skill.stopped
    execute.step()
    assert skill.stopped


@given(st.permutations(range(6)), st.permutations(range(6)))
def test_robots_that_exchange_facts_agree(one: list[int], other: list[int]) -> None:
    said = [
        ("a", "x", 1, 0.0),
        ("b", "x", 2, 0.0),
        ("a", "x", 3, 1.0),
        ("b", "y", 4, 2.0),
        ("a", "y", 5, 1.0),
        ("b", "x", 6, 0.5),
    ]
    facts = []
    for source, name, value, time in said:
        world = WorldModel(source)
        world.set(name, value, time)
        facts.append(world.facts())
    left, right = WorldModel("left"), WorldModel("right")
    for number in one:
        left.merge(facts[number])
    for number in other:
        right.merge(facts[number])
    assert left.facts() == right.facts()
    assert (left.get("x"), left.get("y"), left.get("z", 0)) == (3, 4, 0)


# -- runners --


def test_the_same_program_runs_in_threads() -> None:
    program, stopped, errors = Program(), threading.Event(), list[tuple[str, Exception]]()
    moving = threading.Event()
    program.wheel.on_command = lambda speed: (moving if speed else stopped).set()
    with ThreadRunner(program.robot, lambda *error: errors.append(error)):
        assert moving.wait(30.0)
        program.front.value = 0.1
        assert stopped.wait(30.0)
    assert errors == []


def test_a_block_that_raises_in_its_thread_stops_the_robot_and_is_named() -> None:
    program, heard = Program(), threading.Event()
    named: list[str] = []

    def broken() -> float:
        raise OSError("no driver")

    def on_error(name: str, _: Exception) -> None:
        named.append(name)
        heard.set()

    program.down.get_data = broken  # type: ignore[method-assign]
    with ThreadRunner(program.robot, on_error) as runner:
        assert heard.wait(30.0)
    assert set(named) <= {"ranges", "keep clear down"}
    assert all(isinstance(error, OSError) for _, error in runner.errors)


def reaction(make: Callable[[Program, SimulationClock], EventRunner | PublishedLoop], updates: int) -> float:
    """From the time at which something is near to that at which the wheel stops, s."""
    program, clock = Program(updates=updates), SimulationClock()
    times: list[float] = []
    program.wheel.on_command = lambda speed: times.append(clock.now()) if speed == 0.0 else None
    make(program, clock).start()
    clock.advance_to(1.0001)
    program.front.value = 0.1
    clock.advance_to(20.0)
    return times[0] - 1.0001


def test_in_the_published_loop_a_reactive_action_waits_for_the_action_that_runs() -> None:
    def published(program: Program, clock: SimulationClock) -> PublishedLoop:
        return PublishedLoop(program.robot, clock)

    def events(program: Program, clock: SimulationClock) -> EventRunner:
        return EventRunner(program.robot, clock)

    assert reaction(events, 100) <= 0.02
    assert reaction(published, 1) <= 0.15
    assert reaction(published, 100) > 2.0


def test_the_smallest_schedule_in_which_the_plan_evicts_a_reflex() -> None:
    """Two pushes: found by trying all schedules of up to three steps, shortest first."""
    wheel = Wheel()
    reflex, plan = Queued(Drive(wheel, 0.0), 15.0, "reflex"), Queued(Drive(wheel, 1.0), 20.0, "plan")

    def loses_the_reflex(schedule: tuple[str, ...]) -> bool:
        pipeline = PublishedPipeline()
        for step in schedule:
            if step == "look":
                pipeline.next()
            else:
                pipeline.push(reflex if step == "reflex" else plan)
        return (reflex, plan) in pipeline.evicted

    steps = ("reflex", "plan", "look")
    found = [one for length in range(1, 4) for one in product(steps, repeat=length) if loses_the_reflex(one)]
    assert found[0] == ("reflex", "plan")

    fair = Pipeline()
    fair.preempt(Queued(Drive(wheel, 0.0), 25.0, "reflex"))
    fair.put(plan, fair.epoch)
    ours = [queued.source for queued in iter(fair.next, None)]
    assert ours == ["reflex", "plan"]


# -- what the framework has already --


def test_the_knowledge_base_a_mission_and_the_gate_are_blocks() -> None:
    kb = KnowledgeBase(KnowledgeModel(measures=(Measure("nearest"),), actions=(KnowledgeAction("go"),)))
    front, woken, sent, clock = Range(), list[None](), list[Any](), SimulationClock()

    class Measuring(Monitor[Mapping[str, float]]):
        def interpret(self) -> Mapping[str, float]:
            return {"nearest": front.get_data()}

    monitor, analyze = Measuring("ranges", [front], period=0.1), KnowledgeBaseAnalyze("kb", kb)
    plan = MissionPlan(lambda: woken.append(None))
    monitor.attach(analyze)
    analyze.attach(plan)
    reflex = Reflex("stop", ("front",), lambda readings: readings["front"] < 0.5, {"v": 0.0})
    gate = CommandGate(sent.append, clock, [SensorLimits("front")], [reflex], safe_command={"v": 0.0})
    wheels = GateActuator("wheels", gate)
    knowledge = Knowledge(RobotModel([front], [wheels]))
    robot: Robot = build_robot("r", knowledge, Execute(Pipeline()), monitors=[monitor], plan=plan)
    EventRunner(robot, clock).start()
    clock.advance_to(0.05)
    measured = kb.measurement("nearest")
    assert measured is not None
    assert measured.value == 5.0
    assert woken
    wheels.actuate({"v": 1.0})
    gate.sense({"front": 0.1})
    wheels.actuate({"v": 1.0})
    assert sent == [{"v": 1.0}, {"v": 0.0}]
