"""Models written in TypeQL: what loads, what it means, and what is said of what does not."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import KnowledgeBase, KnowledgeModel, KnowledgeModelError, SimulationClock
from rosa_core.kb import stated_situation
from rosa_core.model.effort import count_effort
from rosa_core.model.elements import (
    Annotation,
    ComponentType,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    EstimationType,
    MeasureKind,
    ParameterType,
)
from rosa_typeql.matching.parameter_text import parameter_text, parameter_value, suggested_type

DATA = Path(__file__).parents[1] / "data"
YAML = Path(__file__).parents[2] / "suave" / "models"
ACTION = '$a isa Action, has action-name "fly";'
FUNCTION = '$f isa Function, has function-name "lift";'
COMPONENT = '$c isa Component, has component-name "rotor";'
MEASURE = '$m isa QualityAttribute, has measure-name "charge";'


class TestSuave:
    def test_the_model_in_typeql_is_the_model_in_yaml(self):
        assert KnowledgeModel.load(DATA / "suave.tql") == KnowledgeModel.load(YAML / "suave.yaml")

    def test_so_is_the_extended_model(self):
        typeql = KnowledgeModel.load(DATA / "suave.tql", DATA / "suave_extended.tql")
        yaml = KnowledgeModel.load(YAML / "suave.yaml", YAML / "suave_extended.yaml")
        assert typeql == yaml
        assert hash(typeql) == hash(yaml)

    @pytest.mark.parametrize(
        ("first", "second"),
        [(YAML / "suave.yaml", DATA / "suave_extended.tql"), (DATA / "suave.tql", YAML / "suave_extended.yaml")],
    )
    def test_files_of_both_kinds_mix(self, first, second):
        assert KnowledgeModel.load(first, second) == KnowledgeModel.load(
            YAML / "suave.yaml", YAML / "suave_extended.yaml"
        )

    def test_it_takes_the_effort_that_the_paper_counts(self):
        suave = count_effort(KnowledgeModel.load(DATA / "suave.tql"))
        assert (suave.entities, suave.relations) == (18, 12)
        extended = count_effort(KnowledgeModel.load(DATA / "suave.tql", DATA / "suave_extended.tql"))
        assert (extended.entities, extended.relations) == (22, 16)

    def test_an_extension_alone_says_what_it_misses(self, tmp_path):
        with pytest.raises(KnowledgeModelError, match="there is no action 'search_pipeline' to match"):
            KnowledgeModel.load(DATA / "suave_extended.tql")


class TestSpellings:
    def test_the_snippet_of_the_paper_loads(self, load):
        # Listing 5, with the function that it leaves out.
        model = load("""insert
            # Action search pipeline
            $a_search_pipeline isa Action, has action-name
               'search_pipeline';
            $f_generate_search_path isa Function, has function-name
               'generate_search_path';
            $f_maintain_motion isa Function, has function-name 'maintain_motion';
            # functional-requirement relationship
            (action: $a_search_pipeline,
             required-function: $f_generate_search_path,
             required-function: $f_maintain_motion)
            isa functional-requirement;
        """)
        assert model.requirements[0].functions == ("generate_search_path", "maintain_motion")

    @pytest.mark.parametrize(
        ("measure", "constraint"),
        [
            (
                '$m isa QualityAttribute, has measure-name "q";',
                "constraint, has attribute-value 2, has constraint-operator",
            ),
            (
                '$m isa QualityAttribute, has attribute-name "q";',
                "constrainment, has attribute-value 2, has constrainment-operator",
            ),
            ('$m isa QualityAttribute, has name "q";', "constraint, has value 2.0, has operator"),
        ],
    )
    def test_constraints_and_measures_of_every_age(self, load, measure, constraint):
        model = load(f"insert {measure} {ACTION} (constraint: $m, constrained: $a) isa {constraint} '<';")
        assert model.measures[0].kind is MeasureKind.QUALITY
        found = model.constraints[0]
        assert (found.operator, found.value, found.measure) == (ConstraintOperator.LESS, 2.0, "q")

    @pytest.mark.parametrize(
        ("spelled", "kind"),
        [
            ("Measure", MeasureKind.MEASURE),
            ("Attribute", MeasureKind.MEASURE),
            ("EnvironmentalAttribute", MeasureKind.ENVIRONMENTAL),
            ("QualityAttribute", MeasureKind.QUALITY),
        ],
    )
    def test_measures(self, load, spelled, kind):
        assert load(f"insert $m isa {spelled}, has measure-name 'q';").measures[0].kind is kind

    def test_the_roles_of_the_measure(self, load):
        text = f"insert {MEASURE} {COMPONENT} (measure: $m, constrained: $c) isa constraint, has value 1;"
        assert load(f"{text} (causer: $c, measure: $m) isa estimation, has value 1;").estimations[0].measure == "charge"

    def test_a_constraint_without_operator_and_value(self, load):
        found = load(f"insert {MEASURE} {ACTION} (constraint: $m, constrained: $a) isa constraint;").constraints[0]
        assert (found.operator, found.value) == (ConstraintOperator.GREATER_OR_EQUAL, None)

    def test_one_constraint_on_several_elements(self, load):
        model = load(
            f"insert {MEASURE} {ACTION} {COMPONENT}"
            "(constraint: $m, constrained: $a, constrained: $c) isa constraint, has attribute-value 0.5;"
        )
        assert [c.constrained.name for c in model.constraints] == ["fly", "rotor"]

    @pytest.mark.parametrize("spelled", ["has estimation-value 3, has estimation-type", "has value 3, has type"])
    def test_estimations(self, load, spelled):
        text = f"insert {MEASURE} {COMPONENT} (causer: $c, affected: $m) isa estimation, {spelled} 'absolute';"
        found = load(text).estimations[0]
        assert (found.causer.name, found.value, found.type) == ("rotor", 3.0, EstimationType.ABSOLUTE)

    @pytest.mark.parametrize(
        ("spelled", "kind"), [("ROSNode", ComponentType.ROS_NODE), ("LifeCycleNode", ComponentType.LIFECYCLE_NODE)]
    )
    def test_nodes(self, load, spelled, kind):
        text = f"insert $n isa {spelled}, has component-name 'n', has package 'p', has executable 'e';"
        node = load(text).components[0]
        assert (node.type, node.package, node.executable) == (kind, "p", "e")


class TestLayout:
    def test_any(self, load):
        plain = load(f"insert {ACTION} {FUNCTION} (action: $a, required-function: $f) isa functional-requirement;")
        odd = load(
            'insert#comment; with \'quotes"\n$a\tisa\n\n Action,has action-name"fly"\n;$f isa Function;'
            "(required-function:$f,action:$a)isa functional-requirement;$f has function-name'lift'"
        )
        assert odd == plain

    @pytest.mark.parametrize(
        "relation",
        [
            "$fd (function: $f, required-component: $c) isa function-design, has function-design-name 'd';",
            "(function: $f, required-component: $c) $fd isa function-design, has function-design-name 'd';",
            "(function: $f, required-component: $c) isa function-design, has function-design-name 'd';",
            "$fd isa function-design (function: $f, required-component: $c), has function-design-name 'd';",
            "$fd isa function-design, links (function: $f, required-component: $c), has function-design-name 'd';",
            "$fd isa function-design, has function-design-name 'd', (function: $f, required-component: $c);",
            "$fd isa function-design; $fd (function: $f); $fd (required-component: $c); $fd has name 'd';",
            "($f, $c) isa function-design, has function-design-name 'd';",
        ],
    )
    def test_players_stand_before_or_after_the_variable(self, load, relation):
        design = load(f"insert {relation} {FUNCTION} {COMPONENT}").function_designs[0]
        assert (design.name, design.function, design.components) == ("d", "lift", ("rotor",))

    def test_texts_may_have_escapes_and_any_character(self, load):
        model = load(r"""insert $a isa Action, has action-name "say \"hé\" \\ # no comment", has note 'it\'s';""")
        assert model.actions[0].name == 'say "hé" \\ # no comment'
        assert model.annotations[0].value == "it's"

    def test_a_byte_order_mark_and_windows_line_ends(self, load):
        assert load(f"\ufeffinsert\r\n{ACTION}\r\n# end").actions[0].name == "fly"


class TestMatch:
    def test_finds_what_earlier_statements_and_files_inserted(self, load):
        model = load(
            f"insert {ACTION}",
            (".yaml", "functions: {lift: {}}"),
            f"insert {COMPONENT} match $a isa Action, has action-name 'fly'; $f isa Function, has name 'lift';"
            "$c has component-name 'rotor';"
            "insert (action: $a, required-function: $f) isa functional-requirement;"
            "(function: $f, required-component: $c) isa function-design, has name 'd';",
        )
        assert model.requirements[0].action == "fly"
        assert model.function_designs[0].components == ("rotor",)

    def test_inserts_once_for_every_solution(self, load):
        model = load(
            f"""insert {MEASURE} $c1 isa Component, has name 'one'; $c2 isa ROSNode, has name 'two';
            $c3 isa Component, has name 'three', has always-improve true;
            match $c isa Component; not {{ $c has always-improve true; }}; $m isa Measure;
            insert (constraint: $m, constrained: $c) isa constraint, has attribute-value 1;"""
        )
        assert [c.constrained.name for c in model.constraints] == ["one", "two"]

    def test_adds_to_what_is_there(self, load):
        model = load(
            f"insert {FUNCTION}",
            "match $f isa Function; insert $f has always-improve true, has description 'keeps it up';",
        )
        assert model.functions[0].always_improve
        assert model.annotations == (
            Annotation(ElementRef(ElementKind.FUNCTION, "lift"), "description", "keeps it up"),
        )

    def test_finds_what_the_statement_before_it_added(self, load):
        model = load(
            f"""insert {FUNCTION} {COMPONENT}
            match $f isa Function; $c isa Component;
            insert (function: $f, required-component: $c) isa function-design, has name 'first';
            match $d isa function-design (function: $f); $f has always-improve false;
            insert $d has priority 1; $f has always-improve true; {MEASURE}
            match $d isa function-design, has priority 1; $d (function: $f); $f has always-improve true; $m isa Measure;
            insert (constraint: $m, constrained: $d) isa constraint, has value 1;
            match (constrained: $d, constraint: $m) isa constraint, has value $v; $d (required-component: $c);
            insert (causer: $c, affected: $m) isa estimation, has estimation-value $v;"""
        )
        assert model.function_designs[0].priority == 1.0
        assert (model.estimations[0].causer.name, model.estimations[0].value) == ("rotor", 1.0)

    def test_matches_relations_and_values(self, load):
        model = load(
            f"""insert {FUNCTION} {COMPONENT} {MEASURE}
            (function: $f, required-component: $c) isa function-design, has name 'd', has priority 2;
            match (function: $f, required-component: $c) isa function-design, has priority $p; $p > 1;
                  $m isa Measure; $d isa function-design;
            insert (constraint: $m, constrained: $d) isa constraint, has value $p;"""
        )
        assert model.constraints[0].value == 2.0
        assert model.constraints[0].constrained == ElementRef(ElementKind.FUNCTION_DESIGN, "d")


class TestParameters:
    @pytest.mark.parametrize(
        ("value", "kind", "read"),
        [
            ('"1"', "double", 1.0),
            ('"-3"', "long", -3),
            ('"True"', "boolean", True),
            ('"[3.0, 5]"', "double_array", (3.0, 5.0)),
            ('"[10,14]"', "long_array", (10, 14)),
            ('"[True, false]"', "boolean_array", (True, False)),
            ('"[a/b.tql, c d]"', "string_array", ("a/b.tql", "c d")),
            ("'[\"x, y\", z]'", "string_array", ("x, y", "z")),
            ('"[]"', "string_array", ()),
            ('"12"', "string", "12"),
            ("2.5", "double", 2.5),
            ("2", "double", 2.0),
            ("true", "boolean", True),
        ],
    )
    def test_are_of_their_type(self, load, value, kind, read):
        text = f"insert {COMPONENT} $p isa ComponentParameter, has parameter-key 'k', has parameter-value {value},"
        model = load(
            f"{text} has parameter-type '{kind}';"
            "(component: $c, parameter: $p) isa component-configuration, has name 'x';"
        )
        parameter = model.component_configurations[0].parameters[0]
        assert parameter.type is ParameterType(kind)
        assert parameter.value == read
        assert type(parameter.value) is type(read)

    @pytest.mark.parametrize(
        ("text", "kind"),
        [
            ("true", ParameterType.BOOLEAN),
            ("7", ParameterType.LONG),
            ("7.0", ParameterType.DOUBLE),
            ("[1, 2.5]", ParameterType.DOUBLE_ARRAY),
            ("[a, 1]", ParameterType.STRING_ARRAY),
            ("[", ParameterType.STRING),
            ("[]", ParameterType.STRING),
            ("nan", ParameterType.STRING),
            ("", ParameterType.STRING),
        ],
    )
    def test_without_a_type_are_what_they_look_like(self, text, kind):
        assert suggested_type(text) is kind

    def test_are_shared_by_configurations_of_several_components(self, load):
        model = load(
            f"""insert {COMPONENT} $d isa Component, has name 'tail';
            $p isa ComponentParameter, has key "speed", has value "2.0", has type "double";
            (component: $c, parameter: $p) isa component-configuration, has name "one";
            (component: $d, parameter: $p) isa component-configuration, has name "two";"""
        )
        assert [c.parameters[0].component for c in model.component_configurations] == ["rotor", "tail"]

    @pytest.mark.parametrize(
        ("value", "kind"), [("high", "double"), ("1.5", "long"), ("[1, x]", "long_array"), ("nan", "double")]
    )
    def test_that_do_not_fit_are_refused(self, refusal, value, kind):
        said = refusal(
            f"""insert {COMPONENT}
            $p isa ComponentParameter, has key "k", has value "{value}", has type "{kind}";
            (component: $c,
             parameter: $p) isa component-configuration, has name "x";"""
        )
        assert said.startswith(f"m0.tql:4: parameter 'k' is not a {kind.replace('_', ' ')}: '{value}'")

    @given(
        st.one_of(
            st.tuples(st.booleans(), st.just("boolean")),
            st.tuples(st.integers(-(10**17), 10**17), st.just("long")),
            st.tuples(st.floats(allow_nan=False, allow_infinity=False), st.just("double")),
            st.tuples(st.text(), st.just("string")),
            st.tuples(st.lists(st.text(), max_size=4).map(tuple), st.just("string_array")),
            st.tuples(st.lists(st.integers(-99, 99), max_size=4).map(tuple), st.just("long_array")),
        )
    )
    def test_written_and_read_again_are_the_same(self, parameter):
        value, kind = parameter
        assert parameter_value(parameter_text(value), ParameterType(kind)) == value


class TestRemarksAndRunTimeFacts:
    def test_remarks_are_kept_and_do_not_make_models_differ(self, load):
        bare = load(f"insert {ACTION}")
        found = load("insert $a isa Action, has action-name 'fly', has description 'up', has description 'and away';")
        assert found == bare
        assert [annotation.value for annotation in found.annotations] == ["up", "and away"]

    def test_how_a_measure_is_measured_is_kept_with_it(self, load):
        model = load(
            f"""insert {MEASURE}
            $qos isa QoSProfile, has reliability 'RELIABLE', has depth 10;
            (measure: $m, qos: $qos) isa topic-interface, has measurement-interface-name '/battery';"""
        )
        found = {annotation.attribute: annotation.value for annotation in model.annotations}
        assert found == {"measurement-interface-name": "/battery", "reliability": "RELIABLE", "depth": 10}

    def test_run_time_facts_are_a_situation_to_suppose(self, load):
        model = load(
            f"""insert {ACTION} {FUNCTION} {MEASURE}
            $c isa Component, has component-name 'rotor', has is-active true;
            $d isa Component, has component-name 'spare', has component-status 'failure', has is-active false;
            (action: $a, required-function: $f) isa functional-requirement;
            (function: $f, required-component: $c) isa function-design, has name 'one', has is-selected true;
            (function: $f, required-component: $d) isa function-design, has name 'two', has is-selected false;
            (measured-attribute: $m) isa measurement, has measurement-value 3, has latest false;
            (measured-attribute: $m) isa measurement, has measurement-value 4.5, has latest true,
                has measurement-time 2023-01-08T06:12:11.111;
            (action: $a) isa required-action, has start-time 2023-01-08T06:12:11;"""
        )
        kb = KnowledgeBase(model, clock=SimulationClock())
        assert not kb.is_component_active("rotor")
        kb.suppose(stated_situation(model))
        assert kb.is_component_active("rotor")
        assert kb.status("component", "spare") == "failure"
        assert kb.status("action", "fly") == "solved"
        assert kb.measurement("charge").value == 4.5

    def test_stated_statuses_change_nothing(self, load):
        model = load("insert $a isa Action, has action-name 'fly', has action-status 'unfeasible';")
        assert KnowledgeBase(model).status("action", "fly") == "feasible"
