"""``rosa replay``: print the log of a tree."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from defusedxml import DefusedXmlException
from defusedxml import ElementTree as SafeET
from rich.console import Console
from rich.text import Text

from rosa_cli.tree_view import STYLES
from rosa_core import InputError
from rosa_core.errors import Location, Problem
from task_layer.bt.display.description import printable
from task_layer.bt.groot.btlog import BtLog, read_btlog
from task_layer.bt.groot.transition import StatusCode


def replay(file: Path, *, speed: float | None, as_json: bool) -> None:
    """Print every change of a status: its time, the node, and both statuses."""
    log = read_btlog(file)
    names = _names(log.xml, file)
    changes = list(_changes(log, names))
    if as_json:
        document = {"file": str(file), "start_s": log.start_s, "transitions": changes}
        print(json.dumps(document, indent=2, ensure_ascii=False))
        return
    console = Console(highlight=False, soft_wrap=True)
    width = max((len(change["name"]) for change in changes), default=0)
    began = time.perf_counter()
    for change in changes:
        if speed is not None:
            time.sleep(max(0.0, change["time_s"] / speed - (time.perf_counter() - began)))
        console.print(_line(change, width))


def _line(change: dict[str, Any], width: int) -> Text:
    old, new = change["old"], change["new"]
    return Text.assemble(
        (f"{change['time_s']:12.6f} s", "cyan"),
        f"  {change['name']:{width}}  ",
        (f"{old:>7}", STYLES[old]),
        " -> ",
        (new, STYLES[new]),
    )


def _changes(log: BtLog, names: dict[int, str]) -> Iterator[dict[str, Any]]:
    """The transitions of the log, with the names of nodes and their statuses before."""
    before: dict[int, StatusCode] = {}
    for transition in log.transitions:
        uid = transition.uid
        old = before.get(uid, StatusCode.IDLE)
        before[uid] = transition.status
        name = names.get(uid, f"node {uid}")
        yield {
            "time_s": transition.time_s,
            "uid": uid,
            "name": name,
            "old": old.name,
            "new": transition.status.name,
        }


def _names(xml: str, file: Path) -> dict[int, str]:
    """The names of the log's nodes, by number."""
    try:
        root = SafeET.fromstring(xml, forbid_dtd=True)
    except (ET.ParseError, DefusedXmlException, ValueError):
        raise InputError(
            Problem("the tree in the log cannot be read", Location(str(file)), "the log is damaged")
        ) from None
    return {int(uid): _name(element) for element in root.iter() if (uid := element.get("_uid", "")).isdecimal()}


def _name(element: ET.Element) -> str:
    tag = element.get("ID", element.tag)
    name = element.get("name") or element.get("_fullpath") or tag
    ports = [f"{port}={text}" for port, text in element.items() if port not in _NOT_PORTS]
    return printable(" ".join([tag, *([] if name == tag else [f'"{name}"']), *ports]))


_NOT_PORTS = ("ID", "name", "_uid", "_fullpath")
