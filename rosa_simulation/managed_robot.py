"""ROSA as the managing system of a simulated robot."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from rosa_core import Clock, KnowledgeBase, KnowledgeModel
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event
from rosa_core.mape import AdaptationLoop, ManagedSystem
from rosa_core.mape.diagnostics import DiagnosticArray


class MonitoredRobot(ManagedSystem, Protocol):
    """A managed system that has monitors."""

    @property
    def clock(self) -> Clock:
        """The robot's time."""
        ...

    @property
    def on_diagnostics(self) -> list[Callable[[DiagnosticArray], None]]:
        """Called with what the monitors publish."""
        ...


def knowledge_base_for(
    robot: MonitoredRobot, model: KnowledgeModel, *, stopwatch: Stopwatch, on_event: Callable[[Event], None]
) -> KnowledgeBase:
    """A knowledge base that is informed by the robot's monitors and, with the adaptation loop, configures it.

    An error in a subscriber to its events ends the run: in an experiment none must be passed over.

    Args:
        robot: what is managed.
        model: its knowledge model.
        stopwatch: runs while the loop works.
        on_event: called with every event, after the loop.
    """
    kb = KnowledgeBase(model, clock=robot.clock, on_subscriber_error=_raise)
    loop = AdaptationLoop(kb, robot)
    kb.subscribe(on_event)

    def monitor(diagnostics: DiagnosticArray) -> None:
        with stopwatch.running():
            loop.monitor.update(diagnostics)

    robot.on_diagnostics.append(monitor)
    return kb


def _raise(error: BaseException, _subscriber: object, _event: Event) -> None:
    raise error
