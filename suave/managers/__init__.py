"""What managing systems over system modes know of SUAVE: modes, managing trees, thresholds."""
