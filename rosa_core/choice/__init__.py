"""Which configuration of an action is the best: alternatives, their estimates, and an exact search."""

from rosa_core.choice.alternatives import Alternatives, CompleteConfiguration, ConfigurationOption, DesignOption
from rosa_core.choice.choose import best_configuration, complete_configurations, estimates, unmet_limits

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
