"""A managed system whose calls block, made one whose calls do not: each component has a thread of its own."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Protocol

from rosa_core.mape.managed_system import Announcing, ComponentState, Observable
from rosa_core.model.elements import ParameterValue


class BlockingSystem(Protocol):
    """A managed system whose calls come back when they are done."""

    def activate(self, component: str) -> bool | None:
        """Start a component."""
        ...

    def deactivate(self, component: str) -> bool | None:
        """Stop a component."""
        ...

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool | None:
        """Let a component run with these parameters."""
        ...


class InThreads:
    """Makes the calls of a blocking system in threads, one for each component, so that none waits for another.

    Its components are ``UNKNOWN`` while a call is under way. Then their state is what the system says, if it can be
    asked, or else what the last call has achieved.

    Args:
        system: what makes the calls.

    Example:
        >>> class Slow:
        ...     def activate(self, component): ...
        ...     def deactivate(self, component): ...
        ...     def set_parameters(self, component, parameters): ...
        >>> system = InThreads(Slow())
        >>> system.activate("camera").result(timeout=10)
        >>> system.state("camera")
        <ComponentState.ACTIVE: 'active'>
    """

    def __init__(self, system: BlockingSystem) -> None:
        self._system = system
        self._observed = system if isinstance(system, Observable) else None
        self._workers: dict[str, _Worker] = {}
        self._states: dict[str, ComponentState] = {}
        self._lock = threading.Lock()
        self._listeners: tuple[Callable[[str], None], ...] = ()

    def activate(self, component: str) -> Future[bool | None]:
        """Start a component, later."""
        return self._call(component, lambda: self._system.activate(component), ComponentState.ACTIVE)

    def deactivate(self, component: str) -> Future[bool | None]:
        """Stop a component, later."""
        return self._call(component, lambda: self._system.deactivate(component), ComponentState.INACTIVE)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Future[bool | None]:
        """Let a component run with these parameters, later."""
        return self._call(component, lambda: self._system.set_parameters(component, parameters), None)

    def state(self, component: str) -> ComponentState:
        """What a component does now, as far as is known."""
        with self._lock:
            worker = self._workers.get(component)
            if worker is not None and worker.calls_open:
                return ComponentState.UNKNOWN
            known = self._states.get(component, ComponentState.INACTIVE)
        return known if self._observed is None else self._observed.state(component)

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        """Call a function with the name of a component when a call is over, and when the system announces a change."""
        with self._lock:
            self._listeners = (*self._listeners, on_change)
        end = self._system.subscribe(on_change) if isinstance(self._system, Announcing) else None

        def unsubscribe() -> None:
            if end is not None:
                end()
            with self._lock:
                self._listeners = tuple(known for known in self._listeners if known is not on_change)

        return unsubscribe

    def _call(
        self, component: str, call: Callable[[], bool | None], then: ComponentState | None
    ) -> Future[bool | None]:
        answer: Future[bool | None] = Future()

        def work() -> None:
            result, error = None, None
            if answer.set_running_or_notify_cancel():
                try:
                    result = call()
                except BaseException as raised:
                    error = raised
            with self._lock:
                worker.calls_open -= 1
                if error is None and result is not False and not answer.cancelled() and then is not None:
                    self._states[component] = then
            if error is not None:
                answer.set_exception(error)
            elif not answer.cancelled():
                answer.set_result(result)
            for listener in self._listeners:
                listener(component)

        with self._lock:
            worker = self._workers.get(component) or self._workers.setdefault(component, _Worker(component))
            worker.calls_open += 1
        worker.calls.put(work)
        return answer


class _Worker:
    """A thread that makes the calls of one component in order; a daemon, since a call may never come back."""

    def __init__(self, component: str) -> None:
        self.calls: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self.calls_open = 0
        threading.Thread(target=self._run, name=f"rosa component {component}", daemon=True).start()

    def _run(self) -> None:
        while True:
            self.calls.get()()
