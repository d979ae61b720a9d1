"""``rosa journal``: what a knowledge base has written, for people and for other programs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from rosa_core import Retention
from rosa_core.journal.codec import fact_document
from rosa_core.journal.journal import compact_journal
from rosa_core.journal.tables import JOURNAL, JournalledWrite, JournalReader
from rosa_core.model.changes import describe
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
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction


def show_journal(file: Path, limit: int | None) -> None:
    """Print one line for each write."""
    for write in _writes(file, limit):
        changes = "; ".join(_describe_write(write)) or "no change"
        print(f"#{write.revision:<7} {write.time:12.3f} s  {changes}")


def export_journal(file: Path) -> None:
    """Print one JSON object for each write."""
    for write in _writes(file, None):
        document = {
            "sequence": write.sequence,
            "revision": write.revision,
            "time": write.time,
            "facts": [fact_document(fact) for fact in write.facts],
            "statuses": [
                {"kind": change.kind, "name": change.name, "old": change.old, "new": change.new}
                for change in write.statuses
            ],
        }
        print(json.dumps(document, ensure_ascii=False))


def compact(file: Path, keep_writes: int | None, keep_seconds: float | None) -> None:
    """Let writes go, and say how many."""
    given = None if keep_writes is None and keep_seconds is None else Retention(keep_writes, keep_seconds)
    size = file.stat().st_size if file.is_file() else 0
    before, left = compact_journal(file, given)
    print(f"{left} of {before} writes kept, {size / 1e6:.1f} MB before, {file.stat().st_size / 1e6:.1f} MB now")


def _writes(file: Path, limit: int | None) -> Iterator[JournalledWrite]:
    with JournalReader(file) as reader, JOURNAL.accessing(file):
        _, last = reader.range()
        yield from reader.writes(after=0 if limit is None else last - limit)


def _describe_write(write: JournalledWrite) -> Iterator[str]:
    for fact in write.facts:
        yield _describe_fact(fact)
    for change in write.statuses:
        yield f"{change.name}: {change.old} -> {change.new}"


def _describe_fact(fact: Fact) -> str:
    match fact:
        case Measurement(measure, value, time):
            return f"{measure} measured {value:g} at {time:.3f} s"
        case RequiredAction(action, preference=preference, result=None):
            return f"{action} requested" + (f" with preference {preference}" if preference else "")
        case RequiredAction(action, result=result):
            return f"{action} {result}"
        case ComponentFailure(component, since):
            return f"{component} works again" if since is None else f"{component} failed at {since:.3f} s"
        case ComponentActive(component, active):
            return f"{component} {'active' if active else 'inactive'}"
        case Selection(_, name, selected):
            return f"{name} {'selected' if selected else 'unselected'}"
        case ConfigurationApplied(configuration, applied):
            return f"{configuration} {'applied' if applied else 'not applied'}"
        case ModelChange(added, removed):
            parts = [f"{describe(element)} added" for element in added]
            return ", ".join([*parts, *(f"{describe(element)} removed" for element in removed)])
        case _:
            return _describe_plan(fact)


def _describe_plan(fact: PendingPlan | PlanEnded | FailedPlan | PlanCount) -> str:
    match fact:
        case PendingPlan(plan):
            return f"plan {plan.id} made ({_steps(plan)})"
        case PlanEnded(plan, result):
            return f"plan {plan.id} {result}"
        case FailedPlan(plan):
            return "failed work may be tried again" if plan is None else f"plan {plan.id} not to be tried again"
        case PlanCount(count):
            return f"{count} plans made so far"


def _steps(plan: ReconfigurationPlan) -> str:
    steps = (("activate", plan.activate), ("deactivate", plan.deactivate), ("set", plan.parameter_adaptations))
    return "; ".join(f"{what} {', '.join(names)}" for what, names in steps if names)
