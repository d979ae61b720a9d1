"""The arena with two robots in it, simulated in MuJoCo or as plane geometry."""
