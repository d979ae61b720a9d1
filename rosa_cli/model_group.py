"""Commands about knowledge models."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rosa_cli.option_groups import expand_options
from rosa_cli.options import Files, Json, SituationOptions, TreeOptions, UtilityOptions, VerifyOptions

app = typer.Typer()


@app.command()
@expand_options
def check(
    trees: TreeOptions,
    files: Annotated[
        list[Path] | None, typer.Argument(metavar="FILE...", help="Knowledge models; later files extend earlier ones.")
    ] = None,
    mission: Annotated[
        Path | None,
        typer.Option(metavar="FILE|DIR", help="Check this mission (BehaviorTree.CPP XML) against the model."),
    ] = None,
    scenario: Annotated[
        str | None, typer.Option(metavar="NAME", help="Whose leaves the mission may use: see 'rosa scenarios'.")
    ] = None,
    reflexes: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Check these reflexes; no knowledge model is needed.")
    ] = None,
) -> None:
    """Validate knowledge models, a mission against them, and reflexes."""
    if reflexes is not None:
        from rosa_cli.reflex_command import check_reflexes

        check_reflexes(reflexes)
        if not files and mission is None:
            return
    if not files:
        raise typer.BadParameter("name at least one knowledge model, or --reflexes FILE", param_hint="FILE...")
    from rosa_cli.model_commands import check_model

    if mission is None:
        check_model(files)
        return
    from rosa_cli.mission_command import check_mission_file

    verdict = check_mission_file(mission, files, trees, scenario=scenario)
    check_model(files)
    print(verdict)


@app.command()
@expand_options
def status(files: Files, situation: SituationOptions, utility: UtilityOptions, as_json: Json = False) -> None:
    """Show the status of every element, in the situation that the options describe."""
    from rosa_cli.choice import requested_utility
    from rosa_cli.model_commands import show_status

    show_status(files, situation, requested_utility(utility), as_json=as_json)


@app.command()
@expand_options
def explain(
    arguments: Annotated[
        list[str], typer.Argument(metavar="FILE... KIND NAME", help="Models, then the element, such as: action fly")
    ],
    situation: SituationOptions,
    as_json: Json = False,
) -> None:
    """Say why an element has its status, down to the measurements."""
    from rosa_cli.model_commands import show_explanation

    show_explanation(arguments, situation, as_json=as_json)


@app.command()
@expand_options
def query(
    arguments: Annotated[
        list[str], typer.Argument(metavar="FILE... QUERY", help="Models, then a TypeQL read query, or - to read it.")
    ],
    situation: SituationOptions,
    as_json: Json = False,
) -> None:
    """Answer a TypeQL query, such as: match $a isa Action, has name $n; fetch $n;"""
    from rosa_cli.model_commands import show_answer

    show_answer(arguments, situation, as_json=as_json)


@app.command()
@expand_options
def verify(files: Files, options: VerifyOptions, as_json: Json = False) -> None:
    """Find what can go wrong with a robot: single points of failure, minimal cut sets, gaps, and defects of the model.

    Exit codes: 0 no defects, 1 constraints contradict each other or something in use is never selected.
    """
    from rosa_cli.verify_command import verify_files

    raise typer.Exit(verify_files(files, options, as_json=as_json))


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
    from rosa_cli.effort_command import show_effort

    show_effort(files or [], table=table, growth=growth, most=most, as_json=as_json)


@app.command()
def schema() -> None:
    """Print the JSON Schema of YAML knowledge models, for editors."""
    from rosa_cli.model_commands import show_schema

    show_schema()
