"""A Pioneer P3DX that drives to the origin past obstacles that its planner does not know (RoCS paper, section 6)."""
