"""The description as a tree of BehaviorTree.CPP's nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import behaviortreepy
from behaviortreepy import NodeStatus

from tests.task_layer.oracle.description import (
    LEAVES,
    VARIABLES,
    WORD,
    Assignment,
    Board,
    Case,
    NodeDescription,
    Step,
    to_xml,
)
from tests.task_layer.oracle.trace import ScriptedCalls, StepResult

_CANNOT_BE_SKIPPED = (
    "unexpected happened in IfThenElseNode",
    "Node [WhileDoElse]: you are not allowed to set manually",
)

_STATUS = {"S": NodeStatus.SUCCESS, "F": NodeStatus.FAILURE, "R": NodeStatus.RUNNING}


def run_theirs(case: Case) -> list[StepResult]:
    """Do all steps of a case with the real nodes.

    A leaf's status is known from the first call on: the binding gives out no nodes but the root and, to its callbacks,
    the leaves. The steps end where BehaviorTree.CPP gives up because the condition of an IfThenElse or a WhileDoElse
    was skipped.
    """
    return _Theirs(case).run()


class _Theirs:
    def __init__(self, case: Case) -> None:
        self.case = case
        self.blackboard = behaviortreepy.Blackboard.create()
        for variable in VARIABLES:
            self.blackboard.set_int(variable, 0)
        self.blackboard.set_string(WORD, "")
        self.calls = ScriptedCalls(lambda leaf: self._assign(leaf.sets) if leaf.sets else None)
        self.leaves: dict[str, Any] = {}
        factory = behaviortreepy.BehaviorTreeFactory()
        for node in case.root.nodes():
            if node.kind in LEAVES:
                self._register(factory, node)
        self.tree = factory.create_tree_from_text(to_xml(case.root), self.blackboard)
        self.root = self.tree.root_node()

    def run(self) -> list[StepResult]:
        results: list[StepResult] = []
        for step in self.case.steps:
            try:
                root = self._do(step)
            except RuntimeError as error:
                if not any(known in str(error) for known in _CANNOT_BE_SKIPPED):
                    raise
                break
            results.append(self._result(step, root))
        return results

    def _register(self, factory: Any, leaf: NodeDescription) -> None:
        def call(how: str) -> Callable[[Any], NodeStatus]:
            def called(node: Any) -> NodeStatus:
                self.leaves[leaf.name] = node
                return _STATUS[self.calls.called(leaf, how)]

            return called

        if leaf.kind == "stateful":
            factory.register_simple_stateful_action(
                leaf.name, call("start"), call("run"), lambda _: self.calls.halted(leaf)
            )
        elif leaf.kind == "condition":
            factory.register_simple_condition(leaf.name, call("run"))
        else:
            factory.register_simple_action(leaf.name, call("run"))

    def _result(self, step: Step, root: NodeStatus) -> StepResult:
        leaves = {name: leaf.status().name for name, leaf in self.leaves.items()}
        return StepResult(str(step), root.name, tuple(self.calls.take()), leaves, self._board())

    def _board(self) -> Board:
        return {variable: self.blackboard.get_int(variable) for variable in VARIABLES}

    def _assign(self, assignment: Assignment) -> None:
        board = self._board()
        assignment.do(board)
        self.blackboard.set_int(assignment.variable, board[assignment.variable])

    def _do(self, step: Step) -> NodeStatus:
        if step.word is not None:
            self.blackboard.set_string(WORD, step.word)
        elif step.assignment is not None:
            self._assign(step.assignment)
        elif step.does == "halt":
            self._halt()
        else:
            outcome = self._tick(step.does)
            if outcome != NodeStatus.SKIPPED:
                return outcome
        return self.root.status()

    def _halt(self) -> None:
        """Halt all nodes; of what ``_onHalted`` does keep only what the nodes that ran have done.

        ``halt_tree`` calls it once more for every node, whether it ran or not.
        """
        if self.root.status() == NodeStatus.RUNNING:
            self.root.halt_node()
        board = self._board()
        self.tree.halt_tree()
        for variable, value in board.items():
            self.blackboard.set_int(variable, value)

    def _tick(self, how: str) -> NodeStatus:
        match how:
            case "tickOnce":
                return self.tree.tick_once()
            case "tickExactlyOnce":
                return self.tree.tick_exactly_once()
        return self.root.execute_tick()
