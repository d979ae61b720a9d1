"""The door for files from outside: whatever stands in one, it fits or is one clear error with its place."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pydantic import Field

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.formats.checked_file import (
    CheckedFile,
    Entry,
    Flag,
    Name,
    Names,
    Number,
    Text,
    Whole,
    checked,
    read_json,
    read_yaml_file,
    value_reader,
    within,
)
from rosa_core.formats.misfits import MisfitError


class Wheel(Entry):
    radius: Annotated[Number, within(0.01, 2.0)]
    spare: Flag = False


class Robot(Entry):
    name: Text
    wheels: dict[Name, Wheel] = Field({})
    rounds: Annotated[Whole, within(1)] = 1
    crew: Names = ()
    goal: Name | tuple[Number, ...] | dict[Name, Wheel] = "home"


def robot(tmp_path: Path, text: str) -> CheckedFile[Robot]:
    path = tmp_path / "robot.yaml"
    path.write_text(text, encoding="utf-8")
    return read_yaml_file(path, Robot, "a robot", "it looks like 'name: Rosie'")


def refusal(tmp_path: Path, text: str) -> str:
    with pytest.raises(InputError) as error:
        robot(tmp_path, text)
    return str(error.value).replace(str(tmp_path), "")


def test_what_fits_is_read_and_knows_its_lines(tmp_path: Path) -> None:
    file = robot(tmp_path, "name: Rosie\nwheels:\n  1: {radius: 5e-1}\n  left: {radius: 1, spare: true}\ncrew: 7\n")
    assert file.content.wheels == {"1": Wheel(radius=0.5), "left": Wheel(radius=1.0, spare=True)}
    assert file.content.crew == ("7",)
    assert file.location("wheels", "1", "radius").line == 3
    assert file.location("crew", 0).line == 5
    file.refuse("no", None, "wheels", "left")
    with file.refusing("name"):
        raise ValueError("taken")
    with pytest.raises(InputError, match=r"robot.yaml:4: no\n.*robot.yaml:1: taken"):
        file.raise_problems()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "/robot.yaml:1: not a robot (it looks like 'name: Rosie')"),
        ("- 1", "/robot.yaml:1: not a robot"),
        ("nam: x", "unknown key 'nam' in the file (did you mean 'name'?)"),
        ("crew: x", "the file has no 'name' (add 'name:')"),
        (
            "name: x\nwheels:\n  a: {radius: 1, radios: 2}",
            ":3: unknown key 'radios' in wheels / a (did you mean 'radius'?)",
        ),
        ("name: x\nwheels:\n  a: {radius: 1, x: 2}", "(allowed here: radius, spare)"),
        (
            "name: x\nwheels:\n  a: {radius: true}",
            ":3: wheels / a / radius: True does not fit here (a number from 0.01 to 2 is expected)",
        ),
        ("name: x\nwheels:\n  a: {radius: .nan}", "(a finite number from 0.01 to 2 is expected)"),
        ("name: x\nwheels:\n  a: {radius: 1e999}", "(a finite number from 0.01 to 2 is expected)"),
        ("name: x\nwheels:\n  a: {radius: 3}", "(a number from 0.01 to 2 is expected)"),
        ("name: x\nrounds: 0", ":2: rounds: 0 does not fit here (a whole number from 1 up is expected)"),
        ("name: x\nrounds: 1.5", "rounds: 1.5 does not fit here (a whole number from 1 up is expected)"),
        ("name: x\nrounds: true", "(a whole number from 1 up is expected)"),
        (f"name: x\nrounds: {'9' * 6000}", "cannot be read as int"),
        ("name: x\nwheels:\n  1: {radius: 1}\n  '1': {radius: 2}", ":4: '1' stands twice; it is already in line 3"),
        ("name: x\nwheels:", "wheels is empty (a mapping is expected"),
        ("name: x\nwheels: {[1]: {}}", "a key must be a plain word or number"),
        ("name: x\nwheels: {? {a: b} : 1}", "a key must be a plain word or number"),
        ("name: x\nwheels: {true: {radius: 1}}", "(text is expected"),
        ("name: x\ncrew: [a, {b: c}]", ":2: crew / 1: does not fit here (text is expected"),
        ("name: x\ngoal: true", "goal: True does not fit here (text is expected; put quotes"),
        (
            "name: x\ngoal: {a: {radius: x}}",
            "goal / a / radius: 'x' does not fit here (a number from 0.01 to 2 is expected)",
        ),
        ("name: 2024-01-01", "(text is expected"),
        ("name: !!binary aGk=", "(text is expected"),
        ("name: !!python/object:os.system x", "cannot be read"),
        ("name: &a [*a]", "nested too deeply"),
        ("name: " + "{a: " * 100 + "1" + "}" * 100, "nested too deeply"),
    ],
)
def test_what_does_not_fit_is_reported_with_its_line_and_a_hint(tmp_path: Path, text: str, said: str) -> None:
    assert said in refusal(tmp_path, text)


def test_a_value_that_may_be_of_several_kinds_is_one_problem(tmp_path: Path) -> None:
    (line,) = refusal(tmp_path, "name: x\ngoal: {a: {radius: x}}").splitlines()
    assert "radius" in line
    (line,) = refusal(tmp_path, "name: x\ngoal: true").splitlines()
    assert ", or a list is expected" in line


def test_everything_is_reported_at_once_and_each_thing_once(tmp_path: Path) -> None:
    said = refusal(tmp_path, "nam: x\nrounds: -1\nwheels: {a: {}, b: {radius: 9}}").splitlines()
    assert len(said) == len(set(said)) == 5


def test_json_has_lines_too(tmp_path: Path) -> None:
    path = tmp_path / "robot.json"
    path.write_text(json.dumps({"name": "x", "wheels": {"a": {"radius": -1}}}, indent=1), encoding="utf-8")
    with pytest.raises(InputError, match=r"robot.json:5: wheels / a / radius: -1 does not fit here"):
        read_json(path, Robot)
    for text, said in (
        ("{", ":1: not valid JSON"),
        ("[" * 100_000, "not valid JSON"),
        (f"[{'9' * 6000}]", "not valid JSON"),
    ):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match=said):
            read_json(path, Robot)


def test_a_validator_may_say_it_in_its_own_words() -> None:
    def never(_: object) -> object:
        raise MisfitError("there is nothing", "bring some")

    from pydantic import AfterValidator

    with pytest.raises(InputError, match=r"^rows.csv:3: there is nothing \(bring some\)$"):
        checked({"x": 1}, dict[str, Annotated[int, AfterValidator(never)]], Location("rows.csv", 3))


def test_a_reader_of_one_value_says_what_is_expected() -> None:
    read = value_reader(Annotated[Whole, within(2, 5)])
    assert read(3.0) == 3
    for raw, said in ((1, "a whole number from 2 to 5 is expected"), ("x", "a whole number from 2 to 5 is expected")):
        with pytest.raises(ValueError, match=said):
            read(raw)


KEYS = st.sampled_from(["name", "wheels", "rounds", "crew", "goal", "radius", "spare", "a", "", "1"]) | st.integers(
    -2, 2
)
SCALARS: st.SearchStrategy[Any] = (
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4) | st.dates() | st.binary(max_size=3)
)
ANYTHING = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS | st.booleans() | st.none(), inner, max_size=4),
    max_leaves=15,
)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.fixed_dictionaries({"name": SCALARS, "wheels": ANYTHING, "goal": ANYTHING}) | ANYTHING)
def test_whatever_stands_in_a_file_it_is_read_or_refused_with_its_name(tmp_path: Path, data: object) -> None:
    problems: tuple[Problem, ...] = ()
    try:
        wheels = robot(tmp_path, yaml.safe_dump(data)).content.wheels
    except InputError as error:
        problems = error.problems
        wheels = {}
    assert all(problem.where and problem.where.file.endswith("robot.yaml") for problem in problems)
    assert all(0.01 <= wheel.radius <= 2.0 for wheel in wheels.values())
