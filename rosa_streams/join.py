"""Streams joined to ROSA: samples become measurements, formulas become measures, missing streams become failures.

A measure is bound to a stream by its meaning. Raw samples do not pass through the knowledge base: of a bound stream,
only what can change a constraint becomes a measurement. A formula is a measure too: 1 where it holds, 0 where it is
violated; while nothing is known it stays unmeasured. A component that needs a stream which nothing can give has
failed, so that designs with it become unfeasible and the task layer chooses something else.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from rosa_core.errors import Problem
from rosa_core.model.elements import Constraint
from rosa_streams.environment import Sample
from rosa_streams.errors import StreamError
from rosa_streams.life_cycle import JournalEntry
from rosa_streams.manager import Manager
from rosa_streams.query import Answer, Query, StreamOf
from rosa_streams.tags import Concept
from rosa_streams.temporal import Verdict

_COMPARE = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}


class Knowledge(Protocol):
    """The part of a knowledge base that streams write to; :class:`rosa_core.KnowledgeBase` has it."""

    def add_measurement(self, measure: str, value: float, time: float | None = None) -> None:
        """A measure was measured."""
        ...

    def set_component_failure(self, name: str, time: float | None = None) -> None:
        """A component failed."""
        ...

    def clear_component_failure(self, name: str) -> None:
        """A component works again."""
        ...

    def constraints(self) -> list[tuple[Constraint, Any]]:
        """All constraints."""
        ...


@dataclass(frozen=True, slots=True)
class StreamMeasure:
    """A measure whose measurements are a stream's samples.

    Attributes:
        measure: of the knowledge model.
        tag: what the stream is about.
        field: the part of the sample's value that is measured; None if the value is the number.
        refresh: seconds after which a sample becomes a measurement whatever its value; None leaves it to constraints.
    """

    measure: str
    tag: Concept | str
    field: str | None = None
    refresh: float | None = None


@dataclass(frozen=True, slots=True)
class FormulaMeasure:
    """A measure that is 1 where a formula holds and 0 where it is violated.

    The formula is evaluated anew after each verdict, from the next state on. Formulas about the past, and those with
    bounds, come to a verdict again and again; ``G f`` without a bound can only be violated.

    Attributes:
        measure: of the knowledge model.
        formula: of metric temporal logic.
        streams: for each variable its stream.
        options: of :class:`~rosa_streams.query.Query`, such as ``period``, ``max_age``, ``regions``.
    """

    measure: str
    formula: str
    streams: Mapping[str, StreamOf | Concept | str]
    options: Mapping[str, Any] = field(default_factory=dict)


class Thinning:
    """Lets through the values that can change a constraint, judged by the last one that was let through.

    Args:
        limits: operators with their values, such as ``(">=", 0.25)``.
        refresh: seconds after which any value is let through; None never.

    >>> thinning = Thinning([(">=", 3.0)])
    >>> [thinning.passes(value, time) for time, value in enumerate([5.0, 4.0, 2.9, 1.0, 3.0])]
    [True, False, True, False, True]
    """

    def __init__(self, limits: Iterable[tuple[str, float]], refresh: float | None = None) -> None:
        self._limits = tuple((_COMPARE[each], value) for each, value in limits)
        self._refresh = math.inf if refresh is None else refresh
        self._last: tuple[bool, ...] | None = None
        self._last_time = -math.inf

    def passes(self, value: float, time: float) -> bool:
        """Whether the value, sampled at a time in seconds, is let through."""
        side = tuple(compare(value, limit) for compare, limit in self._limits)
        if side == self._last and time - self._last_time < self._refresh:
            return False
        self._last, self._last_time = side, time
        return True


class Join:
    """Binds measures and components of a knowledge base to streams of a manager.

    ``samples`` and ``measurements`` count what came and what became a measurement, for each measure.

    Args:
        knowledge: a knowledge base.
        manager: gives the streams.
        measures: what is bound.
        components: for each component the measures whose streams it needs; it has failed while one of them has none.

    Raises:
        StreamError: if a component needs a measure that is not bound.
        TagError, FormulaError: for tags and formulas that cannot be read.
    """

    def __init__(
        self,
        knowledge: Knowledge,
        manager: Manager,
        measures: Iterable[StreamMeasure | FormulaMeasure],
        components: Mapping[str, Iterable[str]] | None = None,
    ) -> None:
        self._knowledge, self._manager = knowledge, manager
        self._targets: dict[str, tuple[str, ...]] = {}
        self._ends: list[Callable[[], None]] = []
        self._failed: dict[str, str] = {}
        self._closed = False
        self.samples: dict[str, int] = {}
        self.measurements: dict[str, int] = {}
        bound = list(measures)
        self._components = {name: tuple(needs) for name, needs in (components or {}).items()}
        self._check({each.measure for each in bound})
        for each in bound:
            self.samples[each.measure] = self.measurements[each.measure] = 0
            if isinstance(each, StreamMeasure):
                self._bind_stream(each)
            else:
                self._bind_formula(each)
        manager.on_review(self._reviewed)
        self._report_components()

    def why(self, component: str) -> str | None:
        """Why a component has failed for want of a stream; None if it has not."""
        return self._failed.get(component)

    def close(self) -> None:
        """Take the targets back."""
        self._closed = True
        for end in self._ends:
            end()
        self._ends.clear()

    def _check(self, bound: set[str]) -> None:
        for component, needs in self._components.items():
            for measure in needs:
                if measure not in bound:
                    what = f"the component '{component}' needs the stream of '{measure}', which is not bound"
                    raise StreamError(Problem(what, hint=f"bound are {', '.join(sorted(bound)) or 'none'}"))

    def _bind_stream(self, bound: StreamMeasure) -> None:
        limits = [
            (str(constraint.operator), constraint.value)
            for constraint, _ in self._knowledge.constraints()
            if constraint.measure == bound.measure and constraint.value is not None
        ]
        thinning = Thinning(limits, bound.refresh)
        stream = StreamOf(bound.tag, bound.field)

        def receive(sample: Sample) -> None:
            self.samples[bound.measure] += 1
            value = stream.value(sample)
            if isinstance(value, int | float) and math.isfinite(value) and thinning.passes(value, sample.time):
                self._measure(bound.measure, float(value), sample.time)

        qid, channel = f"measure.{bound.measure}", f"/measure/{bound.measure}"
        self._targets[bound.measure] = (qid,)
        self._ends.append(self._manager.subscribe(channel, receive))
        self._manager.add_target(qid, bound.tag, channel)
        self._ends.append(lambda: self._manager.remove_target(qid))

    def _bind_formula(self, bound: FormulaMeasure) -> None:
        last: list[float] = []

        def answer(given: Answer) -> None:
            self.samples[bound.measure] += 1
            value = 1.0 if given.verdict is Verdict.TRUE else 0.0
            if last != [value]:
                last[:] = [value]
                self._measure(bound.measure, value, given.time)

        query = Query(
            self._manager,
            bound.formula,
            bound.streams,
            answer,
            repeat=True,
            name=f"measure.{bound.measure}",
            **dict(bound.options),
        )
        self._targets[bound.measure] = query.targets()
        self._ends.append(query.end)

    def _measure(self, measure: str, value: float, time: float) -> None:
        if not self._closed:
            self.measurements[measure] += 1
            self._knowledge.add_measurement(measure, value, time)

    def _reviewed(self, entry: JournalEntry) -> None:
        del entry
        if not self._closed:
            self._report_components()

    def _report_components(self) -> None:
        missing = self._manager.unsatisfied()
        for component, needs in self._components.items():
            lacking = [missing[qid] for measure in needs for qid in self._targets[measure] if qid in missing]
            if lacking and component not in self._failed:
                self._knowledge.set_component_failure(component)
            elif not lacking and component in self._failed:
                self._knowledge.clear_component_failure(component)
            if lacking:
                self._failed[component] = "\n".join(lacking)
            else:
                self._failed.pop(component, None)
