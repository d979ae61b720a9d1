"""The MAPE-K loop: monitor, planner and executor on one knowledge base, woken by its events."""

from __future__ import annotations

from types import TracebackType

from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.mape.configuration_planner import ConfigurationPlanner
from rosa_core.mape.executor import Executor
from rosa_core.mape.managed_system import ManagedSystem
from rosa_core.mape.monitor import DiagnosticsMonitor


class AdaptationLoop:
    """Keeps a managed system configured for what is required of it.

    The parts do not know one another: each reads from and writes to the knowledge base (ROSA paper, section 4.2).
    Adaptation happens within the write that makes it necessary: when ``kb.request_action(...)`` returns, the
    configuration is selected and carried out.

    Args:
        kb: the knowledge base.
        managed_system: the robot's architecture.
        attempts: how often a call to it is tried before its component counts as failed, at least 1.

    Attributes:
        monitor: writes diagnostics to the knowledge base.
        planner: selects designs and configurations.
        executor: carries reconfiguration plans out.

    Raises:
        ValueError: if ``attempts`` is less than 1.

    Example:
        >>> from rosa_core import KnowledgeBase, KnowledgeModel
        >>> from rosa_core.model.elements import (
        ...     Action, Component, ComponentType, Function, FunctionalRequirement, FunctionDesign
        ... )
        >>> class Rover:
        ...     def activate(self, component):
        ...         print("start", component)
        ...     def deactivate(self, component):
        ...         print("stop", component)
        ...     def set_parameters(self, component, parameters):
        ...         print("set", component, dict(parameters))
        >>> node = ComponentType.LIFECYCLE_NODE
        >>> model = KnowledgeModel(
        ...     actions=(Action("drive"),),
        ...     functions=(Function("see"),),
        ...     components=(Component("camera", node), Component("lidar", node)),
        ...     requirements=(FunctionalRequirement("drive", ("see",)),),
        ...     function_designs=(
        ...         FunctionDesign("by camera", "see", ("camera",), priority=1),
        ...         FunctionDesign("by lidar", "see", ("lidar",), priority=2),
        ...     ),
        ... )
        >>> kb = KnowledgeBase(model)
        >>> with AdaptationLoop(kb, Rover()):
        ...     required = kb.request_action("drive")
        ...     kb.set_component_failure("camera")
        start camera
        stop camera
        start lidar
    """

    def __init__(self, kb: KnowledgeBase, managed_system: ManagedSystem, *, attempts: int = 3) -> None:
        self.monitor = DiagnosticsMonitor(kb)
        self.planner = ConfigurationPlanner(kb)
        self.executor = Executor(kb, managed_system, attempts=attempts)
        self._unsubscribe = (
            kb.subscribe(self.planner.on_event, ConfigurationPlanner.EVENTS),
            kb.subscribe(self.executor.on_event, Executor.EVENTS),
        )

    def close(self) -> None:
        """Adapt no longer; the managed system stays as it is."""
        for unsubscribe in self._unsubscribe:
            unsubscribe()

    def __enter__(self) -> AdaptationLoop:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()
