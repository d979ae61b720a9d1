"""PDDL domains and problems, read as people have them into a problem of unified-planning."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from task_layer.pddl.reading.checks import check
from task_layer.pddl.reading.sections import ACTIONS, domain_in_order, problem_in_order
from task_layer.pddl.reading.source import Form, PlainNames, Symbol, parse_forms, render


@dataclass(frozen=True, slots=True)
class ProblemRead:
    """A domain and a problem in unified-planning, and where in the files things are.

    Attributes:
        problem: the ``unified_planning.model.Problem``, whose names are plain.
        names: the plain names, and those of the files.
        goal: where the goal is.
        actions: where the actions are, by their plain names.
    """

    problem: Any
    names: PlainNames
    goal: Location
    actions: dict[str, Location]

    def plain(self, name: str) -> str:
        """The plain name for a name as files have it."""
        return self.names.plain(Symbol(name, 0))


def read_problem(
    domain: str, problem: str, *, domain_file: str = "domain", problem_file: str = "problem"
) -> ProblemRead:
    """Read the text of a domain and of a problem.

    Args:
        domain: the domain.
        problem: the problem.
        domain_file: what errors call the domain.
        problem_file: what errors call the problem.

    Raises:
        InputError: with file, line and hint for each thing that is wrong.
    """
    domain_form = parse_forms(domain.lstrip("\ufeff"), domain_file)
    problem_form = parse_forms(problem.lstrip("\ufeff"), problem_file)
    problems = check(domain_form, domain_file, problem_form, problem_file)
    if problems:
        raise InputError(problems)
    names = PlainNames()
    parsed = _read(domain_form, domain_file, problem_form, problem_file, names)
    goal = next(form.line for form in problem_form.forms if form.head == ":goal")
    actions = {
        names.plain(form.items[1]): Location(domain_file, form.line)
        for form in domain_form.forms
        if form.head in ACTIONS and isinstance(form.items[1], Symbol)
    }
    return ProblemRead(parsed, names, Location(problem_file, goal), actions)


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
    message = what[0] if what else type(error).__name__
    line = getattr(error, "lineno", None)
    where = Location(file, line if isinstance(line, int) else None)
    return Problem(f"it cannot be read: {message}", where, "see docs/pddl.md for what is supported")
