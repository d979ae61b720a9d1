"""Managing systems: who decides how the robot is configured."""
