"""The mission: what is done next, as a behaviour tree."""
