"""What a TreeNodesModel says of nodes and subtrees, in the mission or in a file of its own."""

from __future__ import annotations

from pathlib import Path

import pytest
from py_trees.common import Status

from rosa_core import InputError
from task_layer.bt import Blackboard, InOut, InputPort, Output, Ports, Registry, load_tree, load_trees
from task_layer.bt.mission_check import check_mission
from task_layer.bt.testing import ScriptedLeaf, fake_model

NAVIGATION = """<root>
  <TreeNodesModel>
    <!-- in the shape of a robot's own list of nodes: types of C++, defaults that are none, ports without defaults -->
    <Action ID="PlanRoute">
      <input_port name="goal">Where to</input_port>
      <input_port name="planner_id" default="Grid"/>
      <input_port name="server_timeout" type="std::chrono::milliseconds">How long to wait</input_port>
      <output_port name="path">The route</output_port>
    </Action>
    <Condition ID="IsGoalNear">
      <input_port name="farthest" type="double" default="limits::infinity()"/>
    </Condition>
    <Decorator ID="SpeedControl"><input_port name="rate" type="double" default="1.0"/></Decorator>
    <Control ID="RoundRobin"/>
    <SubTree ID="Recover"><input_port name="seconds" default="5"/><inout_port name="state"/></SubTree>
  </TreeNodesModel>
</root>"""


def load(folder: Path, body: str, leaves: object, rest: str = "", **options: object):
    path = folder / "mission.xml"
    xml = f'<root BTCPP_format="4" main_tree_to_execute="M"><BehaviorTree ID="M">{body}</BehaviorTree>{rest}</root>'
    path.write_text(xml, encoding="utf-8")
    return load_tree(path, leaves, **options)


@pytest.fixture
def manifest(tmp_path: Path) -> Path:
    path = tmp_path / "manifest" / "tree_nodes.xml"
    path.parent.mkdir()
    path.write_text(NAVIGATION, encoding="utf-8")
    return path


def test_a_port_without_default_may_be_left_out_by_a_leaf_that_declares_none(tmp_path: Path) -> None:
    model = '<TreeNodesModel><Action ID="bare"><input_port name="server_timeout">how long</input_port></Action>'
    root = load(tmp_path, "<Sequence><bare/></Sequence>", {"bare": lambda: None}, f"{model}</TreeNodesModel>")
    root.tick_once()
    assert root.status is Status.SUCCESS


def test_a_leaf_that_declares_its_ports_needs_them_whatever_the_model_says(tmp_path: Path) -> None:
    def move(goal: str) -> None:
        """Needs a goal."""

    model = '<TreeNodesModel><Action ID="move"><input_port name="goal"/></Action></TreeNodesModel>'
    with pytest.raises(InputError, match="move needs the port 'goal'"):
        load(tmp_path, "<move/>", {"move": move}, model)


def test_a_behaviour_with_ports_of_a_model_has_no_value_for_one_that_was_left_out(tmp_path: Path) -> None:
    seen: list[object] = []

    class Leaf(ScriptedLeaf):
        def __init__(self, name: str, ports: Ports):
            super().__init__(name)
            seen.extend([ports.get("timeout", "none"), "timeout" in ports, ports["speed"]])

    ports = '<input_port name="timeout" type="int"/><input_port name="speed" type="double" default="0.5"/>'
    model = f'<TreeNodesModel><Action ID="leaf">{ports}</Action></TreeNodesModel>'
    load(tmp_path, "<leaf/>", {"leaf": Leaf}, model)
    assert seen == ["none", False, 0.5]


def test_a_default_that_is_no_value_of_its_type_is_a_warning(tmp_path: Path) -> None:
    model = (
        '\n<TreeNodesModel><Action ID="bare"><input_port name="farthest" type="double" default="limits::infinity()"/>'
        "</Action></TreeNodesModel>"
    )
    root = load(tmp_path, "<Sequence><bare/></Sequence>", {"bare": lambda: None}, model)
    root.tick_once()
    assert root.status is Status.SUCCESS
    (warning,) = load_trees(tmp_path / "mission.xml", {"bare": lambda: None}).warnings()
    assert str(warning).endswith(
        "mission.xml:2: the default of port 'farthest' counts for nothing: 'limits::infinity()' is not a number"
    )


def test_a_file_of_models_counts_for_every_mission(tmp_path: Path, manifest: Path) -> None:
    route: list[object] = []
    leaves = Registry({"PlanRoute": lambda: route.append(1), "IsGoalNear": lambda: True})
    body = '<Sequence><PlanRoute goal="{goal}" path="{path}"/><IsGoalNear/></Sequence>'
    root = load(tmp_path, body, leaves, nodes=[manifest])
    root.tick_once()
    assert (root.status, route) == (Status.SUCCESS, [1])
    with pytest.raises(InputError, match="PlanRoute has no port 'gaol'"):
        load(tmp_path, '<PlanRoute gaol="x"/>', leaves, nodes=[manifest])
    with pytest.raises(InputError, match="PlanRoute has no port 'goal'"):
        load(tmp_path, '<PlanRoute goal="x"/>', leaves)


def test_a_check_without_a_robot_knows_the_nodes_of_a_file_of_models(tmp_path: Path, manifest: Path) -> None:
    path = tmp_path / "mission.xml"
    path.write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="M"><Sequence><PlanRoute goal="x"/><search/></Sequence></BehaviorTree>'
        "</root>",
        encoding="utf-8",
    )
    assert check_mission(path, fake_model("search"), nodes=[manifest]).problems == ()
    (problem,) = check_mission(path, fake_model("search")).problems
    assert "unknown node 'PlanRoute'" in problem.what


def test_a_file_of_models_without_models_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "nodes.xml"
    path.write_text("<root/>", encoding="utf-8")
    with pytest.raises(InputError, match="there is no <TreeNodesModel> in it"):
        load(tmp_path, "<AlwaysSuccess/>", {}, nodes=[path])


SUBTREE = '<BehaviorTree ID="S"><Sequence><ScriptCondition code="level == {0}"/></Sequence></BehaviorTree>'
SUBTREE_MODEL = '<TreeNodesModel><SubTree ID="S"><input_port name="level" default="42"/></SubTree></TreeNodesModel>'


@pytest.mark.parametrize(
    ("ports", "level"),
    [
        ("", "42"),
        ('_autoremap="false"', "42"),
        ('_autoremap="true"', "7"),
        ('level="3"', "3"),
        ('level="{level}"', "7"),
    ],
)
def test_the_default_of_a_subtrees_port_counts_unless_it_is_remapped(ports: str, level: str, tmp_path: Path) -> None:
    body = f'<Sequence><Script code="level := 7"/><SubTree ID="S" {ports}/></Sequence>'
    root = load(tmp_path, body, {}, SUBTREE.format(level) + SUBTREE_MODEL)
    root.tick_once()
    assert root.status is Status.SUCCESS


def test_a_port_that_a_subtrees_model_demands_may_be_remapped_automatically(tmp_path: Path) -> None:
    model = '<TreeNodesModel><SubTree ID="S"><input_port name="level"/></SubTree></TreeNodesModel>'
    body = '<Sequence><Script code="level := 7"/><SubTree ID="S" {}/></Sequence>'
    load(tmp_path, body.format('_autoremap="true"'), {}, SUBTREE.format(7) + model).tick_once()
    with pytest.raises(InputError, match="the SubTree 'S' needs the port 'level'"):
        load(tmp_path, body.format('_autoremap="false"'), {}, SUBTREE.format(7) + model)


def test_a_constant_on_an_in_out_port_is_read(tmp_path: Path) -> None:
    called: list[str] = []

    def call(service: InOut[str]) -> None:
        called.append(service.get())

    load(tmp_path, '<Sequence><call service="/gripper/reset"/></Sequence>', {"call": call}).tick_once()
    assert called == ["/gripper/reset"]


def test_a_constant_on_an_in_out_port_is_an_error_when_it_is_written(tmp_path: Path) -> None:
    def count(number: InOut[int]) -> None:
        number.set(number.get() + 1)

    blackboard = Blackboard()
    root = load(tmp_path, '<Sequence><count number="3"/></Sequence>', {"count": count}, blackboard=blackboard)
    root.tick_once()
    assert root.status is Status.FAILURE
    assert root.children[0].feedback_message == (
        "raised PortError: port 'number' cannot be written: it is the constant '3'"
    )
    body = '<Sequence><Script code="n := 3"/><count number="{n}"/></Sequence>'
    load(tmp_path, body, {"count": count}, blackboard=blackboard).tick_once()
    assert blackboard.get("n") == 4


def test_a_constant_of_the_wrong_type_on_an_in_out_port_is_refused(tmp_path: Path) -> None:
    def count(number: InOut[int]) -> None:
        """Never called."""

    with pytest.raises(InputError, match="number: 'many' is not a whole number"):
        load(tmp_path, '<count number="many"/>', {"count": count})


def test_a_number_that_is_given_to_a_subtree_is_a_number(tmp_path: Path) -> None:
    seen: list[object] = []

    def look(text: str, number: float, times: int) -> None:
        seen.extend([text, number, times])

    subtree = '<BehaviorTree ID="S"><Sequence><Script code="m := n + 1; @h := x / 2"/></Sequence></BehaviorTree>'
    blackboard = Blackboard()
    load(
        tmp_path, '<Sequence><SubTree ID="S" n="5" x="1.5"/></Sequence>', {}, subtree, blackboard=blackboard
    ).tick_once()
    assert blackboard.get("h") == 0.75
    subtree = '<BehaviorTree ID="S"><look text="{version}" number="{x}" times="{n}"/></BehaviorTree>'
    load(
        tmp_path, '<Sequence><SubTree ID="S" version="1.10" x="2" n="3"/></Sequence>', {"look": look}, subtree
    ).tick_once()
    assert seen == ["1.10", 2.0, 3]


def test_an_output_with_a_constant_is_refused(tmp_path: Path) -> None:
    def tell(said: Output[str]) -> None:
        """Never called."""

    with pytest.raises(InputError, match="the port 'said' must name an entry of the blackboard"):
        load(tmp_path, '<tell said="x"/>', {"tell": tell})


def test_declared_ports_may_be_optional(tmp_path: Path) -> None:
    from task_layer.bt.ports.port import OPTIONAL

    class Leaf(ScriptedLeaf):
        PORTS = (InputPort("goal", str, OPTIONAL),)

        def __init__(self, name: str, ports: Ports):
            super().__init__(name)
            self.goal = ports.get("goal")

    assert load(tmp_path, "<leaf/>", {"leaf": Leaf}).goal is None
    assert load(tmp_path, '<leaf goal="x"/>', {"leaf": Leaf}).goal == "x"
