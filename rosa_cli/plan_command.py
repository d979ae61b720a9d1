"""``rosa plan``: a plan for a PDDL problem, with the actions that are feasible."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rosa_cli.exit_codes import ExitCode
from rosa_cli.options import FeasibilityOptions, PlanOptions, SituationOptions
from rosa_cli.output import print_json
from rosa_core import InputError
from rosa_core.errors import Problem, nearest, unwritable
from task_layer.pddl import (
    FeasibilityBridge,
    GroundTask,
    Operator,
    Planner,
    PlannerAnswer,
    PlannerFailedError,
    load_task,
)
from task_layer.pddl.grounding.reachability import Obstacle
from task_layer.pddl.planning.export import plan_dot, plan_rows, plan_tree
from task_layer.pddl.reading.names import comparable


@dataclass(frozen=True, slots=True)
class Feasibility:
    """What is feasible: the facts that hold, the operators that cannot be used, and what is in the way of what.

    ``actions`` are the actions of the knowledge base that a step requests.
    """

    facts: int
    excluded: frozenset[int]
    obstacles: dict[str, Obstacle]
    actions: Callable[[Operator], tuple[str, ...]]
    hint: str = ""
    """What may be missing, if there is no plan."""


def show_plan(options: PlanOptions, feasibility: FeasibilityOptions) -> ExitCode:
    """Plan, and print the plan or why there is none.

    Raises:
        InputError: if the options do not fit together, or a file cannot be used.
    """
    if options.as_json and options.dot:
        raise InputError(Problem("--json and --dot exclude each other", hint="leave one of them out"))
    find_feasible = _choose_feasibility(feasibility)
    task = load_task(options.domain, options.problem)
    feasible = find_feasible(task)
    state = task.initial & ~sum(task.feasibility.values()) | feasible.facts
    try:
        with Planner(task, engine=options.engine, timeout=options.timeout, parallel=options.parallel) as planner:
            planned = planner.plan(state, feasible.excluded, feasible.obstacles)
    except PlannerFailedError as error:
        if options.as_json:
            print_json({"plan": None, "planner_failed": str(error), "engine": options.engine})
        print(f"rosa: {error}", file=sys.stderr)
        return ExitCode.PLANNER_FAILED
    if planned.plan is not None and options.bt is not None:
        _write_tree(options.bt, plan_tree(planned.plan, feasible.actions))
    if options.as_json:
        print_json(_document(planned, feasible, options.engine))
    elif options.dot and planned.plan is not None:
        print(plan_dot(planned.plan), end="")
    else:
        _print_for_people(planned, feasible, options.engine)
    return ExitCode.BROKE_OFF if planned.plan is None else ExitCode.DONE


def _choose_feasibility(options: FeasibilityOptions) -> Callable[[GroundTask], Feasibility]:
    """Where it is known what is feasible: on the command line, in knowledge models, or in the problem file."""
    if options.feasible is not None and options.model is not None:
        raise InputError(Problem("--feasible and --model exclude each other", hint="leave one of them out"))
    more = options.more_models or []
    if options.model is not None:
        return _feasible_in_model([*options.model, *more], SituationOptions(options.measure, options.failed))
    if more:
        what = f"there is one domain and one problem; '{more[0]}' is one file too many"
        raise InputError(Problem(what, hint="knowledge models come after --model"))
    if options.measure or options.failed:
        option = "--measure" if options.measure else "--failed"
        raise InputError(Problem(f"{option} needs a knowledge model", hint="name it with --model"))
    return _feasible_as_stated if options.feasible is None else _feasible_by_name(options.feasible)


def _feasible_as_stated(task: GroundTask) -> Feasibility:
    """What the problem file says is feasible."""
    stated = task.initial & sum(task.feasibility.values())
    hint = "" if stated else "the problem file calls no action feasible: say which are with --feasible or --model"
    return replace(_stated(task, stated), hint=hint)


def _feasible_by_name(names: str) -> Callable[[GroundTask], Feasibility]:
    """What ``--feasible a,b`` says is feasible; every other action is not."""
    listed = [name for name in (part.strip() for part in names.split(",")) if name]

    def read(task: GroundTask) -> Feasibility:
        if not task.feasibility:
            hint = "leave --feasible out, or add (action_feasible ?a) to its conditions"
            raise InputError(Problem("the domain does not ask which actions are feasible", hint=hint))
        known = {comparable(name): bit for name, bit in task.feasibility.items()}
        problems = [
            Problem(f"--feasible {name}: there is no such action", hint=nearest(name, task.feasibility) or _known(task))
            for name in listed
            if comparable(name) not in known
        ]
        if problems:
            raise InputError(problems)
        return _stated(task, sum({known[comparable(name)] for name in listed}))

    return read


def _feasible_in_model(models: list[Path], situation: SituationOptions) -> Callable[[GroundTask], Feasibility]:
    """What knowledge models say is feasible in a situation."""
    from rosa_cli.model_commands import load_knowledge_base

    kb = load_knowledge_base(models, situation)

    def ask(task: GroundTask) -> Feasibility:
        bridge = FeasibilityBridge(kb, task)
        return Feasibility(bridge.feasible(), bridge.excluded(), bridge.obstacles(), bridge.actions)

    return ask


def _stated(task: GroundTask, facts: int) -> Feasibility:
    obstacles = {name: Obstacle(facts=bit) for name, bit in task.feasibility.items() if not bit & facts}

    def actions(operator: Operator) -> tuple[str, ...]:
        return tuple(name for name, bit in task.feasibility.items() if bit & operator.feasibility)

    return Feasibility(facts, frozenset(), obstacles, actions)


def _known(task: GroundTask) -> str:
    return f"there are: {', '.join(task.feasibility)}"


def _document(planned: PlannerAnswer, feasible: Feasibility, engine: str) -> dict[str, Any]:
    document: dict[str, Any] = {
        "plan": None,
        "unfeasible": list(feasible.obstacles),
        "engine": engine,
        "planning_s": planned.cost_s,
    }
    if planned.plan is not None:
        document["plan"] = [
            {
                "action": step.operator.action,
                "arguments": list(step.operator.arguments),
                "requests": list(feasible.actions(step.operator)),
                "start_s": step.start,
                "duration_s": step.operator.duration,
                "after": sorted(before),
            }
            for step, before in zip(planned.plan.steps, planned.plan.after_ends, strict=True)
        ]
        document["duration_s"] = planned.plan.duration
    if planned.no_plan is not None:
        document["no_plan"] = {
            "reason": str(planned.no_plan),
            "unreachable_goals": list(planned.no_plan.goals),
            "in_the_way": list(planned.no_plan.obstacles),
            "never_true": list(planned.no_plan.never),
        }
    return document


def _print_for_people(planned: PlannerAnswer, feasible: Feasibility, engine: str) -> None:
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False)
    if planned.no_plan is not None:
        console.print(Text(f"no plan: {planned.no_plan}"), soft_wrap=True)
        if feasible.obstacles:
            console.print(Text(f"unfeasible: {', '.join(feasible.obstacles)}"), soft_wrap=True)
            if feasible.hint:
                print(f"rosa: {feasible.hint}", file=sys.stderr)
    if planned.plan is None:
        return
    if not planned.plan.steps:
        console.print("the goal is already reached: there is nothing to do")
        return
    rows = list(plan_rows(planned.plan))
    width = max(len(name) for _, name, _, _ in rows)
    timed = planned.plan.duration > 0
    for start, name, duration, bar in rows:
        line = Text(f"{start:8.2f} s  {duration:7.2f} s  ") if timed else Text()
        console.print(line.append(f"{name:{width}}").append(f"  {bar}" if timed else "", "cyan"), soft_wrap=True)
    console.print(Text(f"{len(planned.plan)} steps, planned by {engine} in {planned.cost_s * 1e3:.1f} ms"))


def _write_tree(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise unwritable(path, error, "name another file with --bt") from None
