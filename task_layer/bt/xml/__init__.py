"""Missions in BehaviorTree.CPP v4 XML: read, checked, built, looked at and saved."""
