"""A small kit for testing missions: scripted leaves and skills, a knowledge base to command, and traces to expect."""

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
"""How statuses are written in scripts and traces."""

_SKILL_STATUS = {"S": SkillStatus.SUCCESS, "F": SkillStatus.FAILURE, "R": SkillStatus.RUNNING}
_LETTER = {status: letter for letter, status in LETTERS.items()} | {IDLE: "-"}


class _Script:
    """The letters of a script one after the other; the last for ever."""

    def __init__(self, script: str) -> None:
        if not script or set(script) - set(LETTERS):
            raise ValueError(f"a script is made of the letters S, F and R, not '{script}'")
        self._letters = list(script)

    def next(self) -> str:
        return self._letters.pop(0) if len(self._letters) > 1 else self._letters[0]


class ScriptedLeaf(Behaviour):
    """A leaf that does as its script says.

    Args:
        name: the leaf's name in the tree.
        script: what its ticks come to, for instance ``"RRS"``: R, S or F each; the last for ever.

    Attributes:
        calls: what was done with it: ``start``, ``run`` and ``halt``.
    """

    def __init__(self, name: str, script: str = "S") -> None:
        super().__init__(name)
        self._script = _Script(script)
        self.calls: list[str] = []

    def initialise(self) -> None:
        """Write it down."""
        self.calls.append("start")

    def update(self) -> Status:
        """The next letter."""
        self.calls.append("run")
        return LETTERS[self._script.next()]

    def terminate(self, new_status: Status) -> None:
        """Write it down, if it was running."""
        if new_status is IDLE and self.status is RUNNING:
            self.calls.append("halt")


class ScriptedSkill(Skill):
    """A skill that does as its script says; like :class:`ScriptedLeaf`.

    Attributes:
        calls: what was done with it: ``start``, ``update`` and ``stop``.
    """

    def __init__(self, script: str = "S") -> None:
        self._script = _Script(script)
        self.calls: list[str] = []

    def start(self) -> None:
        """Write it down."""
        self.calls.append("start")

    def update(self) -> SkillStatus:
        """The next letter."""
        self.calls.append("update")
        return _SKILL_STATUS[self._script.next()]

    def stop(self) -> None:
        """Write it down."""
        self.calls.append("stop")


def fake_model(*actions: str) -> KnowledgeModel:
    """A knowledge model in which each action needs one component of its own."""
    names = tuple(dict.fromkeys(actions))
    return KnowledgeModel(
        actions=tuple(Action(name) for name in names),
        functions=tuple(Function(name) for name in names),
        components=tuple(Component(_part(name)) for name in names),
        function_designs=tuple(FunctionDesign(name, name, (_part(name),)) for name in names),
        requirements=tuple(FunctionalRequirement(name, (name,)) for name in names),
    )


class FakeKnowledgeBase(KnowledgeBase):
    """A knowledge base whose actions are feasible or not as the test commands.

    It is a real one, on a model in which each action needs one component of its own.

    Args:
        actions: the actions there are.
        clock: by default a simulation's.
    """

    def __init__(self, *actions: str, clock: Clock | None = None) -> None:
        super().__init__(fake_model(*actions), clock=clock or SimulationClock())

    def make_unfeasible(self, *actions: str) -> None:
        """From now on these actions cannot be performed."""
        for action in actions:
            self.set_component_failure(_part(action))

    def make_feasible(self, *actions: str) -> None:
        """From now on these actions can be performed again."""
        for action in actions:
            self.clear_component_failure(_part(action))

    @property
    def requested(self) -> list[str]:
        """The actions that are to be performed now."""
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
        steps: an expectation for each tick, and between them functions to be called. An expectation names the leaves
            that are visited, in order, and what the tick comes to: ``"is_done F, search R -> R"``; a leaf that is
            skipped is not visited. The word ``"halt"`` halts the tree.
        kb: the knowledge base, if the tree uses one.
        watch: the names of the leaves that count; by default all.

    Raises:
        AssertionError: if a tick comes to something else; says what was seen so far, and shows the tree.
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
    """Remembers which leaves a tick visits, and what they come to."""

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
            f"tick {tick} came to something else:",
            *shown,
            f"  {tick}  expected  {_normal(expected)}",
            f"  {tick}  seen      {last}",
            py_trees.display.unicode_tree(tree, show_status=True),
        ]
    )


def _part(action: str) -> str:
    return f"{action} part"
