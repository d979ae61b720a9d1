"""Test tools for missions: scripted leaves and skills, a knowledge base to control, and expected traces."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import Clock, KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.model.elements import Action, Component, Function, FunctionalRequirement, FunctionDesign
from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SUCCESS
from task_layer.bt.runner import TreeRunner
from task_layer.skill import Skill, SkillStatus

LETTERS = {"S": SUCCESS, "F": FAILURE, "R": RUNNING}
"""The letters of statuses in scripts and traces."""

_SKILL_STATUS = {"S": SkillStatus.SUCCESS, "F": SkillStatus.FAILURE, "R": SkillStatus.RUNNING}
_LETTER = {status: letter for letter, status in LETTERS.items()} | {IDLE: "-"}


class _StatusScript:
    """The letters of a script in order; the last one is repeated."""

    def __init__(self, script: str) -> None:
        if not script or set(script) - set(LETTERS):
            raise ValueError(f"a script is made of the letters S, F and R, not '{script}'")
        self._letters = list(script)

    def next(self) -> str:
        return self._letters.pop(0) if len(self._letters) > 1 else self._letters[0]


class ScriptedLeaf(Behaviour):
    """A leaf whose statuses are given by a script.

    Args:
        name: the leaf's name in the tree.
        script: the statuses of its ticks, R, S or F each, for instance ``"RRS"``; the last one is repeated.

    Attributes:
        calls: its calls so far: ``start``, ``run`` and ``halt``.

    Raises:
        ValueError: if the script is empty or has other letters.

    >>> leaf = ScriptedLeaf("move", "RS")
    >>> leaf.tick_once()
    >>> leaf.status.name, leaf.calls
    ('RUNNING', ['start', 'run'])
    """

    def __init__(self, name: str, script: str = "S") -> None:
        super().__init__(name)
        self._script = _StatusScript(script)
        self.calls: list[str] = []

    def initialise(self) -> None:
        """Record the call."""
        self.calls.append("start")

    def update(self) -> Status:
        """The next status."""
        self.calls.append("run")
        return LETTERS[self._script.next()]

    def terminate(self, new_status: Status) -> None:
        """Record the call, if the leaf was running."""
        if new_status is IDLE and self.status is RUNNING:
            self.calls.append("halt")


class ScriptedSkill(Skill):
    """A skill whose statuses are given by a script.

    Args:
        script: the statuses of its updates, as for :class:`ScriptedLeaf`.

    Attributes:
        calls: its calls so far: ``start``, ``update`` and ``stop``.

    Raises:
        ValueError: if the script is empty or has other letters.
    """

    def __init__(self, script: str = "S") -> None:
        self._script = _StatusScript(script)
        self.calls: list[str] = []

    def start(self) -> None:
        """Record the call."""
        self.calls.append("start")

    def update(self) -> SkillStatus:
        """The next status."""
        self.calls.append("update")
        return _SKILL_STATUS[self._script.next()]

    def stop(self) -> None:
        """Record the call."""
        self.calls.append("stop")


def fake_model(*actions: str) -> KnowledgeModel:
    """A knowledge model in which each action needs one component of its own."""
    names = tuple(dict.fromkeys(actions))
    return KnowledgeModel(
        actions=tuple(Action(name) for name in names),
        functions=tuple(Function(name) for name in names),
        components=tuple(Component(_component_of(name)) for name in names),
        function_designs=tuple(FunctionDesign(name, name, (_component_of(name),)) for name in names),
        requirements=tuple(FunctionalRequirement(name, (name,)) for name in names),
    )


class FakeKnowledgeBase(KnowledgeBase):
    """A knowledge base whose actions a test makes feasible or unfeasible.

    It is a real knowledge base, on a model in which each action needs one component of its own.

    Args:
        actions: the names of its actions.
        clock: by default a simulation clock.

    >>> kb = FakeKnowledgeBase("search", "recharge")
    >>> kb.make_unfeasible("search")
    >>> kb.is_action_feasible("search"), kb.is_action_feasible("recharge")
    (False, True)
    """

    def __init__(self, *actions: str, clock: Clock | None = None) -> None:
        super().__init__(fake_model(*actions), clock=clock or SimulationClock())

    def make_unfeasible(self, *actions: str) -> None:
        """Make actions unfeasible."""
        for action in actions:
            self.set_component_failure(_component_of(action))

    def make_feasible(self, *actions: str) -> None:
        """Make actions feasible again."""
        for action in actions:
            self.clear_component_failure(_component_of(action))

    @property
    def requested(self) -> list[str]:
        """The actions that are required at present."""
        return [required.action for required in self.required_actions()]


def expect_trace(
    tree: Behaviour,
    *steps: str | Callable[[], object],
    kb: KnowledgeBase | None = None,
    watch: Collection[str] | None = None,
) -> None:
    """Tick a tree once for each expectation, and compare.

    Args:
        tree: the mission.
        steps: an expectation for each tick, and between them functions to be called. An expectation has the leaves
            that are visited, in order, with their statuses, and the status of the tree:
            ``"is_done F, search R -> R"``; a leaf that is skipped is not visited. The word ``"halt"`` halts the tree.
        kb: the knowledge base, if the tree uses one.
        watch: the names of the leaves that are compared; by default all.

    Raises:
        AssertionError: if a tick differs; the message has the ticks so far and the tree.
        ValueError: if an expectation cannot be read.

    >>> from task_layer.bt import Sequence
    >>> expect_trace(Sequence("all", [ScriptedLeaf("a", "RS"), ScriptedLeaf("b", "F")]), "a R -> R", "a S, b F -> F")
    """
    runner = TreeRunner(tree, kb, clock=SimulationClock() if kb is None else kb.clock)
    visited = _LeavesVisited(watch)
    runner.tree.add_visitor(visited)
    seen: list[str] = []
    with runner:
        for step in steps:
            if callable(step):
                step()
            elif step == "halt":
                runner.halt()
                seen.append("halt")
            else:
                runner.tick()
                seen.append(f"{', '.join(visited.leaves)} -> {_LETTER[tree.status]}".strip())
                if _normal(step) != seen[-1]:
                    raise AssertionError(_difference(tree, step, seen))


class _LeavesVisited(py_trees.visitors.VisitorBase):
    """Collects the leaves that a tick visits, and their statuses."""

    def __init__(self, watch: Collection[str] | None) -> None:
        super().__init__(full=False)
        self._watch = watch
        self.leaves: list[str] = []

    def initialise(self) -> None:
        self.leaves = []

    def run(self, behaviour: Behaviour) -> None:
        if not behaviour.children and (self._watch is None or behaviour.name in self._watch):
            self.leaves.append(f"{behaviour.name} {_LETTER[behaviour.status]}")


def _normal(expectation: str) -> str:
    leaves, arrow, outcome = expectation.rpartition("->")
    if not arrow or outcome.strip() not in LETTERS:
        raise ValueError(f"an expectation ends in '-> S', '-> F' or '-> R', not '{expectation}'")
    return f"{', '.join(' '.join(leaf.split()) for leaf in leaves.split(','))} -> {outcome.strip()}".strip()


def _difference(tree: Behaviour, expected: str, seen: Iterable[str]) -> str:
    *before, last = seen
    shown = [f"  {number}  {line}" for number, line in enumerate(before, 1)]
    tick = len(before) + 1
    return "\n".join(
        [
            f"tick {tick} differs from the expectation:",
            *shown,
            f"  {tick}  expected  {_normal(expected)}",
            f"  {tick}  seen      {last}",
            py_trees.display.unicode_tree(tree, show_status=True),
        ]
    )


def _component_of(action: str) -> str:
    return f"{action} part"
