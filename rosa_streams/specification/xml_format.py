"""Transformation and target specifications in the paper's XML (listings 1 and 2)."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike
from xml.sax.saxutils import escape, quoteattr

from rosa_core.errors import Location, Problem, nearest
from rosa_streams.environment import ParameterValue, Target, Transformation
from rosa_streams.errors import StreamError
from rosa_streams.specification.drafts import PortDraft, TargetDraft, TransformationDraft
from rosa_streams.specification.numbers import not_negative
from rosa_streams.specification.xml_source import Element, read_xml

CONTAINERS = ("specifications", "transformations", "targets")
_TRANSFORMATION = ("label", "source", "params", "ports", "tags", "cost", "quality")
_TARGET = ("label", "topic", "tag")
_TRUE_FALSE = {"true": True, "1": True, "false": False, "0": False}


def read_specifications(file: str | PathLike[str]) -> list[TransformationDraft | TargetDraft]:
    """The transformations and targets of a file: one as its root, or several in ``<specifications>``.

    Raises:
        StreamError: with every problem that was found, each with its line.
    """
    return _Reader().whole(read_xml(file))


class _Reader:
    """Reads elements and collects what is wrong."""

    def __init__(self) -> None:
        self._problems: list[Problem] = []

    def whole(self, root: Element) -> list[TransformationDraft | TargetDraft]:
        drafts: list[TransformationDraft | TargetDraft] = []
        self._read(root, drafts)
        if self._problems:
            raise StreamError(self._problems)
        return drafts

    def _read(self, element: Element, drafts: list[TransformationDraft | TargetDraft]) -> None:
        if element.tag == "transformation":
            drafts.append(self._transformation(element))
        elif element.tag == "target":
            drafts.append(self._target(element))
        elif element.tag in CONTAINERS:
            for child in element.children:
                self._read(child, drafts)
        else:
            self._unknown("element", element.tag, ("transformation", "target", *CONTAINERS), element.where)

    def _transformation(self, element: Element) -> TransformationDraft:
        parts = self._parts(element, _TRANSFORMATION)
        self._attributes(element, ("type",))
        inputs, outputs = self._ports(parts.get("ports"), parts.get("tags"))
        cost = parts.get("cost")
        if cost is not None:
            self._attributes(cost, ("labor", "upkeep"))
        quality = parts.get("quality")
        return TransformationDraft(
            self._text(element, parts, "label"),
            self._text(element, parts, "source"),
            inputs,
            outputs,
            self._parameters(parts.get("params")),
            element.where,
            (self._number(quality.text, "quality", quality.where) or 0.0) if quality else 0.0,
            self._cost(cost, "labor"),
            self._cost(cost, "upkeep"),
        )

    def _target(self, element: Element) -> TargetDraft:
        parts = self._parts(element, _TARGET)
        tag = parts.get("tag")
        return TargetDraft(
            self._text(element, parts, "label"),
            self._text(element, parts, "tag"),
            self._text(element, parts, "topic"),
            tag.where if tag else element.where,
        )

    def _parts(self, element: Element, known: tuple[str, ...]) -> dict[str, Element]:
        parts: dict[str, Element] = {}
        for child in element.children:
            if child.tag not in known:
                self._unknown("element", child.tag, known, child.where)
            elif child.tag in parts:
                self._problem(f"<{child.tag}> stands twice in a {element.tag}", child.where)
            else:
                parts[child.tag] = child
        return parts

    def _text(self, element: Element, parts: dict[str, Element], name: str) -> str:
        part = parts.get(name)
        if part is None or not part.text:
            what = f"a {element.tag} needs a <{name}>" if part is None else f"<{name}> is empty"
            self._problem(what, element.where if part is None else part.where)
            return ""
        return part.text

    def _parameters(self, params: Element | None) -> tuple[tuple[str, ParameterValue], ...]:
        found: dict[str, ParameterValue] = {}
        for child in params.children if params else ():
            if child.tag != "param":
                self._unknown("element", child.tag, ("param",), child.where)
                continue
            self._attributes(child, ("name", "type"))
            name = child.attributes.get("name", "")
            if not name or name in found:
                self._problem("a parameter needs a name of its own", child.where)
            found[name] = self._value(child)
        return tuple(found.items())

    def _value(self, param: Element) -> ParameterValue:
        kind = param.attributes.get("type", "string")
        try:
            if kind in {"string", "str"}:
                return param.text
            if kind in {"int", "integer"}:
                return int(param.text)
            if kind in {"double", "float"}:
                return float(param.text)
            if kind in {"bool", "boolean"}:
                return _TRUE_FALSE[param.text.lower()]
        except (ValueError, KeyError):
            self._problem(f"'{param.text[:60]}' is no {kind}", param.where)
            return ""
        self._unknown("parameter type", kind, ("string", "int", "double", "bool"), param.where)
        return ""

    def _ports(
        self, ports: Element | None, tags: Element | None
    ) -> tuple[tuple[PortDraft, ...], tuple[PortDraft, ...]]:
        texts = self._tags(tags)
        found: dict[str, list[PortDraft]] = {"in": [], "out": []}
        names: dict[str, Location] = {}
        for child in ports.children if ports else ():
            if child.tag != "port":
                self._unknown("element", child.tag, ("port",), child.where)
                continue
            self._attributes(child, ("type",))
            kind, name = child.attributes.get("type", ""), child.text
            if kind not in found:
                self._unknown("port type", kind, ("in", "out"), child.where)
            elif not name or name in names:
                self._problem(f"two ports are named '{name}'" if name else "a port needs a name", child.where)
            elif name not in texts:
                self._problem(f"the port '{name}' has no tag", child.where, nearest(name, texts))
            else:
                found[kind].append(PortDraft(name, *texts[name]))
            names[name] = child.where
        for name, (_, where) in texts.items():
            if name not in names:
                self._problem(f"a tag is for the port '{name}', and there is none", where, nearest(name, names))
        return tuple(found["in"]), tuple(found["out"])

    def _tags(self, tags: Element | None) -> dict[str, tuple[str, Location]]:
        texts: dict[str, tuple[str, Location]] = {}
        for child in tags.children if tags else ():
            if child.tag != "tag":
                self._unknown("element", child.tag, ("tag",), child.where)
                continue
            self._attributes(child, ("port",))
            port = child.attributes.get("port", "")
            if not port or port in texts:
                what = f"the port '{port}' has two tags" if port else "a tag needs the attribute port"
                self._problem(what, child.where, None if not port else "join them with 'and'")
            texts[port] = (child.text, child.where)
        return texts

    def _cost(self, cost: Element | None, name: str) -> float | None:
        text = cost.attributes.get(name) if cost else None
        return None if cost is None or text is None else self._number(text, name, cost.where)

    def _number(self, text: str, what: str, where: Location) -> float | None:
        number = not_negative(text)
        if number is None:
            self._problem(f"{what} is a number of at least 0, not '{text[:60]}'", where)
        return number

    def _attributes(self, element: Element, known: tuple[str, ...]) -> None:
        for name in element.attributes:
            if name not in known:
                self._unknown("attribute", name, known, element.where)

    def _unknown(self, kind: str, name: str, known: Iterable[str], where: Location) -> None:
        hint = nearest(name, known) or f"known are {', '.join(known)}"
        self._problem(f"unknown {kind} '{name}'", where, hint)

    def _problem(self, what: str, where: Location, hint: str | None = None) -> None:
        self._problems.append(Problem(what, where, hint))


def specifications_xml(transformations: Iterable[Transformation], targets: Iterable[Target] = ()) -> str:
    """The specifications as XML that :func:`read_specifications` reads back."""
    lines = ["<specifications>"]
    for each in transformations:
        lines += ['  <transformation type="nodelet">', *_transformation_xml(each), "  </transformation>"]
    for target in targets:
        lines += [
            "  <target>",
            f"    <label>{escape(target.qid)}</label>",
            f"    <topic>{escape(target.channel)}</topic>",
            f"    <tag>{escape(str(target.tag))}</tag>",
            "  </target>",
        ]
    return "\n".join([*lines, "</specifications>", ""])


def _transformation_xml(each: Transformation) -> Iterable[str]:
    yield f"    <label>{escape(each.tid)}</label>"
    yield f"    <source>{escape(each.source)}</source>"
    yield "    <params>"
    for name, value in each.parameters:
        kind = {bool: "bool", int: "int", float: "double", str: "string"}[type(value)]
        text = str(value).lower() if isinstance(value, bool) else str(value)
        yield f"      <param name={quoteattr(name)} type={quoteattr(kind)}>{escape(text)}</param>"
    yield "    </params>"
    yield "    <ports>"
    for kind, ports in (("in", each.inputs), ("out", each.outputs)):
        for port in ports:
            yield f"      <port type={quoteattr(kind)}>{escape(port.name)}</port>"
    yield "    </ports>"
    yield "    <tags>"
    for port in (*each.inputs, *each.outputs):
        yield f"      <tag port={quoteattr(port.name)}>{escape(str(port.tag))}</tag>"
    yield "    </tags>"
    if each.labor is not None or each.upkeep is not None:
        labor = "" if each.labor is None else f' labor="{each.labor!r}"'
        upkeep = "" if each.upkeep is None else f' upkeep="{each.upkeep!r}"'
        yield f"    <cost{labor}{upkeep}/>"
    if each.quality:
        yield f"    <quality>{each.quality!r}</quality>"
