"""XML from outside: safe, with the line of every element, and bounded in size and depth."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from xml.sax import SAXException, SAXParseException
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import AttributesImpl, Locator

from defusedxml import DefusedXmlException
from defusedxml.sax import parseString

from rosa_core.errors import Location, Problem
from rosa_streams.errors import StreamError

LARGEST = 16_000_000
"""How many bytes a file may have."""

DEEPEST = 20
"""How deep elements may be nested."""


@dataclass(slots=True)
class Element:
    """One element of a file."""

    tag: str
    attributes: dict[str, str]
    where: Location
    children: list[Element] = field(default_factory=list)
    text: str = ""


def read_xml(path: str | PathLike[str]) -> Element:
    """The root element of a file.

    Raises:
        StreamError: if it cannot be read, is not XML, has entities or a document type, or is too large or too deep.
    """
    builder = _Builder(str(path))
    try:
        parseString(_read(Path(path)), builder, forbid_dtd=True)
    except SAXParseException as error:
        where = Location(str(path), error.getLineNumber())
        raise StreamError(Problem(f"not valid XML: {error.getMessage()}", where)) from None
    except DefusedXmlException:
        what = "document types and entities are not allowed"
        raise StreamError(Problem(what, builder.where(), "leave the <!DOCTYPE ...> out")) from None
    except (SAXException, ValueError, LookupError) as error:
        raise StreamError(Problem(f"not valid XML: {error}", Location(str(path)))) from None
    if builder.root is None:
        raise StreamError(Problem("not valid XML: no element found", Location(str(path))))
    return builder.root


def _read(path: Path) -> bytes:
    where = Location(str(path))
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise StreamError(Problem(f"cannot read it: {reason}", where)) from None
    if len(data) > LARGEST:
        raise StreamError(Problem(f"it has more than {LARGEST:,} bytes", where))
    return data


class _Builder(ContentHandler):
    """Makes elements of what the parser reports."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self.root: Element | None = None
        self._file = file
        self._open: list[tuple[Element, list[str]]] = []
        self._position: Locator | None = None

    def setDocumentLocator(self, locator: Locator) -> None:  # noqa: N802
        """Take what knows the line."""
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
        if len(self._open) > DEEPEST:
            raise StreamError(Problem(f"it is nested more than {DEEPEST} levels deep", element.where))

    def endElement(self, name: str) -> None:  # noqa: ARG002, N802
        """The element that began last ends."""
        element, texts = self._open.pop()
        element.text = "".join(texts).strip()

    def characters(self, content: str) -> None:
        """Text inside an element."""
        self._open[-1][1].append(content)
