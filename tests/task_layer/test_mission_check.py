"""What is found in a mission before it is run."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import KnowledgeModel
from task_layer.bt import Registry
from task_layer.bt.mission_check import MissionFindings, check_mission
from task_layer.bt.testing import ScriptedSkill, fake_model

MODEL = fake_model("search", "recharge")
GUARDED = """
<ReactiveSequence><is_action_feasible action_name="{0}"/><{0}/></ReactiveSequence>
"""


@pytest.fixture
def check(tmp_path: Path):
    def checked(body: str, model: KnowledgeModel = MODEL, rest: str = "", **keywords: object) -> MissionFindings:
        file = tmp_path / "mission.xml"
        trees = f'<BehaviorTree ID="main">{body}</BehaviorTree>{rest}'
        file.write_text(f'<root BTCPP_format="4" main_tree_to_execute="main">{trees}</root>', encoding="utf-8")
        return check_mission(file, model, **keywords)

    return checked


def whats(problems) -> list[str]:
    return [problem.what for problem in problems]


def test_a_mission_that_guards_and_performs_every_action_is_flawless(check) -> None:
    found = check(f"<Fallback>{GUARDED.format('search')}{GUARDED.format('recharge')}</Fallback>")
    assert found == MissionFindings(nodes=7)


def test_an_action_that_the_model_has_not_is_a_problem_with_the_nearest_name(check) -> None:
    found = check('<Fallback><is_action_feasible action_name="serch"/><search/><recharge/></Fallback>')
    assert whats(found.problems) == ["the model has no action 'serch'"]
    assert "search" in (found.problems[0].hint or "")
    assert found.problems[0].where is not None
    assert found.problems[0].where.line == 1


def test_a_leaf_that_nobody_knows_is_a_problem(check) -> None:
    found = check("<Sequence><search/><recharge/><arm/></Sequence>")
    assert len(found.problems) == 1
    assert "arm" in found.problems[0].what
    declared = '<TreeNodesModel><Action ID="arm"/></TreeNodesModel>'
    assert check("<Sequence><search/><recharge/><arm/></Sequence>", rest=declared).problems == ()


def test_the_leaves_of_a_registry_count_if_there_is_one(check) -> None:
    leaves = Registry({"search": ScriptedSkill(), "arm": lambda: None})
    found = check(f"<Sequence><arm/>{GUARDED.format('search')}<recharge/></Sequence>", registry=leaves)
    assert len(found.problems) == 1
    assert "recharge" in found.problems[0].what


def test_actions_of_the_model_that_are_never_performed_are_a_warning(check) -> None:
    assert whats(check(GUARDED.format("search")).warnings) == ["the action 'recharge' of the model is never performed"]


@pytest.mark.parametrize(
    ("body", "how"),
    [
        ("<search/>", "not checked"),
        ('<Sequence><is_action_feasible action_name="search"/><search/></Sequence>', "checked only once"),
        ('<ReactiveSequence><is_action_feasible action_name="recharge"/><search/></ReactiveSequence>', "not checked"),
        ('<ReactiveSequence><search/><is_action_feasible action_name="search"/></ReactiveSequence>', "not checked"),
        ('<Fallback><is_action_feasible action_name="search"/><search/></Fallback>', "not checked"),
    ],
)
def test_an_action_without_its_guard_is_a_warning(check, body: str, how: str) -> None:
    (warning,) = (w for w in check(body).warnings if "feasible" in w.what)
    assert warning.what == f"whether 'search' is feasible is {how} before it is performed"
    assert "<ReactiveSequence>" in (warning.hint or "")


@pytest.mark.parametrize(
    "body",
    [
        '<ReactiveSequence><is_action_feasible action_name="search"/><Inverter><search/></Inverter></ReactiveSequence>',
        '<ReactiveSequence><IsActionFeasible action_name="search"/><AlwaysSuccess/><search/></ReactiveSequence>',
        '<ReactiveSequence><is_action_feasible action_name="search"/><SubTree ID="deep"/></ReactiveSequence>',
    ],
)
def test_a_guard_counts_for_everything_after_it(check, body: str) -> None:
    rest = '<BehaviorTree ID="deep"><Sequence><search/></Sequence></BehaviorTree>'
    found = check(body, rest=rest if "SubTree" in body else "")
    assert [w for w in whats(found.warnings) if "feasible" in w] == []


@pytest.mark.parametrize(
    ("body", "unreachable"),
    [
        ("<Fallback><AlwaysSuccess/><search/></Fallback>", "never fails"),
        ("<Sequence><AlwaysFailure/><search/></Sequence>", "never succeeds"),
        ("<Fallback><ForceSuccess><recharge/></ForceSuccess><search/></Fallback>", "never fails"),
        ("<ReactiveSequence><ForceFailure><recharge/></ForceFailure><search/></ReactiveSequence>", "never succeeds"),
        (
            '<Fallback><RetryUntilSuccessful num_attempts="-1"><recharge/></RetryUntilSuccessful><search/></Fallback>',
            "fails",
        ),
        ('<Sequence><Repeat num_cycles="-1"><recharge/></Repeat><search/></Sequence>', "never succeeds"),
        ("<Sequence><KeepRunningUntilFailure><recharge/></KeepRunningUntilFailure><search/></Sequence>", "succeeds"),
        ("<Sequence><Inverter><AlwaysSuccess/></Inverter><search/></Sequence>", "never succeeds"),
        ("<Fallback><Sequence><AlwaysSuccess/><AlwaysSuccess/></Sequence><search/></Fallback>", "never fails"),
        ('<Fallback><SubTree ID="sure"/><search/></Fallback>', "never fails"),
    ],
)
def test_a_child_that_is_never_reached_is_a_warning(check, body: str, unreachable: str) -> None:
    rest = '<BehaviorTree ID="sure"><AlwaysSuccess/></BehaviorTree>' if "SubTree" in body else ""
    (warning,) = (w for w in whats(check(body, rest=rest).warnings) if "never reached" in w)
    assert warning.startswith("'search' is never reached")
    assert warning.endswith(unreachable)


@pytest.mark.parametrize(
    "body",
    [
        "<Fallback><recharge/><search/></Fallback>",
        '<Fallback><AlwaysSuccess _skipIf="x == 1"/><search/></Fallback>',
        '<Fallback><AlwaysSuccess _failureIf="x == 1"/><search/></Fallback>',
        '<Sequence><AlwaysFailure _successIf="x == 1"/><search/></Sequence>',
        '<Fallback><RetryUntilSuccessful num_attempts="2"><recharge/></RetryUntilSuccessful><search/></Fallback>',
        "<Sequence><RunOnce><AlwaysFailure/></RunOnce><search/></Sequence>",
        '<Fallback><Timeout msec="5"><AlwaysSuccess/></Timeout><search/></Fallback>',
    ],
)
def test_a_child_that_may_be_reached_is_not_warned_of(check, body: str) -> None:
    assert [w for w in whats(check(body).warnings) if "never reached" in w] == []


def test_a_tree_that_is_never_used_is_a_warning(check) -> None:
    found = check("<Sequence><search/><recharge/></Sequence>", rest='<BehaviorTree ID="old"><search/></BehaviorTree>')
    assert "the tree 'old' is never used" in whats(found.warnings)


def test_what_is_wrong_with_the_file_is_among_the_problems(tmp_path: Path) -> None:
    file = tmp_path / "mission.xml"
    file.write_text("<root>", encoding="utf-8")
    assert len(check_mission(file, MODEL).problems) == 1
    assert len(check_mission(tmp_path / "none.xml", MODEL).problems) == 1
