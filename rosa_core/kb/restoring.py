"""How a knowledge base is restored from its journal: the journal gives the facts, and they are applied in order."""

from __future__ import annotations

from os import PathLike

from rosa_core.clock import Clock
from rosa_core.errors import KnowledgeModelError
from rosa_core.journal.journal import Journal
from rosa_core.journal.options import JournalOptions
from rosa_core.kb.growth import change_model
from rosa_core.kb.history import History
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import Transaction
from rosa_core.model.elements import ElementKind
from rosa_core.model.facts import (
    ComponentActive,
    ComponentFailure,
    ConfigurationApplied,
    Fact,
    FailedPlan,
    ModelChange,
    PendingPlan,
    PlanCount,
    PlanEnded,
    Selection,
)
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.records import TOPICS, Measurement, RequiredAction


def open_journal(
    path: str | PathLike[str], model: KnowledgeModel, options: JournalOptions, clock: Clock, history: History
) -> tuple[Journal, RuntimeState, int]:
    """Open a journal for writing, and restore what is in it: the state, the revision, and the history.

    Args:
        path: of the journal, made if it is not there.
        model: that the journal must begin with.
        options: how to keep it.
        clock: of the restored state.
        history: filled with the journal's latest entries.

    Returns:
        the journal, open for writing; the state after its last write, inferred; and the number of that write.

    Raises:
        JournalError: if the file is no journal, damaged, of another model, in use, or cannot be opened.
    """
    journal = Journal(path, model, options)
    try:
        last = journal.last_state(model)
        state = RuntimeState(last.model, clock)
        try:
            for fact in last.facts:
                apply(state, Transaction(), fact)
        except (LookupError, KnowledgeModelError) as error:
            raise journal.damaged(f"a fact does not fit the model: {error}") from None
        state.reasoner.infer()
        state.reasoner.changes.clear()
        for topic in TOPICS:
            history.restore(topic, journal.entries(topic, None, history.length))
    except BaseException:
        journal.release()
        raise
    return journal, state, last.revision


def apply(state: RuntimeState, tx: Transaction, fact: Fact) -> None:
    """Apply a fact to a state, by the step of the write that it came from.

    Args:
        state: changed in place; what follows is not inferred.
        tx: in which it is written.
        fact: as a transaction recorded it; those of one write in their order.

    Raises:
        LookupError: if it names something that the model does not have.
        KnowledgeModelError: if it changes the model in a way that does not hold together.
    """
    reasoner = state.reasoner
    match fact:
        case Measurement(measure, value, time):
            state.measure(tx, reasoner.measures[measure], value, time)
        case RequiredAction(action):
            state.set_required(tx, reasoner.actions[action], fact)
        case ComponentFailure(component, since):
            state.set_failure(tx, reasoner.components[component], since)
        case ComponentActive(component, active):
            state.set_active(tx, reasoner.components[component], active)
        case Selection(ElementKind.FUNCTION_DESIGN, name, selected):
            state.select_design(tx, reasoner.designs[name], selected)
        case Selection(_, name, selected):
            state.select_configuration(tx, reasoner.configurations[name], selected)
        case ConfigurationApplied(configuration, applied):
            state.set_applied(tx, reasoner.configurations[configuration], applied)
        case _:
            _apply_to_plans_or_model(state, tx, fact)


def _apply_to_plans_or_model(
    state: RuntimeState, tx: Transaction, fact: PendingPlan | PlanEnded | FailedPlan | PlanCount | ModelChange
) -> None:
    match fact:
        case PendingPlan(plan):
            state.set_pending_plan(tx, plan)
        case PlanEnded():
            state.set_pending_plan(tx, None)
        case FailedPlan(plan):
            state.note_failed_plan(tx, plan)
        case PlanCount(count):
            state.plans_made = count
        case ModelChange(added, removed):
            change_model(state, tx, added, removed)
