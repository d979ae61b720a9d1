"""``rosa check --reflexes``."""

from __future__ import annotations

from pathlib import Path

import pytest

import pioneer_example
from rosa_cli.main import main


def test_reflexes_are_listed_by_priority(capsys: pytest.CaptureFixture[str]) -> None:
    file = Path(pioneer_example.__file__).with_name("reflexes.yaml")
    assert main(["check", "--reflexes", str(file)]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "ok: 2 reflexes on 7 sensors, 2 commands"
    assert [line.split(":")[0].strip() for line in said[1:]] == ["ring faulty", "back off"]


def test_what_is_wrong_is_reported_with_exit_code_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "reflexes.yaml"
    file.write_text("sensors: {a: {}}\ncommands: {stop: {v: 0}}\nsafe_command: stp\nreflexes: {}\n", encoding="utf-8")
    assert main(["check", "--reflexes", str(file)]) == 2
    assert "reflexes.yaml:3: there is no command 'stp' (did you mean 'stop'?)" in capsys.readouterr().err


def test_something_must_be_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check"]) == 2
    assert "--reflexes FILE" in capsys.readouterr().err
