"""Components that are units of systemd, managed through ``systemctl``."""

from __future__ import annotations

import contextlib
import logging
import os
import selectors
import shutil
import subprocess
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rosa_core.mape import ComponentState
from rosa_core.model.elements import ParameterValue
from rosa_processes.declarations import UnitEntry
from rosa_processes.parameter_files import as_environment, replace_file

logger = logging.getLogger(__name__)

_PATIENCE = 30.0
"""How long ``systemctl`` may take, in s."""
_STATES = {
    "active": ComponentState.ACTIVE,
    "reloading": ComponentState.ACTIVE,
    "inactive": ComponentState.INACTIVE,
    "failed": ComponentState.INACTIVE,
}


@dataclass(frozen=True, slots=True)
class UnitStatus:
    """How a unit is, and its main process, if it has one."""

    state: ComponentState
    main_pid: int | None


def unit_status(properties: Mapping[str, str]) -> UnitStatus:
    """What ``systemctl show`` says of one unit.

    >>> unit_status({"LoadState": "loaded", "ActiveState": "active", "MainPID": "0"})
    UnitStatus(state=<ComponentState.ACTIVE: 'active'>, main_pid=None)
    >>> unit_status({"LoadState": "not-found"}).state
    <ComponentState.ABSENT: 'absent'>
    """
    if properties.get("LoadState") in ("not-found", "masked", "bad-setting", "error"):
        return UnitStatus(ComponentState.ABSENT, None)
    state = _STATES.get(properties.get("ActiveState", ""), ComponentState.UNKNOWN)
    pid = properties.get("MainPID", "0")
    return UnitStatus(state, int(pid) if pid.isdecimal() and pid != "0" else None)


class BlockingUnits:
    """Starts and stops units; its calls come back when systemd has done it. Wrap it in ``InThreads``.

    All units are asked for their state once in a period, and at once when the main process of one has ended, which the
    kernel says.

    Args:
        entries: how components are units.
        folder: what files of parameters are relative to.
        period: how often the units are looked at, in s.
        systemctl: the command; by default the one on the path.

    Raises:
        FileNotFoundError: if there is no ``systemctl``.
    """

    def __init__(
        self,
        entries: Mapping[str, UnitEntry],
        folder: Path = Path(),
        *,
        period: float = 0.5,
        systemctl: Sequence[str] | None = None,
    ) -> None:
        found = shutil.which("systemctl")
        if systemctl is None and found is None:
            raise FileNotFoundError("there is no systemctl: units of systemd cannot be managed here")
        self._systemctl = list(systemctl) if systemctl is not None else [str(found)]
        self._entries = dict(entries)
        self._folder = folder
        self._period = period
        self._parameters: dict[str, dict[str, ParameterValue]] = {}
        self._statuses: dict[str, UnitStatus] = {}
        self._listeners: tuple[Callable[[str], None], ...] = ()
        self._lock = threading.Lock()
        self._refreshing = threading.Lock()
        self._wake_reader, self._wake_writer = os.pipe()
        self._closed = False
        self.refresh()
        self._thread = threading.Thread(target=self._watch, name="rosa units", daemon=True)
        self._thread.start()

    def activate(self, component: str) -> bool:
        """Start a unit, and see that it runs."""
        return self._control("start", component)

    def deactivate(self, component: str) -> bool:
        """Stop a unit."""
        return self._control("stop", component)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool:
        """Write a unit's parameters to its file; if they have changed while it runs, it is restarted or reloaded.

        Raises:
            ValueError: if it takes no parameters, or not these.
            OSError: if the file cannot be written.
        """
        entry = self._entries[component].parameters
        if entry is None:
            raise ValueError(f"'{component}' is not declared to take parameters")
        before = self._parameters.get(component, {})
        changed = {**before, **parameters}
        text = as_environment(changed)
        file = self._folder / entry.file
        is_new = not file.exists() or file.read_text(encoding="utf-8") != text
        replace_file(file, text)
        self._parameters[component] = changed
        if is_new and self.state(component) is ComponentState.ACTIVE:
            return self._control(entry.apply, component)
        return True

    def state(self, component: str) -> ComponentState:
        """What a unit did when it was last looked at."""
        with self._lock:
            return self._statuses[component].state

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        """Call a function with the name of every component whose state has changed."""
        with self._lock:
            self._listeners = (*self._listeners, on_change)

        def unsubscribe() -> None:
            with self._lock:
                self._listeners = tuple(known for known in self._listeners if known is not on_change)

        return unsubscribe

    def refresh(self) -> None:
        """Ask systemd how all units are."""
        with self._refreshing:
            new = {}
            for scope in dict.fromkeys(entry.scope for entry in self._entries.values()):
                new.update(self._show(scope))
            with self._lock:
                changed = [name for name, status in new.items() if self._statuses.get(name) != status]
                self._statuses.update(new)
        for name in changed:
            for listener in self._listeners:
                listener(name)

    def close(self) -> None:
        """Look at them no longer; the units stay as they are, as systemd's business."""
        if not self._closed:
            self._closed = True
            os.write(self._wake_writer, b"x")
            self._thread.join(_PATIENCE)
            os.close(self._wake_reader)
            os.close(self._wake_writer)

    def _control(self, verb: str, component: str) -> bool:
        entry = self._entries[component]
        try:
            result = self._run(entry.scope, verb, entry.unit)
        finally:
            self.refresh()
            # Its main process is another one now, and is to be waited for.
            os.write(self._wake_writer, b"x")
        if result.returncode != 0:
            logger.warning("systemctl %s %s: %s", verb, entry.unit, result.stderr.strip() or result.returncode)
        return result.returncode == 0

    def _run(self, scope: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(  # noqa: S603  # units are named by the robot's owner, and checked to be names
            [*self._systemctl, f"--{scope}", "--no-pager", *arguments],
            capture_output=True,
            text=True,
            timeout=_PATIENCE,
            check=False,
            stdin=subprocess.DEVNULL,
        )

    def _show(self, scope: str) -> dict[str, UnitStatus]:
        names = [name for name, entry in self._entries.items() if entry.scope == scope]
        units = [self._entries[name].unit for name in names]
        unknown = {name: UnitStatus(ComponentState.UNKNOWN, None) for name in names}
        try:
            result = self._run(scope, "show", "--property=LoadState,ActiveState,MainPID", "--", *units)
        except (OSError, subprocess.TimeoutExpired) as error:
            logger.warning("how units are is not known: %s", error)
            return unknown
        blocks = [block for block in result.stdout.split("\n\n") if block.strip()]
        if result.returncode != 0 or len(blocks) != len(names):
            logger.warning("how units are is not known: %s", result.stderr.strip() or "systemctl says nothing of them")
            return unknown
        shown = (dict(line.split("=", 1) for line in block.splitlines() if "=" in line) for block in blocks)
        return {name: unit_status(properties) for name, properties in zip(names, shown, strict=True)}

    def _watch(self) -> None:
        while not self._closed:
            with selectors.DefaultSelector() as selector, contextlib.ExitStack() as opened:
                selector.register(self._wake_reader, selectors.EVENT_READ)
                with self._lock:
                    pids = [status.main_pid for status in self._statuses.values() if status.main_pid is not None]
                for pid in dict.fromkeys(pids):
                    with contextlib.suppress(OSError):
                        fd = os.pidfd_open(pid)
                        opened.callback(os.close, fd)
                        selector.register(fd, selectors.EVENT_READ)
                ready = selector.select(self._period)
            if any(key.fd == self._wake_reader for key, _ in ready):
                os.read(self._wake_reader, 1 << 12)
            if not self._closed:
                self.refresh()
