"""What can go wrong with a robot, found before its mission from its knowledge model alone."""
