"""Files of BehaviorTree.CPP v3 become files of version 4 that do the same."""

from __future__ import annotations

from pathlib import Path

import pytest
from py_trees.common import Status

from rosa_core import InputError
from task_layer.bt import Blackboard, Output, load_tree
from task_layer.bt.xml.version_3 import upgrade

OLD = """<?xml version="1.0"?>
<!-- the delivery, as it was -->
<root main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <SequenceStar name="all">
      <SetBlackboard output_key="place" value="kitchen"/>
      <SubTree ID="Go" target="place" reached="arrived"/>
      <SubTreePlus ID="Report" where="{place}" __autoremap="1"/>
      <!-- twice is enough -->
      <RetryUntilSuccesful num_attempts="2"><AlwaysSuccess/></RetryUntilSuccesful>
      <BlackboardCheckString value_A="{arrived}" value_B="yes" return_on_mismatch="FAILURE">
        <Parallel threshold="1"><AlwaysSuccess/><AlwaysFailure/></Parallel>
      </BlackboardCheckString>
      <BlackboardCheckInt value_A="{tries}" value_B="3" return_on_mismatch="SUCCESS">
        <AlwaysFailure/>
      </BlackboardCheckInt>
      <Control ID="SequenceStar"><SubTree ID="Shared" __shared_blackboard="true"/></Control>
    </SequenceStar>
  </BehaviorTree>
  <BehaviorTree ID="Go"><go to="{target}" reached="{reached}"/></BehaviorTree>
  <BehaviorTree ID="Report"><say text="{where}"/></BehaviorTree>
  <BehaviorTree ID="Shared"><say text="{arrived}"/></BehaviorTree>
  <TreeNodesModel><SubTreePlus ID="Report"><input_port name="where"/></SubTreePlus></TreeNodesModel>
</root>
"""


def converted(folder: Path, text: str) -> tuple[Path, list[str]]:
    old, new = folder / "old.xml", folder / "new.xml"
    old.write_text(text, encoding="utf-8")
    return new, [problem.what for problem in upgrade(old, new)]


def test_the_converted_mission_runs(tmp_path: Path) -> None:
    said: list[str] = []

    def go(to: str, reached: Output[str]) -> None:
        said.append(f"to {to}")
        reached.set("yes")

    def say(text: str) -> None:
        said.append(text)

    new, problems = converted(tmp_path, OLD)
    assert problems == []
    blackboard = Blackboard()
    blackboard.set("tries", 1)
    root = load_tree(new, {"go": go, "say": say}, blackboard=blackboard)
    while root.status in (Status.INVALID, Status.RUNNING):
        root.tick_once()
    assert root.status is Status.SUCCESS, [(node.name, node.feedback_message) for node in root.iterate()]
    assert said == ["to kitchen", "kitchen", "yes"]


def test_what_the_file_says_beside_that_stays(tmp_path: Path) -> None:
    text = converted(tmp_path, OLD)[0].read_text(encoding="utf-8")
    assert text.startswith('<?xml version="1.0" encoding="UTF-8"?>\n')
    assert '<root BTCPP_format="4" main_tree_to_execute="Main">' in text
    assert "<!-- twice is enough -->" in text
    assert '<SubTree ID="Go" target="{place}" reached="{arrived}" />' in text
    assert '<SubTree ID="Report" where="{place}" _autoremap="true" />' in text
    assert '<Precondition if="arrived == \'yes\'" else="FAILURE">' in text
    assert '<Precondition if="tries == 3" else="SUCCESS">' in text
    assert '<Control ID="SequenceWithMemory"><SubTree ID="Shared" _autoremap="true" />' in text
    assert '<SubTree ID="Report"><input_port name="where" /></SubTree>' in text


def test_what_cannot_be_converted_is_said(tmp_path: Path) -> None:
    check = '<BlackboardCheckInt value_A="{a}"><AlwaysSuccess/></BlackboardCheckInt>'
    new, problems = converted(tmp_path, f'<root><BehaviorTree ID="M">{check}</BehaviorTree></root>')
    assert problems == ["a <BlackboardCheckInt> without value_A or value_B was left as it is"]
    with pytest.raises(InputError, match="the node 'BlackboardCheckInt' is of"):
        load_tree(new, {})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('<root BTCPP_format="4"/>', "it is of version 4 already"),
        ("<Root/>", "the outermost element is <Root>"),
        ("<root", "not valid XML"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><root>&a;</root>', "document types and entities are not allowed"),
        ("<root>" + "<a>" * 300 + "</a>" * 300 + "</root>", "nested more than 200 levels deep"),
    ],
)
def test_what_is_no_file_of_version_3_is_refused(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        converted(tmp_path, text)
    assert not (tmp_path / "new.xml").exists()
