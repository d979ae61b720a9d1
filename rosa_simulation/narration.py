"""Describes to a narrator what happens to a robot and what its monitors publish."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from rosa_core.mape.diagnostics import DiagnosticArray, values_of
from rosa_simulation.narrator import Narrator
from rosa_simulation.robot import SimulatedRobot
from rosa_simulation.robot_event import RobotEvent

EventText: TypeAlias = Callable[[RobotEvent], str | None]
"""An event in words; None: it stays a fact for programs."""


def kind_and_subject(event: RobotEvent) -> str | None:
    """The subject and what happened to it, such as ``pump_node activated``."""
    return f"{event.subject} {event.kind.value}".strip()


def no_details(_: RobotEvent) -> Mapping[str, Any]:
    """An event of which there are no facts but its kind and subject."""
    return {}


def narrate(
    robot: SimulatedRobot,
    narrator: Narrator,
    causes: Mapping[Any, str],
    *,
    effects: EventText = kind_and_subject,
    details: Callable[[RobotEvent], Mapping[str, Any]] = no_details,
    measurements: Mapping[str, str] | None = None,
) -> None:
    """Describe everything that happens to a robot from now on.

    What a node does is described with the cause of the call that made it do so. A periodic measurement from which
    nothing follows gets into no event.

    Args:
        robot: whose events, calls and diagnostics are observed.
        narrator: makes the events of the run record.
        causes: the kinds of event that are causes, each with its words; ``{}`` stands for the subject, and the names of
            ``details`` may be used in the same way.
        effects: the words for all other events.
        details: more facts about an event.
        measurements: the words for the measures that are monitored, with ``{}`` for the value as a number; None: the
            diagnostics are not recorded.
    """

    def on_event(event: RobotEvent) -> None:
        more = details(event)
        facts = {**({"subject": event.subject} if event.subject else {}), **more}
        if event.kind in causes:
            narrator.cause(causes[event.kind].format(event.subject, **more))
            narrator.fact(event.kind.value, None, **facts)
            return
        text = effects(event)
        if text is not None:
            narrator.effect(text, event.subject)
        narrator.fact(event.kind.value, event.subject, **facts)

    robot.on_event.append(on_event)
    robot.on_call.append(narrator.call)
    if measurements is not None:
        robot.on_diagnostics.append(_diagnostics(narrator, measurements))


def _diagnostics(narrator: Narrator, measurements: Mapping[str, str]) -> Callable[[DiagnosticArray], None]:
    def on_diagnostics(array: DiagnosticArray) -> None:
        for key, value, message in values_of(array):
            if key in measurements:
                narrator.measurement(measurements[key].format(float(value)))
            narrator.fact("diagnostic", key=key, value=value, message=message)

    return on_diagnostics
