"""Models written in TypeQL: what loads, what it means, and what is said of what does not."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import InputError, KnowledgeBase, KnowledgeModel, KnowledgeModelError, SimulationClock
from rosa_core.kb import stated_situation
from rosa_core.model.builder import ModelBuilder
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
from rosa_core.model.parameter_text import parameter_text, parameter_value, suggested_type
from rosa_core.model.typeql_format import read_typeql

DATA = Path(__file__).parents[2] / "data"
YAML = Path(__file__).parents[3] / "suave" / "models"
ACTION = '$a isa Action, has action-name "fly";'
FUNCTION = '$f isa Function, has function-name "lift";'
COMPONENT = '$c isa Component, has component-name "rotor";'
MEASURE = '$m isa QualityAttribute, has measure-name "charge";'


@pytest.fixture
def load(tmp_path):
    """Write texts to files, TypeQL unless a suffix is given, and load them together."""

    def load(*texts: str | tuple[str, str]) -> KnowledgeModel:
        paths = []
        for index, text in enumerate(texts):
            suffix, content = text if isinstance(text, tuple) else (".tql", text)
            path = tmp_path / f"m{index}{suffix}"
            path.write_text(content, encoding="utf-8")
            paths.append(path)
        return KnowledgeModel.load(*paths)

    return load


@pytest.fixture
def refusal(load):
    """What is said of a model that cannot be: one line for each problem, without the directory."""

    def refusal(*texts: str | tuple[str, str]) -> str:
        with pytest.raises(KnowledgeModelError) as error:
            load(*texts)
        lines = []
        for problem in error.value.problems:
            where = "" if problem.where is None else f"{Path(problem.where.file).name}:{problem.where.line}: "
            lines.append(f"{where}{problem.what} ({problem.mend})")
        return "\n".join(lines)

    return refusal


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
        told = model.constraints[0]
        assert (told.operator, told.value, told.measure) == (ConstraintOperator.LESS, 2.0, "q")

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
        told = load(f"insert {MEASURE} {ACTION} (constraint: $m, constrained: $a) isa constraint;").constraints[0]
        assert (told.operator, told.value) == (ConstraintOperator.GREATER_OR_EQUAL, None)

    def test_one_constraint_on_several_elements(self, load):
        model = load(
            f"insert {MEASURE} {ACTION} {COMPONENT}"
            "(constraint: $m, constrained: $a, constrained: $c) isa constraint, has attribute-value 0.5;"
        )
        assert [c.constrained.name for c in model.constraints] == ["fly", "rotor"]

    @pytest.mark.parametrize("spelled", ["has estimation-value 3, has estimation-type", "has value 3, has type"])
    def test_estimations(self, load, spelled):
        text = f"insert {MEASURE} {COMPONENT} (causer: $c, affected: $m) isa estimation, {spelled} 'absolute';"
        told = load(text).estimations[0]
        assert (told.causer.name, told.value, told.type) == ("rotor", 3.0, EstimationType.ABSOLUTE)

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
        told = load("insert $a isa Action, has action-name 'fly', has description 'up', has description 'and away';")
        assert told == bare
        assert [annotation.value for annotation in told.annotations] == ["up", "and away"]

    def test_how_a_measure_is_measured_is_kept_with_it(self, load):
        model = load(
            f"""insert {MEASURE}
            $qos isa QoSProfile, has reliability 'RELIABLE', has depth 10;
            (measure: $m, qos: $qos) isa topic-interface, has measurement-interface-name '/battery';"""
        )
        told = {annotation.attribute: annotation.value for annotation in model.annotations}
        assert told == {"measurement-interface-name": "/battery", "reliability": "RELIABLE", "depth": 10}

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


class TestRefusals:
    @pytest.mark.parametrize(
        ("text", "said"),
        [
            (
                "insert\n$a isa Action, has action-nme 'fly';",
                "m0.tql:2: unknown attribute 'action-nme' (did you mean 'action-name'?)",
            ),
            ("insert\n$a isa Acton, has action-name 'fly';", "m0.tql:2: unknown type 'Acton' (did you mean 'Action'?)"),
            (
                "insert $a isa action-name;",
                "m0.tql:1: unknown type 'action-name' (it is an attribute: $x has action-name ...)",
            ),
            (
                f"insert {ACTION} {FUNCTION}\n(action: $a, required-functon: $f) isa functional-requirement;",
                "m0.tql:2: a functional-requirement has no role 'required-functon' (did you mean 'required-function'?)",
            ),
            (
                f"insert {ACTION}\n(action: $a, required-function: $lift) isa functional-requirement;",
                "m0.tql:2: $lift is not known here (insert it or match it)",
            ),
            (
                f"insert {ACTION} $lift isa Function, has name 'lift';\n"
                "(action: $a, required-function: $lfit) isa functional-requirement;",
                "m0.tql:2: $lfit is not known here (did you mean 'lift'?)",
            ),
            (f"insert {ACTION}\n$b has action-name 'x';", "m0.tql:2: $b has no type, here or in a match (add isa)"),
            (
                f"insert {ACTION}\n{ACTION}",
                "m0.tql:2: what $a is stands twice; it is already in line 1 (use two variables for two things)",
            ),
            (
                f"insert {ACTION}\n$b isa Action, has action-name 'fly';",
                "m0.tql:2: action 'fly' is there already, at ",
            ),
            (
                f"insert {MEASURE} {FUNCTION}\n(constraint: $m,\nconstrained: $f) isa constraint;",
                "m0.tql:3: $f is a Function, which cannot be the constrained of a constraint "
                "(that is for: Action, Component, function-design, component-configuration)",
            ),
            ("insert $a isa Action;", "m0.tql:1: an Action has no action-name (add: has action-name ...)"),
            (
                "insert $f isa Function, has function-name 'f', has package 'p';",
                "m0.tql:1: a Function has no attribute 'package' (it has:",
            ),
            (
                "insert $f isa Component, has component-name 'f', has package 'p';",
                "m0.tql:1: a Component has no attribute 'package' (a ROSNode has it)",
            ),
            (
                "insert $f isa Function, has function-name 3;",
                "m0.tql:1: 'function-name' is text, not 3 (write it in quotes)",
            ),
            (
                "insert $f isa Function, has function-name 'f', has always-improve 'true';",
                "m0.tql:1: 'always-improve' is true or false, not 'true' (write it without quotes)",
            ),
            (
                f"insert {MEASURE} {ACTION} (constraint: $m, constrained: $a) isa constraint, has operator '=>';",
                "m0.tql:1: 'operator' cannot be '=>' (did you mean '>'?)",
            ),
            (
                f"insert {MEASURE} {ACTION} (constraint: $m, constrained: $a) isa constraint, has value 1e999;",
                "m0.tql:1: '1e999' is too large a number (give a finite number)",
            ),
            (
                f"insert {FUNCTION}\n(function: $f) isa function-design, has name 'd';",
                "m0.tql:2: a function-design has no required-component (add (required-component: $...))",
            ),
            (
                f"insert {FUNCTION} {COMPONENT} "
                "(function: $f, function: $f, required-component: $c) isa function-design, has name 'd';",
                "m0.tql:1: a function-design has one function (state a relation for each)",
            ),
            (
                f"insert {FUNCTION} {COMPONENT} "
                "(function: $f, required-component: $c, required-component: $c) isa function-design, has name 'd';",
                "m0.tql:1: function design 'd' lists component 'rotor' twice",
            ),
            (f"insert {ACTION} $a (action: $a);", "m0.tql:1: an Action is not a relation, so it has no players"),
            (
                f"insert {ACTION} (action: $a);",
                "m0.tql:1: a relation without a type (add isa, such as: isa functional-requirement)",
            ),
            (
                "insert $r isa reconfiguration-plan, has start-time 3;",
                "m0.tql:1: a reconfiguration-plan is made at run time",
            ),
            ("insert $r isa thing;", "m0.tql:1: nothing can be just a thing"),
            ("insert $x isa Action, has $n;", "m0.tql:1: $n has no value here"),
            ("insert $x isa $t;", "m0.tql:1: the type of what is inserted must be named"),
            ("insert $x isa Action, has name 'a'; $x isa Function;", "m0.tql:1: what $x is stands twice"),
            ("insert $x isa Action, has name 'a', has name 'b';", "m0.tql:1: 'name' is 'b' here and 'a' in line 1"),
            ("insert $x isa Action, has name 'a'; $x > 3;", "m0.tql:1: an insert compares nothing"),
            (
                "insert $x isa Action, has name 'a', has note 2023-13-01;",
                "m0.tql:1: '2023-13-01' is not a date (write it as 2024-05-31T12:00:00)",
            ),
            ("insert\n$x isa Action has name 'a';", "m0.tql:2: 'has' cannot stand here (expected "),
            (
                "insert\n$x isa Action, has name 'a;\n",
                "m0.tql:2: the text that begins here does not end (close it with ')",
            ),
            ("insert $x isa Action, has name 'a'; %", "m0.tql:1: '%' cannot stand here"),
            ("insert\n\n$x isa", "m0.tql:3: it ends in the middle of a statement"),
            ("insert", "m0.tql:1: it ends in the middle of a statement"),
            ("match $a isa Action;", "m0.tql:1: it ends in the middle of a statement"),
            ("# nothing\n", "m0.tql:None: the file is empty (it needs at least an 'insert')"),
            (
                "match $a isa Action; fetch $a;",
                "m0.tql:1: this is a query, not a model (ask it with 'rosa query FILE... QUERY')",
            ),
            ("match $a isa Action; delete $a isa Action;", "m0.tql:1: a model file only inserts"),
            (
                "# ROSA\ndefine\naction-name sub attribute, value string;",
                "m0.tql:2: this is a schema, not a model (leave it out: the schema of ROSA is built in)",
            ),
        ],
    )
    def test_say_what_is_wrong_where_and_how_to_mend_it(self, refusal, text, said):
        assert said in refusal(text)

    @pytest.mark.parametrize(
        ("match", "said"),
        [
            ("$a isa Action, has action-name 'flyy';", "there is no action 'flyy' to match (did you mean 'fly'?)"),
            ("$a isa Action, has name 'swim';", "there is no action 'swim' to match (insert it in an earlier"),
            ("$a isa Action; not { $a has name 'fly'; };", "nothing that was inserted before matches all of this"),
            ("$a isa Acton;", "unknown type 'Acton' (did you mean 'Action'?)"),
            ("$a isa Action, has acton-name 'fly';", "unknown attribute 'acton-name' (did you mean 'action-name'?)"),
        ],
    )
    def test_of_a_match_too(self, refusal, match, said):
        problem = refusal(f"insert {ACTION}", f"match\n{match}\ninsert $f isa Function, has name 'f';")
        assert problem.startswith("m1.tql:")
        assert said in problem

    @pytest.mark.parametrize(
        ("insert", "said"),
        [
            ("$a isa Action;", "$a is matched, so it has its type"),
            ("$a has action-name 'swim';", "'action-name' cannot be added to an Action that is there"),
            ("$a (action: $a);", "$a is matched; a relation that is there gets no more players"),
            ("$n has description 'x';", "$n is not a thing"),
            ("$f isa Function, has function-name $m;", "$m has no value here"),
        ],
    )
    def test_of_what_is_matched(self, refusal, insert, said):
        assert said in refusal(f"insert {ACTION}", f"match $a isa Action, has name $n; insert {insert}")

    def test_the_same_file_twice(self, refusal):
        assert "action 'fly' is there already" in refusal(f"insert {ACTION}", f"insert {ACTION}")

    def test_several_problems_are_told_at_once(self, refusal):
        said = refusal("insert\n$a isa Action;\n$f isa Functon;\n$c isa Component, has component-name 'c', has x 1;")
        assert [line.split(":")[1] for line in said.splitlines()] == ["2", "3", "4"]

    def test_what_fits_nothing_is_told_once_for_all_solutions(self, refusal):
        text = "insert $a isa Action, has name 'a'; $b isa Action, has name 'b';"
        said = refusal(text, "match $x isa Action; insert $f isa Functon, has name 'f';")
        assert said.count("unknown type") == 1

    def test_a_contradiction_with_another_file_names_both(self, refusal):
        said = refusal(
            (".yaml", "functions: {lift: {always_improve: false}}"),
            "match $f isa Function; insert $f has always-improve true;",
        )
        assert "always_improve of function 'lift' is True here and False at " in said

    def test_what_the_whole_model_shows_has_its_line(self, refusal):
        said = refusal(
            f"insert {MEASURE} {ACTION}\n(constraint: $m, constrained: $a) isa constraint, has value 1;\n"
            "(constraint: $m, constrained: $a) isa constraint, has value 1;"
        )
        assert said.startswith("m0.tql:3: a constraint on action 'fly' stands twice")

    def test_a_file_that_is_not_there(self):
        with pytest.raises(KnowledgeModelError, match=r"nowhere\.tql: cannot read it: No such file"):
            KnowledgeModel.load("nowhere.tql")

    @pytest.mark.parametrize("name", ["m.tql", "m.yaml"])
    def test_a_file_that_is_not_utf_8(self, tmp_path, name):
        path = tmp_path / name
        path.write_bytes("insert $a isa Action, has name 'é';".encode("latin-1"))
        with pytest.raises(KnowledgeModelError, match=r"it is not UTF-8 text \(save it as UTF-8\)"):
            KnowledgeModel.load(path)

    def test_a_path_that_cannot_be(self):
        with pytest.raises(KnowledgeModelError, match="cannot read it"):
            KnowledgeModel.load("a\0.tql")


_PIECES = [
    "insert",
    "match",
    "define",
    "fetch",
    "get",
    "not",
    "or",
    "isa",
    "isa!",
    "has",
    "like",
    "is",
    "sort",
    "limit",
    "$a",
    "$b",
    "$_",
    "$a-b",
    "$1",
    "?v",
    "(",
    ")",
    "{",
    "}",
    ",",
    ";",
    ":",
    "=",
    ">=",
    "<",
    "#",
    "\n",
    '"x"',
    "'y'",
    '"',
    "1",
    "-2.5",
    "1e400",
    "9" * 5000,
    "true",
    "2023-01-01",
    "2023-99-99T99:99:99",
    "Action",
    "Function",
    "Component",
    "constraint",
    "function-design",
    "action",
    "action-name",
    "name",
    "value",
    "function-name",
    "attribute",
    "thing",
    "functional-requirement",
    "required-function",
    "component-configuration",
    "ComponentParameter",
    "parameter-value",
    "measurement",
    "description",
    "time",
    "\x00",
    "\ufeff",
    "é",
    "insert $a isa Action, has name 'x';",
]


def read(path: Path, text: str) -> None:
    """Read one file into a model; errors are fine as long as they are the ones for people."""
    path.write_text(text, encoding="utf-8", errors="surrogatepass" if text.isascii() else "replace", newline="")
    builder = ModelBuilder()
    try:
        read_typeql(str(path), builder)
        builder.build()
    except InputError as error:
        said = str(error)
    else:
        return
    assert said


class TestAnything:
    """Whatever a file holds, it is a model or an error that says why."""

    @settings(max_examples=300, deadline=None)
    @given(st.lists(st.sampled_from(_PIECES), max_size=25).map(" ".join))
    def test_made_of_the_words_of_the_language(self, tmp_path_factory, text):
        read(tmp_path_factory.getbasetemp() / "words.tql", text)

    @settings(max_examples=150, deadline=None)
    @given(st.data())
    def test_a_good_file_with_something_wrong_in_it(self, tmp_path_factory, data):
        tokens = (DATA / "suave_extended.tql").read_text(encoding="utf-8").split(" ")
        for _ in range(data.draw(st.integers(1, 4))):
            at = data.draw(st.integers(0, len(tokens) - 1))
            tokens[at] = data.draw(st.sampled_from([*_PIECES, "", tokens[at][::-1], tokens[at] * 2]))
        read(tmp_path_factory.getbasetemp() / "mutated.tql", " ".join(tokens))

    @settings(max_examples=150, deadline=None)
    @given(st.text(st.characters(exclude_categories=["Cs"]), max_size=60))
    def test_any_text(self, tmp_path_factory, text):
        read(tmp_path_factory.getbasetemp() / "text.tql", text)

    @settings(max_examples=50, deadline=None)
    @given(st.binary(max_size=60))
    def test_any_bytes(self, tmp_path_factory, content):
        path = tmp_path_factory.getbasetemp() / "bytes.tql"
        path.write_bytes(content)
        with pytest.raises(KnowledgeModelError):
            KnowledgeModel.load(path)

    @pytest.mark.parametrize(
        "text",
        [
            "match " + "not { " * 20_000 + "$a isa Action;" + " };" * 20_000 + " insert $b isa Action;",
            "match " + "{ " * 20_000 + "$a isa Action;" + " };" * 20_000 + " insert $b isa Action;",
            "insert " + "(" * 20_000,
            "insert $a isa Action, has note '" + "\\" * 20_000,
            "match " + "$a isa Action;" * 1500 + " insert $b isa Action, has name 'x';",
            "match $a isa thing; $b isa thing; $c isa thing; $d isa thing; $e isa thing;"
            "insert $f isa Function, has name 'f';",
        ],
    )
    def test_deep_and_large(self, tmp_path, text):
        large = tmp_path / "large.tql"
        large.write_text("insert " + " ".join(f"$a{i} isa Action, has name 'a{i}';" for i in range(30)))
        path = tmp_path / "deep.tql"
        path.write_text(text)
        with pytest.raises(KnowledgeModelError):
            KnowledgeModel.load(large, path)


def test_yaml_models_do_not_pay_for_the_parser_generator():
    code = (
        "import sys; from rosa_core import KnowledgeModel, KnowledgeBase; import rosa_cli.main;"
        f"KnowledgeBase(KnowledgeModel.load({str(YAML / 'suave.yaml')!r})); assert 'lark' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
