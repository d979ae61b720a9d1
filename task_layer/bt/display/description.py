"""A node of any tree in words: what it is, what it is called, what its ports are."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from task_layer.bt.types.node_source import NodeKind, NodeSource
from task_layer.bt.types.parameter_text import NotWritableError
from task_layer.bt.types.xml_source import xml_source


def source_or_guess(node: Behaviour) -> NodeSource:
    """How the node is written in XML; if it cannot be, its class, and whether it has children."""
    try:
        return xml_source(node)
    except NotWritableError:
        return NodeSource(type(node).__name__, NodeKind.CONTROL if node.children else NodeKind.ACTION)


def details(node: Behaviour, source: NodeSource) -> list[str]:
    """What there is to say of the node besides its tag: its name, if it is another, and its ports."""
    name = [] if node.name == source.tag else [f'"{printable(node.name)}"']
    return name + ports_of(source)


def ports_of(source: NodeSource) -> list[str]:
    """Every port that is written, as ``name=text``."""
    return [f"{port}={printable(text)}" for port, text in source.ports]


def one_line(node: Behaviour) -> str:
    """Tag, name and ports in one line."""
    source = source_or_guess(node)
    return " ".join([printable(source.tag), *details(node, source)])


def printable(text: str) -> str:
    """The text without what a terminal might obey or XML cannot hold."""
    return "".join(letter if letter.isprintable() else " " for letter in text)
