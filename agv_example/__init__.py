"""The AGV that chooses its path and its architecture together (ROSA paper, section 7.4.1)."""
