"""The command gate: the only way to the actuators (Simplex architecture; RoCS paper, section 4.3).

Deliberation submits commands; reflexes take the command from it in the same call in which a sample triggers them. Every
time that the command changes hands the *epoch* is raised, and a command decided on in an earlier epoch is refused.
So a planner's command can neither overtake a reflex nor follow on it by accident.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from rosa_core import Clock
from rosa_reflexes.commands import Bounds, Command, approached, held, is_finite
from rosa_reflexes.events import (
    Answer,
    GateEvent,
    HandedBack,
    Preempted,
    ReflexRaised,
    Refused,
    SensorFaultChanged,
)
from rosa_reflexes.latches import Latches
from rosa_reflexes.reflex import Reflex
from rosa_reflexes.sensors import Readings, SensorLimits

DELIBERATION_SILENT = "deliberation silent"
"""The name under which the watchdog holds the command."""


@dataclass(frozen=True, slots=True)
class Watchdog:
    """What is commanded when deliberation has been silent for too long.

    Attributes:
        silent_after: for how many seconds deliberation may submit nothing while it has the command.
        command: what is commanded then, until it submits again.
    """

    silent_after: float
    command: Command


class CommandGate:
    """Passes commands on to the actuators, from deliberation or, while one holds the command, from a reflex.

    Any thread may call it; ``actuate`` and ``on_event`` are called within the call that causes them, one at a time;
    ``on_event`` after everything is commanded.

    Args:
        actuate: sends a command to the actuators.
        clock: where the time comes from.
        sensors: the sensors that reflexes read.
        reflexes: the reflexes, in order of declaration.
        safe_command: what is commanded when a reflex raises.
        parameters: named numbers that reflexes read; see :meth:`set_parameter`.
        bounds: by channel, what may be commanded. Rates bind deliberation only.
        watchdog: what happens when deliberation falls silent; None: nothing.
        on_event: hears of every change of hands, refusal and fault.

    Raises:
        ValueError: if two reflexes share a name, or one reads a sensor that there is not.
    """

    def __init__(
        self,
        actuate: Callable[[Command], object],
        clock: Clock,
        sensors: Iterable[SensorLimits],
        reflexes: Iterable[Reflex],
        *,
        safe_command: Command,
        parameters: Mapping[str, float] | None = None,
        bounds: Mapping[str, Bounds] | None = None,
        watchdog: Watchdog | None = None,
        on_event: Callable[[GateEvent], object] | None = None,
    ) -> None:
        now = clock.now()
        self.readings = Readings(sensors, parameters or {}, now)
        self.refusals = dict.fromkeys((Answer.STALE, Answer.PREEMPTED, Answer.INVALID), 0)
        """How many commands were refused, by the answer."""
        self.preemptions = 0
        """How often a reflex took the command from deliberation."""
        self._actuate, self._clock, self._on_event = actuate, clock, on_event
        self._safe, self._bounds, self._watchdog = safe_command, dict(bounds or {}), watchdog
        self._latches = Latches(tuple(reflexes), self.readings)
        self._lock = threading.RLock()
        self._events: deque[GateEvent] = deque()
        self._epoch = 0
        self._holder: str | None = None
        self._held_since = now
        self._command: Command = safe_command
        self._commanded_at = now
        self._submitted_at = now
        self._is_silent = False

    # -- deliberation --

    @property
    def epoch(self) -> int:
        """The present epoch. Deliberation reads it before it decides, and submits it with what it decided."""
        return self._epoch

    @property
    def holder(self) -> str | None:
        """The reflex that holds the command; None: deliberation has it."""
        return self._holder

    @property
    def command(self) -> Command:
        """What the actuators were last commanded; the safe command before the first."""
        return self._command

    def submit(self, command: Command, epoch: int) -> Answer:
        """Deliberation commands.

        Args:
            command: a value for each channel, in the channel's unit.
            epoch: the epoch in which it was decided on.

        Returns:
            ACCEPTED if it was passed on, within bounds and rates; otherwise why it was not.
        """
        with self._locked():
            now = self._clock.now()
            self._submitted_at = now
            if self._is_silent:
                self._is_silent = False
                self._hand_over(now)
            answer = self._answer(command, epoch)
            if answer is Answer.ACCEPTED:
                within = approached(command, self._command, now - self._commanded_at, self._bounds)
                self._send(within, now)
            else:
                self.refusals[answer] += 1
                self._report(Refused(now, self._epoch, answer))
            return answer

    # -- sensors and time --

    def sense(self, values: Mapping[str, float], time: float | None = None) -> None:
        """Samples came in: reflexes that read them fire or are released within this call.

        Args:
            values: by sensor, its new value.
            time: when, in s of the clock; by default now.

        Raises:
            LookupError: if there is no such sensor.
        """
        with self._locked():
            now = self._clock.now() if time is None else time
            for name, value in values.items():
                if self.readings.sample(name, value, now):
                    self._report(SensorFaultChanged(now, self._epoch, name, self.readings.fault(name)))
            self._evaluate(values, now)

    def check(self) -> None:
        """Look what the passing of time has brought: silent sensors, silent deliberation, reflexes that are over.

        To be called periodically: its period adds to how late silence is noticed.
        """
        with self._locked():
            now = self._clock.now()
            for name in (silent := self.readings.look_for_silence(now)):
                self._report(SensorFaultChanged(now, self._epoch, name, self.readings.fault(name)))
            has_command = self._holder is None
            if self._watchdog is not None and has_command and now - self._submitted_at > self._watchdog.silent_after:
                self._is_silent = True
            self._evaluate(silent, now, also_latched=True)

    def set_parameter(self, name: str, value: float) -> None:
        """Give a limit of the reflexes another value, such as the stopping distance at another speed.

        Raises:
            LookupError: if there is no such parameter.
            ValueError: if the value is not a finite number.
        """
        with self._locked():
            self.readings.set_parameter(name, value)
            self._evaluate(self.readings, self._clock.now())

    # -- questions --

    def latched(self) -> tuple[str, ...]:
        """The reflexes that have fired and are not released, the one that commands first."""
        with self._lock:
            return tuple(reflex.name for reflex in self._latches.in_force())

    def why(self) -> str:
        """Why the actuators are commanded what they are, in one line."""
        with self._lock:
            command = ", ".join(f"{name} {value:g}" for name, value in self._command.items())
            if self._holder is None:
                return f"deliberation commands {command}"
            since = f"since {self._held_since:.2f} s"
            return f"'{self._holder}' commands {command} {since}: {self._reason()}"

    # -- the change of hands --

    def _answer(self, command: Command, epoch: int) -> Answer:
        if epoch != self._epoch:
            return Answer.STALE
        if self._holder is not None:
            return Answer.PREEMPTED
        return Answer.ACCEPTED if is_finite(command) else Answer.INVALID

    def _evaluate(self, sampled: Iterable[str], now: float, *, also_latched: bool = False) -> None:
        raised = self._latches.evaluate(sampled, now, also_latched=also_latched)
        for name, error in raised:
            self._report(ReflexRaised(now, self._epoch, name, f"{type(error).__name__}: {error}"))
        self._hand_over(now)

    def _hand_over(self, now: float) -> None:
        """Let whoever is entitled to the command have it."""
        reflex = next(self._latches.in_force(), None)
        silent = self._is_silent and self._watchdog is not None
        holder = reflex.name if reflex is not None else DELIBERATION_SILENT if silent else None
        before = self._holder
        if holder is None:
            if before is not None:
                self._holder = None
                # Nobody could expect deliberation to submit while a reflex had the command.
                self._submitted_at = now
                self._epoch += 1
                self._report(HandedBack(now, self._epoch, before, now - self._held_since))
            return
        command = held(self._command_of(reflex, now), self._bounds)
        if holder == before:
            if command != self._command:
                self._send(command, now)
            return
        self._holder, self._held_since = holder, now
        self._epoch += 1
        self.preemptions += before is None
        self._send(command, now)
        self._report(Preempted(now, self._epoch, holder, command, self._reason(), before))

    def _command_of(self, reflex: Reflex | None, now: float) -> Command:
        if reflex is None:
            return self._safe if self._watchdog is None else self._watchdog.command
        if self._latches.has_raised(reflex):
            return self._safe
        try:
            command = reflex.commands(self.readings)
        except Exception as error:
            self._latches.note_raised(reflex)
            self._report(ReflexRaised(now, self._epoch, reflex.name, f"{type(error).__name__}: {error}"))
            return self._safe
        return command if is_finite(command) else self._safe

    def _reason(self) -> str:
        if self._holder == DELIBERATION_SILENT:
            return "deliberation has submitted nothing for too long"
        reflex = next(self._latches.in_force())
        faults = self.readings.faults()
        said = [
            f"{name} is {faults[name]}" if name in faults else f"{name} {self.readings[name]:g}"
            for name in reflex.reads
        ]
        return f"{reflex.describe} ({', '.join(said)})" if reflex.describe else ", ".join(said)

    def _send(self, command: Command, now: float) -> None:
        self._command, self._commanded_at = command, now
        self._actuate(command)

    def _report(self, event: GateEvent) -> None:
        if self._on_event is not None:
            self._events.append(event)

    @contextmanager
    def _locked(self) -> Iterator[None]:
        """Whoever observes is called when everything is commanded: it may take its time."""
        with self._lock:
            try:
                yield
            finally:
                while self._events and self._on_event is not None:
                    self._on_event(self._events.popleft())
