"""The description as a tree of our nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer import bt
from tests.task_layer.oracle.description import LEAVES, VARIABLES, WORD, Board, Case, NodeDescription, Step
from tests.task_layer.oracle.trace import IDLE, ScriptedCalls, StepResult

_STATUS = {"S": Status.SUCCESS, "F": Status.FAILURE, "R": Status.RUNNING}


class _Instant(Behaviour):
    """A condition or an action that does not take long."""

    def __init__(self, leaf: NodeDescription, calls: ScriptedCalls) -> None:
        super().__init__(leaf.name)
        self._leaf, self._calls = leaf, calls

    def update(self) -> Status:
        return _STATUS[self._calls.called(self._leaf, "run")]


class _Stateful(Behaviour):
    """An action that may take several ticks; as in BehaviorTree.CPP its start is its first tick."""

    def __init__(self, leaf: NodeDescription, calls: ScriptedCalls) -> None:
        super().__init__(leaf.name)
        self._leaf, self._calls = leaf, calls
        self._how = "run"

    def initialise(self) -> None:
        self._how = "start"

    def update(self) -> Status:
        how, self._how = self._how, "run"
        return _STATUS[self._calls.called(self._leaf, how)]

    def terminate(self, new_status: Status) -> None:
        if new_status is Status.INVALID and self.status is Status.RUNNING:
            self._calls.halted(self._leaf)


class NeverReturnsError(Exception):
    """``tickOnce`` ticks again for ever: the tree asks to be woken at every tick."""


def run_ours(case: Case) -> list[StepResult]:
    """Do all steps of a case with our nodes.

    Raises:
        NeverReturnsError: if a ``tickOnce`` has no end.
    """
    return _Ours(case).run()


class _Ours:
    def __init__(self, case: Case) -> None:
        self.case = case
        self.board: Board = dict.fromkeys(VARIABLES, 0)
        self.word = ""
        self.calls = ScriptedCalls(lambda leaf: leaf.sets.do(self.board) if leaf.sets else None)
        self.leaves: dict[str, Behaviour] = {}
        self.root = self._node(case.root)
        self.woken = False
        for node in self.root.iterate():
            node.setup(wake=self._wake)

    def run(self) -> list[StepResult]:
        return [self._result(step, self._do(step)) for step in self.case.steps]

    def _wake(self) -> None:
        self.woken = True

    def _result(self, step: Step, root: Status) -> StepResult:
        leaves = {name: _name(leaf.status) for name, leaf in self.leaves.items()}
        return StepResult(str(step), _name(root), tuple(self.calls.take()), leaves, dict(self.board))

    def _do(self, step: Step) -> Status:
        if step.word is not None:
            self.word = step.word
        elif step.assignment is not None:
            step.assignment.do(self.board)
        elif step.does == "halt":
            self.root.stop(Status.INVALID)
        else:
            return self._tick(step.does)
        return self.root.status

    def _tick(self, how: str) -> Status:
        ticks, visited = 1, list(self.root.tick())
        # the root is visited last, unless it was skipped
        while how == "tickOnce" and self.root in visited and self.root.status is Status.RUNNING and self.woken:
            self.woken = False
            ticks, visited = ticks + 1, list(self.root.tick())
            if ticks > 200:
                raise NeverReturnsError
        outcome = self.root.status
        if how != "executeTick" and outcome is not Status.RUNNING:
            self.root.status = Status.INVALID  # the methods of BehaviorTree.CPP's Tree do so, whatever the root is
        return outcome

    def _node(self, described: NodeDescription) -> Behaviour:
        node = self._bare(described)
        if described.checks or described.assignments:
            bt.set_conditions(node, self._conditions(described))
        return node

    def _conditions(self, described: NodeDescription) -> bt.Conditions:
        checks = {key: lambda check=check: check.holds(self.board) for key, check in described.checks.items()}
        acts = {key: lambda act=act: act.do(self.board) for key, act in described.assignments.items()}
        return bt.Conditions(
            failure_if=checks.get("_failureIf"),
            success_if=checks.get("_successIf"),
            skip_if=checks.get("_skipIf"),
            while_true=checks.get("_while"),
            on_success=acts.get("_onSuccess"),
            on_failure=acts.get("_onFailure"),
            on_halted=acts.get("_onHalted"),
            post=acts.get("_post"),
        )

    def _bare(self, described: NodeDescription) -> Behaviour:
        name, kind = described.name, described.kind
        if kind in LEAVES:
            make = _Stateful if kind == "stateful" else _Instant
            self.leaves[name] = make(described, self.calls)
            return self.leaves[name]
        if kind == "AlwaysSuccess":
            return py_trees.behaviours.Success(name)
        if kind == "AlwaysFailure":
            return py_trees.behaviours.Failure(name)
        children = [self._node(child) for child in described.children]
        if kind.startswith("Switch"):
            variable, *cases = (self._port(value) for value in described.ports.values())
            return bt.Switch(name, children, variable=variable, cases=cases)
        ports = {port: self._port(value) for port, value in described.ports.items()}
        cls: Callable[..., Behaviour] = getattr(bt, kind)
        return cls(name, children[0] if issubclass(cls, bt.Decorator) else children, **ports)

    def _port(self, value: Any) -> Any:
        if isinstance(value, str) and value.startswith("{"):
            entry = value[1:-1]
            return lambda: self.word if entry == WORD else self.board.get(entry)
        return value


def _name(status: Status) -> str:
    return IDLE if status is Status.INVALID else status.name
