"""What the monitors last published, for managing systems without a knowledge base."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray, values_of
from rosa_simulation.monitors import COMPONENT_STATUS, FAILED


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
        """Take what the robot's monitors publish.

        Args:
            diagnostics: an array of measurements and component statuses.
        """
        for key, value, message in values_of(diagnostics):
            if message != COMPONENT_STATUS:
                self.measurements[key] = float(value)
            elif value == FAILED:
                self.failed.add(key)
            else:
                self.failed.discard(key)

    def reaches(self, measure: str, threshold: float) -> bool:
        """Whether the last measurement is at least the threshold; nothing measured, nothing wrong.

        Args:
            measure: its name.
            threshold: in the measure's unit.

        Example:
            >>> situation = Situation()
            >>> situation.reaches("battery_level", 0.25)
            True
            >>> situation.measurements["battery_level"] = 0.2
            >>> situation.reaches("battery_level", 0.25)
            False
        """
        return self.measurements.get(measure, threshold) >= threshold
