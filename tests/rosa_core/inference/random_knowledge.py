"""Hypothesis strategies: random models of robots, and random writes to a knowledge base of one."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hypothesis import strategies as st

from rosa_core import ElementKind, KnowledgeBase, KnowledgeBaseError, KnowledgeModel, Situation
from rosa_core.kb import Result
from rosa_core.model.elements import (
    CONSTRAINABLE,
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ConstraintOperator,
    ElementRef,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)

LIMITS = (-1.0, 0.0, 0.5, 1.0, 2.0)
"""Few values, so that measurements often tie with limits."""
NOW = 5.0
"""Some of the random measurements are older than this, some newer."""


def _names(letter: str, at_least: int, at_most: int) -> st.SearchStrategy[list[str]]:
    return st.integers(at_least, at_most).map(lambda count: [f"{letter}{number}" for number in range(count)])


@st.composite
def models(draw: Callable[..., Any]) -> KnowledgeModel:
    """Robots of a few to some dozen elements, with shared components, functions without designs, idle components."""
    measures, actions = draw(_names("m", 1, 2)), draw(_names("a", 1, 4))
    functions, components = draw(_names("f", 1, 4)), draw(_names("c", 1, 6))
    designs, configurations = draw(_names("d", 0, 9)), draw(_names("k", 0, 9))
    some_functions = st.lists(st.sampled_from(functions), min_size=1, max_size=3, unique=True)
    some_components = st.lists(st.sampled_from(components), min_size=1, max_size=3, unique=True)
    priorities = st.none() | st.integers(1, 3).map(float)
    constrainable = [
        ElementRef(kind, name)
        for kind, names in (
            (ElementKind.ACTION, actions),
            (ElementKind.COMPONENT, components),
            (ElementKind.FUNCTION_DESIGN, designs),
            (ElementKind.COMPONENT_CONFIGURATION, configurations),
        )
        for name in names
    ]
    assert {ref.kind for ref in constrainable} <= CONSTRAINABLE
    constraint = st.builds(
        Constraint,
        st.sampled_from(measures),
        st.sampled_from(constrainable),
        st.sampled_from(ConstraintOperator),
        st.sampled_from((*LIMITS, None)),
    )
    return KnowledgeModel(
        measures=tuple(map(Measure, measures)),
        actions=tuple(map(Action, actions)),
        functions=tuple(Function(name, draw(st.booleans())) for name in functions),
        components=tuple(Component(name, always_improve=draw(st.booleans())) for name in components),
        requirements=tuple(
            FunctionalRequirement(name, tuple(draw(some_functions))) for name in actions if draw(st.integers(0, 3))
        ),
        function_designs=tuple(
            FunctionDesign(name, draw(st.sampled_from(functions)), tuple(draw(some_components)), draw(priorities))
            for name in designs
        ),
        component_configurations=tuple(
            ComponentConfiguration(name, draw(st.sampled_from(components)), (), draw(priorities))
            for name in configurations
        ),
        constraints=tuple(draw(st.lists(constraint, min_size=2, max_size=10, unique=True))),
    )


@dataclass(frozen=True)
class Write:
    """One write by name; ``parts`` are the writes of a transaction, which may end by an exception."""

    what: str
    arguments: tuple[Any, ...] = ()
    parts: tuple[Write, ...] = ()
    rolled_back: bool = False


def single_writes(model: KnowledgeModel) -> st.SearchStrategy[Write]:
    """One write with mostly known names; many will be refused, or change nothing."""

    def some(kind: ElementKind) -> st.SearchStrategy[list[str]]:
        names = model.names[kind]
        return st.lists(st.sampled_from(names), max_size=3, unique=True) if names else st.just([])

    def write(what: str, *arguments: st.SearchStrategy[Any]) -> st.SearchStrategy[Write]:
        return st.tuples(*arguments).map(lambda drawn: Write(what, drawn))

    measure = st.sampled_from(model.names[ElementKind.MEASURE])
    action = st.sampled_from((*model.names[ElementKind.ACTION], "unknown"))
    component = st.sampled_from((*model.names[ElementKind.COMPONENT], "unknown"))
    value = st.sampled_from((*LIMITS, *LIMITS, *LIMITS, 0.4999, 1.0001, -0.0, math.nan, math.inf, 9.0, -9.0))
    time = st.sampled_from((NOW, NOW, NOW, NOW, NOW - 1, NOW + 1))
    situation = st.builds(
        Situation,
        st.dictionaries(measure, st.sampled_from(LIMITS), max_size=2),
        some(ElementKind.COMPONENT).map(tuple),
        some(ElementKind.ACTION).map(tuple),
        some(ElementKind.FUNCTION_DESIGN).map(tuple),
        some(ElementKind.COMPONENT_CONFIGURATION).map(tuple),
        some(ElementKind.COMPONENT).map(tuple),
    )
    return st.one_of(
        write("add_measurement", measure, value, time),
        write("add_measurement", measure, value, time),
        write("set_component_failure", component),
        write("clear_component_failure", component),
        write("set_component_active", component, st.booleans()),
        write("request_action", action),
        write("request_action", action),
        write("cancel_action", action),
        write("finish_action", action, st.sampled_from(["completed", "failed"])),
        write("select_configuration", some(ElementKind.FUNCTION_DESIGN), some(ElementKind.COMPONENT_CONFIGURATION)),
        write("select_configuration", some(ElementKind.FUNCTION_DESIGN), some(ElementKind.COMPONENT_CONFIGURATION)),
        write("end_plan", st.sampled_from(Result)),
        write("suppose", situation),
    )


def writes(model: KnowledgeModel) -> st.SearchStrategy[Write]:
    """A single write, or a transaction of several that is committed or rolled back."""
    single = single_writes(model)
    several = st.lists(single, min_size=1, max_size=5).map(tuple)
    transaction = st.builds(lambda parts, undone: Write("transaction", (), parts, undone), several, st.booleans())
    return st.one_of(single, single, transaction)


@st.composite
def scenarios(draw: Callable[..., Any]) -> tuple[KnowledgeModel, list[Write]]:
    """A model and what is written."""
    model = draw(models())
    return model, draw(st.lists(writes(model), min_size=5, max_size=30))


class AbortedError(Exception):
    """What rolls a transaction back."""


def write_to_kb(kb: KnowledgeBase, write: Write) -> type[Exception] | None:
    """Do it, and say how it was refused."""
    try:
        if write.what == "transaction":
            with kb.transaction():
                for part in write.parts:
                    write_to_kb(kb, part)
                if write.rolled_back:
                    raise AbortedError
        elif write.what == "end_plan":
            plan = kb.pending_reconfiguration_plan()
            if plan is not None:
                kb.set_reconfiguration_result(plan, *write.arguments)
        else:
            getattr(kb, write.what)(*write.arguments)
    except (KnowledgeBaseError, AbortedError) as error:
        return type(error)
    return None
