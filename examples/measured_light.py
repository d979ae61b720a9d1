"""Diagnostics in, parameters out: in the dark, the camera gets a longer exposure."""

from pathlib import Path

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.mape import AdaptationLoop
from rosa_core.mape.diagnostics import diagnostic


class Rover:
    """A managed system that only prints what it is asked for."""

    def activate(self, component):
        print("start", component)

    def deactivate(self, component):
        print("stop", component)

    def set_parameters(self, component, parameters):
        print("set", component, parameters)


kb = KnowledgeBase(KnowledgeModel.load(Path(__file__).with_name("rover.yaml")))
with AdaptationLoop(kb, Rover()) as loop:
    kb.request_action("drive")
    # The same arrays as on /diagnostics of a ROS 2 robot, as dicts or messages.
    for time, light in enumerate((0.8, 0.1, 0.9)):
        loop.monitor.update(diagnostic(float(time), "light sensor", "EA measurement", "light", str(light)))

# prints:
# set camera {'exposure_ms': 20.0}
# start camera
# start motors
# set camera {'exposure_ms': 200.0}
# set camera {'exposure_ms': 20.0}
