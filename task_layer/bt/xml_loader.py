"""Missions as Groot2 saves them, loaded as py_trees behaviours; how is in :mod:`task_layer.bt.xml`."""

from task_layer.bt.xml.loader import load_tree

__all__ = ["load_tree"]
