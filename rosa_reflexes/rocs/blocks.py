"""The blocks Monitor, Analyze, Plan and Execute (RoCS paper, figures 2 and 3).

A Monitor can be attached to an Analyze only, an Analyze to a Plan only: the types say so, and so does ``attach``.
"""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Generic, NoReturn, TypeVar, final

from rosa_reflexes.rocs.actions import Activity, is_running
from rosa_reflexes.rocs.pipeline import Pipeline, Queued
from rosa_reflexes.rocs.touchpoints import Sensor

T = TypeVar("T")
C = TypeVar("C")
V = TypeVar("V")
T_contra = TypeVar("T_contra", contravariant=True)


class TopologyError(TypeError):
    """Blocks that cannot be connected so, or a robot that is not complete; it names the block."""


class _Inbox(Generic[V]):
    """The latest value from each publisher."""

    def __init__(self) -> None:
        self.on_delivery: Callable[[], None] = lambda: None
        self._values: dict[str, V] = {}
        self._lock = threading.Lock()

    def deliver(self, publisher: str, value: V) -> None:
        with self._lock:
            self._values[publisher] = value
        self.on_delivery()

    def values(self) -> dict[str, V]:
        with self._lock:
            return dict(self._values)


class Monitor(ABC, Generic[T]):
    """Reads sensors and makes final values of what they say; the framework publishes them.

    Args:
        name: unique in its robot.
        sensors: what it reads.
        period: every how many seconds.
    """

    def __init__(self, name: str, sensors: Iterable[Sensor[Any]], *, period: float) -> None:
        self.name, self.sensors, self.period = name, tuple(sensors), period
        self.analyzes: list[Analyze[T, Any]] = []

    @abstractmethod
    def interpret(self) -> T:
        """Read the sensors and interpret what they say."""

    def attach(self, analyze: Analyze[T, Any]) -> None:
        """Publish to this block from now on.

        Raises:
            TopologyError: if it is no Analyze.
        """
        if not isinstance(analyze, Analyze):
            what = f"the Monitor '{self.name}' publishes to an Analyze, not to {_described(analyze)}"
            raise TopologyError(what)
        self.analyzes.append(analyze)

    @final
    def publish(self) -> None:
        """Interpret, and publish the value."""
        value = self.interpret()
        for analyze in self.analyzes:
            analyze.inbox.deliver(self.name, value)


class Analyze(ABC, Generic[T_contra, C]):
    """Finds out from what monitors publish whether the world has changed; the framework publishes the change.

    Args:
        name: unique in its robot.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.inbox: _Inbox[T_contra] = _Inbox()
        self.plans: list[Plan[C]] = []
        self._published: tuple[C] | None = None

    @abstractmethod
    def process(self, values: Mapping[str, T_contra]) -> C | None:
        """What the world is like.

        Args:
            values: the latest value of each monitor that has published.

        Returns:
            what the plan is to know; None, or the same as last time: nothing has changed.
        """

    def attach(self, plan: Plan[C]) -> None:
        """Publish to the plan from now on.

        Raises:
            TopologyError: if it is no Plan.
        """
        if not isinstance(plan, Plan):
            what = f"the Analyze '{self.name}' publishes to the Plan, not to {_described(plan)}"
            raise TopologyError(what)
        self.plans.append(plan)

    @final
    def publish(self) -> None:
        """Process what has come in, and publish it if the world has changed."""
        change = self.process(self.inbox.values())
        if change is None or (self._published is not None and self._published[0] == change):
            return
        self._published = (change,)
        for plan in self.plans:
            plan.inbox.deliver(self.name, change)


class Plan(ABC, Generic[C]):
    """Decides what is to be done; there is one in a robot.

    Args:
        name: unique in its robot.
        period: every how many seconds it runs while nothing changes and nothing is to be done.
        priority: of its actions.
    """

    def __init__(self, name: str = "plan", *, period: float = 0.05, priority: float = 0.0) -> None:
        self.name, self.period, self.priority = name, period, priority
        self.inbox: _Inbox[C] = _Inbox()

    @abstractmethod
    def run(self, changes: Mapping[str, C]) -> Iterable[Activity]:
        """The actions that are to be carried out next, in order.

        Args:
            changes: the latest that each Analyze has published.
        """

    @final
    def decide(self, pipeline: Pipeline) -> None:
        """Run, and pass on what was decided on, unless a reactive action came in between."""
        epoch = pipeline.epoch
        for activity in self.run(self.inbox.values()):
            pipeline.put(Queued(activity, self.priority, self.name), epoch)


@final
class Execute:
    """Carries out what is in the pipeline; a more urgent action interrupts the one that runs.

    Args:
        pipeline: what is to be carried out.
        period: every how many seconds an action that runs is updated.
        on_action: hears of every action that begins.
    """

    def __init__(
        self, pipeline: Pipeline, *, period: float = 0.02, on_action: Callable[[Queued], None] | None = None
    ) -> None:
        self.pipeline, self.period = pipeline, period
        self.current: Queued | None = None
        self.on_action = on_action
        self._lock = threading.RLock()

    def __init_subclass__(cls, **_: Any) -> NoReturn:
        raise TopologyError("Execute is concrete: write actions, not another Execute")

    @property
    def idle(self) -> bool:
        """Whether there is nothing to do."""
        return self.current is None and not len(self.pipeline)

    def is_busy_for(self, source: str) -> bool:
        """Whether it carries out an action of this block."""
        return self.current is not None and self.current.source == source

    def step(self) -> None:
        """Carry on; several actions that are over at once are carried out in one step."""
        with self._lock:
            while self._take_turn():
                pass

    def _take_turn(self) -> bool:
        """Begin or update one action; True if it is over and another may follow."""
        urgent = self.pipeline.next(None if self.current is None else self.current.priority)
        if urgent is not None:
            self._end()
            self.current = urgent
            if self.on_action is not None:
                self.on_action(urgent)
            urgent.activity.start()
        if self.current is None or is_running(self.current.activity.update()):
            return False
        self._end()
        return len(self.pipeline) > 0

    def _end(self) -> None:
        current, self.current = self.current, None
        if current is not None:
            current.activity.stop()


def _described(block: object) -> str:
    return f"the {type(block).__name__} '{getattr(block, 'name', block)}'"
