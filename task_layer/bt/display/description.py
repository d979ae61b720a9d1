"""Describes a node of any tree in words: its tag, its name and its ports."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from task_layer.bt.types.node_source import NodeSource, kind_by_children
from task_layer.bt.types.parameter_text import NotWritableError
from task_layer.bt.types.xml_source import xml_source


def source_or_guess(node: Behaviour) -> NodeSource:
    """How the node is written in XML; if it cannot be written, its class and probable category."""
    try:
        return xml_source(node)
    except NotWritableError:
        return NodeSource(type(node).__name__, kind_by_children(len(node.children)))


def name_and_ports(node: Behaviour, source: NodeSource) -> list[str]:
    """The node's name, if it is not the tag, and its ports."""
    name = [] if node.name == source.tag else [f'"{printable(node.name)}"']
    return name + port_texts(source)


def port_texts(source: NodeSource) -> list[str]:
    """The ports in the node's XML, as ``name=text``."""
    return [f"{port}={printable(text)}" for port, text in source.ports]


def one_line(node: Behaviour) -> str:
    """Tag, name and ports in one line."""
    source = source_or_guess(node)
    return " ".join([printable(source.tag), *name_and_ports(node, source)])


def printable(text: str) -> str:
    """The text with spaces for control characters, which a terminal would obey and XML cannot hold."""
    return "".join(letter if letter.isprintable() else " " for letter in text)
