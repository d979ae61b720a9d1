"""The AGV in its world: kinematic, deterministic, light."""

from agv_example.world.robot import AgvRobot, RobotEvent

__all__ = ["AgvRobot", "RobotEvent"]
