"""Changes to good inputs that know their structure: documents, token sequences, XML, bytes and database files."""

from __future__ import annotations

import copy
import math
import re
import sqlite3
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True, slots=True)
class Change:
    """One change: what is done, where, and with what; each number is taken modulo what there is."""

    what: int
    where: int
    payload: int

    def pick(self, several: Sequence[Any]) -> Any:
        """One of several payloads."""
        return several[self.payload % len(several)]


ODD_TEXTS = (
    "", " ", "0", "-1", "1e999", "nan", "9" * 400, "a" * 1500, "../../etc/passwd", "\x00", "\x07", "é\u2028x",
    "\U0001f600",
    "{x}", "{=}", "'", '"', "<a>", "&amp;", "%s", "$(x)", "__init__", "null", "true", "a;b", "[1]", "2026-01-01",
    "#", ":",
    "\t", "\n", "C1", "active.", "(1,failure,3)", "RUNNING", "=", "-", "1_000", "0x1f", "!!python/object:os.system",
)  # fmt: skip
ODD_VALUES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 0.5, -0.0, 2**53, 2**63, -(2**63), 10**30, 1e308, math.inf, -math.inf, math.nan, [],
    {},
    [[]], {"a": {}}, {"": 1}, {0: None}, {True: False}, [None], [1, "a", 0.5], {"ros__parameters": {}}, *ODD_TEXTS,
)  # fmt: skip


def _nested(depth: int) -> Any:
    value: Any = 1
    for level in range(depth):
        value = [value] if level % 2 else {"a": value}
    return value


def changed_document(document: Any, changes: Sequence[Change]) -> Any:
    """A document of mappings, lists and scalars after some changes."""
    holder = [copy.deepcopy(document)]
    for change in changes:
        places = list(_places(holder))
        container, key = places[change.where % len(places)]
        _DOCUMENT_CHANGES[change.what % len(_DOCUMENT_CHANGES)](container, key, change, places)
    return holder[0]


def _places(value: Any) -> Iterator[tuple[Any, Any]]:
    keys = range(len(value)) if isinstance(value, list) else list(value)
    for key in keys:
        yield value, key
        if isinstance(value[key], list | dict):
            yield from _places(value[key])


def _replace(container: Any, key: Any, change: Change, _places: Any) -> None:
    container[key] = copy.deepcopy(change.pick(ODD_VALUES))


def _remove(container: Any, key: Any, _change: Change, places: Any) -> None:
    if container is not places[0][0]:
        del container[key]


def _rename(container: Any, key: Any, change: Change, _places: Any) -> None:
    if isinstance(container, dict):
        container[change.pick((*ODD_TEXTS, 0, 1.5, True, None))] = container.pop(key)


def _copy_from_elsewhere(container: Any, key: Any, change: Change, places: Any) -> None:
    other, other_key = places[change.payload % len(places)]
    container[key] = copy.deepcopy(other[other_key])


def _repeat(container: Any, key: Any, change: Change, _places: Any) -> None:
    if isinstance(container, list):
        container.extend(copy.deepcopy([container[key]] * (change.payload % 5)))
    else:
        container[f"{key}_{change.payload % 3}"] = copy.deepcopy(container[key])


def _wrap(container: Any, key: Any, change: Change, _places: Any) -> None:
    container[key] = [container[key]] if change.payload % 2 else {"a": container[key]}


def _bury(container: Any, key: Any, change: Change, _places: Any) -> None:
    container[key] = _nested(change.payload % 80)


_DOCUMENT_CHANGES: tuple[Callable[[Any, Any, Change, Any], None], ...] = (
    _replace, _replace, _remove, _rename, _copy_from_elsewhere, _repeat, _wrap, _bury,
)  # fmt: skip

_TOKEN = re.compile(r"\s+|\"[^\"\n]*\"|'[^'\n]*'|[\w.\-]+|:=|[<>!=]=|.", re.ASCII)


def tokens_of(text: str) -> list[str]:
    """The words, numbers, quoted texts, signs and spaces of a text in a formal language."""
    return _TOKEN.findall(text)


def changed_tokens(tokens: Sequence[str], changes: Sequence[Change], vocabulary: Sequence[str]) -> str:
    """A text after some changes to its tokens; new ones come from itself, the vocabulary, or are odd."""
    result = list(tokens)
    for change in changes:
        place = change.where % (len(result) + 1)
        put = change.pick((*vocabulary, *ODD_TEXTS))
        match change.what % 8:
            case 0 | 1:
                result[place : place + 1] = [put]
            case 2:
                del result[place : place + 1 + change.payload % 4]
            case 3:
                result.insert(place, put)
            case 4:
                other = change.payload % (len(result) + 1)
                result[place : place + 1] = result[other : other + 5]
            case 5:
                result[place:place] = ["("] * (change.payload % 300)
            case 6:
                result[place:place] = result[place : place + 20] * (change.payload % 20)
            case 7:
                del result[place:]
    return "".join(result)


def changed_bytes(data: bytes, changes: Sequence[Change]) -> bytes:
    """Bytes after some are replaced, removed, repeated or cut off."""
    for change in changes:
        place = change.where % (len(data) + 1)
        match change.what % 6:
            case 0 | 1:
                data = data[:place] + bytes([change.payload % 256]) + data[place + 1 :]
            case 2:
                data = data[:place] + data[place + 1 + change.payload % 30 :]
            case 3:
                data = data[:place] + change.payload.to_bytes(8, "big") * (change.payload % 5) + data[place:]
            case 4:
                data = data[:place] + b"\xff" * 4 + data[place + 4 :]
            case 5:
                data = data[:place]
    return data


def changed_xml(text: str, changes: Sequence[Change], vocabulary: Sequence[str]) -> str:  # noqa: C901
    """An XML document after changes to its elements and attributes."""
    root = ET.fromstring(text)
    for change in changes:
        elements = list(root.iter())
        element = elements[change.where % len(elements)]
        value = change.pick((*vocabulary, *ODD_TEXTS))
        names = list(element.attrib)
        match change.what % 7:
            case 0 | 1:
                if names:
                    element.set(names[change.payload % len(names)], value)
            case 2:
                element.tag = change.pick(vocabulary)
            case 3:
                other = elements[change.payload % len(elements)]
                if element not in other.iter():
                    element.append(copy.deepcopy(other))
            case 4:
                element.set(change.pick(vocabulary), value)
            case 5:
                for child in list(element)[change.payload % 3 :]:
                    element.remove(child)
            case 6:
                if names:
                    del element.attrib[names[change.payload % len(names)]]
    return ET.tostring(root, encoding="unicode").translate({0: "&#0;", 7: "&#7;"})


ODD_CELLS: tuple[Any, ...] = (
    None, 0, 1, -1, 2**62, -(2**63), 0.5, 1e308, math.inf, "", "x", "{}", "[]", "null", "1", '"a"', b"", b"\xff\x00",
    b"[]", "[" * 5000, '{"a":' * 500, "9" * 5000, '[["measurement","x","y",0]]', '[["measurement","battery",1e999,0]]',
    '[["measurement",1,1,1]]', '[["selection","function_design","nowhere",true]]', '[["plan_made",null]]', '[["a"]]',
    '[["component_failure","motor","x"]]', '[["plans_made",-1]]', '[["model_change",{},{}]]', "[[[]]]", "[{}]", "[1]",
    '[["required_action",{}]]', "NaN", "[NaN]", '{"a":NaN}', '{"a":1e999}', '{"a":[1,2]}', "2026-13-01", "done",
    "failed",
    "a" * 3000, "'; DROP TABLE runs; --", '[["action","explore","feasible","unfeasible"]]', '[["x",1,2,3]]',
)  # fmt: skip


def change_database(
    path: Path, changes: Sequence[Change], repair: Callable[[sqlite3.Connection, str], None] = lambda *_: None
) -> None:
    """Alter cells, rows and tables of a SQLite file in place.

    Args:
        path: the file.
        changes: what is done.
        repair: called with the connection and each table that was altered, to make its checksums right again.
    """
    with closing(sqlite3.connect(path)) as db:
        db.execute("PRAGMA ignore_check_constraints = ON")
        for change in changes:
            tables = [
                name for (name,) in db.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name")
            ]
            if not tables:
                return
            table = tables[change.where % len(tables)]
            columns = [row[1] for row in db.execute(f"PRAGMA table_info({table})")]
            column = columns[change.where // 7 % len(columns)]
            rows = db.execute(f"SELECT count(*) FROM {table}").fetchone()[0]
            with suppress(sqlite3.Error):
                _alter(db, table, column, change, change.where // 97 % max(rows, 1))
                repair(db, table)
        db.commit()


def _alter(db: sqlite3.Connection, table: str, column: str, change: Change, row: int) -> None:
    key = db.execute(f"PRAGMA table_info({table})").fetchone()[1]
    one = f"{key} = (SELECT {key} FROM {table} ORDER BY {key} LIMIT 1 OFFSET {row})"
    match change.what % 10:
        case 7:
            db.execute(f"DELETE FROM {table} WHERE {one}")
        case 8 if change.payload % 8 == 0:
            db.execute(f"DROP TABLE {table}")
        case 8:
            db.execute(f"ALTER TABLE {table} RENAME COLUMN {column} TO other")
        case 9:
            pragma = change.pick(("user_version", "application_id"))
            db.execute(f"PRAGMA {pragma} = {change.payload}")
        case _:
            db.execute(f"UPDATE OR IGNORE {table} SET {column} = ? WHERE {one}", (change.pick(ODD_CELLS),))
