"""Steps that are being carried out, and the skills that do it."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from rosa_core import InputError
from rosa_core.errors import Problem, nearest
from task_layer.pddl.ground import GroundTask, Operator
from task_layer.pddl.names import loosely
from task_layer.skill import Skill, SkillStatus

SkillSource: TypeAlias = Skill | Callable[..., Skill]
"""A skill, or a function that is given the names of a step's objects and makes the skill for it."""

_log = logging.getLogger(__name__)


@dataclass(slots=True)
class RunningStep:
    """A step of a plan that has started.

    ``actions`` are the actions of the knowledge base that it has requested, ``trouble`` is why it cannot go on.
    """

    operator: Operator
    skill: Skill
    actions: tuple[str, ...]
    started: float
    trouble: str | None = None

    def begin(self) -> None:
        """Start the skill; one that raises is in trouble."""
        try:
            self.skill.start()
        except Exception as error:
            self._raised(error)

    def update(self) -> SkillStatus:
        """Ask the skill how far it has got; one that raises has failed."""
        try:
            return self.skill.update()
        except Exception as error:
            self._raised(error)
            return SkillStatus.FAILURE

    def end(self) -> None:
        """Stop the skill."""
        try:
            self.skill.stop()
        except Exception as error:
            self._raised(error)

    def _raised(self, error: Exception) -> None:
        _log.exception("the skill of %s raised", self.operator.name)
        self.trouble = f"its skill raised {type(error).__name__}: {error}"


def find_skills(task: GroundTask, skills: Mapping[str, SkillSource]) -> dict[str, SkillSource]:
    """The skill for each action of a task, by the action's name, which may be joined and cased otherwise.

    Raises:
        InputError: if an action has none.
    """
    given = {loosely(name): skill for name, skill in skills.items()}
    actions = dict.fromkeys(operator.action for operator in task.operators)
    problems = [
        Problem(
            f"the action '{name}' has no skill", mend=nearest(name, skills) or f"give one: skills={{'{name}': ...}}"
        )
        for name in actions
        if loosely(name) not in given
    ]
    if problems:
        raise InputError(problems)
    return {name: given[loosely(name)] for name in actions}


def skill_for(operator: Operator, source: SkillSource) -> Skill:
    """The skill for a step."""
    return source if isinstance(source, Skill) else source(*operator.arguments)
