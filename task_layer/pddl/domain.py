"""PDDL domains and problems, read from files as people have them."""

from __future__ import annotations

import warnings
from collections.abc import Collection
from os import PathLike
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.text_source import read_text
from task_layer.pddl.checks import DOMAIN_SECTIONS, check
from task_layer.pddl.ground import GroundTask
from task_layer.pddl.source import Form, PlainNames, Symbol, parse_forms, render

FEASIBILITY_PREDICATE = "action_feasible"
"""The predicate of the ROSA paper's listing 4."""


def load_task(
    domain: str | PathLike[str],
    problem: str | PathLike[str],
    *,
    feasibility_predicate: str = FEASIBILITY_PREDICATE,
    sensed: Collection[str] = (),
) -> GroundTask:
    """Read a domain and a problem.

    The files need not be made for this: durative or plain actions, an empty ``(:functions )``, objects with the names
    of actions, upper case, dots and hyphens in names are all right. Of durative actions the at-start, over-all and
    at-end conditions and effects are kept. Action costs are left out: plans are short, not cheap.

    Args:
        domain: the domain's file.
        problem: the problem's file.
        feasibility_predicate: the predicate with which the domain asks whether an action is feasible; a domain need not
            have it.
        sensed: predicates that are known from elsewhere than from the actions' effects, if the domain has them.

    Raises:
        InputError: with file, line and mend for each thing that is wrong.
    """
    return parse_task(
        read_text(domain),
        read_text(problem),
        feasibility_predicate=feasibility_predicate,
        sensed=sensed,
        domain_file=str(domain),
        problem_file=str(problem),
    )


def parse_task(
    domain: str,
    problem: str,
    *,
    feasibility_predicate: str = FEASIBILITY_PREDICATE,
    sensed: Collection[str] = (),
    domain_file: str = "domain",
    problem_file: str = "problem",
) -> GroundTask:
    """The same from text; ``domain_file`` and ``problem_file`` are named in errors."""
    # The reader takes a third of a second to import, which only those who plan should wait for.
    from task_layer.pddl.grounding import ground

    domain_form, problem_form = (
        parse_forms(domain.lstrip("\ufeff"), domain_file),
        parse_forms(problem.lstrip("\ufeff"), problem_file),
    )
    problems = check(domain_form, domain_file, problem_form, problem_file)
    if problems:
        raise InputError(problems)
    names = PlainNames()
    as_read = _read(domain_form, domain_file, problem_form, problem_file, names)
    lines = {
        names.plain(form.items[1]): form.line
        for form in domain_form.forms
        if form.head in (":action", ":durative-action") and isinstance(form.items[1], Symbol)
    }
    goal = next(form.line for form in problem_form.forms if form.head == ":goal")

    def where(action: str | None) -> Location:
        return Location(problem_file, goal) if action is None else Location(domain_file, lines.get(action))

    def plain(predicate: str) -> str:
        return names.plain(Symbol(predicate, 0))

    return ground(
        as_read,
        changing=[plain(predicate) for predicate in sensed],
        feasibility=plain(feasibility_predicate),
        written=names.written,
        where=where,
    )


def _read(domain: Form, domain_file: str, problem: Form, problem_file: str, names: PlainNames) -> Any:
    from unified_planning.environment import Environment
    from unified_planning.io.pddl_reader import PDDLReader

    domain_text, problem_text = render(_in_order(domain), names), render(problem, names)
    environment = Environment()
    environment.error_used_name = False
    environment.credits_stream = None
    try:
        with warnings.catch_warnings():
            # It warns of objects that are named like actions, which are what the paper's domains have.
            warnings.simplefilter("ignore")
            return PDDLReader(environment).parse_problem_string(domain_text, problem_text)
    except RecursionError:
        raise InputError(Problem("its conditions are nested too deeply", Location(domain_file))) from None
    except Exception as error:
        # Whatever the reader raises, be it an assertion, is about the files: all else has been checked.
        raise InputError(_reader_problem(error, domain_text, domain_file, problem_file)) from None


def _reader_problem(error: Exception, domain_text: str, domain_file: str, problem_file: str) -> Problem:
    what = str(error).strip().splitlines()
    told = what[0] if what else type(error).__name__
    line = getattr(error, "lineno", None)
    in_domain = getattr(error, "pstr", domain_text) == domain_text
    where = Location(domain_file if in_domain else problem_file, line if isinstance(line, int) else None)
    return Problem(f"it cannot be read: {told}", where, "see docs/pddl.md for what is supported")


def _in_order(domain: Form) -> Form:
    """The domain with its sections in the order that the reader expects, without empty ones."""
    name, *sections = domain.items[1:]
    kept = [
        section
        for section in sections
        if isinstance(section, Form) and (len(section.items) > 1 or section.head not in DOMAIN_SECTIONS[:5])
    ]

    def place(section: Form) -> int:
        return min(DOMAIN_SECTIONS.index(section.head), DOMAIN_SECTIONS.index(":action"))

    return Form(domain.line, [domain.items[0], name, *sorted(kept, key=place)])
