"""Which configuration of an action is best: alternatives, estimates, and an exact search."""

from rosa_core.choice.configurations.alternatives import (
    Alternatives,
    CompleteConfiguration,
    ConfigurationOption,
    DesignOption,
)
from rosa_core.choice.configurations.choose import (
    best_configuration,
    complete_configurations,
    estimates,
    unmet_limits,
)

__all__ = [
    "Alternatives",
    "CompleteConfiguration",
    "ConfigurationOption",
    "DesignOption",
    "best_configuration",
    "complete_configurations",
    "estimates",
    "unmet_limits",
]
