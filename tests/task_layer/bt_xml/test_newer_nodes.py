"""Nodes and ports of BehaviorTree.CPP that are newer than 4.8.2, or that its Python binding cannot be asked about.

The expectations follow BehaviorTree.CPP 4.10's documentation and its own tests.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from py_trees.common import Status

from rosa_core import InputError
from task_layer.bt import Blackboard, ManualSelector, Sequence, TryCatch, load_tree
from task_layer.bt.nodes import manual
from task_layer.bt.testing import ScriptedLeaf


def load(folder: Path, body: str, leaves: object, rest: str = "", **options: object):
    path = folder / "mission.xml"
    xml = f'<root BTCPP_format="4" main_tree_to_execute="M"><BehaviorTree ID="M">{body}</BehaviorTree>{rest}</root>'
    path.write_text(xml, encoding="utf-8")
    return load_tree(path, leaves, **options)


def statuses(root, ticks: int) -> str:
    letters = ""
    for _ in range(ticks):
        visited = list(root.tick())
        letters += root.status.name[0] if root in visited else "-"
    return letters


class TestTryCatch:
    def test_all_that_is_tried_succeeds(self) -> None:
        one, two, clean = ScriptedLeaf("one", "RS"), ScriptedLeaf("two"), ScriptedLeaf("clean")
        assert statuses(TryCatch("try", [one, two, clean]), 2) == "RS"
        assert (two.calls, clean.calls) == (["start", "run"], [])

    def test_a_failure_is_cleaned_up_and_stays_a_failure(self) -> None:
        one, two, clean = ScriptedLeaf("one", "F"), ScriptedLeaf("two"), ScriptedLeaf("clean", "RS")
        root = TryCatch("try", [one, two, clean])
        assert statuses(root, 2) == "RF"
        assert (two.calls, clean.calls) == ([], ["start", "run", "run"])
        assert [node.status for node in (one, two, clean)] == [Status.INVALID] * 3

    def test_cleaning_up_may_fail_as_well(self) -> None:
        assert statuses(TryCatch("try", [ScriptedLeaf("one", "F"), ScriptedLeaf("clean", "F")]), 1) == "F"

    def test_what_is_running_when_another_fails_is_halted_before_cleaning_up(self) -> None:
        root = TryCatch("try", [ScriptedLeaf("one"), ScriptedLeaf("two", "RF"), ScriptedLeaf("clean")])
        assert statuses(root, 2) == "RF"

    def test_it_begins_again_from_the_first(self) -> None:
        one, clean = ScriptedLeaf("one", "FS"), ScriptedLeaf("clean")
        root = Sequence("root", [TryCatch("try", [one, clean])])
        assert statuses(root, 1) == "F"
        assert statuses(root, 1) == "S"
        assert clean.calls == ["start", "run"]

    @pytest.mark.parametrize(("on_halt", "calls"), [(False, []), (True, ["start", "run"])])
    def test_a_halt_while_it_tries_is_cleaned_up_if_that_is_wanted(self, on_halt: bool, calls: list[str]) -> None:
        one, clean = ScriptedLeaf("one", "R"), ScriptedLeaf("clean")
        root = TryCatch("try", [one, clean], catch_on_halt=on_halt)
        assert statuses(root, 1) == "R"
        root.stop()
        assert one.calls == ["start", "run", "halt"]
        assert clean.calls == calls
        assert [node.status for node in root.iterate()] == [Status.INVALID] * 3

    def test_cleaning_up_that_takes_longer_than_a_halt_is_halted(self) -> None:
        clean = ScriptedLeaf("clean", "R")
        root = TryCatch("try", [ScriptedLeaf("one", "R"), Sequence("cleaning", [clean])], catch_on_halt=True)
        assert statuses(root, 1) == "R"
        root.stop()
        assert clean.calls == ["start", "run", "halt"]

    def test_a_halt_while_it_cleans_up_is_not_cleaned_up_again(self) -> None:
        clean = ScriptedLeaf("clean", "R")
        root = TryCatch("try", [ScriptedLeaf("one", "F"), clean], catch_on_halt=True)
        assert statuses(root, 1) == "R"
        root.stop()
        assert clean.calls == ["start", "run", "halt"]

    def test_what_is_skipped_is_passed_over(self, tmp_path: Path) -> None:
        body = '<Sequence><TryCatch catch_on_halt="true"><stop _skipIf="{}"/><stop/></TryCatch></Sequence>'
        assert statuses(load(tmp_path, body.format("true"), {"stop": lambda: None}), 1) == "-"
        assert statuses(load(tmp_path, body.format("false"), {"stop": lambda: None}), 1) == "S"


class TestLoops:
    def items(self, folder: Path, queue: object, ticks: int, tag: str = "LoopInt") -> tuple[list[object], str]:
        blackboard, seen = Blackboard(), []
        if queue is not None:
            blackboard.set("queue", queue)
        body = f'<{tag} queue="{{queue}}" value="{{item}}"><look item="{{item}}"/></{tag}>'

        def look(item: object) -> None:
            seen.append(item)

        root = load(folder, f"<Sequence>{body}</Sequence>", {"look": look}, blackboard=blackboard)
        return seen, statuses(root, ticks)

    def test_a_list_on_the_blackboard_stays_as_it_is(self, tmp_path: Path) -> None:
        queue = [1, 2]
        assert self.items(tmp_path, queue, 4) == ([1, 2, 1], "RRSR")
        assert queue == [1, 2]

    def test_a_deque_is_emptied(self, tmp_path: Path) -> None:
        queue = deque([1, 2])
        assert self.items(tmp_path, queue, 4) == ([1, 2], "RRSS")
        assert not queue

    def test_a_text_on_the_blackboard_is_read_as_a_list(self, tmp_path: Path) -> None:
        assert self.items(tmp_path, "1.5;2", 3, "LoopDouble") == ([1.5, 2.0], "RRS")

    def test_what_is_no_queue_fails(self, tmp_path: Path) -> None:
        assert self.items(tmp_path, 3, 1) == ([], "F")
        assert self.items(tmp_path, ["x"], 1) == ([], "F")
        assert self.items(tmp_path, None, 1) == ([], "F")

    def test_a_child_that_takes_time_keeps_its_item(self, tmp_path: Path) -> None:
        class Slow(ScriptedLeaf):
            def __init__(self, name: str):
                super().__init__(name, "RSRS")

        blackboard = Blackboard()
        body = '<LoopString queue="a;b" value="{item}"><Slow/></LoopString>'
        root = load(tmp_path, body, {"Slow": Slow}, blackboard=blackboard)
        shown = []
        for _ in range(5):
            root.tick_once()
            shown.append((root.status.name[0], blackboard.get("item")))
        assert shown == [("R", "a"), ("R", "a"), ("R", "b"), ("R", "b"), ("S", "b")]

    def test_a_loop_that_was_halted_begins_again(self, tmp_path: Path) -> None:
        seen: list[int] = []

        def look(item: int) -> None:
            seen.append(item)

        root = load(tmp_path, '<LoopInt queue="1;2" value="{i}"><look item="{i}"/></LoopInt>', {"look": look})
        root.tick_once()
        root.stop()
        root.tick_once()
        assert seen == [1, 1]


def test_a_node_that_waits_for_an_update_halts_its_child(tmp_path: Path) -> None:
    blackboard = Blackboard()
    blackboard.set("a", 1)
    leaf = ScriptedLeaf("leaf", "R")
    root = load(
        tmp_path,
        '<WaitValueUpdate entry="{a}"><leaf/></WaitValueUpdate>',
        {"leaf": lambda name: leaf},
        blackboard=blackboard,
    )
    assert statuses(root, 2) == "RR"
    root.stop()
    assert leaf.calls == ["start", "run", "run", "halt"]
    assert statuses(root, 1) == "R"
    assert leaf.calls == ["start", "run", "run", "halt"]
    blackboard.set("a", 1)
    assert statuses(root, 1) == "R"
    assert leaf.calls == ["start", "run", "run", "halt", "start", "run"]


class TestManualSelector:
    def selector(self, answers: list[int | Status], **options: object) -> ManualSelector:
        one, two = ScriptedLeaf("one", "RS"), ScriptedLeaf("two", "F")
        root = ManualSelector("choose", [one, two], **options)
        asked: list[object] = []

        def choose(names: object) -> int | Status:
            asked.append(names)
            return answers.pop(0)

        root.setup(choose=choose)
        self.asked = asked
        return root

    def test_the_child_that_is_chosen_is_ticked(self) -> None:
        root = self.selector([1, 0, 0])
        assert statuses(root, 3) == "FRS"
        assert self.asked == [["one", "two"]] * 3

    def test_a_status_may_be_chosen_instead(self) -> None:
        assert statuses(self.selector([Status.SUCCESS, Status.RUNNING, Status.FAILURE]), 3) == "SRF"

    def test_a_child_that_runs_is_halted_when_another_is_chosen(self) -> None:
        root = self.selector([0, 1])
        assert statuses(root, 2) == "RF"
        assert root.children[0].calls == ["start", "run", "halt"]

    def test_the_last_choice_may_be_kept(self) -> None:
        root = self.selector([0], repeat_last_selection=True)
        assert statuses(root, 2) == "RS"
        assert len(self.asked) == 1

    def test_without_a_terminal_it_fails_and_says_why(self, monkeypatch: pytest.MonkeyPatch) -> None:
        root = ManualSelector("choose", [ScriptedLeaf("one")])
        root.setup()
        assert statuses(root, 1) == "F"
        assert "there is no terminal to ask in" in root.feedback_message

    def test_it_is_asked_in_the_terminal(self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
        class Terminal:
            def __init__(self) -> None:
                self.lines = ["7\n", "what\n", "2\n", "S\n", ""]

            def isatty(self) -> bool:
                return True

            def readline(self) -> str:
                return self.lines.pop(0)

        monkeypatch.setattr(manual.sys, "stdin", Terminal())
        assert manual.choose_in_terminal(["one", "two"]) == 1
        assert manual.choose_in_terminal(["one", "two"]) is Status.SUCCESS
        with pytest.raises(RuntimeError, match="the terminal was closed"):
            manual.choose_in_terminal(["one"])
        assert "  1. one\n  2. two\n" in capsys.readouterr().err

    def test_it_is_loaded(self, tmp_path: Path) -> None:
        body = '<ManualSelector repeat_last_selection="true"><stop/><stop/></ManualSelector>'
        root = load(tmp_path, body, {"stop": lambda: None})
        root.setup(choose=lambda names: 1)
        assert statuses(root, 1) == "S"


@dataclass(frozen=True)
class Place:
    x: float
    y: float
    name: str = "somewhere"
    tags: list[int] = field(default_factory=list)


class TestJsonPorts:
    def read(self, folder: Path, text: str, kind: object) -> object:
        seen: list[object] = []

        def look(value) -> None:
            seen.append(value)

        look.__annotations__["value"] = kind
        quoted = text.replace('"', "&quot;")
        load(folder, f'<look value="{quoted}"/>', {"look": look}).tick_once()
        return seen[0]

    @pytest.mark.parametrize(
        ("text", "kind", "value"),
        [
            ("json:3", int, 3),
            ("json:3", float, 3.0),
            ("json:true", bool, True),
            ("json:[1, 2]", list[int], [1, 2]),
            ('json:{"a": [1]}', dict, {"a": [1]}),
            ('json:{"a": 1}', dict[str, float], {"a": 1.0}),
            ('json:{"x": 1, "y": 2.5}', Place, Place(1.0, 2.5)),
            ('json:[{"x": 1, "y": 2, "tags": [3]}]', list[Place], [Place(1.0, 2.0, tags=[3])]),
            ("json:[1]", str, "json:[1]"),
            ("json:[1]", object, "json:[1]"),
        ],
    )
    def test_a_value_in_json(self, text: str, kind: object, value: object, tmp_path: Path) -> None:
        assert self.read(tmp_path, text, kind) == value

    @pytest.mark.parametrize(
        ("text", "kind", "message"),
        [
            ("json:", int, "is no JSON"),
            ("json:NaN", float, "NaN is not a number in JSON"),
            ("json:" + "[" * 100_000, list[int], "is no JSON"),
            ('json:{"x": 1}', Place, "Place needs the field 'y'"),
            ('json:{"x": 1, "y": 1, "z": 1}', Place, "Place has no field 'z'"),
            ('json:{"x": "far", "y": 1}', Place, "'far' is not a number"),
            ("json:3", Place, "Place must be an object"),
            ("json:3", list[int], "it is no list"),
            ("json:1.5", int, "1.5 is not a whole number"),
        ],
    )
    def test_what_is_no_such_value_is_refused(self, text: str, kind: object, message: str, tmp_path: Path) -> None:
        with pytest.raises(InputError) as error:
            self.read(tmp_path, text, kind)
        assert message in str(error.value)
        assert len(str(error.value)) < 400

    def test_json_on_the_blackboard_is_read_by_the_port(self, tmp_path: Path) -> None:
        seen: list[object] = []

        def look(place: Place) -> None:
            seen.append(place)

        text = "json:{&quot;x&quot;: 1, &quot;y&quot;: 2}"
        body = f'<Sequence><SetBlackboard value="{text}" output_key="p"/><look place="{{p}}"/></Sequence>'
        load(tmp_path, body, {"look": look}).tick_once()
        assert seen == [Place(1.0, 2.0)]
