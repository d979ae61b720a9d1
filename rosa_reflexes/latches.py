"""Which reflexes have fired and are not released yet."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from rosa_reflexes.reflex import Reflex
from rosa_reflexes.sensors import Readings


class _Latch:
    """When a reflex fired, and since when its release condition holds without a break."""

    __slots__ = ("clear_since", "raised", "since")

    def __init__(self, since: float) -> None:
        self.since = since
        self.clear_since: float | None = None
        self.raised = False


class Latches:
    """The latches of a gate's reflexes.

    A reflex that raises counts as fired: it can no longer say that all is well. It is released when its conditions can
    be evaluated again and say so.

    Args:
        reflexes: in order of declaration.
        readings: what they are evaluated on.

    Raises:
        ValueError: if two share a name, or one reads what is not there.
    """

    def __init__(self, reflexes: tuple[Reflex, ...], readings: Readings) -> None:
        self._readings = readings
        self._by_priority = sorted(reflexes, key=lambda reflex: -reflex.priority)
        self._readers: dict[str, list[Reflex]] = {name: [] for name in readings}
        self._latches: dict[str, _Latch] = {}
        names = [reflex.name for reflex in reflexes]
        if len(set(names)) < len(names):
            raise ValueError(f"a reflex stands twice: {next(name for name in names if names.count(name) > 1)}")
        for reflex in self._by_priority:
            for sensor in reflex.reads:
                if sensor not in self._readers:
                    raise ValueError(f"reflex '{reflex.name}' reads '{sensor}', and there is no such sensor")
                self._readers[sensor].append(reflex)

    def in_force(self) -> Iterator[Reflex]:
        """The reflexes that have fired, by priority."""
        latches = self._latches
        return iter(()) if not latches else (reflex for reflex in self._by_priority if reflex.name in latches)

    def has_raised(self, reflex: Reflex) -> bool:
        """Whether the reflex is in force because it raised."""
        return self._latches[reflex.name].raised

    def note_raised(self, reflex: Reflex) -> None:
        """The reflex raised while it was asked for its command."""
        self._latches[reflex.name].raised = True

    def evaluate(
        self, sampled: Iterable[str], now: float, *, also_latched: bool = False
    ) -> list[tuple[str, Exception]]:
        """Evaluate the reflexes that read one of the sensors, and, if wanted, those in force.

        Returns:
            the reflexes that raised, with what.
        """
        due = {reflex.name: reflex for name in sampled for reflex in self._readers[name]}
        if also_latched:
            due |= {reflex.name: reflex for reflex in self.in_force()}
        raised: list[tuple[str, Exception]] = []
        for reflex in due.values():
            try:
                self._evaluate(reflex, now)
            except Exception as error:
                latch = self._latches.setdefault(reflex.name, _Latch(now))
                if not latch.raised:
                    raised.append((reflex.name, error))
                latch.raised, latch.clear_since = True, None
        return raised

    def _evaluate(self, reflex: Reflex, now: float) -> None:
        latch = self._latches.get(reflex.name)
        if latch is None:
            if reflex.trigger(self._readings):
                self._latches[reflex.name] = _Latch(now)
            return
        may_release = reflex.may_release(self._readings)
        latch.raised = False
        if not may_release:
            latch.clear_since = None
            return
        if latch.clear_since is None:
            latch.clear_since = now
        if now - latch.clear_since >= reflex.release_after and now - latch.since >= reflex.dwell:
            del self._latches[reflex.name]
