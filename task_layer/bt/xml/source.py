"""Reads XML files from outside: safely, with the line of every element, and bounded in size and depth."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from xml.sax import SAXException, SAXParseException
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import AttributesImpl, Locator

from defusedxml import DefusedXmlException
from defusedxml.sax import parseString

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from task_layer.bt.xml.limits import MAX_BYTES, MAX_DEPTH
from task_layer.bt.xml.syntax_problems import syntax_problem


@dataclass(slots=True)
class Element:
    """One element of a file."""

    tag: str
    attributes: dict[str, str]
    where: Location
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def get(self, name: str) -> str | None:
        """The text of an attribute."""
        return self.attributes.get(name)

    def all(self, tag: str) -> list[Element]:
        """The children of that tag."""
        return [child for child in self.children if child.tag == tag]


def read_xml(path: Path) -> tuple[Element, int]:
    """The root element of a file, and how many bytes the file has.

    Raises:
        InputError: if it cannot be read, is not XML, uses entities or a document type, or is too large or too deep.
    """
    data = read_bytes(path)
    builder = _ElementBuilder(str(path))
    try:
        parseString(data, builder, forbid_dtd=True)
    except SAXParseException as error:
        line, column = error.getLineNumber() or 1, error.getColumnNumber() or 0
        what, hint = syntax_problem(data, error.getMessage(), line, column)
        raise InputError(Problem(f"not valid XML: {what}", Location(str(path), line), hint)) from None
    except DefusedXmlException:
        what = "document types and entities are not allowed"
        raise InputError(Problem(what, builder.where(), "leave the <!DOCTYPE ...> out")) from None
    except (SAXException, ValueError, LookupError) as error:
        raise InputError(Problem(f"not valid XML: {error}", Location(str(path)))) from None
    if builder.root is None:
        raise InputError(Problem("not valid XML: no element found", Location(str(path))))
    return builder.root, len(data)


def read_bytes(path: Path) -> bytes:
    """The content of a file.

    Raises:
        InputError: if it cannot be read, or is too large.
    """
    where = Location(str(path))
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(Problem(f"cannot read it: {reason}", where)) from None
    if len(data) > MAX_BYTES:
        raise InputError(Problem(f"it has more than {MAX_BYTES:,} bytes", where))
    return data


class _ElementBuilder(ContentHandler):
    """Makes elements of the parser's events."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self.root: Element | None = None
        self._file = file
        self._open: list[tuple[Element, list[str]]] = []
        self._position: Locator | None = None

    def setDocumentLocator(self, locator: Locator) -> None:  # noqa: N802
        """Keep the source of line numbers."""
        self._position = locator

    def where(self) -> Location:
        """Where the parser is now."""
        return Location(self._file, None if self._position is None else self._position.getLineNumber())

    def startElement(self, name: str, attrs: AttributesImpl) -> None:  # noqa: N802
        """An element begins."""
        element = Element(name, dict(attrs.items()), self.where())
        if self._open:
            self._open[-1][0].children.append(element)
        else:
            self.root = element
        self._open.append((element, []))
        if len(self._open) > MAX_DEPTH + 2:
            raise InputError(Problem(f"it is nested more than {MAX_DEPTH} levels deep", element.where))

    def endElement(self, name: str) -> None:  # noqa: ARG002, N802
        """The element that began last ends."""
        element, texts = self._open.pop()
        element.text = "".join(texts)

    def characters(self, content: str) -> None:
        """Text inside an element."""
        self._open[-1][1].append(content)
