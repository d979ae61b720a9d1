"""Managing systems: who decides how the robot goes and how it is configured."""
