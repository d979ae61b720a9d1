"""Arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Files = Annotated[
    list[Path], typer.Argument(metavar="FILE...", help="Knowledge models; later files extend earlier ones.")
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document on standard output, nothing else.")]
Measures = Annotated[
    list[str] | None, typer.Option("--measure", "-m", metavar="M=V", help="Suppose measure M was measured as V.")
]
Failed = Annotated[list[str] | None, typer.Option("--failed", metavar="C", help="Suppose component C has failed.")]
Require = Annotated[list[str] | None, typer.Option("--require", metavar="A", help="Suppose action A is required.")]
Select = Annotated[
    list[str] | None,
    typer.Option("--select", metavar="NAME", help="Suppose a function design or component configuration is selected."),
]
Active = Annotated[list[str] | None, typer.Option("--active", metavar="C", help="Suppose component C is active.")]
Tree = Annotated[str | None, typer.Option("--tree", metavar="ID", help="The mission's tree, if there are several.")]
Nodes = Annotated[
    list[Path] | None,
    typer.Option("--nodes", metavar="FILE", help="Models of the mission's nodes, in a file of their own."),
]
RosPackages = Annotated[
    list[str] | None,
    typer.Option("--ros-package", metavar="NAME=DIR", help="Where the files of a ROS package are, for includes."),
]
