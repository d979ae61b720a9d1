"""Steps that are being carried out, and the skills that do it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from rosa_core import InputError, Result
from rosa_core.errors import Problem, nearest
from task_layer.action_requests import ActionRequest, ActionRequests
from task_layer.mission_part import OnRaise
from task_layer.pddl.grounding.ground_task import GroundTask, Operator
from task_layer.pddl.reading.names import comparable
from task_layer.skill import Skill, SkillStatus, updated

SkillSource: TypeAlias = Skill | Callable[..., Skill]
"""A skill, or a function that is given the names of a step's objects and makes the skill for it."""


@dataclass(slots=True)
class RunningStep:
    """A step of a plan that has started: its actions are requested, and its skill begins once they are accepted.

    Attributes:
        operator: what is carried out.
        source: where its skill comes from.
        actions: the actions of the knowledge base that it requests.
        started: when, in s.
        on_raise: hears of what its skill raises.
        trouble: why it cannot go on.
        just_begun: whether its skill has begun, or it has failed to, and it has not been updated since.
    """

    operator: Operator
    source: SkillSource
    actions: tuple[str, ...]
    started: float
    on_raise: OnRaise
    trouble: str | None = None
    just_begun: bool = False
    _skill: Skill | None = None
    _unanswered: int = 0
    _requests: list[ActionRequest] = field(default_factory=list)

    def start(self, requests: ActionRequests) -> None:
        """Request the actions; a step without any begins at once."""
        self._unanswered = len(self.actions)
        for action in self.actions:
            self._requests.append(requests.request(action, accepted=self._accepted, refused=self.fail))
        if not self.actions:
            self._begin()

    def fail(self, reason: str) -> None:
        """It cannot begin: a request was refused, or it would spoil what it needs."""
        self.trouble = reason
        self.just_begun = True

    def update(self) -> SkillStatus:
        """Ask the skill how far it has got; one that raises has failed, one that has not begun is running."""
        self.just_begun = False
        if self.trouble is not None:
            return SkillStatus.FAILURE
        if self._skill is None:
            return SkillStatus.RUNNING
        try:
            return updated(self._skill)
        except Exception as error:
            self._raised(error)
            return SkillStatus.FAILURE

    def end(self, requests: ActionRequests, result: Result) -> None:
        """Stop the skill, if it has begun, and end the actions."""
        if self._skill is not None:
            try:
                self._skill.stop()
            except Exception as error:
                self._raised(error)
        for request in self._requests:
            requests.finish(request, result)

    def _accepted(self) -> bool:
        self._unanswered -= 1
        if self._unanswered or self.trouble is not None:
            return False
        self._begin()
        return True

    def _begin(self) -> None:
        self.just_begun = True
        try:
            self._skill = skill_for(self.operator, self.source)
            self._skill.start()
        except Exception as error:
            self._raised(error)

    def _raised(self, error: Exception) -> None:
        self.on_raise(self.operator, error)
        self.trouble = f"its skill raised {type(error).__name__}: {error}"


def find_skills(task: GroundTask, skills: Mapping[str, SkillSource]) -> dict[str, SkillSource]:
    """The skill for each action of a task, by the action's name, which may be joined and cased otherwise.

    Raises:
        InputError: if an action has none.
    """
    given = {comparable(name): skill for name, skill in skills.items()}
    actions = dict.fromkeys(operator.action for operator in task.operators)
    problems = [
        Problem(
            f"the action '{name}' has no skill", hint=nearest(name, skills) or f"give one: skills={{'{name}': ...}}"
        )
        for name in actions
        if comparable(name) not in given
    ]
    if problems:
        raise InputError(problems)
    return {name: given[comparable(name)] for name in actions}


def skill_for(operator: Operator, source: SkillSource) -> Skill:
    """The skill for a step.

    Raises:
        TypeError: if what should make it makes something else.
    """
    if isinstance(source, Skill):
        return source
    skill = source(*operator.arguments)
    if not isinstance(skill, Skill):
        raise TypeError(f"what makes the skill must return a Skill, not {skill!r}")
    return skill
