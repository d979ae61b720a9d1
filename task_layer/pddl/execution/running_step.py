"""Steps that are being carried out, and the skills that do it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from rosa_core import InputError
from rosa_core.errors import Problem, nearest
from task_layer.pddl.execution.records import OnRaise
from task_layer.pddl.grounding.ground_task import GroundTask, Operator
from task_layer.pddl.reading.names import loosely
from task_layer.skill import Skill, SkillStatus

SkillSource: TypeAlias = Skill | Callable[..., Skill]
"""A skill, or a function that is given the names of a step's objects and makes the skill for it."""


@dataclass(slots=True)
class RunningStep:
    """A step of a plan that has started.

    ``source`` is where its skill comes from, ``actions`` are the actions of the knowledge base that it has requested,
    ``started`` is when, ``on_raise`` hears of what its skill raises, ``trouble`` is why it cannot go on.
    """

    operator: Operator
    source: SkillSource
    actions: tuple[str, ...]
    started: float
    on_raise: OnRaise
    trouble: str | None = None
    _skill: Skill | None = None

    def begin(self) -> None:
        """Start the skill; one that raises is in trouble."""
        try:
            self._skill = skill_for(self.operator, self.source)
            self._skill.start()
        except Exception as error:
            self._raised(error)

    def update(self) -> SkillStatus:
        """Ask the skill how far it has got; one that raises has failed."""
        if self._skill is None:
            return SkillStatus.FAILURE
        try:
            status = self._skill.update()
            if not isinstance(status, SkillStatus):
                raise TypeError(f"update() must return a SkillStatus, not {status!r}")
        except Exception as error:
            self._raised(error)
            return SkillStatus.FAILURE
        return status

    def end(self) -> None:
        """Stop the skill, if there is one by now."""
        if self._skill is None:
            return
        try:
            self._skill.stop()
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
    given = {loosely(name): skill for name, skill in skills.items()}
    actions = dict.fromkeys(operator.action for operator in task.operators)
    problems = [
        Problem(
            f"the action '{name}' has no skill", hint=nearest(name, skills) or f"give one: skills={{'{name}': ...}}"
        )
        for name in actions
        if loosely(name) not in given
    ]
    if problems:
        raise InputError(problems)
    return {name: given[loosely(name)] for name in actions}


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
