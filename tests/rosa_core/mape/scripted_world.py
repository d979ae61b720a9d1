"""A managed system on simulated time that is slow, refuses, lies, hangs, dies and comes back, as a test says."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from rosa_core import SimulationClock
from rosa_core.mape import Answer, ComponentState
from rosa_core.model.elements import ParameterValue


@dataclass
class Part:
    """One component: how it is, and how it reacts to what it is asked for."""

    state: ComponentState = ComponentState.INACTIVE
    delay: float = 0.0
    """How long starting and stopping takes, in s."""
    refusals: int = 0
    """How many calls it refuses."""
    lies: bool = False
    """It says no and does it."""
    hangs: bool = False
    """It begins, and that never ends."""
    parameters: dict[str, ParameterValue] = field(default_factory=dict)
    change: int = 0
    since: float = 0.0


class ScriptedWorld:
    """Components by name, all inactive at first."""

    def __init__(self, clock: SimulationClock, *names: str) -> None:
        self.clock = clock
        self.parts = {name: Part() for name in names}
        self.calls: list[tuple[Any, ...]] = []
        self.listeners: list[Callable[[str], None]] = []

    # -- what it is asked for --

    def activate(self, component: str) -> Answer:
        return self._call("activate", component, ComponentState.ACTIVE)

    def deactivate(self, component: str) -> Answer:
        return self._call("deactivate", component, ComponentState.INACTIVE)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Answer:
        part = self.parts[component]
        self.calls.append((self.clock.now(), "set_parameters", component))
        if part.state is ComponentState.ABSENT:
            raise ConnectionError("nobody there")
        if part.refusals:
            part.refusals -= 1
            return False
        part.parameters.update(parameters)
        return None

    def state(self, component: str) -> ComponentState:
        return self.parts[component].state

    # -- what happens to it --

    def die(self, component: str, state: ComponentState = ComponentState.INACTIVE) -> None:
        """It ends without being asked, and loses its parameters."""
        self.parts[component].parameters.clear()
        self._become(component, state)

    def come(self, component: str) -> None:
        """It is there, or there again, with its defaults."""
        self.die(component)

    def start_by_itself(self, component: str) -> None:
        self._become(component, ComponentState.ACTIVE)

    # -- inside --

    def _call(self, name: str, component: str, then: ComponentState) -> Answer:
        part = self.parts[component]
        self.calls.append((self.clock.now(), name, component))
        if part.state is ComponentState.ABSENT:
            raise ConnectionError("nobody there")
        if part.refusals:
            part.refusals -= 1
            return False
        if part.delay or part.hangs:
            self._become(component, ComponentState.UNKNOWN)
            change = part.change
            if not part.hangs:
                self.clock.call_later(part.delay, lambda: part.change == change and self._become(component, then))
        else:
            self._become(component, then)
        return False if part.lies else None

    def _become(self, component: str, state: ComponentState) -> None:
        part = self.parts[component]
        part.change += 1
        part.since = self.clock.now()
        if state is ComponentState.INACTIVE:
            part.parameters.clear() if part.state is ComponentState.ACTIVE else None
        part.state = state
        for listener in self.listeners:
            listener(component)


class AnnouncingWorld(ScriptedWorld):
    """One that says when something has changed."""

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        self.listeners.append(on_change)
        return lambda: self.listeners.remove(on_change)


class AnsweringLater:
    """A managed system that cannot be observed, and whose answers come after ``delay`` seconds."""

    def __init__(self, clock: SimulationClock, delay: float) -> None:
        self.clock = clock
        self.delay = delay
        self.calls: list[tuple[Any, ...]] = []
        self.answer: bool | BaseException | None = None

    def activate(self, component: str) -> Answer:
        return self._later("activate", component)

    def deactivate(self, component: str) -> Answer:
        return self._later("deactivate", component)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Answer:
        return self._later("set_parameters", component)

    def _later(self, name: str, component: str) -> Answer:
        self.calls.append((self.clock.now(), name, component))
        future: Future[bool | None] = Future()
        future.set_running_or_notify_cancel()

        def answer() -> None:
            if isinstance(self.answer, BaseException):
                future.set_exception(self.answer)
            else:
                future.set_result(self.answer)

        self.clock.call_later(self.delay, answer)
        return future
