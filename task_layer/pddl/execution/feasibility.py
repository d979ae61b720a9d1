"""Between a planning task and the knowledge base: which actions are feasible, and which are requested for a step."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from rosa_core import ElementKind, InputError, KnowledgeBase, UnknownElementError
from rosa_core.errors import Problem, nearest
from task_layer.pddl.grounding.ground_task import GroundTask, Operator, State
from task_layer.pddl.grounding.reachability import Obstacle
from task_layer.pddl.reading.names import comparable

_NO_ACTIONS: Mapping[str, str] = {}


class FeasibilityBridge:
    """Keeps ``(action_feasible X)`` in step with the knowledge base (ROSA paper, section 6.2.5, listing 4).

    An object of the feasibility predicate, and an action of the domain, stand for the action of the knowledge base with
    their name, be it written with hyphens, underscores, dots or spaces, in upper or lower case; or for the one that
    ``actions`` names. A step requests the actions whose feasibility its conditions ask for, or else the one with its
    own name. If a domain does not ask for feasibility, steps whose action is unfeasible are not planned all the same.

    Args:
        kb: the knowledge base.
        task: the planning task.
        actions: actions of the knowledge base by the names of objects and actions of the domain, where they differ.

    Raises:
        InputError: if an object of the feasibility predicate stands for no action of the knowledge base, or ``actions``
            names what is not there.
    """

    def __init__(self, kb: KnowledgeBase, task: GroundTask, actions: Mapping[str, str] = _NO_ACTIONS) -> None:
        self._kb = kb
        self._task = task
        self._action_of = _actions_by_name(actions, list(kb.statuses(ElementKind.ACTION)), task)
        self._requested = {operator.index: self._actions_of(operator) for operator in task.operators}
        self._unasked = [
            (self._action_of[operator.action], operator.index)
            for operator in task.operators
            if not operator.feasibility and operator.action in self._action_of
        ]
        self.mask = sum(task.feasibility.values())
        """The facts that the knowledge base decides, as a mask."""

    def feasible(self) -> State:
        """The feasibility facts that hold now, as a mask."""
        mask = 0
        for name, bit in self._task.feasibility.items():
            if self.is_feasible(self._action_of[name]):
                mask |= bit
        return mask

    def excluded(self) -> frozenset[int]:
        """The operators, by index, that cannot be used now although the domain does not ask for feasibility."""
        return frozenset(index for action, index in self._unasked if not self.is_feasible(action))

    def actions(self, operator: Operator) -> tuple[str, ...]:
        """The actions of the knowledge base that a step requests.

        Args:
            operator: the step.

        Returns:
            their names; none if the step is no action of the knowledge base.
        """
        return self._requested[operator.index]

    def unfeasible_action(self, operator: Operator) -> str | None:
        """The first action of a step that is unfeasible now, if there is one."""
        return next((action for action in self.actions(operator) if not self.is_feasible(action)), None)

    def is_feasible(self, action: str) -> bool:
        """Whether the knowledge base says that an action may be chosen; one that is no longer in it may not."""
        try:
            return self._kb.is_action_feasible(action)
        except UnknownElementError:
            return False

    def why(self, action: str) -> str:
        """One line on an action's status."""
        try:
            return self._kb.explain(ElementKind.ACTION, action).summary
        except UnknownElementError:
            return f"{action} is no longer in the knowledge base"

    def obstacles(self) -> dict[str, Obstacle]:
        """What the unfeasible actions keep from being used.

        Returns:
            by the actions' names, in the order of the knowledge base.
        """
        found: dict[str, Obstacle] = {}
        for action in self._kb.statuses(ElementKind.ACTION):
            if not self.is_feasible(action):
                facts = sum(bit for name, bit in self._task.feasibility.items() if self._action_of[name] == action)
                operators = frozenset(index for other, index in self._unasked if other == action)
                if facts or operators:
                    found[action] = Obstacle(facts, operators)
        return found

    def _actions_of(self, operator: Operator) -> tuple[str, ...]:
        asked = [name for name, bit in self._task.feasibility.items() if bit & operator.feasibility]
        names = asked or [operator.action]
        return tuple(dict.fromkeys(self._action_of[name] for name in names if name in self._action_of))


def _actions_by_name(actions: Mapping[str, str], known: list[str], task: GroundTask) -> dict[str, str]:
    """The action of the knowledge base for each name of the domain that stands for one."""
    _check_mapping(actions, known, task)
    mapped = {comparable(name): action for name, action in actions.items()}
    by_name = {comparable(name): name for name in known}
    names = dict.fromkeys([*task.feasibility, *(operator.action for operator in task.operators)])
    found = {
        name: action
        for name in names
        if (action := mapped.get(comparable(name)) or by_name.get(comparable(name))) is not None
    }
    problems = [
        Problem(f"'{name}' is no action of the knowledge base", hint=_hint(name, known))
        for name in task.feasibility
        if name not in found
    ]
    if problems:
        raise InputError(problems)
    return found


def _hint(name: str, known: Iterable[str]) -> str:
    there_are = f"there are: {', '.join(known) or 'none'}"
    return nearest(name, known) or f"add it to a knowledge model, or map it with actions={{'{name}': ...}}; {there_are}"


def _check_mapping(actions: Mapping[str, str], known: list[str], task: GroundTask) -> None:
    names = [*task.feasibility, *dict.fromkeys(operator.action for operator in task.operators)]
    loose = {comparable(name) for name in names}
    problems = [
        Problem(
            f"'{name}' is mapped to '{action}', which is no action of the knowledge base", hint=nearest(action, known)
        )
        for name, action in actions.items()
        if action not in known
    ]
    problems += [
        Problem(f"'{name}' is mapped, but is neither an object nor an action of the domain", hint=nearest(name, names))
        for name in actions
        if comparable(name) not in loose
    ]
    if problems:
        raise InputError(problems)
