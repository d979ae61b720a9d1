"""``rosa up``: a real robot, whose components are programs and services, until its mission is over."""

from __future__ import annotations

import logging
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer

from rosa_cli.exit_codes import ExitCode
from rosa_cli.options import Json, Quiet

if TYPE_CHECKING:
    from rosa_core.kb import Event
    from rosa_processes import Outcome, RealRobot
    from task_layer.bt import TreeRunner


@dataclass(frozen=True, slots=True)
class UpOptions:
    """Which robot, and what of it is shown."""

    robot: Annotated[Path, typer.Argument(metavar="ROBOT.yaml", help="The robot: its model, components and mission.")]
    mission: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="A tree in XML instead of its own mission; twice: PDDL domain and problem."),
    ] = None
    journal: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Keep its knowledge here, and go on with what is there."),
    ] = None
    watch: Annotated[bool, typer.Option("--watch", help="Show the behaviour tree while it runs.")] = False
    groot: Annotated[
        str | None, typer.Option(metavar="[HOST:]PORT", help="Let Groot2 connect and watch the tree; it asks for 1667.")
    ] = None
    btlog: Annotated[Path | None, typer.Option(metavar="FILE", help="Log the tree, for rosa replay and Groot2.")] = None
    quiet: Quiet = False
    as_json: Json = False


def bring_up(options: UpOptions) -> ExitCode:
    """Bring the robot up, perform its mission, and bring it down in order, also when it is told to end.

    Returns:
        DONE if the mission succeeded or a signal ended it, BROKE_OFF if it failed.

    Raises:
        InputError: if a file cannot be used.
    """
    from rosa_core.errors import InputError, Problem
    from rosa_processes import RealRobot, read_robot
    from rosa_processes.robot_file import with_mission

    # Where its skills are, if it has any of its own.
    sys.path.insert(0, str(options.robot.absolute().parent))
    description = read_robot(options.robot)
    if options.mission:
        description = with_mission(description, options.mission)
    if options.journal is not None:
        description = replace(description, journal=options.journal)
    _check_watching(options, is_tree=isinstance(description.mission, Path))
    level = logging.ERROR if options.quiet else logging.WARNING
    logging.basicConfig(stream=sys.stderr, level=level, format="%(message)s")
    try:
        robot = RealRobot(description)
    except OSError as error:
        raise InputError(Problem(str(error))) from error
    with robot, _interrupted_by_signals(robot):
        outcome = _run(robot, options)
    if options.as_json:
        from rosa_cli.output import print_json

        print_json({"mission": outcome.mission, "feedback": outcome.feedback})
    elif not options.quiet:
        print(" ".join(filter(None, (f"the mission ended: {outcome.mission}", outcome.feedback))), file=sys.stderr)
    return ExitCode.BROKE_OFF if outcome.mission == "failure" else ExitCode.DONE


def _check_watching(options: UpOptions, *, is_tree: bool) -> None:
    from rosa_cli.watching import Watching

    watching = Watching(options.watch, options.groot, options.btlog)
    watching.check("bt" if is_tree else "none", quiet=options.quiet, is_terminal=sys.stderr.isatty())


def _run(robot: RealRobot, options: UpOptions) -> Outcome:
    from rich.console import Console, Group
    from rich.live import Live

    from rosa_cli.tree_view import TreeView
    from rosa_cli.watching import TreeOutputs, Watching

    console = Console(stderr=True, highlight=False)
    with ExitStack() as stack:
        outputs = stack.enter_context(TreeOutputs(Watching(options.watch, options.groot, options.btlog)))

        def on_tree(runner: TreeRunner) -> None:
            outputs.attach(runner)
            if options.watch:
                view = TreeView(runner.tree.root, unicode=not console.options.ascii_only)
                runner.tree.add_post_tick_handler(lambda _: view.update())
                live = Live(get_renderable=lambda: Group(*view.lines(console.height - 2)), console=console)
                stack.enter_context(live)

        if not options.quiet:
            # Until the knowledge base is closed: how components end is worth knowing too.
            robot.kb.subscribe(_printing(lambda text: console.print(text, markup=False, soft_wrap=True)))
        return robot.run(on_tree)


def _printing(show: Callable[[str], None]) -> Callable[[Event], None]:
    """A line for what components do and which fail."""
    from rosa_core.kb import ActionUpdate, ComponentActivity, MonitoringData

    def on_event(event: Event) -> None:
        said: list[str] = []
        if isinstance(event, MonitoringData):
            said += [f"{name} has failed" for name in event.failures]
            said += [f"{name} works again" for name in event.recoveries]
        elif isinstance(event, ComponentActivity):
            said += [f"{name} runs" for name in event.activated]
            said += [f"{name} runs no longer" for name in event.deactivated]
        elif isinstance(event, ActionUpdate):
            said += [f"{action.action} is required" for action in event.requested]
            said += [f"{action.action} has ended: {action.result}" for action in event.ended]
        for text in said:
            show(text)

    return on_event


@contextmanager
def _interrupted_by_signals(robot: RealRobot) -> Iterator[None]:
    """SIGTERM and SIGINT end the mission, and then the robot, in order."""

    def end(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        robot.interrupt()

    before = {number: signal.signal(number, end) for number in (signal.SIGTERM, signal.SIGINT)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
