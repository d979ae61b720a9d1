"""The sub-commands of ``rosa streams``: specifications of streams checked, matched, planned and explained; formulas."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosa_cli.exit_codes import ExitCode
from rosa_cli.options import Json
from rosa_cli.output import print_json

if TYPE_CHECKING:
    from rosa_streams.planning import Plan
    from rosa_streams.specification import Specification

app = typer.Typer(
    help="Streams by meaning: check, match, plan and explain specifications; monitor recordings.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

SpecificationFiles = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILE...", help="Specifications (.xml, .yaml) and ontologies (.yaml, .ttl, .owl), in any order."
    ),
]
Searching = Annotated[str, typer.Option("--search", metavar="HOW", help="paper, fast or exact.")]
Horizon = Annotated[float | None, typer.Option(min=0.0, max=1e9, metavar="S", help="Seconds over which upkeep counts.")]
MaxCost = Annotated[float | None, typer.Option(min=0.0, metavar="C", help="The most that a plan may cost.")]
QualityWeight = Annotated[
    float | None, typer.Option(min=0.0, max=1e9, metavar="W", help="What a unit of a stream's quality is worth.")
]
Deadline = Annotated[float, typer.Option(min=0.01, max=86_400.0, metavar="S", help="Seconds that the search may take.")]


@app.command("check")
def check(files: SpecificationFiles, as_json: Json = False) -> None:
    """Validate specifications, and the units in them if there are any."""
    from rosa_streams.validity import violations

    specification = _load(files)
    environment = specification.environment
    found = violations(environment) if environment.units else ()
    if as_json:
        print_json({
            "transformations": len(environment.transformations),
            "targets": len(environment.targets),
            "units": len(environment.units),
            "violations": [{"kind": str(each.kind), "about": each.about, "reason": each.reason} for each in found],
            "notes": list(specification.notes),
        })  # fmt: skip
    else:
        counts = (
            f"{len(environment.transformations)} transformations, {len(environment.targets)} targets, "
            f"{len(environment.units)} units"
        )
        print(f"{counts}: {'valid' if not found else f'{len(found)} violations'}")
        for violation in found:
            print(f"  {violation.kind}: {violation}")
    if found:
        raise typer.Exit(ExitCode.BROKE_OFF)


@app.command("match")
def match(files: SpecificationFiles, as_json: Json = False) -> None:
    """Show which output may feed which input."""
    from rosa_streams.matching import ValidityMatrix

    environment = _load(files).environment
    matrix = ValidityMatrix.of(environment.library().values(), similarity=environment.similarity)
    pairs = sorted((str(output), str(into)) for output, into in matrix.pairs())
    if as_json:
        document = {
            "inputs": len(matrix.inputs),
            "outputs": len(matrix.outputs),
            "matches": [list(each) for each in pairs],
        }
        print_json(document)
        return
    print(f"{len(matrix.inputs)} inputs, {len(matrix.outputs)} outputs, {len(pairs)} matches")
    for output, into in pairs:
        print(f"  {output} -> {into}")
    for target in environment.goal().values():
        matrix.add_target(target)
        given = sorted(str(output) for output, into in matrix.pairs() if into == ("", target.qid))
        print(f"  target {target.qid}: {', '.join(given) or 'nothing matches'}")


@app.command("plan")
def plan_command(
    files: SpecificationFiles,
    search: Searching = "exact",
    horizon: Horizon = None,
    max_cost: MaxCost = None,
    quality_weight: QualityWeight = None,
    deadline: Deadline = 10.0,
    as_json: Json = False,
) -> None:
    """Find the units that give the targets their streams at least cost.

    Exit codes: 0 there is a plan, 1 there is none.
    """
    specification = _load(files)
    found = _plan(specification, search, horizon, max_cost, quality_weight, deadline)
    if as_json:
        print_json({
            "status": str(found.status),
            "cost": found.cost,
            "bound": found.bound,
            "units": [
                {
                    "transformation": unit.tid,
                    "inputs": dict(unit.inputs),
                    "outputs": {port: _channels(channels) for port, channels in unit.outputs if channels},
                }
                for unit in found.units
            ],
            "why": found.why,
        })  # fmt: skip
    else:
        _show_plan(found)
    if found.cost is None:
        raise typer.Exit(ExitCode.BROKE_OFF)


@app.command("explain")
def explain(
    arguments: Annotated[
        list[str], typer.Argument(metavar="FILE... [TARGET]", help="Specifications, then the target; all by default.")
    ],
    as_json: Json = False,
) -> None:
    """Say why targets can have their streams, or cannot, and what would help.

    Exit codes: 0 they can, 1 one cannot.
    """
    from rosa_core.errors import InputError, Problem, nearest
    from rosa_streams.costs import DeclaredCosts
    from rosa_streams.environment import update
    from rosa_streams.planning import plan, problem_of, why_unsatisfiable
    from rosa_streams.reasons import reason_of

    last = arguments[-1]
    named = None if Path(last).suffix in {".xml", ".yaml", ".yml", ".ttl", ".owl", ".rdf", ".nt"} else last
    specification = _load([Path(each) for each in (arguments if named is None else arguments[:-1])])
    environment = specification.environment
    goal = environment.goal()
    if named is not None and named not in goal:
        hint = nearest(named, goal) or f"the targets are {', '.join(goal) or 'none'}"
        raise InputError(Problem(f"no target '{named}' is in the files", hint=hint))
    problem = problem_of(environment, DeclaredCosts())
    missing = problem.unsatisfiable_goals()
    wanted = [target for target in goal.values() if target not in missing]
    after = update(environment, plan(environment, targets=wanted).change)
    reasons = []
    for target in goal.values():
        if named is None or target.qid == named:
            why = why_unsatisfiable(problem, target) if target in missing else None
            text = (
                None if why is None else "\n".join((str(why).splitlines()[0], *(f"  {line}" for line in why.reasons)))
            )
            remedies = () if why is None else tuple(map(str, why.remedies))
            reasons.append(reason_of(after, target, text, {}, {}, remedies))
    if as_json:
        print_json({
            "targets": {
                each.qid: {"satisfied": each.satisfied, "reasons": list(each.reasons), "remedies": list(each.remedies)}
                for each in reasons
            }
        })  # fmt: skip
    else:
        print("\n".join(map(str, reasons)) or "there are no targets")
    if not all(each.satisfied for each in reasons):
        raise typer.Exit(ExitCode.BROKE_OFF)


@app.command("monitor")
def monitor(
    formula: Annotated[str, typer.Argument(metavar="FORMULA", help="Such as: G (lost -> F[0,5] found)")],
    data: Annotated[
        Path, typer.Option(metavar="FILE.csv", help="A recording: a column time in seconds, one for each variable.")
    ],
    regions: Annotated[
        Path | None, typer.Option(metavar="FILE.yaml", help="Regions by name, for inside, distance and RCC-8.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Evaluate a formula of metric temporal logic over a recording.

    Exit codes: 0 it holds, or the recording leaves it open; 1 it is violated.
    """
    from rosa_streams.recordings import monitor_recording, read_regions
    from rosa_streams.temporal import Verdict, parse_formula

    parsed = parse_formula(formula)
    done = monitor_recording(parsed, data, None if regions is None else read_regions(regions))
    if as_json:
        print_json({"verdict": str(done.verdict), "time": done.known_at})
    elif done.known_at is None:
        print(f"unknown: the recording leaves open whether {parsed} holds")
    else:
        print(f"{done.verdict}, known at {done.known_at:g} s: {parsed}")
    if done.verdict is Verdict.FALSE:
        raise typer.Exit(ExitCode.BROKE_OFF)


def _load(files: list[Path]) -> Specification:
    from rosa_core.errors import InputError, Problem
    from rosa_streams.specification import load_specification

    specification = load_specification(*files)
    if not specification.environment.transformations and not specification.environment.targets:
        hint = "give specifications beside ontologies; a template needs individuals of its class"
        raise InputError(Problem("there are no transformations or targets in the files", hint=hint))
    for note in specification.notes:
        print(f"rosa: note: {note}", file=sys.stderr)
    return specification


def _plan(
    specification: Specification,
    search: str,
    horizon: float | None,
    max_cost: float | None,
    quality_weight: float | None,
    deadline: float,
) -> Plan:
    from rosa_core.errors import InputError, Problem, nearest
    from rosa_streams.costs import Objective
    from rosa_streams.planning import Search, plan

    known = [str(each) for each in Search]
    if search not in known:
        raise InputError(
            Problem(f"unknown search '{search}'", hint=nearest(search, known) or f"known are {', '.join(known)}")
        )
    defaults = Objective()

    def chosen(option: float | None, from_file: float | None, default: float) -> float:
        return option if option is not None else from_file if from_file is not None else default

    objective = Objective(
        chosen(horizon, specification.horizon, defaults.horizon),
        chosen(max_cost, specification.max_cost, defaults.max_cost),
        chosen(quality_weight, specification.quality_weight, defaults.quality_weight),
    )
    return plan(specification.environment, objective=objective, search=search, deadline=deadline)


def _show_plan(found: Plan) -> None:
    if found.cost is None:
        print(f"none: {found.why}")
        return
    bound = "" if found.bound is None else f", at least {found.bound:g}"
    print(f"{found.status}: cost {found.cost:g}{bound}")
    for word, units in (
        ("created", found.change.created()),
        ("reconfigured", found.change.reconfigured()),
        ("unloaded", found.change.unloaded()),
    ):
        for unit in units:
            print(f"  {word} {unit.cid}")
            for port, channel in unit.inputs if word != "unloaded" else ():
                print(f"    {port} <- {channel}")
            for port, channels in unit.outputs if word != "unloaded" else ():
                print(f"    {port} -> {', '.join(channels)}")


def _channels(channels: tuple[str, ...]) -> str | list[str]:
    """An output has one channel, or several if it serves several targets."""
    return channels[0] if len(channels) == 1 else list(channels)
