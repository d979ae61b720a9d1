"""A better sensor is mounted while the robot works: the knowledge grows, and the robot uses it at once."""

from pathlib import Path

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.mape import AdaptationLoop
from rosa_core.model.elements import Component, ComponentType, FunctionDesign


class Rover:
    """A managed system that only prints what it is asked for."""

    def activate(self, component):
        print("start", component)

    def deactivate(self, component):
        print("stop", component)

    def set_parameters(self, component, parameters):
        print("set", component, parameters)


kb = KnowledgeBase(KnowledgeModel.load(Path(__file__).with_name("rover.yaml")))
with AdaptationLoop(kb, Rover()):
    kb.request_action("drive")
    radar = Component("radar", ComponentType.ROS_NODE)
    kb.add_elements(radar, FunctionDesign("see with radar", "see", ("radar",), priority=0))

# prints:
# set camera {'exposure_ms': 20.0}
# start camera
# start motors
# stop camera
# start radar
