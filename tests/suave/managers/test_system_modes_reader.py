"""Reading the model files of ROS 2 system modes."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import InputError
from rosa_simulation.system_modes import NodePart, PartState, SystemModes, SystemPart, load_system_modes
from tests.suave.flights import suave_modes

# In the form of the system_modes package's own examples: bare parts one a line, namespaces, rules, states without mode.
ACTUATION = """\
# system modes example
---

actuation:
  ros__parameters:
    type: system
    parts:
      drive_base
      left/manipulator
    modes:
      __DEFAULT__:
        drive_base: active
        left/manipulator: inactive
      PERFORMANCE:
        drive_base: active.FAST
        left/manipulator: active.STRONG
    rules:
      degrade_from_PERFORMANCE:
        if_target: active.PERFORMANCE
        if_part: [left/manipulator, inactive]
        new_target: active.__DEFAULT__

/left/manipulator:
  ros__parameters:
    type: node
    modes:
      __DEFAULT__:
        ros__parameters:
          max_torque: 0.1
      STRONG:
        ros__parameters:
          max_torque: 0.2
          gains: {p: 1.0, i: 0.5}
          joints: [1, 2]

drive_base:
  ros__parameters:
    type: node
    modes:
      __DEFAULT__:
        ros__parameters:
          controller: PID
      FAST:
        ros__parameters:
          controller: MPC
          limited: false
"""


def load(tmp_path: Path, text: str) -> SystemModes:
    file = tmp_path / "modes.yaml"
    file.write_text(text, encoding="utf-8")
    return load_system_modes(file)


def test_a_file_in_the_form_of_the_packages_examples_is_read(tmp_path: Path) -> None:
    modes = load(tmp_path, ACTUATION)
    assert modes.part("actuation") == SystemPart(
        "actuation",
        ("drive_base", "left/manipulator"),
        {
            "__DEFAULT__": {"drive_base": PartState(True), "left/manipulator": PartState(False)},
            "PERFORMANCE": {"drive_base": PartState(True, "FAST"), "left/manipulator": PartState(True, "STRONG")},
        },
    )
    strong = {"max_torque": 0.2, "gains.p": 1.0, "gains.i": 0.5, "joints": (1, 2)}
    manipulator = modes.part("left/manipulator")
    assert manipulator == NodePart("left/manipulator", {"__DEFAULT__": {"max_torque": 0.1}, "STRONG": strong})
    assert modes.modes("drive_base") == ("__DEFAULT__", "FAST")


def test_parts_may_stand_in_a_list(tmp_path: Path) -> None:
    text = ACTUATION.replace(
        "      drive_base\n      left/manipulator\n", "      - drive_base\n      - /left/manipulator\n"
    )
    assert text != ACTUATION
    assert load(tmp_path, text) == load(tmp_path, ACTUATION)


@pytest.mark.parametrize(("extended", "effort"), [(False, (6, 18, 6)), (True, (8, 23, 7))])
def test_suaves_modes_count_as_in_table_7(extended: bool, effort: tuple[int, int, int]) -> None:
    counted = suave_modes(extended=extended).effort()
    assert (counted["parts"], counted["modes"], counted["parameters"]) == effort
    assert sum(effort) == (38 if extended else 30)


def test_the_altitudes_are_those_of_the_exemplar() -> None:
    node = suave_modes(extended=False).part("f_generate_search_path_node")
    assert {mode: values["spiral_altitude"] for mode, values in node.modes.items()} == {  # type: ignore[index,call-overload]
        "__DEFAULT__": 1.0,
        "fd_spiral_high": 3.0,
        "fd_spiral_medium": 2.0,
        "fd_spiral_low": 1.0,
    }


def replaced(old: str, new: str) -> str:
    assert old in ACTUATION
    return ACTUATION.replace(old, new, 1)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "modes.yaml:1: not a system modes file"),
        ("[1, 2]", "not a system modes file"),
        ("a: [", "not valid YAML"),
        ("a: {type: node}", "modes.yaml:1: a has no 'ros__parameters' (add 'ros__parameters:')"),
        ("a: {ros__parameters: {type: robot}}", "'type' must be one of 'node', 'system'"),
        ("a: {ros__parameters: {type: node}}", "a / ros__parameters has no 'modes'"),
        (
            "a: {ros__parameters: {type: node, modes: {FAST: {ros__parameters: {}}}}}",
            "every part needs a mode __DEFAULT__",
        ),
        (
            "a: {ros__parameters: {type: node, modes: {__DEFAULT__: 3}}}",
            "__DEFAULT__: 3 does not fit here (a mapping is expected",
        ),
        ("a: {ros__parameters: {type: system, modes: {__DEFAULT__: {}}}}", "a / ros__parameters has no 'parts'"),
        (
            replaced("active.FAST", "active.FASTER"),
            "modes.yaml:15: 'drive_base' has no mode 'FASTER' (did you mean 'FAST'",
        ),
        (replaced("active.FAST", "asleep"), "PERFORMANCE / drive_base: 'asleep' does not fit here (write inactive"),
        (
            replaced("      drive_base\n", "      drive_bas\n"),
            "has an unknown part 'drive_bas' (did you mean 'drive_base'",
        ),
        (replaced("left/manipulator: inactive", "right: inactive"), "modes.yaml:13: 'right' is no part of 'actuation'"),
        (
            replaced("    modes:\n", "    mode:\n"),
            "modes.yaml:10: unknown key 'mode' in actuation / ros__parameters (did you mean 'modes'",
        ),
        (replaced("max_torque: 0.1", "max_torque: [1, a]"), "max_torque: does not fit here (write a boolean"),
        (replaced("max_torque: 0.1", "max_torque: null"), "max_torque is empty (write a boolean"),
        (replaced("drive_base:\n  ros__", "left/manipulator:\n  ros__"), "are the same part"),
    ],
)
def test_what_is_wrong_is_named_with_file_line_and_hint(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError) as refused:
        load(tmp_path, text)
    assert words in str(refused.value)


def test_every_problem_is_named_at_once(tmp_path: Path) -> None:
    text = replaced("active.FAST", "active.FASTER").replace("active.STRONG", "active.STRONGER")
    with pytest.raises(InputError) as refused:
        load(tmp_path, text)
    assert len(refused.value.problems) == 2


def system(name: str, part: str) -> str:
    modes = f"{{__DEFAULT__: {{{part}: active}}}}"
    return f"{name}: {{ros__parameters: {{type: system, parts: {part}, modes: {modes}}}}}\n"


NODE = "n: {ros__parameters: {type: node, modes: {__DEFAULT__: {ros__parameters: {}}}}}\n"


def test_systems_that_contain_each_other_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a part of itself"):
        load(tmp_path, system("a", "b") + system("b", "a"))
    with pytest.raises(InputError, match="is a part of itself"):
        load(tmp_path, system("a", "a"))


def test_systems_may_be_nested_but_not_without_end(tmp_path: Path) -> None:
    def nested(depth: int) -> str:
        return system("s0", "n") + "".join(system(f"s{i}", f"s{i - 1}") for i in range(1, depth)) + NODE

    assert len(load(tmp_path, nested(10)).parts) == 11
    with pytest.raises(InputError, match="nested too deeply"):
        load(tmp_path, nested(1000))


NAMES = st.sampled_from(["a", "b", "/c", "type", "ros__parameters", "__DEFAULT__"])
SCALARS = NAMES | st.sampled_from(["active", "inactive", "active.", "active.a", "a b", 1, -0.5, True, None, ""])
ANYTHING = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(NAMES, inner, max_size=4), max_leaves=20
)
PARTS = st.sampled_from(["a", "/c", "a b", ["a", "b"]]) | ANYTHING
MODE = st.fixed_dictionaries({"ros__parameters": st.dictionaries(NAMES, ANYTHING)})
MODE |= st.dictionaries(NAMES, st.sampled_from(["active", "inactive", "active.a"])) | ANYTHING
MODES = st.fixed_dictionaries({"__DEFAULT__": MODE}, optional={"a": MODE, "b": MODE}) | ANYTHING
A_NODE = st.fixed_dictionaries({"type": st.just("node"), "modes": MODES})
A_SYSTEM = st.fixed_dictionaries(
    {"type": st.just("system"), "parts": PARTS, "modes": MODES}, optional={"rules": ANYTHING}
)
FILES = st.dictionaries(NAMES, st.fixed_dictionaries({"ros__parameters": A_NODE | A_SYSTEM | ANYTHING}), max_size=3)
FILES |= ANYTHING


@given(FILES)
def test_whatever_stands_in_a_file_it_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, data: object
) -> None:
    file = tmp_path_factory.getbasetemp() / "anything.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    try:
        modes = load_system_modes(file)
    except InputError:
        return
    for name in modes.parts:
        assert "__DEFAULT__" in modes.modes(name)
