"""``rosa query``: rows on the terminal and as JSON, in a supposed situation."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

DATA = Path(__file__).parents[1] / "data"
FILES = [str(DATA / "suave.tql"), str(DATA / "suave_extended.tql")]
SELECTABLE = "match $a isa Action, has name $name; not {$a has status 'unfeasible';}; fetch $name;"


def rosa(*arguments: str, stdin: str = "") -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "rosa_cli.main", *arguments]
    return subprocess.run(command, capture_output=True, text=True, input=stdin, check=False)


def test_prints_the_rows_as_json():
    done = rosa("query", *FILES, SELECTABLE, "--measure", "battery_level=0.2", "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout) == [{"name": "recharge"}]


def test_prints_a_table_for_people():
    done = rosa("query", *FILES, "match $a isa Action; fetch $a: name, status;", "--require", "recharge")
    assert done.returncode == 0
    lines = [line.split() for line in done.stdout.splitlines()]
    assert lines == [
        ["a.name", "a.status"],
        ["search_pipeline", "feasible"],
        ["inspect_pipeline", "feasible"],
        ["recharge", "unsolved"],
    ]


def test_says_when_there_are_none():
    done = rosa("query", *FILES, "match $a isa! ROSNode; get $a;")
    assert (done.returncode, done.stdout) == (0, "no rows\n")


def test_reads_the_query_from_standard_input():
    done = rosa("query", *FILES, "-", "--json", "--failed", "c_thruster_1", stdin=SELECTABLE)
    assert len(json.loads(done.stdout)) == 3


def test_takes_yaml_models_and_all_that_can_be_supposed():
    model = Path(__file__).parents[2] / "suave" / "models" / "suave.yaml"
    active = "match $c isa Component, has is-active true, has name $n; get $n;"
    done = rosa("query", str(model), active, "--json", "--active", "c_thruster_2", "--select", "low altitude")
    assert json.loads(done.stdout) == [{"n": "c_thruster_2"}]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([*FILES, "match $a isa Acton; fetch $a;"], "rosa: query:1: unknown type 'Acton' (did you mean 'Action'?)"),
        ([*FILES, "match $a isa Action; delete $a isa Action;"], "rosa: query:1: a query only reads"),
        ([FILES[0]], "rosa: a file and a query are needed"),
        (FILES, "rosa: query:1: "),
        (["nowhere.tql", SELECTABLE], "rosa: nowhere.tql: cannot read it"),
    ],
)
def test_bad_input_ends_with_a_message_and_exit_code_2(arguments, said):
    done = rosa("query", *arguments)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


def test_a_stated_situation_holds(tmp_path):
    path = tmp_path / "m.tql"
    path.write_text("insert $c isa Component, has component-name 'arm', has is-active true;", encoding="utf-8")
    done = rosa("query", str(path), "match $c isa Component; fetch $c: name, is-active;", "--json")
    assert json.loads(done.stdout) == [{"c": {"name": "arm", "is-active": True}}]


@pytest.mark.parametrize("command", ["check", "status", "effort"])
def test_other_commands_take_typeql_models(command):
    done = rosa(command, *FILES)
    assert done.returncode == 0, done.stderr


def test_a_schema_is_not_a_model(tmp_path):
    path = tmp_path / "schema.tql"
    path.write_text("define\nAction sub entity, owns action-name @key;\n", encoding="utf-8")
    done = rosa("check", str(path))
    assert done.returncode == 2
    assert "schema.tql:1: this is a schema, not a model (leave it out: the schema of ROSA is built in)" in done.stderr


def test_help_does_not_wait_for_the_parser_generator():
    code = """
import sys
from rosa_cli.main import main
sys.argv = ["rosa", "--help"]
try:
    main()
except SystemExit:
    assert "lark" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
