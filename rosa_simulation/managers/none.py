"""No managing system: the task is performed, and nothing adapts."""

from __future__ import annotations

from rosa_simulation.mission import Mission
from task_layer.bt import TreeRunner


def no_manager(mission: Mission) -> TreeRunner:
    """The mission's tree, every action counting as feasible, with skills that set up by themselves what they need."""
    skills = mission.skills
    return mission.runner(mission.unguarded_tree(lambda action: mission.unmanaged(action, skills[action])))
