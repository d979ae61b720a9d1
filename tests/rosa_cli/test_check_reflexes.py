"""``rosa check --reflexes``."""

from __future__ import annotations

from pathlib import Path

import pioneer_example
from tests.rosa_cli.cli import refused, rosa


def test_reflexes_are_listed_by_priority() -> None:
    process = rosa("check", "--reflexes", Path(pioneer_example.__file__).with_name("reflexes.yaml"))
    assert process.returncode == 0
    said = process.stdout.splitlines()
    assert said[0] == "ok: 2 reflexes on 7 sensors, 2 commands"
    assert [line.split(":")[0].strip() for line in said[1:]] == ["ring faulty", "back off"]


def test_what_is_wrong_is_reported_with_exit_code_2(tmp_path: Path) -> None:
    file = tmp_path / "reflexes.yaml"
    file.write_text("sensors: {a: {}}\ncommands: {stop: {v: 0}}\nsafe_command: stp\nreflexes: {}\n", encoding="utf-8")
    said = refused(rosa("check", "--reflexes", file))
    assert "reflexes.yaml:3: there is no command 'stp' (did you mean 'stop'?)" in said


def test_something_must_be_named() -> None:
    assert "--reflexes FILE" in refused(rosa("check"))
