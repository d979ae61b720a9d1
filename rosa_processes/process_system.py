"""Components that are programs of this computer, as the adaptation loop manages them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from pathlib import Path

from rosa_core.mape import ComponentState
from rosa_core.model.elements import ParameterValue
from rosa_processes.declarations import ProcessEntry
from rosa_processes.process import ManagedProcess
from rosa_processes.supervisor import Supervisor


class ProcessSystem:
    """Starts and stops programs, each with its process group; a managed system whose calls only begin something.

    That a process has ended the kernel says at once. None of them outlives the manager, however that ends.

    Args:
        entries: how components are programs.
        folder: what paths in them are relative to.

    Raises:
        OSError: on other systems than Linux.
    """

    def __init__(self, entries: Mapping[str, ProcessEntry], folder: Path = Path()) -> None:
        self._supervisor = Supervisor()
        self._listeners: tuple[Callable[[str], None], ...] = ()
        self._lock = threading.Lock()
        self._closed = False
        self._processes = {
            name: ManagedProcess(name, entry, folder, self._supervisor, self._announce)
            for name, entry in entries.items()
        }
        for process in self._processes.values():
            process.prepare()

    def activate(self, component: str) -> None:
        """Begin to start a component.

        Raises:
            FileNotFoundError: if there is no such program.
        """
        self._processes[component].switch(on=True)

    def deactivate(self, component: str) -> None:
        """Begin to stop a component."""
        self._processes[component].switch(on=False)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Future[bool | None]:
        """Let a component run with these parameters; the future says when, or why not."""
        process = self._processes[component]

        def set_parameters() -> bool | None:
            process.set_parameters(parameters)
            return True

        return self._supervisor.call(set_parameters)

    def state(self, component: str) -> ComponentState:
        """What a component does now."""
        return self._processes[component].state()

    def pid(self, component: str) -> int | None:
        """The number of a component's process, while there is one."""
        return self._processes[component].pid

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        """Call a function with the name of every component whose state may have changed, in the supervisor's thread."""
        with self._lock:
            self._listeners = (*self._listeners, on_change)

        def unsubscribe() -> None:
            with self._lock:
                self._listeners = tuple(known for known in self._listeners if known is not on_change)

        return unsubscribe

    def close(self, timeout: float = 10.0) -> None:
        """Stop all in order, and kill what still runs after so many seconds. Closing it again does nothing."""
        if self._closed:
            return
        self._closed = True
        all_ended = threading.Event()

        def look(_: str = "") -> None:
            if all(process.pid is None and not process.is_wanted for process in self._processes.values()):
                all_ended.set()

        unsubscribe = self.subscribe(look)
        for process in self._processes.values():
            process.end()
        look()
        all_ended.wait(timeout)
        unsubscribe()
        self._supervisor.close()

    def __enter__(self) -> ProcessSystem:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _announce(self, component: str) -> None:
        for listener in self._listeners:
            listener(component)
