"""One description of a tree and of what is done with it, from which both trees are made."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from xml.sax.saxutils import quoteattr

VARIABLES = ("v0", "v1", "v2")
"""The blackboard's entries: small integers, 0 at the beginning."""

WORD = "word"
"""An entry that holds text, for a Switch: BehaviorTree.CPP wants an entry to be of one type."""

Board = dict[str, int]


@dataclass(frozen=True, slots=True)
class Check:
    """A comparison of an entry with a number or another entry."""

    variable: str
    equal: bool
    other: str | int

    def holds(self, board: Board) -> bool:
        other = board[self.other] if isinstance(self.other, str) else self.other
        return (board[self.variable] == other) is self.equal

    def __str__(self) -> str:
        return f"{self.variable} {'==' if self.equal else '!='} {self.other}"


@dataclass(frozen=True, slots=True)
class Assignment:
    """An entry gets a number, or another entry's; or 1 becomes 0 and 0 becomes 1."""

    variable: str
    value: str | int

    def do(self, board: Board) -> None:
        board[self.variable] = (
            self.value
            if isinstance(self.value, int)
            else 1 - board[self.variable]
            if self.value == "other"
            else board[self.value]
        )

    def __str__(self) -> str:
        return f"{self.variable} := {f'1 - {self.variable}' if self.value == 'other' else self.value}"


@dataclass(frozen=True, slots=True)
class NodeDescription:
    """A node, with what is below it.

    Attributes:
        kind: the tag in XML; for leaves ``condition``, ``instant`` or ``stateful``.
        number: makes names unique.
        ports: the parameters, as Python values; ``{v0}`` for an entry.
        checks: pre-conditions by attribute (``_skipIf``).
        assignments: post-conditions by attribute (``_onHalted``).
        script: what the ticks of a leaf come to: S, F, R; the last for ever.
        sets: what the leaf does to the blackboard at each call.
    """

    kind: str
    number: int
    children: tuple[NodeDescription, ...] = ()
    ports: dict[str, int | str | bool] = field(default_factory=dict)
    checks: dict[str, Check] = field(default_factory=dict)
    assignments: dict[str, Assignment] = field(default_factory=dict)
    script: str = ""
    sets: Assignment | None = None

    @property
    def name(self) -> str:
        return f"{self.kind}{self.number}"

    def nodes(self) -> Iterator[NodeDescription]:
        yield self
        for child in self.children:
            yield from child.nodes()


@dataclass(frozen=True, slots=True)
class Step:
    """What is done with a tree: ``executeTick``, ``tickOnce``, ``tickExactlyOnce``, ``halt``, or an entry is set."""

    does: str
    assignment: Assignment | None = None
    word: str | None = None

    def __str__(self) -> str:
        if self.word is not None:
            return f"{WORD} := '{self.word}'"
        return self.does if self.assignment is None else str(self.assignment)


@dataclass(frozen=True, slots=True)
class Case:
    """A tree, and what is done with it."""

    root: NodeDescription
    steps: tuple[Step, ...]

    def woken_by_nobody(self) -> Case:
        """The same, but ``tickOnce`` does not tick again."""
        steps = (replace(step, does="tickExactlyOnce") if step.does == "tickOnce" else step for step in self.steps)
        return replace(self, steps=tuple(steps))


LEAVES = ("condition", "instant", "stateful")


def to_xml(root: NodeDescription) -> str:
    """The tree as BehaviorTree.CPP reads it; what is below a SubTree is a tree of its own."""
    trees: list[tuple[str, NodeDescription]] = [("main", root)]
    lines = ['<root BTCPP_format="4" main_tree_to_execute="main">']
    for tree, top in trees:  # grows while it is written
        lines += [f' <BehaviorTree ID="{tree}">', *_element(top, "  ", trees), " </BehaviorTree>"]
    return "\n".join([*lines, "</root>"])


def _element(node: NodeDescription, indent: str, trees: list[tuple[str, NodeDescription]]) -> Iterator[str]:
    attributes: dict[str, object] = {**node.ports, **node.checks, **node.assignments}
    children = node.children
    if node.kind == "SubTree":
        attributes = {"ID": node.name, "_autoremap": "true", **attributes}
        trees.append((node.name, children[0]))
        children = ()
    tag = node.name if node.kind in LEAVES else node.kind
    text = "".join(f" {key}={quoteattr(_text(value))}" for key, value in attributes.items())
    if not children:
        yield f"{indent}<{tag}{text}/>"
        return
    yield f"{indent}<{tag}{text}>"
    for child in children:
        yield from _element(child, indent + "  ", trees)
    yield f"{indent}</{tag}>"


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
