"""Recognizes files of BehaviorTree.CPP v3, and converts them to v4.

The names and attributes are those of BehaviorTree.CPP's guide to migrate from version 3.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from xml.etree import ElementTree as ET

from defusedxml.ElementTree import DefusedXMLParser

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from task_layer.bt.types.vocabulary import REPLACED
from task_layer.bt.xml.source import Element, read_bytes, read_xml

_SHARED = ("__shared_blackboard", "__autoremap")
_KEPT = ("ID", "name")


def is_version_3(root: Element) -> bool:
    """Whether a file is of BehaviorTree.CPP v3: it says so, or says nothing and has nodes that only v3 has."""
    version = root.get("BTCPP_format")
    return version == "3" or (version is None and _sign_of_version_3(root) is not None)


def version_3_problem(root: Element) -> Problem:
    """What is wrong with a file of BehaviorTree.CPP v3."""
    sign = _sign_of_version_3(root)
    because = "it says so" if sign is None else f"<{sign.tag[:60]}> in line {sign.where.line}"
    hint = "convert it: rosa tree OLD.xml --upgrade NEW.xml"
    return Problem(f"this is BehaviorTree.CPP v3 ({because}); only version 4 is read", root.where, hint)


def _sign_of_version_3(root: Element) -> Element | None:
    to_do = [tree for tree in root.children if tree.tag == "BehaviorTree"]
    while to_do:
        element = to_do.pop()
        if element.tag in REPLACED or any(name in element.attributes for name in _SHARED):
            return element
        to_do.extend(reversed(element.children))
    return None


def upgrade(old: str | PathLike[str], new: str | PathLike[str]) -> list[Problem]:
    """Convert a file of BehaviorTree.CPP v3 to v4; comments stay.

    Args:
        old: the file.
        new: the file that is written; it must not exist yet.

    Returns:
        what could not be converted, or is to be looked at.

    Raises:
        InputError: if the file is no XML, is of version 4 already, or the new one cannot be written.
    """
    root, _ = read_xml(Path(old))  # safely: this refuses entities, and limits size and depth
    if root.tag != "root":
        raise InputError(Problem(f"the outermost element is <{root.tag[:60]}>", root.where, "it must be <root>"))
    if root.get("BTCPP_format") == "4":
        raise InputError(Problem("it is of version 4 already", root.where))
    parser = DefusedXMLParser(target=ET.TreeBuilder(insert_comments=True), forbid_dtd=True)
    document = ET.parse(io.BytesIO(read_bytes(Path(old))), parser)  # noqa: S314 - the parser is defusedxml's
    conversion = _Conversion(Location(str(old)))
    top = document.getroot()
    attributes = {name: text for name, text in top.attrib.items() if name != "BTCPP_format"}
    top.attrib.clear()
    top.attrib.update({"BTCPP_format": "4", **attributes})
    conversion.convert(top)
    text = ET.tostring(top, encoding="unicode")
    try:
        with Path(new).open("x", encoding="utf-8") as file:
            file.write(f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n')
    except (OSError, ValueError) as error:
        raise InputError(Problem(f"cannot write it: {error}", Location(str(new)))) from None
    return conversion.problems


class _Conversion:
    """Changes elements of version 3 into those of version 4, in place."""

    def __init__(self, where: Location) -> None:
        self.problems: list[Problem] = []
        self._where = where
        self._in_models = False

    def convert(self, top: ET.Element) -> None:
        """Convert an element and all below it."""
        to_do = [(top, False)]
        while to_do:
            element, in_models = to_do.pop()
            if isinstance(element.tag, str):
                if in_models:
                    element.tag = _MODELS.get(element.tag, element.tag)
                else:
                    self._element(element)
                in_models = in_models or element.tag == "TreeNodesModel"
                to_do.extend((child, in_models) for child in element)

    def _element(self, element: ET.Element) -> None:
        tag = str(element.tag)
        if tag in ("SubTree", "SubTreePlus"):
            self._subtree(element, braces=tag == "SubTree")
        elif tag in _RENAMED:
            element.tag = _RENAMED[tag]
        elif tag in _COMPARED:
            self._comparison(element, _COMPARED[tag])
        elif tag in ("Action", "Condition", "Control", "Decorator") and element.get("ID") in _RENAMED:
            element.set("ID", _RENAMED[element.get("ID", "")])
        if element.tag == "Parallel":
            _rename_attributes(element, _PARALLEL)

    def _subtree(self, element: ET.Element, *, braces: bool) -> None:
        element.tag = "SubTree"
        for name in _SHARED:
            shared = element.attrib.pop(name, None)
            if shared is not None and shared.strip().lower() in ("1", "true"):
                element.set("_autoremap", "true")
        for name, text in list(element.attrib.items()):
            # A SubTree of v3 names an entry of the tree above; a SubTreePlus writes {braces} around it.
            if braces and name not in _KEPT and not name.startswith("_") and not text.startswith("{"):
                element.set(name, f"{{{text}}}")

    def _comparison(self, element: ET.Element, literal: Callable[[str], str]) -> None:
        values = [element.attrib.pop(name, "") for name in ("value_A", "value_B")]
        otherwise = element.attrib.pop("return_on_mismatch", "FAILURE")
        if not all(values):
            what = f"a <{element.tag}> without value_A or value_B was left as it is"
            self.problems.append(Problem(what, self._where, "write a Precondition"))
            return
        element.tag = "Precondition"
        sides = " == ".join(_operand(value, literal) for value in values)
        element.set("if", sides)
        element.set("else", otherwise)


def _operand(text: str, literal: Callable[[str], str]) -> str:
    text = text.strip()
    return text[1:-1] if text.startswith("{") and text.endswith("}") else literal(text)


def _quoted(text: str) -> str:
    return f'"{text}"' if "'" in text else f"'{text}'"


def _rename_attributes(element: ET.Element, names: Mapping[str, str]) -> None:
    attributes = {names.get(name, name): text for name, text in element.attrib.items()}
    element.attrib.clear()
    element.attrib.update(attributes)


_RENAMED = {
    "SequenceStar": "SequenceWithMemory",
    "FallbackStar": "Fallback",
    "RetryUntilSuccesful": "RetryUntilSuccessful",
}
_MODELS = {"SubTreePlus": "SubTree"}
_PARALLEL = {
    "threshold": "success_count",
    "success_threshold": "success_count",
    "failure_threshold": "failure_count",
}
_COMPARED: Mapping[str, Callable[[str], str]] = {
    "BlackboardCheckInt": str,
    "BlackboardCheckDouble": str,
    "BlackboardCheckBool": lambda text: {"1": "true", "0": "false"}.get(text, text.lower()),
    "BlackboardCheckString": _quoted,
}
