"""The loader of trees that Groot2 saved; it is implemented in :mod:`task_layer.bt.xml`."""

from task_layer.bt.xml.loader import load_tree

__all__ = ["load_tree"]
