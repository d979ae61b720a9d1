"""The fault tree of an element: gates over failures of components and regions of measures, shared parts once."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rosa_core.model.elements import ElementKind, ElementRef
from rosa_verification.causes import Cause, cause_text
from rosa_verification.structure import Combination, Gate, Structure

_SIGNS = {"<": "below", "<=": "up_to", ">": "above", ">=": "from", "=": "at"}
_NOT_NAME = re.compile(r"[^A-Za-z0-9_]+")


@dataclass(frozen=True, slots=True)
class TreeGate:
    """What follows from some of its inputs.

    Args:
        name: letters, digits and underscores; unique in the tree.
        label: in words.
        combination: any or all of the inputs; of none, never or always.
        gates: names of the gates among the inputs.
        causes: the causes among the inputs.
    """

    name: str
    label: str
    combination: Combination
    gates: tuple[str, ...]
    causes: tuple[Cause, ...]


@dataclass(frozen=True, slots=True)
class FaultTree:
    """When an element is unfeasible.

    Args:
        gates: by name, the top one first.
        causes: all that occur, with a name for each: letters, digits and underscores, unique in the tree.
    """

    gates: Mapping[str, TreeGate]
    causes: Mapping[Cause, str]

    @property
    def top(self) -> TreeGate:
        """The gate of the element itself."""
        return next(iter(self.gates.values()))


def fault_tree(structure: Structure, element: ElementRef) -> FaultTree:
    """The fault tree of an element.

    Args:
        structure: of the model.
        element: one of the structure's.
    """
    names = _Names()
    gates: dict[str, TreeGate] = {}
    causes: dict[Cause, str] = {}
    label = f"{element} unfeasible"
    waiting: list[tuple[str, str, Gate]] = [(names.of(element), label, _simple(structure.unfeasible(element)))]
    while waiting:
        name, label, gate = waiting.pop(0)
        if name in gates:
            continue
        below: list[str] = []
        leaves: list[Cause] = []
        for item in (_without_only_failures(structure, part) for part in gate.inputs):
            if isinstance(item, Gate):
                inner = f"{name}_parts"
                below.append(inner)
                waiting.append((inner, "all of its parts unfeasible", _simple(item)))
            elif isinstance(item, ElementRef):
                below.append(names.of(item))
                waiting.append((names.of(item), f"{item} unfeasible", _simple(structure.unfeasible(item))))
            else:
                leaves.append(item)
                causes[item] = names.of(item)
        gates[name] = TreeGate(name, label, gate.combination, tuple(below), tuple(leaves))
    return FaultTree(gates, causes)


def _simple(gate: Gate) -> Gate:
    """The same gate, with no gate of a single input below it, and not one that merely repeats another."""
    inputs = tuple(item.inputs[0] if isinstance(item, Gate) and len(item.inputs) == 1 else item for item in gate.inputs)
    only = inputs[0] if len(inputs) == 1 else None
    return only if isinstance(only, Gate) else Gate(gate.combination, inputs)


def _without_only_failures(structure: Structure, item: Cause | ElementRef | Gate) -> Cause | ElementRef | Gate:
    """Its failure itself instead of a component against which nothing else can be."""
    if isinstance(item, ElementRef) and item.kind is ElementKind.COMPONENT:
        inputs = structure.unfeasible(item).inputs
        if len(inputs) == 1 and isinstance(inputs[0], str):
            return inputs[0]
    return item


class _Names:
    """Names that every format takes, each given once."""

    def __init__(self) -> None:
        self._given: dict[Cause | ElementRef, str] = {}
        self._used: set[str] = set()

    def of(self, thing: Cause | ElementRef) -> str:
        if thing not in self._given:
            text = f"{thing.kind}_{thing.name}" if isinstance(thing, ElementRef) else cause_text(thing)
            for sign, word in _SIGNS.items():
                text = text.replace(f" {sign} ", f" {word} ")
            base = name = _NOT_NAME.sub("_", text if text[0].isascii() and text[0].isalpha() else f"the_{text}").strip(
                "_"
            )
            number = 1
            while name.lower() in self._used:  # some tools take no notice of capital letters
                number += 1
                name = f"{base}_{number}"
            self._used.update((name.lower(), f"{name}_parts".lower()))
            self._given[thing] = name
        return self._given[thing]


def inputs_of(tree: FaultTree, gate: TreeGate) -> Iterator[tuple[str, bool]]:
    """The names of a gate's inputs, and whether each is a gate.

    Args:
        tree: the gate's.
        gate: one of its gates.
    """
    yield from ((name, True) for name in gate.gates)
    yield from ((tree.causes[cause], False) for cause in gate.causes)
