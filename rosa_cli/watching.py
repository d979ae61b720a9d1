"""Ways for ``rosa run`` to watch a behaviour tree: in the terminal, in Groot2, or in a log."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from rosa_core import InputError
from rosa_core.errors import Problem
from task_layer.bt import TreeRunner

DEFAULT_SPEED = 10.0
"""Multiple of real time at which a simulated mission can be watched."""


@dataclass(frozen=True, slots=True)
class Watching:
    """The ways in which a tree is watched.

    Attributes:
        terminal: shown live in the terminal.
        groot: ``[HOST:]PORT`` that Groot2 connects to.
        btlog: the log file to write.
    """

    terminal: bool = False
    groot: str | None = None
    btlog: Path | None = None

    def check(self, task_layer: str, *, quiet: bool, is_terminal: bool) -> None:
        """Check that the tree can be watched in these ways.

        Raises:
            InputError: if there is no tree, no terminal, or the address is not valid.
        """
        wanted = [
            name
            for name, is_wanted in (
                ("--watch", self.terminal),
                ("--groot", self.groot is not None),
                ("--btlog", self.btlog is not None),
            )
            if is_wanted
        ]
        if wanted and task_layer != "bt":
            raise InputError(Problem(f"{wanted[0]} needs a behaviour tree", None, "--task-layer bt runs one"))
        if self.terminal and quiet:
            raise InputError(Problem("--watch shows the tree and --quiet shows nothing", None, "give one of them"))
        if self.terminal and not is_terminal:
            hint = "run it in a terminal, or write a log with --btlog FILE and print that with rosa replay"
            raise InputError(Problem("--watch needs a terminal on standard error", None, hint))
        if self.groot is not None:
            _address(self.groot)

    @property
    def is_live(self) -> bool:
        """Whether it is watched while it runs."""
        return self.terminal or self.groot is not None


class TreeOutputs:
    """Serves a tree to Groot2 and logs it, until the run is over."""

    def __init__(self, watching: Watching) -> None:
        self._watching = watching
        self._open = ExitStack()

    def attach(self, runner: TreeRunner) -> None:
        """Start serving and logging the tree of a runner.

        Raises:
            InputError: if the port is taken, the log cannot be written, or a library is not installed.
        """
        root, clock = runner.tree.root, runner.clock
        if self._watching.groot is not None:
            from task_layer.bt.groot import GrootPublisher

            host, port = _address(self._watching.groot)
            self._open.enter_context(GrootPublisher(root, port, host=host, clock=clock))
        if self._watching.btlog is not None:
            from task_layer.bt.groot import BtLogWriter

            self._open.enter_context(BtLogWriter(self._watching.btlog, root, clock))

    def __enter__(self) -> TreeOutputs:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._open.close()


def _address(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not port.isdecimal() or len(port) > 5:
        hint = "--groot 1667 is for this computer only, --groot *:1667 for the network"
        raise InputError(Problem(f"'{text}' is not an address for Groot2", None, hint))
    return host or "127.0.0.1", int(port)
