"""Missions: what is to be done, and what goes wrong meanwhile."""
