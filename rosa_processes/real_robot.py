"""A real robot, up: its knowledge base, the adaptation loop over its components, its monitors and its mission."""

from __future__ import annotations

import pkgutil
import sys
import threading
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosa_core import KnowledgeBase, RequestRefusedError, Result, WallClock
from rosa_core.inference.rules import constraint_status
from rosa_core.kb import StatusesChanged
from rosa_core.mape import AdaptationLoop, InThreads, Watch
from rosa_core.model.status import Status
from rosa_core.model.utility import Limit
from rosa_processes.combined_system import CombinedSystem, ObservedSystem
from rosa_processes.declarations import MqttEntry, ProcessEntry, UnitEntry
from rosa_processes.monitor_input import MonitorInput
from rosa_processes.process_system import ProcessSystem
from rosa_processes.robot_file import ActionEntry, PddlEntry, RobotDescription
from rosa_processes.unit_system import BlockingUnits
from task_layer.skill import Skill, SkillStatus, WaitUntil

if TYPE_CHECKING:
    from task_layer.bt import TreeRunner
    from task_layer.pddl import PlanExecutor

LONGEST_END = 60.0
"""How long components have to stop at the end, in s; after that they are killed."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a robot's mission ended: ``success``, ``failure`` or ``interrupted``, and what the mission says to it."""

    mission: str
    feedback: str = ""


class RealRobot:
    """Brings a robot up, and down again when it is closed; a context manager.

    If its journal was written by a manager that died, it goes on with what that knew: how components are is looked at
    anew, units that still run are kept, and what is required the mission says again.

    Args:
        description: what its file says.
        read_stdin: whether diagnostics are read from standard input, if the file says so.

    Raises:
        InputError: if the journal cannot be used.
        OSError: if components cannot be managed here, or monitors have no place to connect to.
    """

    def __init__(self, description: RobotDescription, *, read_stdin: bool = True) -> None:
        self._description = description
        self._interrupted = False
        self._wake = threading.Event()
        self._runner: TreeRunner | PlanExecutor | None = None
        self._end = ExitStack()
        with ExitStack() as stack:
            self.system = self._make_system(stack)
            self.kb = KnowledgeBase(description.model, WallClock(), description.journal, dispatch="threads")
            stack.callback(self.kb.close, LONGEST_END)
            self._take_over()
            self.loop = AdaptationLoop(
                self.kb, self.system, limits=description.limits, watch_period=description.watch_period
            )
            self._start_watch(stack)
            monitors = description.monitors
            self.monitors = MonitorInput(
                self.loop.monitor,
                stdin=sys.stdin.fileno() if monitors.stdin and read_stdin else None,
                socket=None if monitors.socket is None else description.folder / monitors.socket,
                port=monitors.port,
            )
            stack.callback(self.monitors.close)
            self._end = stack.pop_all()

    def run(self, on_tree: Callable[[TreeRunner], None] = lambda _: None) -> Outcome:
        """Perform the mission until it is over or :meth:`interrupt` is called; without one, until that.

        Args:
            on_tree: called with the runner of a behaviour tree before its first tick.

        Raises:
            InputError: if the mission cannot be used.
        """
        mission = self._description.mission
        if mission is None:
            return self._serve()
        with self._plan_executor(mission) if isinstance(mission, PddlEntry) else self._tree_runner(mission) as runner:
            if not isinstance(mission, PddlEntry):
                on_tree(runner)  # type: ignore[arg-type]
            self._runner = runner
            status = runner.run(until=lambda: self._interrupted)
            name = status.name.lower()
            feedback = str(getattr(runner, "feedback", ""))
        return Outcome(name if name in ("success", "failure") else "interrupted", feedback)

    def interrupt(self) -> None:
        """Let :meth:`run` return soon. Any thread, and a signal's handler, may call this."""
        self._interrupted = True
        self._wake.set()
        if self._runner is not None:
            self._runner.interrupt()

    def close(self) -> None:
        """End in order: nothing is required any more, what runs is stopped, and the journal knows it."""
        self._end.close()

    def __enter__(self) -> RealRobot:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # -- up --

    def _make_system(self, stack: ExitStack) -> CombinedSystem:
        managed, folder = self._description.managed, self._description.folder
        processes = {name: entry for name, entry in managed.items() if isinstance(entry, ProcessEntry)}
        units = {name: entry for name, entry in managed.items() if isinstance(entry, UnitEntry)}
        systems: dict[str, ObservedSystem] = {}
        if processes:
            programs = ProcessSystem(processes, folder)
            stack.callback(programs.close)
            systems |= dict.fromkeys(processes, programs)
        if units:
            blocking = BlockingUnits(units, folder)
            stack.callback(blocking.close)
            systems |= dict.fromkeys(units, InThreads(blocking))
        devices = {name: entry for name, entry in managed.items() if isinstance(entry, MqttEntry)}
        if devices:
            from rosa_processes.mqtt_system import MqttSystem

            by_mqtt = MqttSystem(devices, self._description.broker)
            stack.callback(by_mqtt.close)
            systems |= dict.fromkeys(devices, by_mqtt)
        return CombinedSystem(systems)

    def _take_over(self) -> None:
        """Before anybody plans: how components are now, and nothing of what a manager that died was at."""
        kb = self.kb
        with kb.transaction():
            Watch(kb, self.system).adopt()
            if (pending := kb.pending_reconfiguration_plan()) is not None:
                kb.set_reconfiguration_result(pending, Result.ABANDONED)
            for required in kb.required_actions():
                kb.cancel_action(required.action)

    def _start_watch(self, stack: ExitStack) -> None:
        watch = self.loop.watch
        if watch is None:
            raise TypeError("what is managed cannot be observed")
        watch.adopt()
        thread = threading.Thread(target=watch.run, name="rosa watch", daemon=True)
        thread.start()
        stack.callback(thread.join, LONGEST_END)
        stack.callback(watch.stop)

    # -- the mission --

    def _serve(self) -> Outcome:
        """Keep the actions required that are to be, as far as they are feasible."""
        kb, wanted = self.kb, self._description.require
        unsubscribe = kb.subscribe(lambda _: self._wake.set(), (StatusesChanged,))
        try:
            while not self._interrupted:
                self._wake.clear()
                required = {action.action for action in kb.required_actions()}
                for action in wanted:
                    if action not in required:
                        # What is unfeasible now is requested when a status has changed.
                        with suppress(RequestRefusedError):
                            kb.request_action(action)
                if not self._interrupted:
                    self._wake.wait()
        finally:
            unsubscribe()
            with kb.transaction():
                for action in wanted:
                    kb.cancel_action(action)
        return Outcome("interrupted")

    def _tree_runner(self, mission: Path) -> TreeRunner:
        from task_layer.bt import Registry, TreeRunner, load_tree

        registry = Registry()
        for action in self.kb.model.actions:
            registry.add(action.name, self._skill(action.name))
        return TreeRunner(load_tree(mission, registry), self.kb, period=self._description.tick_period)

    def _plan_executor(self, mission: PddlEntry) -> PlanExecutor:
        from task_layer.pddl import PlanExecutor, Planner, load_task

        task = load_task(mission.domain, mission.problem)
        skills = {action.name: self._skill(action.name) for action in self.kb.model.actions}
        planner = Planner(task)
        self._end.callback(planner.close)
        return PlanExecutor(planner, self.kb, skills, period=self._description.tick_period)

    def _skill(self, action: str) -> Any:
        entry = self._description.actions.get(action, ActionEntry())
        if entry.skill is not None:
            return pkgutil.resolve_name(entry.skill)
        if entry.duration is not None:
            return _ForSeconds(self.kb, entry.duration)
        if entry.until is not None:
            return WaitUntil(_reading(self.kb, Limit.parse(entry.until)))
        return WaitUntil(lambda: False)


class _ForSeconds(Skill):
    """Runs for a while."""

    def __init__(self, kb: KnowledgeBase, duration: float) -> None:
        self._clock = kb.clock
        self._duration = duration
        self._until = 0.0

    def start(self) -> None:
        self._until = self._clock.now() + self._duration

    def update(self) -> SkillStatus:
        return SkillStatus.SUCCESS if self._clock.now() >= self._until else SkillStatus.RUNNING


def _reading(kb: KnowledgeBase, limit: Limit) -> Callable[[], bool]:
    def holds() -> bool:
        measurement = kb.measurement(limit.measure)
        value = None if measurement is None else measurement.value
        return constraint_status(limit.operator, limit.value, value) is Status.SATISFIED

    return holds
