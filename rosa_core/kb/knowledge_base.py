"""The knowledge base: the model, what is happening now, and what follows from both (ROSA paper, sections 5 and 6.2.1).

Its methods are the services of the paper's table 5. Every write is a transaction: validated, applied, inferred, then
announced. A write that is refused raises a :class:`~rosa_core.errors.KnowledgeBaseError` and changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from rosa_core.choice.utility import Utility
from rosa_core.errors import (
    InvalidValueError,
    RequestRefusedError,
)
from rosa_core.inference.explanation import explain
from rosa_core.inference.status import Result, Status
from rosa_core.kb import growth, reconfiguration
from rosa_core.kb.events import ReconfigurationPlan, RequiredAction
from rosa_core.kb.lookup import result_of
from rosa_core.kb.questions import KnowledgeQuestions
from rosa_core.kb.situation import Situation
from rosa_core.model.changes import Element
from rosa_core.model.elements import ElementRef
from rosa_core.model.numbers import finite


class KnowledgeBase(KnowledgeQuestions):
    """What a robot knows at run time.

    Any thread may read and write. Writes happen one after the other, and a reader sees none of them by half: it waits
    while another thread is in a transaction. Close it at the end, or use it as a context manager.

    Args:
        model: the design-time knowledge.
        clock: where times come from; by default the wall clock (seconds since the epoch).
        journal: a file in which every write is durable before it is announced; made if it is not there. If it is, the
            knowledge base goes on where the one that wrote it ended.
        journal_options: how to keep the journal.
        dispatch: how subscribers are called: ``synchronous``, in the thread that wrote, before the write returns;
            ``threads``, each in a thread of its own; or a dispatcher.
        history_length: how many entries of each topic :meth:`history` remembers.
        on_subscriber_error: called when a subscriber raises; by default that is logged.

    Raises:
        JournalError: if the journal is none, damaged, of another model, or in use.
    """

    # -- monitoring --

    def add_measurement(self, measure: str, value: float, time: float | None = None) -> None:
        """A measure was measured at a time (seconds; now by default). The latest measurement counts.

        Raises:
            UnknownElementError: if there is no such measure.
            InvalidValueError: if the value or time is not a finite number.
        """
        taken = self.clock.now() if time is None else time
        with self._write() as tx:
            node = self._measure(measure)
            value = finite(value, f"a measurement of {measure}")
            self._state.measure(tx, node, value, finite(taken, "the time of a measurement"))

    def set_component_failure(self, name: str, time: float | None = None) -> None:
        """A component failed (at a time in seconds; now by default). A failure does not stop it from being active."""
        since = self.clock.now() if time is None else time
        with self._write() as tx:
            component = self._component(name)
            self._state.set_failure(tx, component, finite(since, "the time of a failure"))

    def clear_component_failure(self, name: str) -> None:
        """A component works again."""
        with self._write() as tx:
            self._state.set_failure(tx, self._component(name), None)

    # -- task layer --

    def request_action(
        self, name: str, preference: str | None = None, utility: Utility | None = None
    ) -> RequiredAction:
        """The action is to be performed (``~/action/request``). If it already is, nothing changes.

        Args:
            name: the action.
            preference: the measure of which the estimated configuration is to have as much as possible.
            utility: weights and limits on estimated measures, instead of a preference.

        Raises:
            UnknownElementError: if there is no such action or measure.
            InvalidValueError: if both a preference and a utility are given.
            RequestRefusedError: if the action is unfeasible; the message says why.
        """
        if preference is not None and utility is not None:
            raise InvalidValueError("give a preference or a utility: a preference is the utility with weight 1 on it")
        with self._write() as tx:
            action = self._action(name)
            for measure in (preference,) if preference is not None else utility.measures if utility else ():
                self._measure(measure)
            if not action.required and action.status is Status.UNFEASIBLE:
                why = explain(self._reasoner, action).summary
                raise RequestRefusedError(f"the request is refused: {why}")
            return self._state.require(tx, action, preference, utility)

    def cancel_action(self, name: str) -> RequiredAction | None:
        """The action is no longer to be performed; its result is ``abandoned``. None if it was not required."""
        with self._write() as tx:
            return self._state.end_action(tx, self._action(name), Result.ABANDONED)

    def finish_action(self, name: str, result: Result | str = Result.COMPLETED) -> RequiredAction | None:
        """The action was ``completed`` or has ``failed``. None if it was not required."""
        with self._write() as tx:
            return self._state.end_action(tx, self._action(name), result_of(result))

    # -- configuration planning --

    def select_configuration(
        self, function_designs: Iterable[str], component_configurations: Iterable[str]
    ) -> ReconfigurationPlan | None:
        """Select designs and configurations, and plan how to get there (``~/select_configuration``).

        Others of the same functions and components are unselected, and so are those that nothing requires any more.
        A plan that is still pending is abandoned, unless the new one would do just the same. The work of a plan that
        failed is not planned again before a failure is cleared or something else is to be done.

        Returns:
            the pending plan, or None if there is nothing to reconfigure.

        Raises:
            UnknownElementError, InvalidValueError: for unknown names, or two choices for one function or component.
        """
        with self._write() as tx:
            designs = [self._design(name) for name in dict.fromkeys(function_designs)]
            configurations = [self._configuration(name) for name in dict.fromkeys(component_configurations)]
            reconfiguration.check_one_each(designs, configurations)
            return self._state.select(tx, designs, configurations)

    def replan(self) -> ReconfigurationPlan | None:
        """Make the reconfiguration plan anew, from what is selected and how the robot runs now.

        What nothing requires any more is unselected; else the selection stays. As with :meth:`select_configuration`, a
        pending plan that would do just the same stays, and what failed is not planned again for now.

        Returns:
            the pending plan, or None if there is nothing to reconfigure.
        """
        with self._write() as tx:
            return self._state.select(tx, [], [])

    # -- execution --

    def set_reconfiguration_result(self, plan: ReconfigurationPlan, result: Result | str) -> bool:
        """How the plan ended (``~/reconfiguration_plan/result/set``). False if it had already ended."""
        ended = result_of(result)
        with self._write() as tx:
            pending = self._state.pending_plan
            if pending is None or plan.id != pending.id:
                return False
            adapted = plan.parameter_adaptations if ended is Result.COMPLETED else ()
            self._state.end_plan(tx, ended, [self._configuration(name) for name in adapted])
            return True

    def set_component_active(self, name: str, active: bool) -> None:
        """The component runs now, or no longer (``~/component/active/set``)."""
        with self._write() as tx:
            self._state.set_active(tx, self._component(name), active)

    # -- what if --

    def suppose(self, situation: Situation) -> None:
        """Assert raw facts, for asking what would follow from them; requests are not refused.

        Raises:
            UnknownElementError, InvalidValueError: as the single writes do.
        """
        with self._write() as tx:
            now = self.clock.now()
            actions = [self._action(name) for name in situation.required_actions]
            designs = [self._design(name) for name in situation.selected_designs]
            configurations = [self._configuration(name) for name in situation.selected_configurations]
            active = [self._component(name) for name in situation.active_components]
            failed = [self._component(name) for name in situation.failed_components]
            measured = [
                (self._measure(name), finite(value, f"a measurement of {name}"))
                for name, value in situation.measurements.items()
            ]
            for action in actions:
                self._state.require(tx, action)
            for design in designs:
                self._state.select_design(tx, design, True)
            for configuration in configurations:
                self._state.select_configuration(tx, configuration, True)
            for component in active:
                self._state.set_active(tx, component, True)
            for component in failed:
                self._state.set_failure(tx, component, now)
            for measure, value in measured:
                self._state.measure(tx, measure, value, now)

    @contextmanager
    def supposing(self, situation: Situation) -> Iterator[None]:
        """Inside the block, questions are answered as if these facts held; then everything is as it was.

        Nothing of it is announced, journalled or remembered, and neither is what the block itself writes. Other threads
        wait meanwhile.

        Raises:
            UnknownElementError, InvalidValueError: as the single writes do.
        """
        try:
            with self.transaction():
                self.suppose(situation)
                yield
                raise _TakeBackError
        except _TakeBackError:
            pass

    # -- knowledge that grows --

    def add_elements(self, *elements: Element) -> None:
        """Add elements and relations to the model, behind those that it has.

        The cost is that of loading the model, whatever the number of elements: add those that belong together at once.

        Raises:
            KnowledgeChangeRefusedError: for dangling or double names, and whatever else makes a model file refused.
        """
        with self._write() as tx:
            growth.add_elements(self._state, tx, elements)

    def remove_elements(self, *elements: Element | ElementRef) -> None:
        """Remove elements and relations from the model; those that have a name may be given by reference.

        A selected design or configuration is unselected by it, a pending plan that names something removed abandoned,
        and the measurements and failures of what is removed are forgotten. To change an element, remove it and add it
        anew in one transaction. The cost is that of loading the model.

        Raises:
            KnowledgeChangeRefusedError: if there is no such element, if one that stays refers to it, or if it is a
                required action, its preference, or an active component.
        """
        with self._write() as tx:
            growth.remove_elements(self._state, tx, elements)


class _TakeBackError(Exception):
    """Takes back what was only supposed."""
