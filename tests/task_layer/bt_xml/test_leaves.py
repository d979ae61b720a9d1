"""What may be registered as a leaf, and how its ports work."""

from __future__ import annotations

from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import py_trees
import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.ports import BehaviourWithPorts, PortInformation

from rosa_core import InputError, KnowledgeBase
from task_layer.bt import (
    Blackboard,
    InOut,
    InputPort,
    IsActionFeasible,
    Node,
    Output,
    OutputPort,
    Ports,
    Registry,
    RosaAction,
    SkillAction,
    load_tree,
    tree_xml,
)
from task_layer.skill import Skill, SkillStatus


class Loader:
    """Loads trees with a blackboard to look at."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "mission.xml"
        self.blackboard = Blackboard()
        self.errors: list[str] = []

    def load(self, nodes: str, registry: Any, models: str = "") -> Behaviour:
        text = f'<root BTCPP_format="4"><BehaviorTree ID="M">{nodes}</BehaviorTree>{models}</root>'
        self.path.write_text(text, encoding="utf-8")
        root = load_tree(self.path, registry, blackboard=self.blackboard)
        for node in root.iterate():
            if isinstance(node, Node):
                node.setup(on_raise=lambda _, error: self.errors.append(str(error)))
        return root

    def tick(self, nodes: str, registry: Any) -> Status:
        root = self.load(f"<Sequence>{nodes}</Sequence>", registry)
        root.tick_once()
        return root.status


@pytest.fixture
def loader(tmp_path: Path) -> Loader:
    return Loader(tmp_path)


class Gear(Enum):
    LOW = 1
    HIGH = 2


@pytest.mark.parametrize(
    ("result", "status"),
    [
        (True, Status.SUCCESS),
        (False, Status.FAILURE),
        (None, Status.SUCCESS),
        (Status.RUNNING, Status.RUNNING),
        (SkillStatus.RUNNING, Status.RUNNING),
        (SkillStatus.FAILURE, Status.FAILURE),
    ],
)
def test_what_a_function_returns_is_its_status(result: object, status: Status, loader: Loader) -> None:
    assert loader.tick("<leaf/>", {"leaf": lambda: result}) is status


def test_a_function_that_returns_something_else_has_failed(loader: Loader) -> None:
    assert loader.tick("<leaf/>", {"leaf": lambda: 3}) is Status.FAILURE
    assert loader.errors == ["a leaf must return a bool, a status or None, not 3"]


def test_the_parameters_of_a_function_are_its_ports(loader: Loader) -> None:
    calls = []

    def leaf(speed: float, gear: Gear, names: list[str], loud: bool = False, *, note: str | None = None) -> None:
        calls.append((speed, gear, names, loud, note))

    loader.tick('<leaf speed="1.5" gear="HIGH" names="a;b" loud="true" note="x"/>', {"leaf": leaf})
    loader.tick('<leaf speed="2" gear="1" names=""/>', {"leaf": leaf})
    assert calls == [(1.5, Gear.HIGH, ["a", "b"], True, "x"), (2.0, Gear.LOW, [], False, None)]


def test_a_port_reads_its_entry_at_every_tick(loader: Loader) -> None:
    seen: list[int] = []

    def leaf(number: int) -> None:
        seen.append(number)

    root = loader.load(
        '<Sequence><Script code="n := 1 + (later ? 1 : 0)"/><leaf number="{n}"/></Sequence>', {"leaf": leaf}
    )
    loader.blackboard.set("later", False)
    root.tick_once()
    loader.blackboard.set("later", True)
    root.tick_once()
    assert seen == [1, 2]


def test_a_value_that_is_not_of_the_ports_type_fails_the_leaf(loader: Loader) -> None:
    def leaf(number: int) -> None:
        raise AssertionError

    assert loader.tick('<Script code="n := 1.5"/><leaf number="{n}"/>', {"leaf": leaf}) is Status.FAILURE
    assert loader.errors == ["port 'number': 1.5 is not a whole number"]


def test_a_function_writes_its_outputs(loader: Loader) -> None:
    def look(seen: Output[str], count: InOut[int]) -> bool:
        seen.set("fish")
        count.set(count.get() + 1)
        return True

    loader.tick('<Script code="n := 1"/><look seen="{animal}" count="{n}"/>', {"look": look})
    assert (loader.blackboard.get("animal"), loader.blackboard.get("n")) == ("fish", 2)


def test_an_output_that_nobody_wants_is_not_written(loader: Loader) -> None:
    def look(seen: Output[str]) -> None:
        seen.set("fish")

    assert loader.tick("<look/>", {"look": look}) is Status.SUCCESS
    assert loader.blackboard.names() == []


def test_a_default_may_be_an_entry(loader: Loader) -> None:
    seen = []

    def leaf(goal: str = "{=}") -> None:
        seen.append(goal)

    loader.tick("<Script code=\"goal := 'home'\"/><leaf/>", {"leaf": leaf})
    assert seen == ["home"]


class Move(Behaviour):
    """A behaviour that takes its ports."""

    PORTS = (InputPort("goal", str), OutputPort("reached", bool))

    def __init__(self, name: str, ports: Ports) -> None:
        super().__init__(name)
        self.ports = ports

    def update(self) -> Status:
        self.feedback_message = self.ports["goal"]
        self.ports["reached"] = True
        return Status.SUCCESS


def test_a_behaviour_class_gets_its_ports(loader: Loader) -> None:
    root = loader.load('<Move name="go" goal="{where}" reached="{ok}"/>', {"Move": Move})
    loader.blackboard.set("where", "home")
    root.tick_once()
    assert isinstance(root, Move)
    assert (root.name, root.feedback_message) == ("go", "home")
    assert loader.blackboard.get("ok") is True


def test_a_behaviour_class_of_py_trees_takes_constants(loader: Loader) -> None:
    registry = {"Count": py_trees.behaviours.TickCounter}
    root = loader.load('<Count duration="3" completion_status="FAILURE"/>', registry)
    assert isinstance(root, py_trees.behaviours.TickCounter)
    assert (root.duration, root.completion_status) == (3, Status.FAILURE)


def test_a_function_with_a_name_makes_behaviours(loader: Loader) -> None:
    def make(name: str) -> Behaviour:
        return py_trees.behaviours.Running(name)

    root = loader.load(
        '<Sequence><a name="x"/><b/></Sequence>',
        {"a": make, "b": partial(py_trees.behaviours.TickCounter, duration=1, completion_status=Status.SUCCESS)},
    )
    assert [(type(child).__name__, child.name) for child in root.children] == [("Running", "x"), ("TickCounter", "b")]


def test_a_behaviour_instance_cannot_be_registered() -> None:
    with pytest.raises(TypeError, match="a behaviour can stand in one place only"):
        Registry({"x": py_trees.behaviours.Running("x")})


class Doubled(BehaviourWithPorts):
    """A behaviour with the typed ports of py_trees 2.6."""

    INPUT_PORTS: ClassVar = {"number": PortInformation(data_type=int, default_value=4)}
    OUTPUT_PORTS: ClassVar = {"twice": PortInformation(data_type=int)}

    def update(self) -> Status:
        self._set_output("twice", 2 * self.get_input("number"))
        return Status.SUCCESS


def test_typed_ports_of_py_trees_use_the_blackboard_of_the_tree(loader: Loader) -> None:
    nodes = '<Script code="n := 3"/><Doubled number="{n}" twice="{m}"/><Doubled twice="{k}"/>'
    loader.tick(nodes, {"Doubled": Doubled})
    assert (loader.blackboard.get("m"), loader.blackboard.get("k")) == (6, 8)
    with pytest.raises(InputError, match="number: 'x' is not a whole number"):
        loader.load('<Doubled number="x" twice="{m}"/>', {"Doubled": Doubled})


class Drive(Skill):
    def update(self) -> SkillStatus:
        return SkillStatus.RUNNING


def test_a_skill_becomes_a_rosa_action(loader: Loader) -> None:
    nodes = '<Sequence><drive name="go"/><drive/><RosaAction action_name="drive" preference="energy"/></Sequence>'
    first, second, third = loader.load(nodes, {"drive": Drive}).children
    assert isinstance(first, RosaAction)
    assert isinstance(second, RosaAction)
    assert isinstance(third, RosaAction)
    assert (first.name, first.action_name, second.name) == ("go", "drive", "drive")
    assert first.skill is not second.skill
    assert (third.name, third.action_name, third.preference) == ("RosaAction", "drive", "energy")


def test_a_skill_may_be_carried_out_without_a_request(loader: Loader) -> None:
    skill = Drive()
    root = loader.load("<drive/>", Registry().add("drive", skill, request=False))
    assert type(root) is SkillAction
    assert root.skill is skill


def test_a_subclass_of_rosa_action_is_made_for_its_action(loader: Loader) -> None:
    class Hooked(RosaAction):
        def on_running(self) -> Status:
            return Status.SUCCESS

    root = loader.load('<search preference="energy"/>', {"search": Hooked})
    assert isinstance(root, Hooked)
    assert (root.action_name, root.preference) == ("search", "energy")


@pytest.mark.parametrize("tag", ["IsActionFeasible", "is_action_feasible"])
def test_feasibility_is_built_in(tag: str, loader: Loader, kb: KnowledgeBase) -> None:
    root = loader.load(f'<{tag} action_name="search_pipeline"/>', {})
    assert isinstance(root, IsActionFeasible)
    root.setup(kb=kb)
    root.tick_once()
    assert (root.name, root.status) == (tag, Status.SUCCESS)


def test_a_subtree_may_guard_the_action_that_it_is_given(loader: Loader) -> None:
    loader.path.write_text(
        '<root BTCPP_format="4" main_tree_to_execute="M"><BehaviorTree ID="M"><SubTree ID="Guarded" action="drive"/>'
        '</BehaviorTree><BehaviorTree ID="Guarded"><ReactiveSequence><IsActionFeasible action_name="{action}"/>'
        '<RosaAction action_name="{action}"/></ReactiveSequence></BehaviorTree></root>'
    )
    root = load_tree(loader.path, {"drive": Drive})
    feasible, action = root.children[0].children
    assert isinstance(feasible, IsActionFeasible)
    assert isinstance(action, RosaAction)
    assert (feasible.action_name, action.action_name) == ("drive", "drive")
    assert '<RosaAction action_name="{action}" />' in tree_xml(root)


def test_own_control_nodes_and_decorators_may_be_registered(loader: Loader) -> None:
    registry = {"Choose": py_trees.composites.Selector, "Not": py_trees.decorators.Inverter}
    root = loader.load('<Choose memory="true"><Not><AlwaysSuccess/></Not><AlwaysSuccess/></Choose>', registry)
    root.tick_once()
    assert isinstance(root, py_trees.composites.Selector)
    assert root.status is Status.SUCCESS


def test_the_model_gives_defaults_that_the_leaf_does_not_have(loader: Loader) -> None:
    seen = []

    def leaf(speed: float, gear: int = 1) -> None:
        seen.append((speed, gear))

    models = (
        '<TreeNodesModel><Action ID="leaf"><input_port name="speed" default="2.5" type="double"/>'
        '<input_port name="gear" default="7" type="int"/></Action></TreeNodesModel>'
    )
    loader.load("<leaf/>", {"leaf": leaf}, models).tick_once()
    assert seen == [(2.5, 1)]


def test_the_model_of_a_subtree_gives_its_ports_defaults(loader: Loader) -> None:
    loader.path.write_text(
        '<root BTCPP_format="4" main_tree_to_execute="M"><BehaviorTree ID="M"><SubTree ID="S"/></BehaviorTree>'
        '<BehaviorTree ID="S"><Script code="x := 5"/></BehaviorTree><TreeNodesModel><SubTree ID="S">'
        '<inout_port name="x" default="{y}"/></SubTree></TreeNodesModel></root>'
    )
    load_tree(loader.path, {}, blackboard=loader.blackboard).tick_once()
    assert loader.blackboard.get("y") == 5


def test_enums_are_numbers_in_scripts_and_switches(loader: Loader) -> None:
    registry = Registry(enums={"RED": 3}).add_enum(Gear)
    nodes = (
        '<Sequence><Script code="g := HIGH; c := RED"/>'
        '<Switch2 variable="{g}" case_1="LOW" case_2="HIGH"><AlwaysFailure/><AlwaysSuccess/><AlwaysFailure/></Switch2>'
        "<Script code=\"ok := c == 'RED'\"/></Sequence>"
    )
    loader.load(nodes, registry).tick_once()
    assert (loader.blackboard.get("g"), loader.blackboard.get("ok")) == (2.0, 1.0)


def test_every_action_can_count_as_feasible(tmp_path: Path) -> None:
    file = tmp_path / "mission.xml"
    ask = '<Sequence><is_action_feasible action_name="dive"/><IsActionFeasible action_name="dance"/></Sequence>'
    file.write_text(f'<root BTCPP_format="4"><BehaviorTree ID="m">{ask}</BehaviorTree></root>', encoding="utf-8")
    tree = load_tree(file, Registry().count_all_as_feasible())
    tree.tick_once()
    assert tree.status == Status.SUCCESS
