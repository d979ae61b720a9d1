"""The sections of PDDL files: which there are, and in which order the reader expects them."""

from __future__ import annotations

from collections.abc import Sequence

from task_layer.pddl.reading.source import Form, Symbol

DOMAIN_SECTIONS = (
    ":requirements",
    ":types",
    ":constants",
    ":predicates",
    ":functions",
    ":action",
    ":durative-action",
)
PROBLEM_SECTIONS = (":domain", ":requirements", ":objects", ":init", ":goal", ":metric")
ACTIONS = (":action", ":durative-action")
ACTION_PARTS = {
    ":action": (":parameters", ":precondition", ":effect"),
    ":durative-action": (":parameters", ":duration", ":condition", ":effect"),
}

_MAY_BE_EMPTY = (":init", ":goal")


def domain_in_order(domain: Form) -> Form:
    """The domain with its sections, and the parts of its actions, in the order expected, without empty sections."""
    sections = _sorted(domain, DOMAIN_SECTIONS[: DOMAIN_SECTIONS.index(":action")])
    ordered = [_action_in_order(section) if section.head in ACTIONS else section for section in sections]
    return Form(domain.line, [*domain.items[:2], *ordered])


def problem_in_order(problem: Form) -> Form:
    """The problem with its sections in the order expected, without empty ones.

    What a plan costs is left out: it may be written in terms that the reader does not know.
    """
    sections = [section for section in _sorted(problem, PROBLEM_SECTIONS) if section.head != ":metric"]
    return Form(problem.line, [*problem.items[:2], *sections])


def _sorted(form: Form, order: Sequence[str]) -> list[Form]:
    """Sections that are not in ``order`` come last, in the order of the file."""
    sections = [section for section in list(form.forms)[1:] if len(section.items) > 1 or section.head in _MAY_BE_EMPTY]
    return sorted(sections, key=lambda section: order.index(section.head) if section.head in order else len(order))


def _action_in_order(action: Form) -> Form:
    ordered = list(action.items[:2])
    for keyword in ACTION_PARTS[action.head]:
        part = action.after(keyword)
        if part is not None:
            ordered += [Symbol(keyword, part.line), part]
    return Form(action.line, ordered)
