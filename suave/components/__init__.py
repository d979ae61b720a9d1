"""The robot's software components: nodes that can be activated, deactivated and given parameters."""
