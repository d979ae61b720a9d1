"""PDDL domains and problems, read from files as people have them."""

from __future__ import annotations

import warnings
from collections.abc import Collection
from os import PathLike
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.formats.text_source import read_text
from task_layer.pddl.grounding.ground_task import GroundTask
from task_layer.pddl.reading.checks import check
from task_layer.pddl.reading.sections import domain_in_order, problem_in_order
from task_layer.pddl.reading.source import Form, PlainNames, Symbol, parse_forms, render

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
        InputError: with file, line and hint for each thing that is wrong.
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
    from task_layer.pddl.grounding.grounder import ground

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
    domain_text = render(domain_in_order(domain), names)
    problem_text = render(problem_in_order(problem), names)
    try:
        return _parse(domain_text, problem_text)
    except RecursionError:
        raise InputError(Problem("its conditions are nested too deeply", Location(domain_file))) from None
    except Exception as error:
        # Whatever the reader raises, be it an assertion, is about the files: all else has been checked.
        file = problem_file if _is_readable(domain_text) else domain_file
        raise InputError(_reader_problem(error, file)) from None


def _parse(domain_text: str, problem_text: str | None) -> Any:
    from unified_planning.environment import get_environment
    from unified_planning.io.pddl_reader import PDDLReader

    # With an environment of its own the reader fails on effects with forall: their variables are of the global one.
    environment = get_environment()
    before = environment.error_used_name
    environment.error_used_name = False
    try:
        with warnings.catch_warnings():
            # It warns of objects that are named like actions, which are what the paper's domains have.
            warnings.simplefilter("ignore")
            return PDDLReader(environment).parse_problem_string(domain_text, problem_text)
    finally:
        environment.error_used_name = before


def _is_readable(domain_text: str) -> bool:
    try:
        _parse(domain_text, None)
    except Exception:
        return False
    return True


def _reader_problem(error: Exception, file: str) -> Problem:
    what = str(error).strip().splitlines()
    told = what[0] if what else type(error).__name__
    line = getattr(error, "lineno", None)
    where = Location(file, line if isinstance(line, int) else None)
    return Problem(f"it cannot be read: {told}", where, "see docs/pddl.md for what is supported")
