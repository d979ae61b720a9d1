"""Missions in the shapes in which others write them; the missions themselves are made up."""

from __future__ import annotations

from pathlib import Path

import py_trees
import pytest
from py_trees.common import Status

from rosa_core import InputError
from task_layer.bt import Ports, Registry, load_tree, load_trees
from task_layer.bt.testing import ScriptedLeaf

# A navigation stack: no BTCPP_format in the list of nodes, C++ types, control nodes and decorators of its own.
NODES = """<root>
  <TreeNodesModel>
    <Action ID="PlanRoute">
      <input_port name="goal">Where to</input_port>
      <input_port name="server_timeout">Milliseconds</input_port>
      <output_port name="path">The route</output_port>
      <output_port name="error_code_id">What went wrong</output_port>
    </Action>
    <Action ID="ClearMap"><input_port name="service_name">The service</input_port></Action>
    <Condition ID="GoalChanged"><input_port name="farthest" type="double" default="limits::infinity()"/></Condition>
    <Control ID="Recovery"><input_port name="number_of_retries">How often</input_port></Control>
    <Decorator ID="Rate"><input_port name="hz">How often a second</input_port></Decorator>
  </TreeNodesModel>
</root>"""
NAVIGATE = """<!-- Plans a route now and then, and clears the map when that fails. -->
<root BTCPP_format="4" main_tree_to_execute="MainTree">
  <BehaviorTree ID="MainTree">
    <Recovery number_of_retries="6" name="Navigate">
      <Rate hz="1.0">
        <Recovery number_of_retries="1" name="PlanRoute">
          <PlanRoute goal="{goal}" path="{path}" error_code_id="{code}"/>
          <ClearMap name="Clear" service_name="map/clear"/>
        </Recovery>
      </Rate>
      <ReactiveFallback name="RecoverIf">
        <GoalChanged/>
        <ClearMap service_name="map/clear"/>
      </ReactiveFallback>
    </Recovery>
  </BehaviorTree>
</root>"""


class Recovery(py_trees.composites.Selector):
    """A control node of one's own."""

    def __init__(self, name: str, children: list[py_trees.behaviour.Behaviour], ports: Ports):
        super().__init__(name, memory=True, children=children)
        self.retries = int(ports["number_of_retries"])


class Rate(py_trees.decorators.PassThrough):
    """A decorator of one's own."""

    def __init__(self, name: str, child: py_trees.behaviour.Behaviour, ports: Ports):
        super().__init__(name, child)
        self.hz = float(ports["hz"])


def test_a_navigation_stack_with_its_list_of_nodes(tmp_path: Path) -> None:
    (tmp_path / "nodes.xml").write_text(NODES, encoding="utf-8")
    (tmp_path / "navigate.xml").write_text(NAVIGATE, encoding="utf-8")
    leaves = Registry({"PlanRoute": lambda: None, "ClearMap": lambda: None, "GoalChanged": lambda: False})
    leaves.add("Recovery", Recovery, ports=()).add("Rate", Rate, ports=())
    root = load_tree(tmp_path / "navigate.xml", leaves, nodes=[tmp_path / "nodes.xml"])
    assert (root.retries, root.children[0].hz, root.children[0].decorated.retries) == (6, 1.0, 1)
    root.tick_once()
    assert root.status is Status.SUCCESS


# A studio for manipulators: a tree in each file, names with spaces, attributes of the editor, models beside each tree.
OBJECTIVES = {
    "pick_and_place.xml": """<?xml version="1.0" encoding="utf-8" ?>
<root BTCPP_format="4" main_tree_to_execute="Pick and Place">
  <!-- ////////// -->
  <BehaviorTree ID="Pick and Place" _description="Moves a part" _favorite="true">
    <Control ID="Sequence" name="root">
      <SubTree ID="Open Gripper" _collapsed="true"/>
      <SubTree ID="Move to Waypoint" _collapsed="false" waypoint="At home" speed="0.5"/>
      <Action ID="Call" service="/gripper/close"/>
    </Control>
  </BehaviorTree>
</root>""",
    "move_to_waypoint.xml": """<?xml version="1.0" encoding="utf-8" ?>
<root BTCPP_format="4" main_tree_to_execute="Move to Waypoint">
  <BehaviorTree ID="Move to Waypoint" _subtreeOnly="true">
    <Control ID="Sequence"><Action ID="Move" waypoint="{waypoint}" speed="{speed}" group="{group}"/></Control>
  </BehaviorTree>
  <TreeNodesModel>
    <SubTree ID="Move to Waypoint">
      <input_port name="waypoint"/>
      <input_port name="speed" default="1.0"/>
      <input_port name="group" default="arm"/>
      <MetadataFields><Metadata subcategory="Motion"/></MetadataFields>
    </SubTree>
  </TreeNodesModel>
</root>""",
    "gripper/open_gripper.xml": """<root BTCPP_format="4" main_tree_to_execute="Open Gripper">
  <BehaviorTree ID="Open Gripper"><Action ID="Call" service="/gripper/open"/></BehaviorTree>
</root>""",
    "draft.xml": """<root BTCPP_format="4" main_tree_to_execute="Draft">
  <BehaviorTree ID="Draft"><SubTree ID="A Tree of the Studio"/></BehaviorTree>
</root>""",
}


def test_a_studios_folder_of_objectives(tmp_path: Path) -> None:
    for name, text in OBJECTIVES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    done: list[object] = []

    def call(service: str) -> None:
        done.append(service)

    def move(waypoint: str, speed: float, group: str) -> None:
        done.append((waypoint, speed, group))

    project = load_trees(tmp_path, {"Call": call, "Move": move})
    root = project.build("Pick and Place")
    root.tick_once()
    assert root.status is Status.SUCCESS
    assert done == ["/gripper/open", ("At home", 0.5, "arm"), "/gripper/close"]
    (warning,) = project.warnings("Pick and Place")
    assert str(warning).endswith("there is no tree 'A Tree of the Studio', which 'Draft' uses")
    with pytest.raises(InputError, match="name one of its trees: Draft, Move to Waypoint, Open"):
        project.build()


# A tutorial of BehaviorTree.CPP: the compact form, scripts with escaped operators, no main tree.
TUTORIAL = """<root BTCPP_format="4">
  <BehaviorTree ID="Tutorial">
    <Sequence>
      <Script code=" msg:='hello world'; A:=THE_ANSWER; B:=3.14; color:=RED "/>
      <Precondition if="A&gt;-B &amp;&amp; color != BLUE" else="FAILURE">
        <Say message="{A}"/>
      </Precondition>
      <LoopString queue="a;b" value="{item}"><Say message="{item}"/></LoopString>
      <TryCatch catch_on_halt="true"><Fail/><Say message="{msg}"/></TryCatch>
    </Sequence>
  </BehaviorTree>
</root>"""


def test_a_tutorial_with_scripts(tmp_path: Path) -> None:
    said: list[str] = []

    def say(message: str) -> None:
        said.append(message)

    path = tmp_path / "tutorial.xml"
    path.write_text(TUTORIAL, encoding="utf-8")
    leaves = Registry(
        {"Say": say, "Fail": lambda name: ScriptedLeaf(name, "F")}, enums={"RED": 1, "BLUE": 2, "THE_ANSWER": 42}
    )
    root = load_tree(path, leaves)
    while root.status in (Status.INVALID, Status.RUNNING):
        root.tick_once()
    assert root.status is Status.FAILURE
    assert said == ["42.000000", "a", "b", "hello world"]
