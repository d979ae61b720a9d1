"""Records a run in simulated time while it happens."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosa_core.clock import SimulationClock, Stopwatch
from rosa_simulation.narrator import Narrator
from rosa_simulation.plans import recorded_plan
from rosa_simulation.run_record import AwaitedAction, MissionEvent, Reaction, RecordedPlan, RunRecord, raised_event
from rosa_simulation.scenario import Observer, RunRequest

if TYPE_CHECKING:
    from task_layer.mission_part import MissionPart
    from task_layer.pddl import PlanRecord


class RunRecorder:
    """Collects what goes into a :class:`RunRecord`, and shows it to the observer at once.

    Args:
        observer: watches the run.
        clock: simulated time.
        effect_time: how long after its cause an effect still belongs to it, s; see :class:`Narrator`.
        start_time: gives the time at which the mission began, in s of the clock.

    Attributes:
        narrator: makes the events; what happens to the robot is reported to it, and a knowledge base's events go to
            its ``on_kb_event``.
        stopwatch: whatever the managing system does belongs into its ``running()``.
    """

    def __init__(
        self,
        observer: Observer,
        clock: SimulationClock,
        *,
        effect_time: float = 0.01,
        start_time: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self._started = time.perf_counter()
        self._observer = observer
        self._clock = clock
        self._start_time = start_time
        self._events: list[MissionEvent] = []
        self._plans: list[RecordedPlan] = []
        self._raised: dict[tuple[str, str], list[int]] = {}  # who and what: index of the event, and how many times
        self._columns: tuple[str, ...] = ()
        self._trajectory: list[tuple[float, ...]] = []
        self._duration: float | None = None
        self.narrator = Narrator(clock, self.add_event, effect_time=effect_time, start_time=start_time)
        self.stopwatch = Stopwatch()

    @property
    def mission_time(self) -> float:
        """Seconds since the mission began."""
        return self._clock.now() - self._start_time()

    def add_event(self, event: MissionEvent) -> None:
        """Record an event."""
        self._events.append(event)
        self._observer.event(event)

    def on_raise(self, who: MissionPart, error: Exception) -> None:
        """Record that a behaviour, a step or a sensor raised; for the runners of trees and of plans.

        The same error of the same behaviour, step or sensor is one event, which says how many times it was raised.

        Args:
            who: the part of the mission that raised.
            error: that it raised.
        """
        first = self._raised.setdefault((who.name, f"{type(error).__name__}: {error}"), [len(self._events), 0])
        first[1] += 1
        if first[1] == 1:
            self.add_event(raised_event(self.mission_time, who.name, error))

    def on_plan(self, record: PlanRecord) -> None:
        """Record a plan, or that there is none."""
        self.narrator.on_plan(record)
        self._plans.append(recorded_plan(record, self.mission_time))

    def sample(self, columns: Sequence[str], values: Callable[[], tuple[float, ...]], *, period: float = 1.0) -> None:
        """Record the trajectory from now on.

        Args:
            columns: the names of the values.
            values: gives a row of them; the mission time is put before it.
            period: s between two rows.
        """
        self._columns = ("time_s", *columns)

        def take() -> None:
            self._trajectory.append((self.mission_time, *values()))
            self._observer.progress(self.mission_time)

        self._clock.call_every(period, take, start=self._clock.now())

    def close(self) -> float:
        """End the mission; what was last called may still take effect, and is recorded.

        Returns:
            how long it took, in s; the same when it is called again.
        """
        if self._duration is None:
            self._duration = self.mission_time
            self._clock.advance_to(self._clock.now() + self.narrator.effect_time)
            self.narrator.close()
        return self._duration

    def record(
        self,
        scenario: str,
        request: RunRequest,
        *,
        ended_by: str,
        completed: bool = True,
        duration: float | None = None,
        inputs: Mapping[str, Any],
        metrics: Mapping[str, Any],
        reactions: Mapping[str, Sequence[Reaction]],
        waiting_for: Sequence[AwaitedAction] = (),
    ) -> RunRecord:
        """The record of the run, which is over.

        Args:
            scenario: its name.
            request: what was to be run.
            ended_by: how the mission ended, in words.
            completed: whether it ran to its designed end.
            duration: how long the mission took, s; by default until :meth:`close`, which this calls if need be.
            inputs: everything that the run was made of, as values that JSON can hold.
            metrics: what it achieved, by the names of the scenario's metrics.
            reactions: by the names of the uncertainties.
            waiting_for: the actions that it was waiting for when it ended.
        """
        taken = self.close()
        events = list(self._events)
        for index, times in self._raised.values():
            if times > 1:
                event = events[index]
                facts = tuple({**fact, "times": times} for fact in event.facts)
                events[index] = replace(event, text=f"{event.text} ({times} times)", facts=facts)
        return RunRecord(
            scenario=scenario,
            manager=request.manager,
            task_layer=request.task_layer,
            seed=request.seed,
            completed=completed,
            ended_by=ended_by,
            duration_s=round(taken if duration is None else duration, 6),
            inputs=inputs,
            metrics=metrics,
            reactions={name: tuple(several) for name, several in reactions.items()},
            events=tuple(events),
            trajectory_columns=self._columns,
            trajectory=tuple(self._trajectory),
            wall_clock_s=time.perf_counter() - self._started,
            managing_s=self.stopwatch.elapsed(),
            plans=tuple(self._plans),
            waiting_for=tuple(waiting_for),
        )
