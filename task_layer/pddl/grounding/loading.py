"""Planning tasks from PDDL files: read, then grounded."""

from __future__ import annotations

from collections.abc import Collection
from os import PathLike

from rosa_core.formats.text_source import read_text
from task_layer.pddl.grounding.ground_task import GroundTask

FEASIBILITY_PREDICATE = "action_feasible"
"""The predicate of the ROSA paper's listing 4."""


def load_task(
    domain: str | PathLike[str],
    problem: str | PathLike[str],
    *,
    feasibility_predicate: str = FEASIBILITY_PREDICATE,
    sensed: Collection[str] = (),
) -> GroundTask:
    """Read a domain and a problem, and ground them.

    The files need not be made for this: durative or plain actions, an empty ``(:functions )``, objects with the names
    of actions, upper case, dots and hyphens in names are all right. Of durative actions the at-start, over-all and
    at-end conditions and effects are kept. Action costs are left out: plans are short, not cheap.

    Args:
        domain: the domain's file.
        problem: the problem's file.
        feasibility_predicate: the predicate with which the domain asks whether an action is feasible; a domain need not
            have it.
        sensed: predicates that are known from elsewhere than from the actions' effects, if the domain has them.

    Returns:
        the task without variables.

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
    """The same as :func:`load_task` from text.

    Args:
        domain: the domain.
        problem: the problem.
        feasibility_predicate: as in :func:`load_task`.
        sensed: as in :func:`load_task`.
        domain_file: what errors call the domain.
        problem_file: what errors call the problem.

    Returns:
        the task without variables.

    Raises:
        InputError: with file, line and hint for each thing that is wrong.

    Example:
        >>> task = parse_task(
        ...     "(define (domain d) (:predicates (there)) (:action go :parameters () :effect (there)))",
        ...     "(define (problem p) (:domain d) (:init) (:goal (there)))",
        ... )
        >>> task.facts, [operator.name for operator in task.operators]
        (('(there)',), ['(go)'])
    """
    # unified-planning takes a third of a second to import, which only those who plan should wait for.
    from task_layer.pddl.grounding.grounder import ground
    from task_layer.pddl.reading.problem import read_problem

    as_read = read_problem(domain, problem, domain_file=domain_file, problem_file=problem_file)
    return ground(
        as_read.problem,
        changing=[as_read.plain(predicate) for predicate in sensed],
        feasibility=as_read.plain(feasibility_predicate),
        written=as_read.names.written,
        where=lambda action: as_read.goal if action is None else as_read.actions[action],
    )
