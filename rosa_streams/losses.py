"""What is remembered of lost units, and which transformations are set aside for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rosa_streams.runtime import LostUnit


class Losses:
    """Sets a transformation aside whose units are lost again and again.

    Args:
        tries: how many losses within ``window`` are one too many.
        window: in seconds; so long a transformation is set aside, too.
    """

    def __init__(self, tries: int, window: float) -> None:
        self._tries, self._window = tries, window
        self._recent: dict[str, list[LostUnit]] = {}
        self._until: dict[str, float] = {}

    def add(self, tid: str, lost: LostUnit) -> None:
        """A unit of this transformation was lost."""
        recent = self._recent.setdefault(tid, [])
        recent.append(lost)
        del recent[: -self._tries]
        if len(recent) == self._tries and lost.time - recent[0].time <= self._window:
            self._until[tid] = lost.time + self._window

    def discard(self, tid: str) -> None:
        """The transformation is gone, and what was remembered of it."""
        self._recent.pop(tid, None)
        self._until.pop(tid, None)

    def set_aside(self, now: float) -> Mapping[str, float]:
        """The transformations that are not to be used, and until when."""
        self._until = {tid: until for tid, until in self._until.items() if until > now}
        return self._until

    @property
    def recent(self) -> Mapping[str, Sequence[LostUnit]]:
        """The latest losses by transformation."""
        return self._recent
