"""A rover that drives with its camera, and with its lidar when the camera fails.

The smallest robot there is: a model (rover.yaml), a managed system, a skill, a tree.
"""

from pathlib import Path

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.mape import AdaptationLoop
from task_layer.bt import TreeRunner, if_feasible
from task_layer.skill import Skill, SkillStatus

kb = KnowledgeBase(KnowledgeModel.load(Path(__file__).with_name("rover.yaml")))


class Rover:
    """The managed system: how components are started, stopped and configured."""

    def activate(self, component):
        print("start", component)

    def deactivate(self, component):
        print("stop", component)

    def set_parameters(self, component, parameters):
        print("set", component, parameters)


class Drive(Skill):
    """Three updates long; during the second one the camera fails."""

    left = 3

    def update(self):
        self.left -= 1
        if self.left == 1:
            kb.set_component_failure("camera")  # what a monitor would report
        return SkillStatus.RUNNING if self.left else SkillStatus.SUCCESS


with AdaptationLoop(kb, Rover()), TreeRunner(if_feasible("drive", Drive()), kb, period=0.01) as runner:
    print(runner.run())
print("see with camera:", kb.status("function_design", "see with camera").value)

# prints:
# set camera {'exposure_ms': 20.0}
# start camera
# start motors
# stop camera
# start lidar
# stop lidar
# stop motors
# Status.SUCCESS
# see with camera: unfeasible
