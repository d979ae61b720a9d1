"""What TypeQL models are refused, and that nothing at all is a traceback."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import InputError, KnowledgeModel, KnowledgeModelError
from rosa_core.formats.builder import ModelBuilder
from rosa_typeql.models.reader import read_typeql

DATA = Path(__file__).parents[1] / "data"
YAML = Path(__file__).parents[2] / "suave" / "models"
ACTION = '$a isa Action, has action-name "fly";'
FUNCTION = '$f isa Function, has function-name "lift";'
COMPONENT = '$c isa Component, has component-name "rotor";'
MEASURE = '$m isa QualityAttribute, has measure-name "charge";'


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
    def test_say_what_is_wrong_where_and_how_to_fix_it(self, refusal, text, said):
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

    def test_several_problems_are_reported_at_once(self, refusal):
        said = refusal("insert\n$a isa Action;\n$f isa Functon;\n$c isa Component, has component-name 'c', has x 1;")
        assert [line.split(":")[1] for line in said.splitlines()] == ["2", "3", "4"]

    def test_what_fits_nothing_is_reported_once_for_all_solutions(self, refusal):
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
