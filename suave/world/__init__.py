"""The world that the robot is in: physics, pipeline, water, battery."""
