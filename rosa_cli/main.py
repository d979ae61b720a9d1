"""The ``rosa`` command: its sub-commands, and what becomes of errors.

Heavy imports are made inside the sub-commands, so that ``rosa --help`` answers at once.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from rosa_cli.journal_app import journal
from rosa_cli.options import Active, Failed, Files, Json, Measures, Nodes, Require, RosPackages, Select, Tree
from rosa_core.errors import InputError, Problem, RosaError

app = typer.Typer(
    name="rosa",
    help="Robots that adapt their task and their architecture together.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

app.add_typer(journal, name="journal")

EXIT_BROKE_OFF = 1
EXIT_BAD_INPUT = 2


@app.command()
def check(
    files: Files,
    mission: Annotated[
        Path | None,
        typer.Option(metavar="FILE|DIR", help="Check this mission (BehaviorTree.CPP XML) against the model."),
    ] = None,
    tree: Tree = None,
    nodes: Nodes = None,
    ros_package: RosPackages = None,
    scenario: Annotated[
        str | None, typer.Option(metavar="NAME", help="Whose leaves the mission may use: see 'rosa scenarios'.")
    ] = None,
) -> None:
    """Validate knowledge models, and a mission against them."""
    from rosa_cli.model_commands import check_model

    if mission is None:
        check_model(files)
        return
    from rosa_cli.mission_command import check_mission_file
    from rosa_cli.mission_files import MissionOptions

    options = MissionOptions.of(tree, nodes, ros_package)
    verdict = check_mission_file(mission, files, options, scenario=scenario)
    check_model(files)
    print(verdict)


@app.command()
def status(
    files: Files,
    measure: Measures = None,
    failed: Failed = None,
    require: Require = None,
    select: Select = None,
    active: Active = None,
    preference: Annotated[
        str | None,
        typer.Option(metavar="M", help="Show the configuration with the most of measure M for the required action."),
    ] = None,
    weight: Annotated[
        list[str] | None, typer.Option(metavar="M=W", help="The same, by a utility in which measure M weighs W.")
    ] = None,
    limit: Annotated[
        list[str] | None, typer.Option(metavar="LIMIT", help="A limit to the estimates, such as 'energy <= 3'.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Show the status of every element, in the situation that the options describe."""
    from rosa_cli.choice import wanted_utility
    from rosa_cli.model_commands import Supposed, show_status

    utility = wanted_utility(preference, weight, limit)
    show_status(files, Supposed(measure, failed, require, select, active), utility, as_json=as_json)


@app.command()
def explain(
    arguments: Annotated[
        list[str], typer.Argument(metavar="FILE... KIND NAME", help="Models, then the element, such as: action fly")
    ],
    measure: Measures = None,
    failed: Failed = None,
    require: Require = None,
    select: Select = None,
    active: Active = None,
    as_json: Json = False,
) -> None:
    """Say why an element has its status, down to the measurements."""
    from rosa_cli.model_commands import Supposed, show_explanation

    show_explanation(arguments, Supposed(measure, failed, require, select, active), as_json=as_json)


@app.command()
def query(
    arguments: Annotated[
        list[str], typer.Argument(metavar="FILE... QUERY", help="Models, then a TypeQL read query, or - to read it.")
    ],
    measure: Measures = None,
    failed: Failed = None,
    require: Require = None,
    select: Select = None,
    active: Active = None,
    as_json: Json = False,
) -> None:
    """Answer a TypeQL query, such as: match $a isa Action, has name $n; fetch $n;"""
    from rosa_cli.model_commands import Supposed, show_answer

    show_answer(arguments, Supposed(measure, failed, require, select, active), as_json=as_json)


@app.command()
def effort(
    files: Annotated[
        list[Path] | None, typer.Argument(metavar="FILE...", help="Knowledge models; later files extend earlier ones.")
    ] = None,
    table: Annotated[
        bool, typer.Option("--table", help="The paper's table 7, counted from the robots' files.")
    ] = False,
    growth: Annotated[bool, typer.Option("--growth", help="How it grows with adaptations (section 7.6).")] = False,
    most: Annotated[
        int, typer.Option(min=1, max=1000, metavar="N", help="With --growth: up to so many adaptations.")
    ] = 10,
    as_json: Json = False,
) -> None:
    """Count what has to be modelled, as the ROSA paper does: entities and relations of a model, table 7, its growth."""
    if bool(files) + table + growth != 1:
        hint = "rosa effort model.yaml, rosa effort --table, or rosa effort --growth"
        raise InputError(Problem("either files, --table or --growth is needed, and only one of them", hint=hint))
    if files:
        from rosa_cli.model_commands import show_effort

        show_effort(files, as_json=as_json)
        return
    from rosa_cli.effort_command import show_effort_table, show_growth

    if table:
        show_effort_table(as_json=as_json)
    else:
        show_growth(most, as_json=as_json)


@app.command()
def schema() -> None:
    """Print the JSON Schema of YAML knowledge models, for editors."""
    from rosa_cli.model_commands import show_schema

    show_schema()


@app.command()
def scenarios() -> None:
    """List the scenarios that can be run."""
    from rosa_cli.run_command import list_scenarios

    list_scenarios()


@app.command()
def run(
    scenario: Annotated[str, typer.Argument(help="Which one: see 'rosa scenarios'.")],
    manager: Annotated[str, typer.Option(help="The managing system, such as rosa or none.")] = "rosa",
    task_layer: Annotated[str, typer.Option(help="How the mission is written: bt or pddl.")] = "bt",
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same run.")] = 0,
    time_limit: Annotated[
        float | None, typer.Option(min=1.0, max=1e6, help="End of the mission, in s from its beginning.")
    ] = None,
    mission_config: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The mission, in a file of the scenario's own kind.")
    ] = None,
    mission: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A tree in BehaviorTree.CPP XML, instead of the mission's own.")
    ] = None,
    domain: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A PDDL domain, instead of the mission's own.")
    ] = None,
    problem: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A PDDL problem, instead of the mission's own.")
    ] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write a run record into this directory.")] = None,
    video: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Film the mission into this mp4 or webp file (extra: video).")
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(
            min=0.01,
            help="Show it at this multiple of real time, not as fast as it goes (10 with --watch or --groot).",
        ),
    ] = None,
    watch: Annotated[bool, typer.Option("--watch", help="Show the behaviour tree while it runs.")] = False,
    groot: Annotated[
        str | None, typer.Option(metavar="[HOST:]PORT", help="Let Groot2 connect and watch the tree; it asks for 1667.")
    ] = None,
    btlog: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Log the tree, for rosa replay and Groot2.")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show nothing while it runs.")] = False,
    as_json: Json = False,
) -> None:
    """Run a scenario, and show what happens."""
    from rosa_cli.run_command import run_scenario
    from rosa_cli.watching import Watching
    from rosa_simulation.scenario import RunRequest

    request = RunRequest(
        manager,
        task_layer,
        seed,
        time_limit,
        mission_config,
        mission=mission,
        domain=domain,
        problem=problem,
        video=video,
    )
    watching = Watching(watch, groot, btlog)
    if not run_scenario(scenario, request, out=out, speed=speed, quiet=quiet, as_json=as_json, watching=watching):
        raise typer.Exit(EXIT_BROKE_OFF)


@app.command()
def tree(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE|DIR...", help="A mission in BehaviorTree.CPP v4 XML, or its folder.")
    ],
    tree: Tree = None,
    nodes: Nodes = None,
    ros_package: RosPackages = None,
    dot: Annotated[bool, typer.Option("--dot", help="Print it as a graph for Graphviz.")] = False,
    svg: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw it into this SVG file.")] = None,
    upgrade: Annotated[
        Path | None, typer.Option(metavar="NEW.xml", help="Convert a file of BehaviorTree.CPP v3 into this one.")
    ] = None,
) -> None:
    """Show the behaviour tree of a mission."""
    from rosa_cli.mission_files import MissionOptions
    from rosa_cli.tree_command import show_tree, upgrade_tree

    if upgrade is not None:
        upgrade_tree(files, upgrade)
        return
    show_tree(files, MissionOptions.of(tree, nodes, ros_package), dot=dot, svg=svg)


@app.command()
def replay(
    file: Annotated[Path, typer.Argument(metavar="FILE.btlog", help="A log of rosa run --btlog or BehaviorTree.CPP.")],
    speed: Annotated[
        float | None, typer.Option(min=0.01, help="Print it at this multiple of real time, not all at once.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Print the log of a behaviour tree: when which node changed its status."""
    from rosa_cli.replay_command import replay as print_log

    print_log(file, speed=speed, as_json=as_json)


@app.command()
def plan(
    domain: Annotated[Path, typer.Argument(metavar="DOMAIN", help="A PDDL domain.")],
    problem: Annotated[Path, typer.Argument(metavar="PROBLEM", help="A PDDL problem.")],
    feasible: Annotated[
        str | None, typer.Option(metavar="A,B", help="The actions that are feasible; all others are not.")
    ] = None,
    model: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE...", help="Knowledge models that say what is feasible; several may follow."),
    ] = None,
    measure: Measures = None,
    failed: Failed = None,
    engine: Annotated[
        str, typer.Option(metavar="NAME", help="Any engine of unified-planning that is installed.")
    ] = "pyperplan",
    timeout: Annotated[
        float | None, typer.Option(min=0.001, metavar="S", help="Stop planning after so many seconds.")
    ] = None,
    parallel: Annotated[bool, typer.Option("--parallel", help="Let steps run at once that do not interfere.")] = False,
    dot: Annotated[bool, typer.Option("--dot", help="Print the plan as a graph for Graphviz.")] = False,
    bt: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the plan as a behaviour tree.")] = None,
    more_models: Annotated[list[Path] | None, typer.Argument(metavar="FILE", hidden=True)] = None,
    as_json: Json = False,
) -> None:
    """Plan a PDDL mission with the actions that are feasible.

    Exit codes: 0 there is a plan, 1 there is none, 3 the planner failed or ran out of time.
    """
    from rosa_cli.plan_command import PlanOutput, choose_feasibility, show_plan

    code = show_plan(
        domain,
        problem,
        choose_feasibility(feasible, model, more_models or [], measure or [], failed or []),
        engine=engine,
        timeout=timeout,
        parallel=parallel,
        output=PlanOutput(as_json=as_json, as_dot=dot, tree=bt),
    )
    if code:
        raise typer.Exit(code)


@app.command()
def campaign(
    scenario: Annotated[str, typer.Argument(help="Which one: see 'rosa scenarios'.")],
    managers: Annotated[
        str, typer.Option(metavar="A,B", help="Managing systems; rosa-pddl is rosa with the task layer pddl.")
    ],
    runs: Annotated[int, typer.Option(min=1, max=1_000_000, metavar="N", help="How many for each manager.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where results are kept; what is there is not run again.")],
    workers: Annotated[
        int | None, typer.Option(min=1, max=1024, metavar="N", help="Processes on this machine; all cores by default.")
    ] = None,
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler, such as tcp://10.0.0.1:8786.")
    ] = None,
    seed: Annotated[
        int, typer.Option(min=0, max=2**53, metavar="S", help="Of the first run; the others count from it.")
    ] = 10_000,
    experiment: Annotated[
        Path | None, typer.Option(metavar="FILE", help="YAML: which parameters are set, and which are varied.")
    ] = None,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Try again what is recorded as failed.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")] = False,
    as_json: Json = False,
) -> None:
    """Run a scenario many times under several managers, in parallel. The same command goes on after an interruption."""
    from rosa_cli.campaign_command import CampaignRequest, run_campaign

    if workers is not None and cluster is not None:
        hint = "leave one of them out"
        raise InputError(Problem("--workers and --cluster exclude each other", hint=hint))
    request = CampaignRequest(scenario, managers, runs, out, seed, workers, cluster, experiment, retry_failed)
    raise typer.Exit(run_campaign(request, quiet=quiet, as_json=as_json))


@app.command()
def report(
    paths: Annotated[
        list[Path],
        typer.Argument(metavar="DIR...", help="Results of campaigns, run records, or CSV files of the SUAVE exemplar."),
    ],
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The HTML file; report.html in the first directory by default.")
    ] = None,
    csv: Annotated[
        Path | None, typer.Option(metavar="DIR", help="For CSV in the exemplar's format; beside the HTML by default.")
    ] = None,
    figures: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figures as SVG files as well.")] = None,
    parquet: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write runs and reactions as Parquet as well (extra: parquet).")
    ] = None,
) -> None:
    """Report on results: one HTML file that needs nothing else, and CSV files."""
    from rosa_cli.report_command import ReportRequest, write_report

    write_report(ReportRequest(paths, out, csv, figures, parquet))


@app.command()
def compare(
    first: Annotated[Path, typer.Argument(metavar="RUN", help="A directory of rosa run --out.")],
    second: Annotated[Path, typer.Argument(metavar="RUN", help="Another one.")],
    as_json: Json = False,
) -> None:
    """Show two runs side by side: how they were made, what came of them, what happened."""
    from rosa_cli.compare_command import compare_runs

    compare_runs(first, second, as_json=as_json)


@app.command()
def bench(
    most: Annotated[int, typer.Option(min=100, max=1_000_000, help="The largest model, in elements.")] = 10_000,
    as_json: Json = False,
) -> None:
    """Measure how fast inference is, beside its peers where they are installed."""
    from rosa_cli.bench_command import run_bench

    run_bench(most, as_json=as_json)


def main() -> None:
    """Run the command line: bad input ends with its message and exit code 2 (and typer makes 130 of Ctrl-C)."""
    try:
        app(standalone_mode=True)
    except RosaError as error:
        print(f"rosa: {error}", file=sys.stderr)
        sys.exit(EXIT_BAD_INPUT)
    except BrokenPipeError:
        # The reader went away (rosa ... | head); there is nobody to complain to.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(EXIT_BROKE_OFF)


if __name__ == "__main__":
    main()
