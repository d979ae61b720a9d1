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
        """Begin to time a reaction, unless one of that name is open already.

        Args:
            name: the uncertainty.
            stamp: when it showed itself, s.
        """
        self._open.setdefault(name, _Cause(stamp, self._stopwatch.elapsed()))

    def decide(self, name: str) -> None:
        """Note that the managing system has decided: it calls a component, and what follows is delay.

        Args:
            name: the uncertainty that it reacts to.
        """
        cause = self._open.get(name)
        if cause is not None and cause.decided is None:
            cause.decided = self._stopwatch.elapsed()

    def end(self, name: str, now: float) -> None:
        """End the reaction.

        Args:
            name: the uncertainty.
            now: when the adaptation is in effect, s.
        """
        cause = self._open.pop(name, None)
        if cause is not None:
            decided = self._stopwatch.elapsed() if cause.decided is None else cause.decided
            self.reactions[name].append(Reaction(cause.time, now - cause.time, decided - cause.elapsed))

    def drop(self, name: str) -> None:
        """Time the reaction no longer: none is needed any more.

        Args:
            name: the uncertainty.
        """
        self._open.pop(name, None)

    def means(self) -> dict[str, float | None]:
        """The mean reaction time of each, s; None where there was no reaction."""
        return {
            name: sum(r.total_s for r in reactions) / len(reactions) if reactions else None
            for name, reactions in self.reactions.items()
        }
