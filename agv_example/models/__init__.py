"""Knowledge models of the AGV."""
