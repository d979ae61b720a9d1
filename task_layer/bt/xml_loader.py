"""The loader of trees that Groot2 saved; it is implemented in :mod:`task_layer.bt.xml`."""

from task_layer.bt.xml.loader import TreeProject, load_tree, load_trees

__all__ = ["TreeProject", "load_tree", "load_trees"]
