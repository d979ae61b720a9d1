"""What units take while they run, measured from cycle to cycle."""

from __future__ import annotations

from collections.abc import Mapping

from rosa_streams.runtime.instance import Instance


class UpkeepMeter:
    """Processor seconds per second of each unit since it was last asked, by transformation."""

    def __init__(self) -> None:
        self._seen: dict[str, tuple[float, float]] = {}

    def read(self, instances: Mapping[str, Instance], now: float) -> dict[str, list[float]]:
        """What the units of each transformation took, each since the last reading (or since it was loaded).

        Args:
            instances: the loaded units.
            now: in seconds; a unit for which no time has passed is left out.
        """
        rates: dict[str, list[float]] = {}
        seen: dict[str, tuple[float, float]] = {}
        for cid, instance in instances.items():
            before, at = self._seen.get(cid, (0.0, instance.since))
            if now > at:
                rates.setdefault(instance.unit.tid, []).append((instance.cpu - before) / (now - at))
                before, at = instance.cpu, now
            seen[cid] = (before, at)
        self._seen = seen
        return rates
