"""``rosa plan``: a plan for a PDDL problem, with the actions that are feasible."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
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

EXIT_NO_PLAN = 1
EXIT_PLANNER_FAILED = 3


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
    """What may have been forgotten, if there is no plan."""


@dataclass(frozen=True, slots=True)
class PlanOutput:
    """How the plan is to be told."""

    as_json: bool = False
    as_dot: bool = False
    tree: Path | None = None


def show_plan(
    domain: Path,
    problem: Path,
    feasibility: Callable[[GroundTask], Feasibility],
    *,
    engine: str,
    timeout: float | None,
    parallel: bool,
    output: PlanOutput,
) -> int:
    """Plan, and print the plan or why there is none.

    Returns:
        the exit code: 0 with a plan, 1 if there is none, 3 if the planner failed or ran out of time.
    """
    if output.as_json and output.as_dot:
        raise InputError(Problem("--json and --dot exclude each other", hint="leave one of them out"))
    task = load_task(domain, problem)
    feasible = feasibility(task)
    state = task.initial & ~sum(task.feasibility.values()) | feasible.facts
    try:
        with Planner(task, engine=engine, timeout=timeout, parallel=parallel) as planner:
            planned = planner.plan(state, feasible.excluded, feasible.obstacles)
    except PlannerFailedError as error:
        if output.as_json:
            _print_json({"plan": None, "planner_failed": str(error), "engine": engine})
        print(f"rosa: {error}", file=sys.stderr)
        return EXIT_PLANNER_FAILED
    if planned.plan is not None and output.tree is not None:
        _write_tree(output.tree, plan_tree(planned.plan, feasible.actions))
    if output.as_json:
        _print_json(_document(planned, feasible, engine))
    elif output.as_dot and planned.plan is not None:
        print(plan_dot(planned.plan), end="")
    else:
        _print_for_people(planned, feasible, engine)
    return EXIT_NO_PLAN if planned.plan is None else 0


def choose_feasibility(
    feasible: str | None, models: list[Path] | None, more: list[Path], measures: list[str], failed: list[str]
) -> Callable[[GroundTask], Feasibility]:
    """Where it is known what is feasible: on the command line, in knowledge models, or in the problem file.

    Raises:
        InputError: if the options do not fit together.
    """
    if feasible is not None and models is not None:
        raise InputError(Problem("--feasible and --model exclude each other", hint="leave one of them out"))
    if models is not None:
        return feasible_in_model([*models, *more], measures, failed)
    if more:
        what = f"there is one domain and one problem; '{more[0]}' is one file too many"
        raise InputError(Problem(what, hint="knowledge models come after --model"))
    if measures or failed:
        option = "--measure" if measures else "--failed"
        raise InputError(Problem(f"{option} needs a knowledge model", hint="name it with --model"))
    return feasible_as_stated if feasible is None else feasible_by_name(feasible)


def feasible_as_stated(task: GroundTask) -> Feasibility:
    """What the problem file says is feasible."""
    stated = task.initial & sum(task.feasibility.values())
    hint = "" if stated else "the problem file calls no action feasible: say which are with --feasible or --model"
    return replace(_stated(task, stated), hint=hint)


def feasible_by_name(names: str) -> Callable[[GroundTask], Feasibility]:
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


def feasible_in_model(
    models: list[Path], measures: list[str], failed: list[str]
) -> Callable[[GroundTask], Feasibility]:
    """What knowledge models say is feasible in a situation."""
    from rosa_cli.model_commands import Supposed, suppose

    kb = suppose(models, Supposed(measures, failed, None, None, None))

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
        hint = "name another file with --bt"
        raise InputError(Problem(f"cannot write it: {error.strerror}", Location(str(path)), hint)) from None


def _print_json(document: dict[str, Any]) -> None:
    print(json.dumps(document, indent=2, ensure_ascii=False))
