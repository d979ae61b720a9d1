"""One status for skills, functions and leaves."""

from __future__ import annotations

import pytest
from py_trees.common import Status

from task_layer.bt.engine.status import as_status
from task_layer.skill import Skill, SkillStatus, updated


@pytest.mark.parametrize(
    ("result", "status"),
    [
        *((status, Status[status.name]) for status in SkillStatus),
        (True, Status.SUCCESS),
        (False, Status.FAILURE),
        (None, Status.SUCCESS),
        (Status.INVALID, Status.INVALID),
    ],
)
def test_every_result_stands_for_one_status(result: object, status: Status) -> None:
    assert as_status(result) is status


@pytest.mark.parametrize("result", [1, 0, "done", "RUNNING"])
def test_what_only_resembles_a_status_is_none(result: object) -> None:
    with pytest.raises(TypeError, match="a leaf must return"):
        as_status(result)


def test_a_skill_must_say_how_far_it_has_got() -> None:
    class Vague(Skill):
        def update(self) -> SkillStatus:
            return "nearly"  # type: ignore[return-value]

    with pytest.raises(TypeError, match="must return a SkillStatus, not 'nearly'"):
        updated(Vague())
    with pytest.raises(TypeError, match=r"must define update\(\)"):
        updated(Skill())
