"""Whatever text comes from outside is read, or refused with one clear error; nothing else."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml
from hypothesis import example, given, settings
from hypothesis import strategies as st

from rosa_core import InputError
from rosa_streams.recordings import monitor_recording
from rosa_streams.specification import load_specification
from rosa_streams.tags import load_ontology, parse_tag
from rosa_streams.temporal import Monitor, parse_formula

WORDS = st.sampled_from(
    [
        "G",
        "F",
        "U",
        "H",
        "O",
        "S",
        "[0,1]",
        "[",
        "]",
        "(",
        ")",
        "->",
        "and",
        "or",
        "not",
        "x",
        "matches",
        "true",
        ",",
        "1e999",
        "-1",
        "inf",
        "s",
        "==",
        "3",
        "==",
        "'a'",
        ">",
        "inside(",
        "distance(a,b)",
    ]
)
TAG_WORDS = st.sampled_from(
    [
        "A",
        "⊓",
        "∃",
        "r.",
        "some",
        "value",
        "and",
        "(",
        ")",
        "{",
        "}",
        "a",
        "not",
        ".",
        ",",
        "1",
        "⊤",
        "<x#A>",
        "p:A",
        "[",
        "exists",
    ]
)
YAML = st.sampled_from(
    [
        "classes",
        "roles",
        "individuals",
        "transformations",
        "targets",
        "units",
        "planning",
        "ontology",
        "is",
        "equals",
        "tag",
        "channel",
        "inputs",
        "outputs",
        "a",
        "A",
        "links",
        "transitive",
        "horizon",
        "quality",
    ]
)
VALUES = st.recursive(
    st.one_of(
        st.none(), st.booleans(), st.integers(-3, 3), st.floats(), YAML, st.sampled_from(["A and B", "x(", "${A}"])
    ),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(YAML, inner, max_size=4)),
    max_leaves=12,
)


def refusal(read: Callable[[], object]) -> str | None:
    """What is said when the input is refused; None if it is read."""
    try:
        read()
    except InputError as error:
        return str(error)
    return None


def evaluated(text: str) -> None:
    monitor = Monitor(parse_formula(text))
    monitor.step({"x": 1}, 0.0)
    monitor.step({"x": "a"}, 0.5)
    monitor.tick(2.0)


@given(st.one_of(st.lists(WORDS, max_size=12).map(" ".join), st.text(max_size=30)))
@settings(deadline=None, max_examples=400)
def test_any_formula(text: str) -> None:
    assert refusal(lambda: evaluated(text)) != ""


@given(st.one_of(st.lists(TAG_WORDS, max_size=12).map(" ".join), st.text(max_size=30)))
@settings(deadline=None, max_examples=400)
def test_any_tag(text: str) -> None:
    if refusal(lambda: parse_tag(text)) is None:
        tag = parse_tag(text)
        assert parse_tag(str(tag)) == tag


@given(VALUES)
@settings(deadline=None, max_examples=300)
def test_any_yaml(data: object) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "x.yaml"
        file.write_text(yaml.safe_dump(data), encoding="utf-8")
        assert "x.yaml" in (refusal(lambda: load_specification(file)) or "x.yaml")
        assert "x.yaml" in (refusal(lambda: load_ontology(file)) or "x.yaml")


@given(st.binary(max_size=60), st.sampled_from([".xml", ".yaml", ".ttl", ".owl", ".csv"]))
@example(b"\xff\xfe", ".csv")
@example(b"time,x\n0,\x00\n", ".csv")
@example(b"\x00", ".ttl")
@settings(deadline=None, max_examples=300)
def test_any_bytes(data: bytes, suffix: str) -> None:
    pytest.importorskip("rdflib")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"x{suffix}"
        file.write_bytes(data)
        formula = parse_formula("x > 3")
        read = (lambda: monitor_recording(formula, file)) if suffix == ".csv" else (lambda: load_specification(file))
        assert file.name in (refusal(read) or file.name)


def test_class_expressions_in_a_circle_are_refused(tmp_path: Path) -> None:
    pytest.importorskip("rdflib")
    (tmp_path / "x.ttl").write_text(
        "@prefix : <http://e.org/#> . @prefix owl: <http://www.w3.org/2002/07/owl#> . "
        "@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> . "
        ":A a owl:Class ; rdfs:subClassOf _:c . :r a owl:ObjectProperty . "
        "_:c owl:onProperty :r ; owl:someValuesFrom _:c ."
    )
    with pytest.raises(InputError, match="nested more than"):
        load_specification(tmp_path / "x.ttl")
