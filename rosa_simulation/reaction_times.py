"""How fast a managing system reacts: from an uncertainty to the adaptation to it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from rosa_core.clock import Stopwatch
from rosa_simulation.run_record import Reaction


@dataclass(slots=True)
class _Cause:
    """An uncertainty that the managing system has yet to react to; ``decided`` once it has made the call."""

    time: float
    elapsed: float
    decided: float | None = None


class ReactionTimes:
    """Times reactions, each by the name of its uncertainty; at most one reaction of a name is open at a time.

    Args:
        names: the uncertainties.
        stopwatch: runs while the managing system does; its share until the decision is the compute part.

    Attributes:
        reactions: those that came to an end, by name.
    """

    def __init__(self, names: Iterable[str], stopwatch: Stopwatch) -> None:
        self._stopwatch = stopwatch
        self._open: dict[str, _Cause] = {}
        self.reactions: dict[str, list[Reaction]] = {name: [] for name in names}

    def begin(self, name: str, stamp: float) -> None:
        """The uncertainty showed itself at a time (s), unless it is waiting for a reaction already."""
        self._open.setdefault(name, _Cause(stamp, self._stopwatch.elapsed()))

    def decide(self, name: str) -> None:
        """The managing system makes the call: its deciding is over, what follows is delay."""
        cause = self._open.get(name)
        if cause is not None and cause.decided is None:
            cause.decided = self._stopwatch.elapsed()

    def end(self, name: str, now: float) -> None:
        """The adaptation is in effect, at a time in s."""
        cause = self._open.pop(name, None)
        if cause is not None:
            decided = self._stopwatch.elapsed() if cause.decided is None else cause.decided
            self.reactions[name].append(Reaction(cause.time, now - cause.time, decided - cause.elapsed))

    def drop(self, name: str) -> None:
        """No reaction is needed any more."""
        self._open.pop(name, None)

    def means(self) -> dict[str, float | None]:
        """The mean reaction time of each, s; None where there was no reaction."""
        return {
            name: sum(r.total_s for r in reactions) / len(reactions) if reactions else None
            for name, reactions in self.reactions.items()
        }
