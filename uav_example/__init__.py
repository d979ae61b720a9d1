"""UAV: an aircraft that searches an area for samples and analyses them, also when its gripper has failed."""
