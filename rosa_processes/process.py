"""One component that is a program: started, heard, given parameters, and stopped as its declaration says."""

from __future__ import annotations

import contextlib
import logging
import os
import shutil
import signal
import subprocess
import threading
from asyncio import TimerHandle
from collections import deque
from collections.abc import Callable, Mapping
from enum import Enum
from pathlib import Path
from typing import IO

from rosa_core.mape import ComponentState
from rosa_core.model.elements import ParameterValue
from rosa_processes.declarations import ProcessEntry, signal_number
from rosa_processes.parameter_files import as_json_line, as_text, replace_file
from rosa_processes.readiness import LOOK_EVERY, Readiness, readiness
from rosa_processes.supervisor import Supervisor

logger = logging.getLogger(__name__)

_KEPT_LINES = 20
_LONGEST_LINE = 10_000
_STANDBY_AGAIN = 1.0
"""How long after its end a process on standby is started again, in s."""


class _Phase(Enum):
    ENDED = "ended"
    STARTING = "starting"
    RUNNING = "running"
    STOPPING = "stopping"


class ManagedProcess:
    """A program and how it is at present. Its thread is the supervisor's; ``switch`` and ``state`` are for any.

    Args:
        name: the component's.
        entry: how it is declared.
        folder: what the declaration's paths are relative to.
        supervisor: who starts it.
        on_change: called with the name when its state may have changed.
    """

    def __init__(
        self,
        name: str,
        entry: ProcessEntry,
        folder: Path,
        supervisor: Supervisor,
        on_change: Callable[[str], None],
    ) -> None:
        self.name = name
        self.parameters: dict[str, ParameterValue] = {}
        self._entry = entry
        self._base = folder
        self._folder = (folder / entry.folder).resolve()
        self._environment = {**os.environ, **entry.env}
        self._supervisor = supervisor
        self._on_change = on_change
        self._lock = threading.Lock()
        self._wanted = False
        """Whether the process is to run."""
        self._on = False
        """Whether the component is to be active; a process on standby runs also when it is not."""
        self._announced = False
        """Whether a process on standby has the order to be active."""
        self._again = False
        self._phase = _Phase.ENDED
        self._process: subprocess.Popen[bytes] | None = None
        self._readiness: Readiness | None = None
        self._timer: TimerHandle | None = None
        self._log: IO[bytes] | None = None
        self._partial_line = b""
        self._output: deque[str] = deque(maxlen=_KEPT_LINES)

    @property
    def pid(self) -> int | None:
        """The number of the process, while there is one."""
        process = self._process
        return None if process is None else process.pid

    @property
    def is_wanted(self) -> bool:
        """Whether the process is to run."""
        return self._wanted

    def state(self) -> ComponentState:
        """What it does now."""
        with self._lock:
            is_running = self._wanted and self._phase is _Phase.RUNNING and not self._again
            if self._entry.standby and not self._on and not self._announced:
                return ComponentState.INACTIVE
            if is_running and (not self._entry.standby or (self._on and self._announced)):
                return ComponentState.ACTIVE
            if not self._wanted and self._phase is _Phase.ENDED:
                return ComponentState.INACTIVE
            return ComponentState.UNKNOWN

    def switch(self, *, on: bool) -> None:
        """Begin to start it, or to stop it; one on standby only gets a message.

        Raises:
            FileNotFoundError: if there is no such program.
        """
        if on:
            self._program()
        with self._lock:
            self._on = on
            self._wanted = on or self._entry.standby
        self._supervisor.call(self._say_active if self._entry.standby else self._follow)

    def prepare(self) -> None:
        """Start it if it is to stand by."""
        if self._entry.standby:
            with self._lock:
                self._wanted = True
            self._supervisor.call(self._follow)

    def end(self) -> None:
        """Begin to stop it for good."""
        with self._lock:
            self._on = self._wanted = False
        self._supervisor.call(self._follow)

    # -- in the supervisor's thread --

    def set_parameters(self, parameters: Mapping[str, ParameterValue]) -> None:
        """Let it run with these from now on.

        Raises:
            ValueError: if it takes no parameters.
            OSError: if it does not take them.
        """
        entry = self._entry.parameters
        if entry is None:
            raise ValueError(f"'{self.name}' is not declared to take parameters")
        changed = {**self.parameters, **parameters}
        is_new = changed != self.parameters
        self.parameters = changed
        if entry.file is not None:
            replace_file(self._base / entry.file, as_json_line(changed))
        if self._phase is _Phase.ENDED:
            return
        if entry.stdin is not None:
            self._write_parameters()
        elif entry.signal is not None:
            self._signal(signal_number(entry.signal))
        elif entry.argument is not None and is_new:
            with self._lock:
                self._again = True
            self._follow()

    def _follow(self) -> None:
        """Bring it nearer to how it is wanted."""
        with self._lock:
            wanted = self._wanted and not self._again
        if wanted and self._phase is _Phase.ENDED:
            self._start()
        elif not wanted and self._phase in (_Phase.STARTING, _Phase.RUNNING):
            self._stop()
        else:
            self._on_change(self.name)

    def _start(self) -> None:
        entry, loop = self._entry, self._supervisor.loop
        self._output.clear()
        try:
            self._readiness = readiness(entry.ready, self._base, self._start_probe)
            if entry.log is not None:
                self._log = (self._base / entry.log).open("ab", buffering=0)
            takes_stdin = entry.standby or (entry.parameters is not None and entry.parameters.stdin is not None)
            self._process = self._supervisor.start(
                [self._program(), *entry.command[1:], *self._arguments()],
                environment=self._environment,
                folder=str(self._folder),
                stdin=subprocess.PIPE if takes_stdin else subprocess.DEVNULL,
                stdout=subprocess.PIPE,
            )
        except OSError as error:
            logger.error("'%s' cannot be started: %s", self.name, error)
            self._change(_Phase.ENDED, wanted=False)
            return
        self._change(_Phase.STARTING)
        if self._process.stdout is not None:
            os.set_blocking(self._process.stdout.fileno(), False)
            loop.add_reader(self._process.stdout.fileno(), self._read_output)
        self._supervisor.when_ended(self._process, self._ended)
        if self._process.stdin is not None:
            os.set_blocking(self._process.stdin.fileno(), False)
        if entry.parameters is not None and entry.parameters.stdin is not None:
            with contextlib.suppress(OSError):  # it has ended already, which is seen elsewhere
                self._write_parameters()
        self._look()

    def _look(self) -> None:
        """See whether it is ready by now; else look again soon."""
        self._cancel_timer()
        if self._phase is not _Phase.STARTING or self._readiness is None:
            return
        try:
            is_ready = self._readiness.is_ready()
        except OSError as error:
            logger.warning("whether '%s' is ready cannot be seen: %s", self.name, error)
            is_ready = False
        if is_ready:
            self._readiness.close()
            self._change(_Phase.RUNNING)
            if self._entry.standby and self._on:
                self._say_active()
        else:
            self._timer = self._supervisor.loop.call_later(LOOK_EVERY, self._look)

    def _stop(self) -> None:
        self._cancel_timer()
        self._change(_Phase.STOPPING, announce=False)
        self._signal(signal_number(self._entry.stop.signal))
        self._timer = self._supervisor.loop.call_later(self._entry.stop.within, self._signal, signal.SIGKILL)

    def _ended(self) -> None:
        process = self._process
        if process is None:
            return
        self._cancel_timer()
        # Before it is waited for: until then nobody else can have its number.
        self._signal(signal.SIGKILL)
        code = process.wait()
        self._read_output()
        self._close_files(process)
        self._process = None
        unbidden = self._phase is not _Phase.STOPPING
        if unbidden:
            last = f"; it said: {self._output[-1]}" if self._output and code > 0 else ""
            logger.warning("'%s' has ended by itself %s%s", self.name, _how(code), last)
        with self._lock:
            self._again = self._announced = False
            # What has ended by itself is not wanted to run any more, until somebody asks for it again.
            self._on = self._on and not unbidden
        self._change(_Phase.ENDED, wanted=False if unbidden else None)
        if unbidden and self._entry.standby:
            self._timer = self._supervisor.loop.call_later(_STANDBY_AGAIN, self.prepare)
        elif self._wanted:
            self._follow()

    def _say_active(self) -> None:
        """Tell a process on standby whether it is to be active; start it if it does not run."""
        if self._phase is not _Phase.RUNNING:
            self._follow()
            return
        wanted = announced = self._on
        try:
            if wanted != self._announced:
                self._write_line(as_json_line({"active": wanted}))
        except OSError as error:
            logger.warning("'%s' does not take its state: %s", self.name, error)
            announced = self._announced
        with self._lock:
            self._announced = announced
            if announced != wanted:
                self._on = announced
        self._on_change(self.name)

    def _change(self, phase: _Phase, *, wanted: bool | None = None, announce: bool = True) -> None:
        with self._lock:
            self._phase = phase
            if wanted is not None:
                self._wanted = wanted
        if announce:
            self._on_change(self.name)

    def _signal(self, number: int) -> None:
        """To the process and all of its group."""
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, number)

    def _program(self) -> str:
        path = self._environment.get("PATH", os.defpath)
        command = self._entry.command[0]
        found = shutil.which(str(self._folder / command) if "/" in command else command, path=path)
        if found is None:
            raise FileNotFoundError(f"there is no program '{command}'")
        return found

    def _arguments(self) -> list[str]:
        form = None if self._entry.parameters is None else self._entry.parameters.argument
        return [] if form is None else [form.format(key=k, value=as_text(v)) for k, v in self.parameters.items()]

    def _write_parameters(self) -> None:
        if self.parameters:
            self._write_line(as_json_line(self.parameters))

    def _write_line(self, line: str) -> None:
        stdin = None if self._process is None else self._process.stdin
        data = line.encode()
        if stdin is not None and os.write(stdin.fileno(), data) != len(data):
            raise OSError(f"'{self.name}' does not read its standard input")

    def _read_output(self) -> None:
        stdout = None if self._process is None else self._process.stdout
        if stdout is None or stdout.closed:
            return
        with contextlib.suppress(BlockingIOError):
            data = os.read(stdout.fileno(), 1 << 16)
            if not data:
                self._supervisor.loop.remove_reader(stdout.fileno())
            if self._log is not None:
                self._log.write(data)
            self._hear(data)

    def _hear(self, data: bytes) -> None:
        *lines, rest = (self._partial_line + data).split(b"\n")
        self._partial_line = rest[-_LONGEST_LINE:]
        for line in lines:
            text = line.decode(errors="replace").rstrip()
            self._output.append(text)
            logger.debug("%s: %s", self.name, text)
            if self._phase is _Phase.STARTING and self._readiness is not None:
                self._readiness.hear(text)
        if lines and self._phase is _Phase.STARTING:
            self._look()

    def _start_probe(self, command: list[str]) -> subprocess.Popen[bytes]:
        return self._supervisor.start(command, environment=self._environment, folder=str(self._folder))

    def _cancel_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _close_files(self, process: subprocess.Popen[bytes]) -> None:
        if self._readiness is not None:
            self._readiness.close()
        if process.stdout is not None:
            self._supervisor.loop.remove_reader(process.stdout.fileno())
        for file in (process.stdin, process.stdout, self._log):
            if file is not None:
                with contextlib.suppress(OSError):
                    file.close()
        self._log, self._partial_line = None, b""


def _how(code: int) -> str:
    return f"by signal {signal.Signals(-code).name}" if code < 0 else f"with exit code {code}"
