"""Arguments and options of the commands; those that belong together are a dataclass (see ``expand_options``)."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from rosa_simulation.scenario import RunRequest
    from task_layer.bt import TreeSource

Files = Annotated[
    list[Path],
    typer.Argument(metavar="FILE...", help="Knowledge models, later ones extend earlier ones; or a scenario's name."),
]
Scenario = Annotated[str, typer.Argument(help="Which one: see 'rosa scenarios'.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document on standard output, nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Show nothing while it runs.")]
Measures = Annotated[
    list[str] | None, typer.Option("--measure", "-m", metavar="M=V", help="Suppose measure M was measured as V.")
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="Set a parameter: see 'rosa scenarios SCENARIO'. Repeatable."),
]
Failed = Annotated[list[str] | None, typer.Option("--failed", metavar="C", help="Suppose component C has failed.")]


@dataclass(frozen=True, slots=True)
class SituationOptions:
    """The situation that a knowledge base is supposed to be in."""

    measure: Measures = None
    failed: Failed = None
    require: Annotated[list[str] | None, typer.Option(metavar="A", help="Suppose action A is required.")] = None
    select: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Suppose a function design or component configuration is selected."),
    ] = None
    active: Annotated[list[str] | None, typer.Option(metavar="C", help="Suppose component C is active.")] = None


@dataclass(frozen=True, slots=True)
class UtilityOptions:
    """By what a configuration is chosen."""

    preference: Annotated[
        str | None,
        typer.Option(metavar="M", help="Show the configuration with the most of measure M for the required action."),
    ] = None
    weight: Annotated[
        list[str] | None, typer.Option(metavar="M=W", help="The same, by a utility in which measure M weighs W.")
    ] = None
    limit: Annotated[
        list[str] | None, typer.Option(metavar="LIMIT", help="A limit to the estimates, such as 'energy <= 3'.")
    ] = None


@dataclass(frozen=True, slots=True)
class TreeOptions:
    """Which tree of a mission is meant, and what is needed to read it."""

    tree: Annotated[str | None, typer.Option(metavar="ID", help="The mission's tree, if there are several.")] = None
    nodes: Annotated[
        list[Path] | None, typer.Option(metavar="FILE", help="Models of the mission's nodes, in a file of their own.")
    ] = None
    ros_package: Annotated[
        list[str] | None, typer.Option(metavar="NAME=DIR", help="Where the files of a ROS package are, for includes.")
    ] = None

    def packages(self) -> dict[str, Path]:
        """The folders of ROS packages, by name.

        Raises:
            InputError: if a package has no folder.
        """
        return dict(map(_package, self.ros_package or ()))

    def source(self, mission: Path | None) -> TreeSource | Path | None:
        """The tree of a mission.

        Raises:
            InputError: if there is no mission that the options could be about.
        """
        if mission is None and (self.tree or self.nodes or self.ros_package):
            # Not at the top: `rosa --help` needs no errors, and importing them takes longer than all that it does.
            from rosa_core.errors import InputError, Problem

            raise InputError(Problem("--tree, --nodes and --ros-package are about a mission", hint="add --mission"))
        if mission is None or not (self.tree or self.nodes or self.ros_package):
            return mission
        from task_layer.bt import TreeSource

        return TreeSource(mission, self.tree, tuple(self.nodes or ()), self.packages())


def _package(text: str) -> tuple[str, Path]:
    from rosa_core.errors import InputError, Problem
    from rosa_core.paths import is_directory

    name, equals, folder = text.partition("=")
    if not (name and equals and folder):
        hint = "--ros-package robot_trees=/path/to/its/folder"
        raise InputError(Problem(f"--ros-package {text!r} does not say where the package is", hint=hint))
    if not is_directory(folder):
        raise InputError(Problem(f"--ros-package {name}: there is no folder {folder!r}"))
    return name, Path(folder)


@dataclass(frozen=True, slots=True)
class RunOptions:
    """What is run."""

    manager: Annotated[str, typer.Option(help="The managing system, such as rosa or none.")] = "rosa"
    task_layer: Annotated[str, typer.Option(help="How the mission is written: bt or pddl.")] = "bt"
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same run.")] = 0
    time_limit: Annotated[
        float | None, typer.Option(min=1.0, max=1e6, help="End of the mission, in s from its beginning.")
    ] = None
    mission_config: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="YAML that says what is uncertain and how the world is: SUAVE's mission_config.yaml, a mission of"
            " the AGV, or 'parameters: {NAME: VALUE}'.",
        ),
    ] = None
    settings: Settings = None
    mission: Annotated[
        Path | None,
        typer.Option(metavar="FILE|DIR", help="A tree in BehaviorTree.CPP XML, instead of the mission's own."),
    ] = None
    domain: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A PDDL domain, instead of the mission's own.")
    ] = None
    problem: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A PDDL problem, instead of the mission's own.")
    ] = None
    video: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Film the mission into this mp4 or webp file (extra: video).")
    ] = None

    def request(self, trees: TreeOptions) -> RunRequest:
        """The same, for a scenario; ``trees`` says which tree of the mission is meant.

        Raises:
            InputError: if it says so without a mission.
        """
        from rosa_simulation.scenario import RunRequest

        given = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "settings"}
        return RunRequest(**{**given, "mission": trees.source(self.mission), "parameters": self._parameters()})

    def _parameters(self) -> dict[str, Any]:
        if not self.settings:
            return {}
        from rosa_cli.settings import read_settings

        return read_settings(self.settings)


@dataclass(frozen=True, slots=True)
class DisplayOptions:
    """What is shown of a run, and what is left of it."""

    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write a run record into this directory.")] = None
    speed: Annotated[
        float | None,
        typer.Option(
            min=0.01,
            help="Show it at this multiple of real time, not as fast as it goes (10 with --watch or --groot).",
        ),
    ] = None
    watch: Annotated[bool, typer.Option("--watch", help="Show the behaviour tree while it runs.")] = False
    groot: Annotated[
        str | None, typer.Option(metavar="[HOST:]PORT", help="Let Groot2 connect and watch the tree; it asks for 1667.")
    ] = None
    btlog: Annotated[Path | None, typer.Option(metavar="FILE", help="Log the tree, for rosa replay and Groot2.")] = None
    quiet: Quiet = False
    as_json: Json = False


@dataclass(frozen=True, slots=True)
class PlanOptions:
    """What is planned, with which engine, and how the plan is shown."""

    domain: Annotated[Path, typer.Argument(metavar="DOMAIN", help="A PDDL domain.")]
    problem: Annotated[Path, typer.Argument(metavar="PROBLEM", help="A PDDL problem.")]
    engine: Annotated[str, typer.Option(metavar="NAME", help="Any engine of unified-planning that is installed.")] = (
        "pyperplan"
    )
    timeout: Annotated[
        float | None, typer.Option(min=0.001, metavar="S", help="Stop planning after so many seconds.")
    ] = None
    parallel: Annotated[bool, typer.Option("--parallel", help="Let steps run at once that do not interfere.")] = False
    dot: Annotated[bool, typer.Option("--dot", help="Print the plan as a graph for Graphviz.")] = False
    bt: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the plan as a behaviour tree.")] = None
    as_json: Json = False


@dataclass(frozen=True, slots=True)
class FeasibilityOptions:
    """Which actions are feasible for a plan."""

    feasible: Annotated[
        str | None, typer.Option(metavar="A,B", help="The actions that are feasible; all others are not.")
    ] = None
    model: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE...", help="Knowledge models that say what is feasible; several may follow."),
    ] = None
    measure: Measures = None
    failed: Failed = None
    more_models: Annotated[list[Path] | None, typer.Argument(metavar="FILE", hidden=True)] = None


@dataclass(frozen=True, slots=True)
class CampaignOptions:
    """Which runs a campaign consists of, who carries them out, and where results go."""

    scenario: Scenario
    managers: Annotated[
        str, typer.Option(metavar="A,B", help="Managing systems; rosa-pddl is rosa with the task layer pddl.")
    ]
    runs: Annotated[int, typer.Option(min=1, max=1_000_000, metavar="N", help="How many for each manager.")]
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where results are kept; what is there is not run again.")]
    workers: Annotated[
        int | None, typer.Option(min=1, max=1024, metavar="N", help="Processes on this machine; all cores by default.")
    ] = None
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler, such as tcp://10.0.0.1:8786.")
    ] = None
    seed: Annotated[
        int, typer.Option(min=0, max=2**53, metavar="S", help="Of the first run; the others count from it.")
    ] = 10_000
    experiment: Annotated[
        Path | None, typer.Option(metavar="FILE", help="YAML: which parameters are set, and which are varied.")
    ] = None
    settings: Settings = None
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Try again what is recorded as failed.")] = False
    quiet: Quiet = False
    as_json: Json = False


@dataclass(frozen=True, slots=True)
class ReportOptions:
    """What is reported, and into which files."""

    paths: Annotated[
        list[Path],
        typer.Argument(metavar="DIR...", help="Results of campaigns, run records, or CSV files of the SUAVE exemplar."),
    ]
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The HTML file; report.html in the first directory by default.")
    ] = None
    csv: Annotated[
        Path | None, typer.Option(metavar="DIR", help="For CSV in the exemplar's format; next to the HTML by default.")
    ] = None
    figures: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figures as SVG files as well.")] = None
    parquet: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write runs and reactions as Parquet as well (extra: parquet).")
    ] = None


@dataclass(frozen=True, slots=True)
class VerifyOptions:
    """What of a model is verified, and what is written of it."""

    order: Annotated[
        int, typer.Option(min=1, max=6, metavar="N", help="The most causes that together make something unfeasible.")
    ] = 3
    every_kind: Annotated[
        bool,
        typer.Option("--all", help="Show functions, designs, components and configurations too, not only actions."),
    ] = False
    reliability: Annotated[
        Path | None, typer.Option(metavar="FILE", help="YAML: how likely components fail; shows how likely actions do.")
    ] = None
    measure: Annotated[
        list[str] | None,
        typer.Option("--measure", "-m", metavar="M=V", help="With --reliability, --fault-tree: M was measured as V."),
    ] = None
    fault_tree: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="Write a fault tree: .svg drawing, .xml Open-PSA, .dft Galileo."),
    ] = None
    action: Annotated[
        str | None, typer.Option(metavar="A", help="Of which action the fault tree is; not needed if there is one.")
    ] = None
