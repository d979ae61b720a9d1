"""What skills and functions say of themselves, as a status of py_trees: the one place where the two meet."""

from __future__ import annotations

from py_trees.common import Status

from task_layer.skill import SkillStatus

_STATUS = {
    SkillStatus.RUNNING: Status.RUNNING,
    SkillStatus.SUCCESS: Status.SUCCESS,
    SkillStatus.FAILURE: Status.FAILURE,
    True: Status.SUCCESS,
    False: Status.FAILURE,
    None: Status.SUCCESS,
}


def as_status(result: object) -> Status:
    """The status that a result stands for.

    Args:
        result: a ``SkillStatus`` or ``Status`` is what it says; True means SUCCESS, False FAILURE, None SUCCESS.

    Raises:
        TypeError: if it is something else.

    Example:
        >>> as_status(SkillStatus.RUNNING), as_status(False)
        (<Status.RUNNING: 'RUNNING'>, <Status.FAILURE: 'FAILURE'>)
    """
    if isinstance(result, Status):
        return result
    if result is None or isinstance(result, bool | SkillStatus):
        return _STATUS[result]
    raise TypeError(f"a leaf must return a bool, a status or None, not {result!r}")
