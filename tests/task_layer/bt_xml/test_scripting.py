"""The scripting language, alone and against BehaviorTree.CPP."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from task_layer.bt import Blackboard
from task_layer.bt.scripting import BoundCondition, BoundScript, Scope, ScriptError, compile_script
from task_layer.bt.scripting.scope import MAX_TEXT
from tests.task_layer.bt_xml.btcpp import mission, script, with_btcpp, with_loader


def run(text: str, **enums: float) -> dict[str, object]:
    blackboard = Blackboard()
    compile_script(text).run(Scope(blackboard, enums))
    return {key: blackboard.get(key) for key in blackboard.names()}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3),
        ("0x1F", 31),
        ("1.5e3", 1500.0),
        ("+3", 3),
        ("-3", -3.0),
        ("true", 1),
        ("'a'", "a"),
        ('"a"', "a"),
        ("1 + 2 * 3 - 4 / 8", 6.5),
        ("2 * -3", -6.0),
        ("--3", 3.0),
        ("1 - 2 - 3", -4.0),
        ("8 / 4 / 2", 1.0),
        ("(1 + 2) & 3", 3.0),
        ("1 | 2 ^ 3 & 1", 2.0),
        ("~5", -6.0),
        ("!0", 1.0),
        ("!!3", 1.0),
        ("1 < 2 < 3", 1.0),
        ("3 > 2 > 2", 0.0),
        ("1 == 1.00000001", 1.0),
        ("1 || 0 && 0", 0.0),  # && does not bind tighter than ||
        ("'ab' < 'b'", 1.0),
        ("'3' == 3", 1.0),
        ("'true' == 1", 1.0),
        ("'a' .. 3 .. 'b'", "a3b"),
        ("'a' .. 1.5", "a1.500000"),
        ("'a' + 'b'", "ab"),
        ("1 ? 'yes' : 'no'", "yes"),
        ("0 ? 1 : 2", 2),
        ("1 < 2 ? (0 ? 1 : 5) : 3", 5),
        ("1 / 0", math.inf),
        ("-1 / 0", -math.inf),
        ("RED + 1", 3.0),
        ("'RED' == 2", 1.0),
    ],
)
def test_an_expression_comes_to_its_value(text: str, value: object) -> None:
    result = run(f"x := {text}", RED=2)["x"]
    assert (result, type(result)) == (value, type(value))


def test_several_statements_are_done_in_turn() -> None:
    assert run("a := 1; b := a + 1; a += b; b *= 5; b -= 1; b /= 2") == {"a": 3, "b": 4.5}


def test_an_assignment_is_a_value() -> None:
    assert run("a := (b := 3)") == {"a": 3, "b": 3}


def test_an_entry_stays_what_it_is() -> None:
    assert run("x := 1; x = 4.0; y := 1.5; y = 2; z := 'a'; z += 'b'") == {"x": 4, "y": 2.0, "z": "ab"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 3", "there is no entry 'x' on the blackboard \\(':=' would make one\\)"),
        ("x := y", "there is no entry 'y' on the blackboard"),
        ("x := 1; x = 2.5", "2.5 is not a whole number"),
        ("x := 1; x = 'a'", "'a' is not a number"),
        ("x := 'a'; x = 1", "'x' holds a text and cannot hold a number"),
        ("x := 'a'; x += 1", "a text and a number do not mix"),
        ("x := 'a'; x -= 'b'", "'-=' cannot be applied to texts"),
        ("x := 'a' + 1", "'\\+' cannot be applied to a text and a number"),
        ("x := 3 .. 4", "'..' needs a text"),
        ("x := 2 && 1", "2 is neither true nor false"),
        ("x := 5.5 & 3", "5.5 is not a whole number"),
        ("x := !'a'", "'!' cannot be applied to a text"),
        ("x := 9007199254740993 + 0", "too large to be a floating point number"),
        ("x := ~1e30", "'~' cannot be applied to"),
        ("x := x", "there is no entry 'x'"),
    ],
)
def test_what_cannot_be_done_says_why(text: str, message: str) -> None:
    with pytest.raises(ScriptError, match=message):
        run(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x :=", "ends in the middle of a statement"),
        ("x := 1;", "ends in the middle of a statement"),
        ("x := 1;; y := 2", "column 8: ';' cannot stand here"),
        ("x := (1", "ends in the middle of a statement; expected .*'\\)'"),
        ("x := 'a", "column 6: the text that begins here does not end"),
        ("x := 3a", "column 6: this is not a number"),
        ("x := 5 % 3", "column 8: '%' cannot stand here"),
        ("x := 1 + 2 & 3", "column 12: arithmetic and bit and '!' operators are mixed \\(set parentheses\\)"),
        ("x := 'a' .. 1 + 2", "column 15: text and arithmetic operators are mixed"),
        ("x := !1 + 2", "operators are mixed"),
        ("x := y := 3", "column 8: ':=' cannot stand here"),
        ("x := 1 ? 2 : 0 ? 4 : 5", "cannot stand here"),
        ("3 := 4", "column 3: ':=' cannot stand here"),
        ("x := +y", "column 6: a '\\+' in front of something that is not a number"),
        ("x := 99999999999999999999", "too large a number"),
        ("x := 1e999", "too large a number"),
        ("x := 1;\ny := {z}", "line 2, column 6"),
        ("__import__('os')", "column 11: '\\(' cannot stand here"),
    ],
)
def test_what_cannot_be_read_says_where(text: str, message: str) -> None:
    with pytest.raises(ScriptError, match=message):
        compile_script(text)


def test_nesting_is_bounded() -> None:
    assert run("x := " + "(" * 30 + "1" + ")" * 30) == {"x": 1}
    for text in ("x := " + "(" * 31 + "1" + ")" * 31, "1?" * 4000 + "1", "x := " + "(" * 9000):
        with pytest.raises(ScriptError, match="nest more than 30 deep"):
            compile_script(text)
    with pytest.raises(ScriptError, match="20001 characters"):
        compile_script(" " * 20_001)


def test_long_chains_do_not_recurse() -> None:
    assert run("x := " + "+".join(["1"] * 4000)) == {"x": 4000.0}
    assert run("x := " + "-" * 4000 + "1") == {"x": 1.0}


def test_a_condition_must_be_true_or_false() -> None:
    scope = Scope(Blackboard())
    assert BoundCondition(compile_script("2 > 1"), scope)() is True
    assert BoundCondition(compile_script("0"), scope)() is False
    with pytest.raises(ScriptError, match="the condition '3' is no condition"):
        BoundCondition(compile_script("3"), scope)()


def test_a_script_keeps_its_text() -> None:
    bound = BoundScript(compile_script("x := 1"), Scope(Blackboard()))
    assert bound() == 1
    assert bound.text == "x := 1"


_ATOMS = st.one_of(
    st.integers(0, 300).map(str),
    st.sampled_from(["0x1f", "1.5", "2.0", "0.25", "1e2", "true", "false", "i", "d", "s", "t", "nope"]),
    st.sampled_from(["''", "'a'", "'ab'", "'b'", "'3'", "'1.5'", "'true'", "'x y'"]),
)
_BINARY = st.sampled_from(["..", "&", "|", "^", "&&", "||", "==", "!=", "<", ">", "<=", ">="])
_ARITHMETIC = st.sampled_from(["+", "-", "*", "/"])


def _larger(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(inner, _BINARY, inner).map(" ".join),
        # In parentheses: BehaviorTree.CPP before 4.9 took 1 - 2 + 3 for 1 - (2 + 3).
        st.tuples(inner, _ARITHMETIC, inner).map(" ".join).map("({})".format),
        st.tuples(st.sampled_from(["-", "!", "~"]), inner).map("".join),
        inner.map("({})".format),
        st.tuples(inner, inner, inner).map(lambda three: "{} ? {} : {}".format(*three)),
    )


_EXPRESSIONS = st.recursive(_ATOMS, _larger, max_leaves=6)
_STATEMENTS = st.tuples(
    st.sampled_from(["i", "d", "s", "new"]), st.sampled_from([":=", "=", "+=", "-=", "*=", "/="]), _EXPRESSIONS
).map(" ".join)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(_STATEMENTS, min_size=1, max_size=3).map("; ".join))
def test_scripts_do_what_they_do_under_btcpp(tmp_path: Path, text: str) -> None:
    xml = mission(script("i := 7; d := 2.5; s := 'abc'; t := '12'"), script(text))
    theirs = with_btcpp(xml)
    if theirs.raised is not None and "cannot be mixed" in theirs.raised:
        return  # it also refuses "-1 == !0", where each side has operators of one group
    if theirs.raised is not None and "while parsing" in theirs.raised:
        with pytest.raises(ScriptError):
            compile_script(text)
        return
    ours = with_loader(xml, tmp_path)
    if ours.raised is not None and "is not a number" in ours.raised:
        return  # it takes the text '3a' for the number 3
    assert (theirs.raised is None) == (ours.raised is None), (theirs.raised, ours.raised)
    if theirs.raised is None:
        assert ours.entries == theirs.entries


@pytest.mark.parametrize("script", ["s := s + s", "s += s", "s := s .. s", "s = s .. 'a'"])
def test_a_text_that_grows_at_every_tick_is_refused_before_it_fills_the_memory(script: str) -> None:
    blackboard = Blackboard()
    blackboard.set("s", "a" * MAX_TEXT)
    compiled = compile_script(script)
    with pytest.raises(ScriptError, match=f"a script makes texts of at most {MAX_TEXT}"):
        compiled.run(Scope(blackboard))
    assert blackboard.get("s") == "a" * MAX_TEXT


def test_a_number_of_thousands_of_digits_on_the_blackboard_is_refused_in_few_words() -> None:
    blackboard = Blackboard()
    blackboard.set("n", 10**6000)
    for text in ("n + 1", "n .. 'a'", "n && 1", "n & 1"):
        with pytest.raises(ScriptError, match="a whole number of 19932 bits"):
            compile_script(text).run(Scope(blackboard))
