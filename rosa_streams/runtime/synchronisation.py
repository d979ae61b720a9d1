"""Streams brought together into one stream of states, over which formulas are evaluated.

A state says for one time what each variable is: the latest sample of its stream that is not older than ``max_age``;
otherwise the variable is unknown. When states are made:

- ``periodic``: every ``period`` seconds, whatever came;
- ``any``: for every time at which any stream has a sample, once a later sample comes or time passes
  (:meth:`Synchroniser.tick`), so that samples of the same time are one state;
- ``all``: when every stream has had a new sample since the last state.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from rosa_streams.environment import Sample
from rosa_streams.errors import StreamError

POLICIES = ("periodic", "any", "all")


@dataclass(frozen=True, slots=True)
class TimedState:
    """The values of variables at a time, in seconds; a variable that is missing is unknown."""

    time: float
    values: Mapping[str, Any]


class Synchroniser:
    """Makes states out of samples.

    Args:
        variables: what states are made of.
        policy: ``periodic``, ``any`` or ``all``.
        period: in seconds, for ``periodic``.
        max_age: in seconds; an older sample is not taken for the present value.

    >>> synchroniser = Synchroniser(["x", "y"], policy="all", max_age=1.0)
    >>> synchroniser.receive("x", Sample("x", 1, 0.0)), synchroniser.receive("x", Sample("x", 2, 0.4))
    (None, None)
    >>> synchroniser.receive("y", Sample("y", 5, 0.5))
    TimedState(time=0.5, values={'x': 2, 'y': 5})
    """

    def __init__(
        self,
        variables: Iterable[str],
        *,
        policy: str = "any",
        period: float | None = None,
        max_age: float = math.inf,
    ) -> None:
        if policy not in POLICIES:
            raise StreamError(f"states are made {', '.join(POLICIES)}, not '{policy}'")
        if (policy == "periodic") != (period is not None) or (period is not None and not period > 0):
            raise StreamError("the policy 'periodic', and no other, has a period over 0")
        if not max_age > 0:
            raise StreamError(f"the limit of age is over 0 s, not {max_age}")
        self.variables = tuple(dict.fromkeys(variables))
        self.policy, self.period, self.max_age = policy, period, max_age
        self._latest: dict[str, Sample] = {}
        self._new: set[str] = set()
        self._last = -math.inf
        self._pending: float | None = None

    def receive(self, variable: str, sample: Sample) -> TimedState | None:
        """Take a sample of a variable's stream; returns the state if there is one now.

        A sample that is older than the latest of its stream is left out, and so is a state that would not be later than
        the last one.

        Raises:
            StreamError: if there is no such variable.
        """
        if variable not in self.variables:
            raise StreamError(f"'{variable}' is none of {', '.join(self.variables)}")
        latest = self._latest.get(variable)
        if latest is not None and sample.time < latest.time:
            return None
        state = None
        if self.policy == "any":
            if self._pending is not None and sample.time > self._pending:
                state = self._state(self._pending)
            self._pending = sample.time if self._pending is None else max(self._pending, sample.time)
        self._latest[variable] = sample
        if self.policy != "all":
            return state
        self._new.add(variable)
        if len(self._new) < len(self.variables):
            return None
        return self._state(max(each.time for each in self._latest.values()))

    def tick(self, now: float) -> TimedState | None:
        """Time has come to ``now``: the periodic state, or the state of samples that have come for ``any``."""
        if self.policy == "periodic":
            return self._state(now)
        if self._pending is None or now < self._pending:
            return None
        return self._state(self._pending)

    def _state(self, time: float) -> TimedState | None:
        self._pending = None
        if time <= self._last:
            return None
        self._last = time
        self._new.clear()
        values = {
            name: sample.value for name, sample in self._latest.items() if time - self.max_age <= sample.time <= time
        }
        return TimedState(time, {name: values[name] for name in self.variables if name in values})
