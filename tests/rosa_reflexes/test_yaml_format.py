"""Reflexes in YAML: what a file declares, and what is said of files that cannot be used."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import InputError, SimulationClock
from rosa_reflexes import Command, Preempted, read_reflexes

GOOD = """\
sensors:
  range.front: {lowest: 0.0, highest: 5.0, silent_after: 0.5, stuck_after: 2.0, on_fault: stop, works_again_after: 0.2}
parameters: {near: 0.35}
commands:
  stop: {v: 0.0}
  creep: {v: 0.1}
bounds:
  v: {lowest: -0.5, highest: 0.5, rate: 1.0}
safe_command: stop
reflexes:
  keep clear: {rule: range.front < near -> stop; release > 0.5 for 0.3 s, priority: 10, dwell: 0.2}
  slow down: {rule: "range.front < 1.0 -> creep; release > 1.2"}
watchdog: {silent_after: 0.5, command: stop}
"""


def written(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "reflexes.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_file_makes_a_gate_that_does_what_it_says(tmp_path: Path) -> None:
    clock, sent, events = SimulationClock(), list[Command](), list[object]()
    gate = read_reflexes(written(tmp_path, GOOD)).gate(sent.append, clock, events.append)
    gate.sense({"range.front": 0.9})
    assert sent[-1] == {"v": 0.1}
    gate.sense({"range.front": 0.3})
    assert (sent[-1], gate.holder) == ({"v": 0.0}, "keep clear")
    gate.sense({"range.front": 0.4})
    gate.set_parameter("near", 0.5)
    clock.advance_to(0.4)
    gate.sense({"range.front": 0.6})
    clock.advance_to(0.6)
    gate.sense({"range.front": 0.6})
    assert gate.holder == "keep clear"
    clock.advance_to(0.71)
    gate.sense({"range.front": 0.6})
    assert gate.holder == "slow down"
    clock.advance_to(1.3)
    gate.check()
    assert gate.holder == "range.front faulty"
    assert "range.front is silent" in gate.why()
    assert [event.reflex for event in events if isinstance(event, Preempted)] == [
        "slow down",
        "keep clear",
        "slow down",
        "range.front faulty",
    ]


def test_the_bounds_hold_deliberation(tmp_path: Path) -> None:
    clock, sent = SimulationClock(), list[Command]()
    gate = read_reflexes(written(tmp_path, GOOD)).gate(sent.append, clock)
    clock.advance_to(0.25)
    gate.submit({"v": 9.0}, gate.epoch)
    assert sent == [{"v": 0.25}]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("near -> stop", "nera -> stop", r"reflexes.yaml:11: there is no sensor or parameter 'nera' .*'near'"),
        ("near -> stop", "near -> stp", r"reflexes.yaml:11: there is no command 'stp' .*'stop'"),
        ("< near ->", "<< near ->", r"reflexes.yaml:11: it cannot be read from '< near .*column 14"),
        ("> 0.5 for", "> 0.2 for", None),
        ("range.front < 1.0", "near < 1.0", r"reflexes.yaml:12: it reads no sensor"),
        ("range.front < 1.0", "faulty(near) or range.front < 1.0", r":12: .*release condition needs"),
        ("safe_command: stop", "safe_command: halt", r"reflexes.yaml:9: there is no command 'halt'"),
        ("safe_command: stop\n", "", r"safe_command"),
        ("creep: {v: 0.1}", "creep: {v: 0.9}", r"reflexes.yaml:6: v may be from -0.5 to 0.5, not 0.9"),
        ("creep: {v: 0.1}", "creep: {w: 0.1}", r"reflexes.yaml:6: the command 'creep' gives no value for v"),
        ("creep: {v: 0.1}", "creep: {v: .nan}", r"reflexes.yaml:6: .*number"),
        ("creep: {v: 0.1}", "creep: {}", r"gives no value for v"),
        ("  v: {lowest", "  w: {lowest", r"reflexes.yaml:8: no command has a channel 'w'"),
        ("rate: 1.0", "rate: 0", r"reflexes.yaml:8: a rate must be positive"),
        ("lowest: 0.0, highest: 5.0", "lowest: 6, highest: 5", r"reflexes.yaml:2: nothing lies between 6"),
        ("silent_after: 0.5, stuck", "silent_after: -1, stuck", r"reflexes.yaml:2: .*a number from 0 up"),
        ("on_fault: stop", "on_fault: hlat", r"reflexes.yaml:2: there is no command 'hlat'"),
        ("dwell: 0.2", "dwel: 0.2", r"reflexes.yaml:11: .*dwel"),
        ("{near: 0.35}", "{near: 0.35, range.front: 1}", r"reflexes.yaml:3: 'range.front' is a sensor as well"),
        ("{near: 0.35}", "{near: 0.35, a b: 1}", r"reflexes.yaml:3: no rule could name 'a b'"),
        ("{near: 0.35}", "{near: 0.35, release: 1}", r"reflexes.yaml:3: 'release' has a meaning of its own"),
        ("  slow down:", "  range.front faulty:", r"reflexes.yaml:12: the gate itself has a reflex"),
        ("command: stop}\n", "command: sit}\n", r"reflexes.yaml:13: there is no command 'sit'"),
    ],
)
def test_what_is_wrong_is_reported_with_file_and_line(tmp_path: Path, old: str, new: str, said: str | None) -> None:
    assert old in GOOD
    file = written(tmp_path, GOOD.replace(old, new))
    if said is None:
        read_reflexes(file)
        return
    with pytest.raises(InputError, match=said):
        read_reflexes(file)


def test_all_that_is_wrong_is_reported_at_once(tmp_path: Path) -> None:
    text = GOOD.replace("near -> stop", "nera -> stp").replace("safe_command: stop", "safe_command: halt")
    with pytest.raises(InputError) as error:
        read_reflexes(written(tmp_path, text))
    assert len(error.value.problems) == 3


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "reflexes",
        "a: &a [*a]",
        "sensors: {a: {}}\ncommands: {stop: {v: 0}}\nsafe_command: stop\nreflexes: {r: {rule: 'a < "
        + "(" * 900
        + "'}}",
        "sensors: {a: {}}\ncommands: {stop: {v: 0}}\nsafe_command: stop\nreflexes: {r: {rule: '" + "a" * 5000 + "'}}",
        "sensors: {a: {}}\ncommands: {stop: {v: 0}}\nsafe_command: stop\n"
        "reflexes: {r: {rule: '__import__(1) -> stop'}}",
        "sensors: !!python/object/apply:os.system [true]",
        "x" * 100_000,
        "sensors: {a: {lowest: 1" + "0" * 400 + "}}",
    ],
)
def test_hostile_files_end_in_one_clear_error(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match=r"reflexes\.yaml"):
        read_reflexes(written(tmp_path, text))
