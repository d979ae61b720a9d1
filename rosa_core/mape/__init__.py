"""Monitor, plan and execute over the knowledge base (analysis is the knowledge base's own inference)."""

from rosa_core.mape.adaptation_loop import AdaptationLoop
from rosa_core.mape.configuration_planner import ConfigurationPlanner
from rosa_core.mape.executor import Executor
from rosa_core.mape.managed_system import ManagedSystem
from rosa_core.mape.monitor import DiagnosticsMonitor, MonitorReport

__all__ = [
    "AdaptationLoop",
    "ConfigurationPlanner",
    "DiagnosticsMonitor",
    "Executor",
    "ManagedSystem",
    "MonitorReport",
]
