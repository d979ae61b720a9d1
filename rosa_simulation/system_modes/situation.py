"""What the monitors last published, for managing systems without a knowledge base."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray, values_of

_COMPONENT_STATUS, _FAILED = "Component status", "FALSE"


class Situation:
    """The latest measurements, and the components that have failed.

    Attributes:
        measurements: the last value of each measure; nothing of those that were never measured.
        failed: the components that failed and have not recovered.
    """

    def __init__(self) -> None:
        self.measurements: dict[str, float] = {}
        self.failed: set[str] = set()

    def update(self, diagnostics: DiagnosticArray) -> None:
        """Take what the robot's monitors publish."""
        for key, value, message in values_of(diagnostics):
            if message != _COMPONENT_STATUS:
                self.measurements[key] = float(value)
            elif value == _FAILED:
                self.failed.add(key)
            else:
                self.failed.discard(key)

    def reaches(self, measure: str, threshold: float) -> bool:
        """Whether the last measurement is at least the threshold; nothing measured, nothing wrong."""
        return self.measurements.get(measure, threshold) >= threshold
