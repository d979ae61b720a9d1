"""The MAPE-K loop: monitor, planner and executor on one knowledge base, woken by its events."""

from __future__ import annotations

from types import TracebackType

from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.mape.configuration_planner import ConfigurationPlanner
from rosa_core.mape.executor import Executor
from rosa_core.mape.limits import NO_LIMITS, LimitsByComponent
from rosa_core.mape.managed_system import Announcing, ManagedSystem, Observable
from rosa_core.mape.monitor import DiagnosticsMonitor
from rosa_core.mape.watch import Watch


class AdaptationLoop:
    """Keeps a managed system configured for what is required of it.

    The parts do not know one another: each reads from and writes to the knowledge base (ROSA paper, section 4.2).
    Adaptation happens within the write that makes it necessary: when ``kb.request_action(...)`` returns, the
    configuration is selected and carried out.

    Args:
        kb: the knowledge base.
        managed_system: the robot's architecture.
        attempts: how often a call to it is tried before its component counts as failed, at least 1.
        limits: how much time and how many attempts components get, by name.
        watch_period: how often the watch looks at all components, in s.

    Attributes:
        monitor: writes diagnostics to the knowledge base.
        planner: selects designs and configurations.
        executor: carries reconfiguration plans out.
        watch: writes which components have ended or started; None if the system cannot say it. Call its ``run`` in a
            thread, or ``check_all`` now and then.

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

    def __init__(
        self,
        kb: KnowledgeBase,
        managed_system: ManagedSystem,
        *,
        attempts: int = 3,
        limits: LimitsByComponent = NO_LIMITS,
        watch_period: float = 1.0,
    ) -> None:
        self._kb = kb
        self.monitor = DiagnosticsMonitor(kb)
        self.planner = ConfigurationPlanner(kb)
        self.watch: Watch | None = None
        if isinstance(managed_system, Observable):
            self.watch = Watch(kb, managed_system, limits=limits, period=watch_period)
        on_failure = _nothing if self.watch is None else self.watch.note_failure
        self.executor = Executor(kb, managed_system, attempts=attempts, limits=limits, on_failure=on_failure)
        self._unsubscribe = [
            kb.subscribe(self.planner.on_event, ConfigurationPlanner.EVENTS),
            kb.subscribe(self.executor.on_event, Executor.EVENTS),
        ]
        if self.watch is not None:
            self._unsubscribe.append(kb.subscribe(self.executor.wake, Executor.WAKING))
            self._unsubscribe.append(kb.subscribe(self.watch.on_event, Watch.EVENTS))
        if isinstance(managed_system, Announcing):
            self._unsubscribe.append(managed_system.subscribe(self._on_change))

    def resume(self) -> None:
        """Go on where a journal ended: see how the components are, and carry out the plan that is pending."""
        if self.watch is not None:
            self.watch.adopt()
        pending = self._kb.pending_reconfiguration_plan()
        if pending is not None:
            self.executor.execute(pending)

    def close(self) -> None:
        """Adapt no longer; the managed system stays as it is."""
        for unsubscribe in self._unsubscribe:
            unsubscribe()
        if self.watch is not None:
            self.watch.stop()

    def _on_change(self, component: str) -> None:
        self.executor.wake()
        if self.watch is not None:
            self.watch.notice(component)

    def __enter__(self) -> AdaptationLoop:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()


def _nothing(_component: str) -> None:
    """Who hears of failures if there is no watch."""
