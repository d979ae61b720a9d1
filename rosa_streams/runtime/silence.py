"""Units that have gone silent: they get samples, or the time to produce, and give nothing."""

from __future__ import annotations

from rosa_streams.runtime.instance import Instance


class SilenceWatch:
    """Compares what a unit has received and sent from check to check.

    A computation that should never be silent for long has ``max_silence``, in seconds: after so long without a sample,
    though it was called, its unit is lost. That is how a camera that goes dark is found.
    """

    def __init__(self, instance: Instance, seconds: float) -> None:
        self.instance, self.seconds = instance, seconds
        self._sent, self._received = instance.sent, instance.received

    def is_silent(self) -> bool:
        """Whether nothing was sent since the last check though something was received."""
        instance = self.instance
        silent = instance.sent == self._sent and instance.received > self._received
        self._sent, self._received = instance.sent, instance.received
        return silent

    @property
    def reason(self) -> str:
        """What is said of a unit that is lost for it."""
        return f"it is silent: no sample for {self.seconds:g} s"


def silence_watch(instance: Instance) -> SilenceWatch | None:
    """The watch of a unit, if its computation has ``max_silence``."""
    seconds = getattr(instance.computation, "max_silence", None)
    return None if seconds is None else SilenceWatch(instance, float(seconds))
