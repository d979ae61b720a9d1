"""The world that the aircraft flies in: a kinematic one."""
