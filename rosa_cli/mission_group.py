"""Commands about missions: running them, and looking at trees, logs and plans."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rosa_cli.option_groups import expand_options
from rosa_cli.options import DisplayOptions, FeasibilityOptions, Json, PlanOptions, RunOptions, Scenario, TreeOptions

app = typer.Typer()


@app.command()
def scenarios() -> None:
    """List the scenarios that can be run."""
    from rosa_cli.run_command import list_scenarios

    list_scenarios()


@app.command()
@expand_options
def run(scenario: Scenario, options: RunOptions, trees: TreeOptions, display: DisplayOptions) -> None:
    """Run a scenario, and show what happens."""
    from rosa_cli.run_command import run_scenario

    raise typer.Exit(run_scenario(scenario, options.request(trees), display))


@app.command()
def new(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Of the package and its scenario, such as my_robot.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="Make the package's folder in this directory.")] = Path(),
) -> None:
    """Write a robot package of your own: the smallest that runs and passes its test."""
    from rosa_cli.new_command import print_new_robot

    print_new_robot(name, out)


@app.command()
@expand_options
def tree(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE|DIR...", help="A mission in BehaviorTree.CPP v4 XML, or its folder.")
    ],
    trees: TreeOptions,
    dot: Annotated[bool, typer.Option("--dot", help="Print it as a graph for Graphviz.")] = False,
    svg: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw it into this SVG file.")] = None,
    upgrade: Annotated[
        Path | None, typer.Option(metavar="NEW.xml", help="Convert a file of BehaviorTree.CPP v3 into this one.")
    ] = None,
) -> None:
    """Show the behaviour tree of a mission."""
    from rosa_cli.tree_command import show_tree, upgrade_tree

    if upgrade is not None:
        upgrade_tree(files, upgrade)
    else:
        show_tree(files, trees, dot=dot, svg=svg)


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
@expand_options
def plan(options: PlanOptions, feasibility: FeasibilityOptions) -> None:
    """Plan a PDDL mission with the actions that are feasible.

    Exit codes: 0 there is a plan, 1 there is none, 3 the planner failed or ran out of time.
    """
    from rosa_cli.plan_command import show_plan

    raise typer.Exit(show_plan(options, feasibility))
