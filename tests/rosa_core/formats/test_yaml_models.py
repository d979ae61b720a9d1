"""Knowledge models in YAML: what a good file means, how files extend one another, and the JSON Schema for editors."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import jsonschema
import networkx as nx
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeModel, KnowledgeModelError
from rosa_core.formats.yaml_format import json_schema
from rosa_core.model import ElementKind, ElementRef
from rosa_core.model.effort import count_effort
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    ComponentParameter,
    ComponentType,
    Constraint,
    ConstraintOperator,
    Estimation,
    EstimationType,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
    MeasureKind,
    ParameterType,
)
from tests.rosa_core.sample_models import DRONE, knowledge_model

Load = Callable[..., KnowledgeModel]


@pytest.fixture
def load(tmp_path: Path) -> Load:
    """Loads the model that several texts state, each a file of its own: 1.yaml, 2.yaml, ..."""

    def load_texts(*texts: str) -> KnowledgeModel:
        paths = []
        for number, text in enumerate(texts, start=1):
            paths.append(tmp_path / f"{number}.yaml")
            paths[-1].write_text(text, encoding="utf-8")
        return KnowledgeModel.load(*paths)

    return load_texts


def shipped(*names: str) -> KnowledgeModel:
    with as_file(files("suave.models")) as folder:
        return KnowledgeModel.load(*(folder / name for name in names))


# -- a good model --

GOOD = """
measures:
  energy: {kind: quality}
  depth: {kind: environmental}
  noise:
actions:
  dive: {requires: [sink, steer], constraints: [{measure: energy, operator: ">", value: 1}]}
  rest:
functions:
  sink:
  steer: {always_improve: true}
components:
  ballast: {constraints: [{measure: depth, operator: "<=", value: 100.5}]}
  rudder: {type: lifecycle_node, package: boat, executable: rudder, always_improve: true}
  sonar: {type: ros_node, estimations: [{measure: noise, value: 3}]}
function_designs:
  by ballast: {function: sink, components: [ballast]}
  by rudder:
    function: steer
    components: [rudder, sonar]
    priority: 2
    constraints: [{measure: depth}]
    estimations: [{measure: energy, value: -0.5, type: absolute}]
component_configurations:
  gentle: {component: rudder}
  sharp:
    component: rudder
    priority: 1.5
    parameters:
      {angle: 30, gain: 0.5, reverse: true, mode: fast, limits: [1, 2.5], names: [a, b], at: {value: 1, type: double}}
    constraints: [{measure: noise, operator: "<", value: 2}]
    estimations: [{measure: energy, value: 2, type: negative}]
"""


def test_every_element_of_a_good_file_is_in_the_model_in_order_of_declaration(load: Load) -> None:
    model = load(GOOD)
    assert model.measures == (
        Measure("energy", MeasureKind.QUALITY),
        Measure("depth", MeasureKind.ENVIRONMENTAL),
        Measure("noise", MeasureKind.MEASURE),
    )
    assert model.actions == (Action("dive"), Action("rest"))
    assert model.requirements == (FunctionalRequirement("dive", ("sink", "steer")),)
    assert model.functions == (Function("sink", False), Function("steer", True))
    assert model.components == (
        Component("ballast"),
        Component("rudder", ComponentType.LIFECYCLE_NODE, "boat", "rudder", always_improve=True),
        Component("sonar", ComponentType.ROS_NODE),
    )
    assert model.function_designs == (
        FunctionDesign("by ballast", "sink", ("ballast",), None),
        FunctionDesign("by rudder", "steer", ("rudder", "sonar"), 2.0),
    )
    gentle, sharp = model.component_configurations
    assert gentle == ComponentConfiguration("gentle", "rudder")
    assert (sharp.component, sharp.priority) == ("rudder", 1.5)


def test_parameters_have_the_type_of_their_spelling_or_the_one_stated(load: Load) -> None:
    sharp = load(GOOD).component_configurations[1]
    given_types = {parameter.key: (parameter.value, parameter.type) for parameter in sharp.parameters}
    assert given_types == {
        "angle": (30, ParameterType.LONG),
        "gain": (0.5, ParameterType.DOUBLE),
        "reverse": (True, ParameterType.BOOLEAN),
        "mode": ("fast", ParameterType.STRING),
        "limits": ((1, 2.5), ParameterType.DOUBLE_ARRAY),
        "names": (("a", "b"), ParameterType.STRING_ARRAY),
        "at": (1.0, ParameterType.DOUBLE),
    }
    assert {parameter.component for parameter in sharp.parameters} == {"rudder"}


def test_constraints_and_estimations_have_their_defaults(load: Load) -> None:
    model = load(GOOD)
    design = ElementRef(ElementKind.FUNCTION_DESIGN, "by rudder")
    assert Constraint("depth", design, ConstraintOperator.GREATER_OR_EQUAL, None) in model.constraints
    action = ElementRef(ElementKind.ACTION, "dive")
    assert Constraint("energy", action, ConstraintOperator.GREATER, 1.0) in model.constraints
    assert {constraint.constrained.kind for constraint in model.constraints} == {
        "action",
        "component",
        "function_design",
        "component_configuration",
    }
    assert Estimation(ElementRef(ElementKind.COMPONENT, "sonar"), "noise", 3.0) in model.estimations
    assert [estimation.type for estimation in model.estimations] == list(
        map(EstimationType, ["positive", "absolute", "negative"])
    )


def test_names_are_unique_only_within_a_kind(load: Load) -> None:
    model = load(
        """
        measures: {x: }
        actions: {x: {requires: [x]}}
        functions: {x: }
        components: {x: , y: }
        function_designs: {x: {function: x, components: [y]}}
        component_configurations: {x: {component: x}}
        """
    )
    assert [names.count("x") for names in model.names.values()] == [1] * 6


def test_an_entry_with_nothing_after_it_is_an_entry_with_nothing_in_it(load: Load) -> None:
    assert load("{actions: {rest: }, functions: {f: }}") == load("{actions: {rest: {}}, functions: {f: {}}}")


@pytest.mark.parametrize("suffix", [".yaml", ".yml", ".YAML"])
def test_yaml_files_are_known_by_their_suffix(tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"model{suffix}"
    file.write_text("actions: {rest: }", encoding="utf-8")
    assert KnowledgeModel.load(str(file)) == KnowledgeModel(actions=(Action("rest"),))


# -- several files --


def test_a_later_file_may_add_elements_requirements_constraints_and_estimations(load: Load) -> None:
    model = load(
        GOOD,
        """
        measures: {heat: }
        functions: {see: }
        actions: {dive: {requires: [see], constraints: [{measure: heat, operator: "<", value: 9}]}, surface: }
        components: {sonar: {estimations: [{measure: heat, value: 1}]}}
        """,
    )
    assert model.names[ElementKind.ACTION] == ("dive", "rest", "surface")
    assert model.names[ElementKind.MEASURE] == ("energy", "depth", "noise", "heat")
    assert model.requirements == (
        FunctionalRequirement("dive", ("sink", "steer")),
        FunctionalRequirement("dive", ("see",)),
    )
    on_dive = [c.measure for c in model.constraints if c.constrained.name == "dive"]
    assert on_dive == ["energy", "heat"]
    assert [e.measure for e in model.estimations if e.causer.name == "sonar"] == ["noise", "heat"]


def test_a_later_file_may_say_the_same_again_or_what_was_left_open(load: Load) -> None:
    model = load(
        "{functions: {f: }, components: {c: }, function_designs: {d: {function: f, components: [c]}}}",
        "{functions: {f: {always_improve: true}}, function_designs: {d: {function: f, components: [c], priority: 3}}}",
    )
    assert model.functions == (Function("f", always_improve=True),)
    assert model.function_designs == (FunctionDesign("d", "f", ("c",), 3.0),)


def test_files_may_refer_to_what_only_a_later_one_declares(load: Load) -> None:
    model = load("actions: {go: {requires: [move]}}", "functions: {move: }")
    assert model.requirements == (FunctionalRequirement("go", ("move",)),)


# -- the model as a whole --


def test_the_shipped_models_have_the_development_effort_of_the_paper() -> None:
    plain, extended = (
        count_effort(shipped("suave.yaml")),
        count_effort(shipped("suave.yaml", "suave_extended.yaml")),
    )
    assert (plain.entities, plain.relations, plain.total) == (18, 12, 30)
    assert (extended.entities, extended.relations, extended.total) == (22, 16, 38)
    assert sum(extended.by_kind.values()) == extended.total


def test_effort_counts_a_parameter_once_per_component_key_and_value(load: Load) -> None:
    effort = count_effort(
        load(
            """
            components: {a: , b: }
            component_configurations:
              one: {component: a, parameters: {speed: 1.0, mode: x}}
              two: {component: a, parameters: {speed: 1.0, mode: y}}
              three: {component: b, parameters: {speed: 1.0}}
            """
        )
    )
    assert effort.by_kind["component_parameters"] == 4
    assert (effort.entities, effort.relations, effort.total) == (6, 3, 9)


@pytest.mark.parametrize("names", [("suave.yaml",), ("suave.yaml", "suave_extended.yaml")])
def test_what_depends_on_what_has_no_cycles(names: tuple[str, ...]) -> None:
    model = shipped(*names)
    graph = model.graph()
    assert nx.is_directed_acyclic_graph(graph)
    assert len(graph) == sum(map(len, model.names.values())) + len(model.constraints)


def test_the_graph_leads_from_what_is_depended_on_to_what_depends_on_it() -> None:
    graph = knowledge_model(DRONE).graph()
    light, hover = ElementRef(ElementKind.MEASURE, "light"), ElementRef(ElementKind.ACTION, "hover")
    reached = {ref.name for ref in nx.descendants(graph, light) if ref.kind is not ElementKind.CONSTRAINT}
    assert reached == {"sharp", "grainy", "camera", "see by camera", "see", "deliver"}
    assert {ref.name for ref in nx.ancestors(graph, hover) if ref.kind is ElementKind.COMPONENT} == {
        "rotors",
        "autopilot",
        "damper",
    }


def test_constraints_with_almost_the_same_value_are_different_nodes_of_the_graph(load: Load) -> None:
    limits = "[{measure: m, value: 1000000}, {measure: m, value: 1000001}]"
    model = load(f"{{measures: {{m: }}, actions: {{go: {{constraints: {limits}}}}}}}")
    nodes = [ref for ref in model.graph() if ref.kind is ElementKind.CONSTRAINT]
    assert len(nodes) == 2


def test_a_model_built_from_elements_is_checked_like_one_from_files() -> None:
    on_measure = ElementRef(ElementKind.MEASURE, "m")
    with pytest.raises(KnowledgeModelError) as caught:
        KnowledgeModel(
            measures=(Measure("m"), Measure("m"), Measure("")),
            actions=(Action("go"),),
            requirements=(FunctionalRequirement("goo", ()),),
            component_configurations=(
                ComponentConfiguration("k", "c", (ComponentParameter("d", "x", 1, ParameterType.LONG),), float("nan")),
            ),
            constraints=(Constraint("m", on_measure),),
            estimations=(Estimation(ElementRef(ElementKind.ACTION, "go"), "m", float("inf")),),
        )
    found = "\n".join(problem.what for problem in caught.value.problems)
    for part in (
        "measure 'm' is declared twice",
        "a measure has an empty name",
        "names the unknown action 'goo'",
        "lists no function",
        "names the unknown component 'c'",
        "parameter of another component, 'd'",
        "has priority nan",
        "a constraint on measure 'm' cannot be",
        "an estimation for action 'go' cannot be",
        "has the value inf",
    ):
        assert part in found


# -- the JSON Schema --


@pytest.mark.parametrize("name", ["suave.yaml", "suave_extended.yaml"])
def test_the_json_schema_accepts_the_shipped_models(name: str) -> None:
    jsonschema.validate(yaml.safe_load(files("suave.models").joinpath(name).read_text(encoding="utf-8")), json_schema())


@pytest.mark.parametrize("text", [DRONE, GOOD])
def test_the_json_schema_accepts_what_the_loader_accepts(text: str, load: Load) -> None:
    load(text)
    jsonschema.validate(yaml.safe_load(text), json_schema())


@pytest.mark.parametrize(
    "bad",
    [
        {"action": {}},
        {"actions": []},
        {"actions": {"go": {"require": ["f"]}}},
        {"actions": {"go": {"requires": "f"}}},
        {"functions": {"f": {"always_improve": "yes"}}},
        {"components": {"c": {"type": "node"}}},
        {"function_designs": {"d": {"priority": "high"}}},
        {"actions": {"go": {"constraints": [{"operator": ">="}]}}},
        {"actions": {"go": {"constraints": [{"measure": "m", "operator": "=="}]}}},
        {"components": {"c": {"estimations": [{"measure": "m"}]}}},
        {"component_configurations": {"k": {"parameters": {"p": {"value": 1}}}}},
    ],
)
def test_the_json_schema_rejects_a_bad_model(bad: Any) -> None:
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(bad, json_schema())


@settings(max_examples=50, deadline=None)
@given(st.permutations(list(yaml.safe_load(DRONE))))
def test_the_order_of_sections_does_not_matter(order: list[str]) -> None:
    stated = yaml.safe_load(DRONE)
    assert knowledge_model(yaml.safe_dump({section: stated[section] for section in order}, sort_keys=False)) == (
        knowledge_model(DRONE)
    )
