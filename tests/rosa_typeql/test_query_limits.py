"""What queries are refused, how their work is bounded, and what the documentation says of them."""

from __future__ import annotations

import json
import re
import threading
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeBase, KnowledgeModel, QueryError, RosaError, SimulationClock
from rosa_core.model.elements import Action, Component
from rosa_typeql.matching.like import RegularExpression, RegularExpressionError
from rosa_typeql.queries.query import PreparedQuery

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests" / "data"
MODEL = KnowledgeModel.load(DATA / "suave.tql", DATA / "suave_extended.tql")


@pytest.fixture
def clock() -> SimulationClock:
    return SimulationClock()


@pytest.fixture
def kb(clock) -> KnowledgeBase:
    return KnowledgeBase(MODEL, clock=clock)


def refusal(kb: KnowledgeBase, text: str) -> str:
    with pytest.raises(QueryError) as error:
        kb.query(text)
    return str(error.value)


class TestRefusals:
    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("", "query: the query is empty"),
            ("match\n$a isa Acton; fetch $a;", "query:2: unknown type 'Acton' (did you mean 'Action'?)"),
            ("match $a isa Action, has nmae $n; fetch $n;", "unknown attribute 'nmae' (did you mean 'name'?)"),
            (
                "match $a isa Action, has priority $n; fetch $n;",
                "an Action has no attribute 'priority' (it has: action-name",
            ),
            (
                "match (acton: $a) isa functional-requirement; fetch $a;",
                "a functional-requirement has no role 'acton' (did you mean 'action'?)",
            ),
            ("match $a isa Action; not {(acton: $a);}; fetch $a;", "no relation has the role 'acton'"),
            ("match (acton: $a); fetch $a;", "no relation has the role 'acton' (did you mean 'action'?)"),
            ("match ($a) isa Action; fetch $a;", "an Action is not a relation, so it has no players"),
            (
                "match (constrained: $f) isa constraint; $f isa Function; get $f;",
                "$f cannot play the role 'constrained': it is a Function",
            ),
            ("match $a isa Action; $a isa Function; get $a;", "$a cannot be a Function: it is an Action"),
            ("match $a isa Action; $a > 3; get $a;", "$a is an attribute here and a thing elsewhere"),
            ("match $a isa Action, has is-required 1; get $a;", "'is-required' is true or false, and 1 is not"),
            ("match $a isa Action; get $b;", "$b has no value in every row"),
            ("match $a isa Action; not {$a has name $n;}; get $n;", "$n has no value in every row"),
            ("match $a isa Action; $n > 3; get $a;", "nothing gives $n a value"),
            ("match $a isa Action; not {$n > 3;}; get $a;", "nothing gives $n a value"),
            ("match $a isa Action; $a is $b; get $a;", "nothing gives $b a value"),
            ("match $a; get $a;", "nothing is said of $a (say what it is, such as: $a isa Action)"),
            ("match $a isa Action; get $a; sort $a;", "$a is not an attribute to sort by"),
            ("match $a isa Action, has name $n; get $n; sum $n;", "sum is of numbers, and $n is 'search_pipeline'"),
            ("match $a isa Action; fetch $a: nmae;", "unknown attribute 'nmae'"),
            ("match $a isa Action, has name $n; fetch $n: name;", "$n has no attributes"),
            ("match $a isa Action, has name $n; fetch $a: name; $n as a;", "'a' stands twice in a row"),
            ("match $a isa Action; get $a; limit 2.5;", "'2.5' is not a number of rows"),
            ("match $a isa Action; get $a; limit 1; limit 2;", "'limit' stands twice"),
            ("match $a has name like '(a'; get $a;", "the regular expression '(a' cannot be used: a '(' is not closed"),
            (
                "match $a isa Action;\n$a has name like '(.)\\1'; get $a;",
                "query:2: the regular expression '(.)\\\\1' cannot be used: '\\1' is not supported: no back-references",
            ),
            (
                "match $a has name like 'a(?=b)'; get $a;",
                "look-around is not supported (use several statements",
            ),
            ("match $a isa Action; insert $b isa Action;", "a query only reads"),
            ("match $a isa Action; delete $a isa Action;", "a query only reads"),
            ("insert $a isa Action;", "a query only reads"),
            ("define x sub entity;", "a query only reads"),
            ("match $a isa Action; get $a; group $a;", "'group' is not supported"),
            ("match $a isa Action; ?x = 3; get $a;", "value variables ('?x') are not supported"),
            ("fetch $a;", "'fetch' cannot stand here (expected 'match')"),
            ("match $a isa Action, has name 'x; get $a;", "the text that begins here does not end"),
            ("match " + "not {" * 40 + "$a isa Action;" + "};" * 40 + "get $a;", "blocks nest more than 30 deep"),
            ("match " + "$a isa Action;" * 1001 + "get $a;", "a match of 1001 statements is too large"),
            ("x" * 100_001, "a query is a text of at most 100000 characters"),
        ],
    )
    def test_say_what_is_wrong_where_and_how_to_fix_it(self, kb, text, said):
        assert said in refusal(kb, text)

    def test_are_errors_of_input_and_of_the_knowledge_base(self, kb):
        with pytest.raises(RosaError):
            kb.query(3)  # type: ignore[arg-type]

    def test_nothing_was_written(self, kb):
        for text in ("insert $a isa Action;", "match $a isa Action; delete $a isa Action;"):
            refusal(kb, text)
        assert kb.revision == 0


class TestBounds:
    def test_parts_that_multiply_end_with_an_error(self, kb):
        text = f"match {' '.join(f'$x{i} isa thing;' for i in range(9))} get;"
        assert "was given up after 1000000 steps (say more" in refusal(kb, text)

    def test_the_bound_counts_what_negations_and_players_try(self, kb):
        prepared = PreparedQuery(
            "match $c isa Component; not {$x isa Component; $y isa Component; $n isa measure-name; $n = 'no';};",
            steps=150,
        )
        with pytest.raises(QueryError, match="given up after 150 steps"):
            prepared.rows(prepared.snapshot(kb._state, kb._history))

    def test_a_query_over_many_elements_is_within_it(self):
        model = KnowledgeModel(
            actions=tuple(Action(f"a{i}") for i in range(5_000)),
            components=tuple(Component(f"c{i}") for i in range(50_000)),
        )
        kb = KnowledgeBase(model, clock=SimulationClock())
        assert kb.query("match $c isa Component, has name 'c49999', has status $s; get $s;") == [{"s": "feasible"}]
        assert kb.query("match $c isa Component, has status 'feasible'; get $c; count;") == [{"count": 50_000}]

    @pytest.mark.parametrize("pattern", ["(a+)+b", "(a|a)*b", "(a*)*(a*)*b", "a{1,50}a{1,50}b", "(.*)*x"])
    def test_no_regular_expression_takes_long(self, pattern):
        # Linear in the text: an engine that tries one alternative after the other would not come back.
        expression = RegularExpression(pattern)
        assert not expression.matches("a" * 3_000)
        assert expression.steps("a" * 6_000) <= 2 * expression.steps("a" * 3_000)

    def test_matching_counts_by_the_length_of_the_text(self, tmp_path):
        path = tmp_path / "long.yaml"
        path.write_text(f"actions:\n  ? {'a' * 900}\n  :\n", encoding="utf-8")
        kb = KnowledgeBase(KnowledgeModel.load(path), clock=SimulationClock())
        text = "match $a isa Action, has name $n; $n like '(a{1,300}){1,3}'; get $n; count;"
        assert kb.query(text) == [{"count": 1}]
        prepared = PreparedQuery(text, steps=50)
        with pytest.raises(QueryError, match="given up after 50 steps"):
            prepared.rows(prepared.snapshot(kb._state, kb._history))

    def test_a_query_is_of_one_moment(self, kb):
        """While another thread writes two measures together, a query sees both or neither."""
        done = threading.Event()

        def write() -> None:
            for i in range(300):
                with kb.transaction():
                    kb.add_measurement("battery_level", float(i))
                    kb.add_measurement("water_visibility", float(i))
            done.set()

        writer = threading.Thread(target=write)
        writer.start()
        while not done.is_set():
            rows = kb.query("match $m isa measurement, has latest true, has value $v; get $m, $v;")
            assert len({row["v"] for row in rows}) <= 1
        writer.join()


_REGULAR = st.recursive(
    st.sampled_from(["a", "b", "c", ".", "[ab]", "[^a]", "\\w", ""]),
    lambda inner: st.one_of(
        st.tuples(inner, inner).map("".join),
        st.tuples(inner, inner).map(lambda pair: f"({pair[0]}|{pair[1]})"),
        st.tuples(inner, st.sampled_from("*+?")).map(lambda pair: f"({pair[0]}){pair[1]}"),
        st.tuples(inner, st.sampled_from(["{2}", "{0,2}", "{1,}", "{0}"])).map(lambda pair: f"(?:{pair[0]}){pair[1]}"),
    ),
    max_leaves=6,
)


class TestRegularExpressions:
    @settings(max_examples=400, deadline=None)
    @given(_REGULAR, st.text("abc", max_size=6))
    def test_match_what_pythons_own_match(self, pattern, text):
        assert RegularExpression(pattern).matches(text) == (re.fullmatch(pattern, text) is not None)

    @settings(max_examples=300, deadline=None)
    @given(st.text("ab()[]{}|*+?\\^$-,12d:&<=QEpC", max_size=12) | st.text(max_size=6), st.text(max_size=4))
    def test_any_text_is_one_or_is_refused(self, pattern, text):
        try:
            expression = RegularExpression(pattern)
        except RegularExpressionError:
            return
        assert expression.matches(text) in (True, False)

    @pytest.mark.parametrize(
        ("pattern", "text"),
        [
            ("^a$", "a"),
            ("\\d+\\.\\d", "12.5"),
            ("\\$\\^", "$^"),
            ("[\\]-]+", "-]"),
            ("a\\{", "a{"),
            ("[({]&", "{&"),
            ("[a-c]x*?", "bxx"),
            ("\\S\\W\\D", "a-b"),
            ("a{2}b{1,}", "aabb"),
            ("(?i)battery", "BATTERY"),
            ("(?s).*", "a\nb"),
            ("\\Q(a\\E.", "(ab"),
            ("\\p{Lu}\\x{e9}\\x41", "ÉéA"),
            ("(?<part>a|b)+", "ab"),
            ("\\bfly\\b", "fly"),
            (".", "\U0001f916"),
        ],
    )
    def test_spellings(self, pattern, text):
        assert RegularExpression(pattern).matches(text)

    @pytest.mark.parametrize(
        ("pattern", "text"),
        [("fly", "fly high"), ("a", "A"), ("\\d", "\u0663"), ("\\w", "é"), (".", "\n"), ("a", "a\n")],
    )
    def test_as_in_java_the_whole_text_is_matched_and_classes_are_ascii(self, pattern, text):
        assert not RegularExpression(pattern).matches(text)

    @pytest.mark.parametrize(
        ("pattern", "said"),
        [
            ("(a", "a '(' is not closed"),
            ("a)", "a ')' has no '('"),
            ("[a", "a '[' is not closed"),
            ("a\\", "it ends with a"),
            ("*a", "there is nothing to repeat before '*'"),
            ("a**", "a repetition is repeated (put the inner one in a group)"),
            ("a{2,1}", "wrong way round: '{2,1}'"),
            ("a{5000}", "a repetition is too large"),
            ("[z-a]", "no such range or class of characters: 'z-a'"),
            ("\\p{javaLowerCase}", "no such range or class of characters"),
            ("(a)\\1", "no back-references, no octal numbers"),
            ("\\0101", "no back-references, no octal numbers"),
            ("(?<n>a)\\k<n>", "not supported: '\\k'"),
            ("(?!a)b", "look-around is not supported"),
            ("(?<=a)b", "look-around is not supported"),
            ("(?>a)b", "atomic groups and possessive repetitions"),
            ("a++", "atomic groups and possessive repetitions"),
            ("a{2}+", "atomic groups and possessive repetitions"),
            ("[a-z&&[^b]]", "intersections of classes"),
            ("[a[bc]]", "a class within a class is not supported (write \\[ for the character"),
            ("[[:alpha:]]", "a class within a class"),
            ("a{", "'{' begins no repetition here"),
            ("a{,3}", "'{' begins no repetition here"),
            ("\\h", "not supported: '\\h'"),
            ("\\v", "'\\v' is not supported"),
            ("(\\pL{300}){3}", "it is too large"),
            ("a" * 1001, "it has more than 1000 characters"),
            ("\ud800", "half of a surrogate pair"),
        ],
    )
    def test_what_java_has_and_re2_has_not_is_refused_in_words(self, pattern, said):
        with pytest.raises(RegularExpressionError) as error:
            RegularExpression(pattern)
        assert said in str(error.value)


_WORDS = [
    "match", "fetch", "get", "not {", "{", "}", "};", "or", "isa", "isa!", "has", "like", "is", "contains", "sort",
    "limit", "offset", "count", "sum", "as", "$a", "$b", "$c", "(", ")", ",", ";", ":", "=", "!=", "<", ">=", '"x"',
    "'recharge'", "1", "2.5", "true", "2023-01-01", "Action", "Component", "thing", "name", "status", "attribute",
    "action-name", "constraint", "constrained", "measurement", "latest", "match $a isa Action, has name $b;", "get $a;",
]  # fmt: skip


class TestAnything:
    @settings(max_examples=400, deadline=None)
    @given(st.lists(st.sampled_from(_WORDS), max_size=20).map(" ".join))
    def test_made_of_the_words_of_the_language_is_answered_or_refused(self, text):
        kb = KnowledgeBase(MODEL, clock=SimulationClock())
        try:
            rows = kb.query(f"match $a isa Action; {text}")
        except QueryError as error:
            said = str(error)
        else:
            said = json.dumps(rows)
        assert said

    @settings(max_examples=100, deadline=None)
    @given(st.text(max_size=50))
    def test_any_text(self, text):
        kb = KnowledgeBase(MODEL, clock=SimulationClock())
        with pytest.raises(QueryError):
            kb.query(text)


class TestTheDocumentation:
    TEXT = (ROOT / "docs" / "typeql.md").read_text(encoding="utf-8")
    EXAMPLES = re.findall(r"```typeql\n(.*?)```\n```json\n(.*?)```", TEXT, re.DOTALL)

    @pytest.mark.parametrize(("text", "rows"), EXAMPLES)
    def test_queries_give_what_it_says(self, kb, text, rows):
        kb.add_measurement("battery_level", 0.2)
        kb.add_measurement("water_visibility", 2.0)
        assert kb.query(text) == json.loads(rows)

    def test_every_query_has_its_answer(self):
        assert len(self.EXAMPLES) == self.TEXT.count("```typeql\n") >= 5

    def test_the_model_loads(self, tmp_path):
        path = tmp_path / "drone.tql"
        path.write_text(re.findall(r"```typeql-model\n(.*?)```", self.TEXT, re.DOTALL)[0], encoding="utf-8")
        model = KnowledgeModel.load(path)
        assert [c.name for c in model.component_configurations] == ["slow", "fast"]
