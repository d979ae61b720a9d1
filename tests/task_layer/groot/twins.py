"""The same tree twice: as ours, and as BehaviorTree.CPP's own (through behaviortreepy)."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import behaviortreepy
import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import InputError
from task_layer import bt
from task_layer.bt.groot import read_btlog
from task_layer.bt.types.node_source import NodeSource, set_source
from tests.hang_limit import HANG_LIMIT

OUTCOMES = {"R": Status.RUNNING, "S": Status.SUCCESS, "F": Status.FAILURE}
_THEIRS = behaviortreepy.NodeStatus
THEIR_OUTCOMES = {"R": _THEIRS.RUNNING, "S": _THEIRS.SUCCESS, "F": _THEIRS.FAILURE}


@dataclass(frozen=True)
class Drawn:
    """A node as a test draws it: a leaf has a script of outcomes, which is repeated."""

    tag: str
    below: tuple[Drawn, ...] = ()
    script: str = ""
    ports: tuple[tuple[str, int], ...] = field(default=())


def leaf(script: str) -> Drawn:
    return Drawn("leaf", script=script)


def node(tag: str, *below: Drawn, **ports: int) -> Drawn:
    return Drawn(tag, below, ports=tuple(sorted(ports.items())))


class ScriptedLeaf(py_trees.behaviour.Behaviour):
    def __init__(self, name: str, script: str) -> None:
        super().__init__(name)
        self.script = itertools.cycle(script)

    def update(self) -> Status:
        return OUTCOMES[next(self.script)]


class Twins:
    """Ours and theirs; each leaf is an action of its own, called ``leaf1``, ``leaf2``..."""

    def __init__(self, drawn: Drawn) -> None:
        self._count = itertools.count(1)
        self.ours = self._ours(drawn)
        self._count = itertools.count(1)
        self._factory = behaviortreepy.BehaviorTreeFactory()
        self._subtrees: list[str] = []
        main = self._theirs(drawn)
        self.xml = (
            '<root BTCPP_format="4" main_tree_to_execute="MainTree">'
            f'<BehaviorTree ID="MainTree">{main}</BehaviorTree>{"".join(self._subtrees)}</root>'
        )
        self.theirs = self._factory.create_tree_from_text(self.xml)

    def tick(self) -> None:
        """Tick both; BehaviorTree.CPP sets a root that has ended to idle at once, py_trees does not."""
        self.theirs.tick_exactly_once()
        self.ours.tick_once()
        if self.ours.status is not Status.RUNNING:
            self.ours.status = Status.INVALID

    def halt(self) -> None:
        self.theirs.halt_tree()
        self.ours.stop(Status.INVALID)

    def _name(self, drawn: Drawn) -> str:
        return f"{drawn.tag}{next(self._count)}"

    def _ours(self, drawn: Drawn) -> Behaviour:
        name = self._name(drawn)
        if drawn.tag == "leaf":
            ours = ScriptedLeaf(name, drawn.script)
            set_source(ours, NodeSource(name))
            return ours
        below = [self._ours(child) for child in drawn.below]
        kind = getattr(bt, drawn.tag)
        return kind(name, below[0] if issubclass(kind, bt.Decorator) else below, **dict(drawn.ports))

    def _theirs(self, drawn: Drawn) -> str:
        name = self._name(drawn)
        if drawn.tag == "leaf":
            script = itertools.cycle(drawn.script)

            def go(*_: object) -> object:
                return THEIR_OUTCOMES[next(script)]

            self._factory.register_simple_stateful_action(name, go, go, lambda *_: None)
            return f"<{name}/>"
        below = "".join([self._theirs(child) for child in drawn.below])
        if drawn.tag == "SubTree":
            self._subtrees.append(f'<BehaviorTree ID="{name}">{below}</BehaviorTree>')
            return f'<SubTree ID="{name}"/>'
        ports = "".join(f' {port}="{value}"' for port, value in drawn.ports)
        return f'<{drawn.tag} name="{name}"{ports}>{below}</{drawn.tag}>'


@contextmanager
def their_log(twins: Twins, path: Path, expected: Callable[[], int]) -> Iterator[None]:
    """BehaviorTree.CPP's log of what happens in the block; its own thread writes it some ms later.

    Args:
        twins: the trees.
        path: the log.
        expected: how many transitions there must be; asked after the block.
    """
    logger = behaviortreepy.FileLogger(twins.theirs, str(path))
    yield
    deadline, wanted = time.monotonic() + HANG_LIMIT, expected()
    while time.monotonic() < deadline:
        time.sleep(0.005)
        logger.flush()
        with suppress(InputError):  # it is being written
            if len(read_btlog(path).transitions) >= wanted:
                break
    del logger
