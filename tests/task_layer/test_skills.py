"""Skills that are made of others, or of functions."""

from __future__ import annotations

from task_layer.bt.testing import ScriptedSkill
from task_layer.skill import SkillStatus, WaitUntil, WithHooks


def test_until_runs_until_something_is_so() -> None:
    arrived: list[bool] = []
    skill = WaitUntil(lambda: bool(arrived))
    skill.start()
    assert skill.update() is SkillStatus.RUNNING
    arrived.append(True)
    assert skill.update() is SkillStatus.SUCCESS
    skill.stop()


def test_what_accompanies_a_skill_begins_before_it_and_ends_after_it() -> None:
    skill = ScriptedSkill("RF")
    accompanied = WithHooks(skill, lambda: skill.calls.append("begin"), lambda: skill.calls.append("end"))
    accompanied.start()
    assert accompanied.update() is SkillStatus.RUNNING
    assert accompanied.update() is SkillStatus.FAILURE
    accompanied.stop()
    assert skill.calls == ["begin", "start", "update", "update", "stop", "end"]
