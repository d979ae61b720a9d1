"""The AGV in its world: kinematic, deterministic, light."""

from agv_example.world.robot import AgvRobot

__all__ = ["AgvRobot"]
