"""Queries (figure 1 of the paper): a formula over streams that are wished for by their meaning, answered and cleared
away.

1. A client gives a query to the manager, 2. which configures the environment for the streams of its variables;
3. the formula goes to the engine, 4. with subscriptions to these streams; 5. the engine's answer returns to the
manager, which unloads what is no longer needed, and 6. goes to the client.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from rosa_core.clock import SimulationClock, Timer
from rosa_core.errors import Problem, nearest
from rosa_streams.environment import Sample
from rosa_streams.errors import FormulaError, StreamError
from rosa_streams.manager import Manager
from rosa_streams.runtime import Synchroniser, TimedState
from rosa_streams.tags import Concept, parse_tag
from rosa_streams.temporal import Monitor, Verdict, variables

_NUMBERS = itertools.count(1)


@dataclass(frozen=True, slots=True)
class StreamOf:
    """A variable's stream: its meaning, and which part of the sample's value the variable is.

    Attributes:
        tag: what is wished for.
        field: a key of the value (a mapping), or an attribute; None takes the whole value.
    """

    tag: Concept | str
    field: str | None = None

    def value(self, sample: Sample) -> Any:
        """The variable's value in a sample; None (unknown) if the value has no such part."""
        if self.field is None:
            return sample.value
        if isinstance(sample.value, Mapping):
            return sample.value.get(self.field)
        return getattr(sample.value, self.field, None)


@dataclass(frozen=True, slots=True)
class Answer:
    """What is known of a query's formula, and since when (seconds)."""

    verdict: Verdict
    time: float


class Query:
    """A formula under evaluation over streams.

    ``late`` counts states that came after their time had been passed by; ``failure`` says why evaluation broke off.

    Args:
        manager: gives the streams.
        formula: of metric temporal logic.
        streams: for each variable of the formula its stream; a text is the tag.
        answer: called with the answer; in real time by the manager's thread.
        repeat: evaluate it anew after each answer, from the next state on, instead of ending.
        policy, period, max_age: how samples become states; see :class:`~rosa_streams.runtime.Synchroniser`.
        tick_period: in simulated time, seconds between checks of deadlines; by default ``period``. In real time call
            :meth:`tick` now and then.
        lateness: how many seconds after its time a sample may come; deadlines are checked so much later.
        regions: for spatial atoms.
        name: of the targets; by default a new one.

    Raises:
        FormulaError, StreamError: for a formula that cannot be read, and variables without a stream.
    """

    def __init__(
        self,
        manager: Manager,
        formula: str,
        streams: Mapping[str, StreamOf | Concept | str],
        answer: Callable[[Answer], None],
        *,
        repeat: bool = False,
        policy: str = "any",
        period: float | None = None,
        max_age: float = math.inf,
        tick_period: float | None = None,
        lateness: float = 0.0,
        regions: Mapping[str, Any] | None = None,
        name: str | None = None,
    ) -> None:
        self.name = name or f"query{next(_NUMBERS)}"
        self.monitor = Monitor(formula, regions)
        self._manager, self._answer, self._repeat = manager, answer, repeat
        self._streams = {each: _stream(stream) for each, stream in streams.items()}
        self._check(regions or {})
        self._synchroniser = Synchroniser(self._streams, policy=policy, period=period, max_age=max_age)
        self._ends: list[Callable[[], None]] = []
        self._timer: Timer | None = None
        self._lateness = lateness
        self._reached = -math.inf
        self._flush_scheduled = False
        self.late = 0
        self.failure: str | None = None
        self.ended = False
        for variable, stream in self._streams.items():
            self._ends.append(manager.subscribe(self._channel(variable), self._receiver(variable, stream)))
        for variable, stream in self._streams.items():
            manager.add_target(self._qid(variable), stream.tag, self._channel(variable))
        every = period if tick_period is None else tick_period
        if isinstance(manager.clock, SimulationClock) and every is not None:
            self._timer = manager.clock.call_every(every, self.tick)

    def targets(self) -> tuple[str, ...]:
        """The names of its targets."""
        return tuple(self._qid(variable) for variable in self._streams)

    def tick(self) -> None:
        """Let time pass for deadlines and periodic states; in real time, call it now and then."""
        if self.ended:
            return
        now = self._manager.clock.now()
        state = self._synchroniser.tick(now)
        if state is not None:
            self._take(state)
        passed = now - self._lateness
        if not self.ended and self.monitor.verdict is Verdict.UNKNOWN and passed > self._reached:
            self._reached = passed
            self._evaluated(self.monitor.tick(passed), passed)

    def end(self) -> None:
        """Stop evaluating, and take the targets back."""
        if self.ended:
            return
        self.ended = True
        if self._timer is not None:
            self._timer.cancel()
        for end in self._ends:
            end()
        for variable in self._streams:
            self._manager.remove_target(self._qid(variable))

    def _check(self, regions: Mapping[str, Any]) -> None:
        names = variables(self.monitor.formula)
        for name in names:
            if name not in self._streams and name not in regions:
                hint = nearest(name, self._streams) or "give the tag of its stream"
                raise StreamError(Problem(f"the variable '{name}' of the formula has no stream", hint=hint))

    def _qid(self, variable: str) -> str:
        return f"{self.name}.{variable}"

    def _channel(self, variable: str) -> str:
        return f"/{self.name}/{variable}"

    def _receiver(self, variable: str, stream: StreamOf) -> Callable[[Sample], None]:
        def receive(sample: Sample) -> None:
            if self.ended:
                return
            state = self._synchroniser.receive(variable, Sample(variable, stream.value(sample), sample.time))
            if state is not None:
                self._take(state)
            clock = self._manager.clock
            if isinstance(clock, SimulationClock) and not self._flush_scheduled:
                # Samples of the same time come in one go: the state is whole at the end of this moment.
                self._flush_scheduled = True
                clock.call_at(clock.now(), self._flush)

        return receive

    def _flush(self) -> None:
        self._flush_scheduled = False
        if not self.ended and self._synchroniser.policy == "any":
            state = self._synchroniser.tick(self._manager.clock.now())
            if state is not None:
                self._take(state)

    def _take(self, state: TimedState) -> None:
        if state.time <= self._reached:
            self.late += 1
            return
        self._reached = state.time
        try:
            self._evaluated(self.monitor.step(state.values, state.time), state.time)
        except FormulaError as error:
            self.failure = str(error)
            self._manager.post(self.end)

    def _evaluated(self, verdict: Verdict, time: float) -> None:
        if verdict is Verdict.UNKNOWN or self.ended:
            return
        answer = Answer(verdict, time)
        if self._repeat:
            self.monitor.restart()
            self._answer(answer)
        else:
            self._manager.post(lambda: self._finish(answer))

    def _finish(self, answer: Answer) -> None:
        if not self.ended:
            self.end()
            self._answer(answer)


def _stream(stream: StreamOf | Concept | str) -> StreamOf:
    if isinstance(stream, StreamOf):
        return stream if isinstance(stream.tag, Concept) else StreamOf(parse_tag(stream.tag), stream.field)
    return StreamOf(parse_tag(stream) if isinstance(stream, str) else stream)
