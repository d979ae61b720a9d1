"""Monitor, plan and execute over the knowledge base (analysis is the knowledge base's own inference)."""

from rosa_core.mape.adaptation_loop import AdaptationLoop
from rosa_core.mape.configuration_planner import ConfigurationPlanner
from rosa_core.mape.executor import Executor
from rosa_core.mape.in_threads import InThreads
from rosa_core.mape.limits import Limits
from rosa_core.mape.managed_system import Announcing, Answer, ComponentState, ManagedSystem, Observable
from rosa_core.mape.monitor import DiagnosticsMonitor, MonitorReport
from rosa_core.mape.watch import Watch

__all__ = [
    "AdaptationLoop",
    "Announcing",
    "Answer",
    "ComponentState",
    "ConfigurationPlanner",
    "DiagnosticsMonitor",
    "Executor",
    "InThreads",
    "Limits",
    "ManagedSystem",
    "MonitorReport",
    "Observable",
    "Watch",
]
