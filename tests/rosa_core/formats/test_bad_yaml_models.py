"""Bad knowledge models: all that is wrong is reported with file, line and hint, and nothing else is ever raised."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeModel, KnowledgeModelError
from rosa_core.errors import InputError, Location, Problem
from tests.hang_limit import HANG_LIMIT
from tests.rosa_core.sample_models import DRONE


def problems(tmp_path: Path, *contents: str | bytes) -> list[str]:
    """What is wrong with files a.yaml, b.yaml, ...; the paths are cut down to the file names."""
    paths = []
    for letter, content in zip("abc", contents, strict=False):
        paths.append(tmp_path / f"{letter}.yaml")
        paths[-1].write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(KnowledgeModelError) as caught:
        KnowledgeModel.load(*paths)
    assert str(caught.value).splitlines()
    return [str(problem).replace(f"{tmp_path}/", "") for problem in caught.value.problems]


BASE = """\
measures: {energy: {kind: quality}}
actions: {dive: {requires: [sink]}}
functions: {sink: }
components: {ballast: }
function_designs:
  by ballast: {function: sink, components: [ballast]}
component_configurations:
  full: {component: ballast, parameters: {level: 1.0}}
"""

BAD: dict[str, tuple[str, str, str, str]] = {
    # what: (in BASE, replaced by, place, words)
    "unknown section": ("measures", "mesures", "a.yaml:1:", "'mesures' in the file (did you mean 'measures'?)"),
    "unknown key": ("requires", "require", "a.yaml:2:", "in actions / dive (did you mean 'requires'?)"),
    "key of another kind": ("sink: }", "sink: {priority: 1}}", "a.yaml:3:", "allowed here: always_improve"),
    "unknown key in a list": ("[sink]", "[sink], constraints: [{measur: energy}]", "a.yaml:2:", "mean 'measure'?"),
    "dangling function": ("[sink]", "[sing]", "a.yaml:2:", "names the unknown function 'sing' (did you mean 'sink'?)"),
    "dangling function of a design": ("function: sink", "function: sinc", "a.yaml:6:", "(did you mean 'sink'?)"),
    "dangling component": ("[ballast]", "[balast]", "a.yaml:6:", "component 'balast' (did you mean 'ballast'?)"),
    "dangling component of a configuration": ("component: ballast", "component: bolast", "a.yaml:8:", "mean 'ballast'"),
    "dangling measure": ("[sink]", "[sink], constraints: [{measure: enrgy}]", "a.yaml:2:", "(did you mean 'energy'?)"),
    "name of another kind": ("[sink]", "[ballast]", "a.yaml:2:", "'ballast' is a component, not a function"),
    "nothing near": ("[sink]", "[qqq]", "a.yaml:2:", "declare it as a function or name one of those declared"),
    "element twice": ("ballast: }", "ballast: , ballast: }", "a.yaml:4:", "'ballast' stands twice"),
    "required twice": ("[sink]", "[sink, sink]", "a.yaml:2:", "requires 'sink' twice"),
    "component twice": ("[ballast]", "[ballast, ballast]", "a.yaml:6:", "lists component 'ballast' twice"),
    "constraint twice": (
        "[sink]",
        "[sink], constraints: [{measure: energy, value: 1}, {measure: energy, value: 1.0}]",
        "a.yaml:2:",
        "stands twice",
    ),
    "estimation twice": (
        "components: {ballast: }",
        "components: {ballast: {estimations: [{measure: energy, value: 1}, {measure: energy, value: 2}]}}",
        "a.yaml:4:",
        "on 'energy' stands twice",
    ),
    "cyclic design": ("[ballast]", "[by ballast]", "a.yaml:6:", "function design 'by ballast' is cyclic"),
    "design of its own function": ("[ballast]", "[sink]", "a.yaml:6:", "is cyclic"),
    "empty design": ("[ballast]", "[]", "a.yaml:6:", "'by ballast' has no components"),
    "design without components": (", components: [ballast]", "", "a.yaml:6:", "has no components (add 'components:')"),
    "design without function": ("function: sink, ", "", "a.yaml:6:", "has no function (add 'function:')"),
    "configuration without component": ("component: ballast, ", "", "a.yaml:8:", "has no component"),
    "requires nothing": ("[sink]", "[]", "a.yaml:2:", "lists no function"),
    "text for a list": ("[sink]", "sink", "a.yaml:2:", "a list is expected"),
    "list for a mapping": ("{sink: }", "[sink]", "a.yaml:3:", "a mapping is expected"),
    "text for a number": ("[ballast]}", "[ballast], priority: high}", "a.yaml:6:", "a number is expected"),
    "flag for a number": ("[ballast]}", "[ballast], priority: true}", "a.yaml:6:", "a number is expected"),
    "number for text": ("[sink]", "[7]", "a.yaml:2:", "put quotes round a number"),
    "text for a flag": ("sink: }", 'sink: {always_improve: "yes"}}', "a.yaml:3:", "true or false is expected"),
    "unknown word": ("kind: quality", "kind: qualty", "a.yaml:1:", "is 'qualty' (it must be"),
    "unknown operator": ("[sink]", '[sink], constraints: [{measure: energy, operator: "=="}]', "a.yaml:2:", "is '=='"),
    "not a number": ("[ballast]}", "[ballast], priority: .nan}", "a.yaml:6:", "priority"),
    "infinite": ("[sink]", "[sink], constraints: [{measure: energy, value: .inf}]", "a.yaml:2:", "value"),
    "no measure": ("[sink]", "[sink], constraints: [{value: 1}]", "a.yaml:2:", "has no 'measure' (add 'measure:')"),
    "estimation on an action": ("[sink]", "[sink], estimations: []", "a.yaml:2:", "unknown key 'estimations'"),
    "mixed list": ("level: 1.0", "level: [1, a]", "a.yaml:8:", "a list whose type is not clear"),
    "empty list": ("level: 1.0", "level: []", "a.yaml:8:", "a list whose type is not clear"),
    "value of another type": ("level: 1.0", "level: {value: 1.5, type: long}", "a.yaml:8:", "is not a long: 1.5"),
    "node words on hardware": ("ballast: }", "ballast: {package: x}}", "a.yaml:4:", "is not a node"),
    "date": ("kind: quality", "kind: 2020-02-30", "a.yaml:1:", "cannot be read as timestamp"),
    "key that is no word": ("sink: }", "[sink]: }", "a.yaml:3:", "a key must be a plain word or number"),
    "tag": ("kind: quality", "kind: !measure quality", "a.yaml:1:", "cannot be read as !measure"),
    "python object": ("kind: quality", 'kind: !!python/name:os.system ""', "a.yaml:1:", "cannot be read"),
}  # fmt: skip


@pytest.mark.parametrize(("there", "instead", "place", "words"), BAD.values(), ids=BAD)
def test_what_is_wrong_is_reported_with_file_line_and_hint(
    tmp_path: Path, there: str, instead: str, place: str, words: str
) -> None:
    assert there in BASE
    found = problems(tmp_path, BASE.replace(there, instead, 1))
    assert any(problem.startswith(place) and words in problem for problem in found), found


def test_everything_that_is_wrong_is_reported_at_once(tmp_path: Path) -> None:
    text = BASE.replace("[sink]", "[sunk]").replace("[ballast]", "[]").replace("component: ballast", "component: b")
    assert [problem.split(" ")[0] for problem in problems(tmp_path, text)] == ["a.yaml:2:", "a.yaml:6:", "a.yaml:8:"]


# -- several files --

CONTRADICTIONS = {
    "priority": (
        "function_designs: {d: {function: f, components: [c], priority: 1}}",
        "function_designs: {d: {priority: 2}}",
        "priority of function design 'd' is 2.0 here and 1.0 at a.yaml:2",
    ),
    "components": (
        "function_designs: {d: {function: f, components: [c]}}",
        "function_designs: {d: {components: [e]}}",
        "components of function design 'd' is [e] here and [c] at a.yaml:2",
    ),
    "type": (
        "components: {x: {type: ros_node}}",
        "components: {x: {type: lifecycle_node}}",
        "type of component 'x' is lifecycle_node here and ros_node at a.yaml:2",
    ),
    "flag": (
        "functions: {g: {always_improve: true}}",
        "functions: {g: {always_improve: false}}",
        "always_improve of function 'g' is False here and True at a.yaml:2",
    ),
    "parameter": (
        "component_configurations: {k: {component: c, parameters: {speed: 1}}}",
        "component_configurations: {k: {component: c, parameters: {speed: 2}}}",
        "parameter 'speed' of component configuration 'k' is 2 here and 1",
    ),
}


@pytest.mark.parametrize(("first", "second", "words"), CONTRADICTIONS.values(), ids=CONTRADICTIONS)
def test_two_files_that_contradict_each_other_are_both_named(
    tmp_path: Path, first: str, second: str, words: str
) -> None:
    found = problems(tmp_path, f"# first\n{first}", f"# second\n\n{second}")
    assert found[0].startswith("b.yaml:3: ")
    assert words in found[0]


def test_an_error_in_the_second_file_is_placed_there(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, BASE, "actions:\n  dive:\n    requires:\n    - flote\n")
    assert found.startswith("b.yaml:4: action 'dive' names the unknown function 'flote'")


def test_a_requirement_that_an_earlier_file_states_already_is_reported(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, BASE, "# more\nactions: {dive: {requires: [sink]}}")
    assert found.startswith("b.yaml:2: action 'dive' requires 'sink' twice")


# -- files that are not models at all --


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "the file is empty"),
        ("# only a comment\n", "the file is empty"),
        ("{}", "the model is empty"),
        ("actions: {}", "the model is empty"),
        ("just text", "a mapping is expected"),
        ("- a\n- list\n", "a mapping is expected"),
        ("42", "the file"),
        ("actions: {go: ", "not valid YAML"),
        ("a: b: c", "a.yaml:1: not valid YAML"),
        ("actions:\n\tgo:\n", "a.yaml:2: not valid YAML"),
        ("--- {a: 1}\n--- {b: 2}\n", "expected a single document"),
        ("actions: *nobody", "not valid YAML"),
        ("a: \0", "not valid YAML"),
        (b"\xff\xfea\x00", "it is not UTF-8 text"),
        (b"actions: {caf\xe9: }", "it is not UTF-8 text"),
        ("actions: &a {go: *a}", "nested too deeply"),
        ("actions: " + "[" * 60 + "]" * 60, "nested too deeply"),
    ],
)
def test_a_file_that_is_no_model_is_reported_by_name(tmp_path: Path, content: str | bytes, words: str) -> None:
    found = problems(tmp_path, content)
    assert found[0].startswith("a.yaml:")
    assert words in found[0]


def test_a_file_that_is_not_there_is_reported_by_name(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeModelError, match=r"gone\.yaml: cannot read it: No such file"):
        KnowledgeModel.load(tmp_path / "gone.yaml")
    (tmp_path / "folder.yaml").mkdir()
    with pytest.raises(KnowledgeModelError, match=r"folder\.yaml: cannot read it"):
        KnowledgeModel.load(tmp_path / "folder.yaml")


def test_a_file_of_an_unknown_kind_is_reported_by_name(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeModelError, match=r"model\.json: unknown kind of file .*\.yaml"):
        KnowledgeModel.load(tmp_path / "model.json")


def test_at_least_one_file_must_be_given() -> None:
    with pytest.raises(KnowledgeModelError, match="no file is given"):
        KnowledgeModel.load()


def test_a_problem_reads_as_place_what_and_hint() -> None:
    assert str(Problem("it is wrong", Location("f.yaml", 3), "hint it")) == "f.yaml:3: it is wrong (hint it)"
    assert str(InputError([Problem("a"), Problem("b", Location("f"))])) == "a\nf: b"
    assert InputError("text").problems == (Problem("text"),)


# -- hostile files --

LONG = "0x" + "F" * 5000
"""A number with more digits than Python prints."""
HUGE = "0x" + "F" * 300
"""A number that Python prints, over the greatest float."""


def kind_of_measure(value: str) -> str:
    return f"measures: {{m: {{kind: {value}}}}}"


def parameter(value: str) -> str:
    return f"{{components: {{c: }}, component_configurations: {{k: {{component: c, parameters: {{p: {value}}}}}}}}}"


HOSTILE = {
    "empty int": kind_of_measure('!!int ""'),
    "empty float": kind_of_measure('!!float ""'),
    "not a bool": kind_of_measure("!!bool maybe"),
    "not a timestamp": kind_of_measure("!!timestamp soon"),
    "digits too many": kind_of_measure("9" * 5000),
    "number too long to print": kind_of_measure(LONG),
    "number too long as a key": f"? {LONG}\n: 1\n",
    "limit too long to print": f"actions: {{a: {{constraints: [{{measure: m, value: {LONG}}}]}}}}",
    "parameter over float": parameter(f"{{value: {HUGE}, type: double}}"),
    "list over float": parameter(f"{{value: [{HUGE}], type: double_array}}"),
    "parameter of a type too long to print": parameter(f"{{value: {LONG}, type: string}}"),
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE)
def test_values_that_cannot_be_are_reported_like_any_other(tmp_path: Path, text: str) -> None:
    assert problems(tmp_path, text)[0].startswith("a.yaml:1")


def load_with_little_memory(file: Path) -> subprocess.CompletedProcess[str]:
    """Load in a process of its own with 600 MB of address space: what a file does there, it does to nobody else."""
    program = (
        "import resource, sys\n"
        "resource.setrlimit(resource.RLIMIT_AS, (600 << 20, 600 << 20))\n"
        "from rosa_core import KnowledgeModel, KnowledgeModelError\n"
        "try:\n    KnowledgeModel.load(sys.argv[1])\n"
        "except KnowledgeModelError as error:\n    print(error)\n"
    )
    command = [sys.executable, "-c", program, str(file)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=HANG_LIMIT)


@pytest.mark.skipif(sys.platform != "linux", reason="needs limits on a process's memory")
@pytest.mark.parametrize("opening", ["[", "{a: "])
def test_a_file_nested_a_hundred_thousand_deep_is_reported_and_kills_nothing(tmp_path: Path, opening: str) -> None:
    (tmp_path / "deep.yaml").write_text("actions: " + opening * 100_000, encoding="utf-8")
    done = load_with_little_memory(tmp_path / "deep.yaml")
    assert (done.returncode, done.stderr) == (0, "")
    assert "deep.yaml" in done.stdout


@pytest.mark.skipif(sys.platform != "linux", reason="needs limits on a process's memory")
def test_aliases_of_aliases_do_not_fill_the_memory(tmp_path: Path) -> None:
    lines = ["l0: &l0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"l{n}: &l{n} [{', '.join([f'*l{n - 1}'] * 9)}]" for n in range(1, 10)]
    (tmp_path / "bomb.yaml").write_text("\n".join(lines), encoding="utf-8")
    done = load_with_little_memory(tmp_path / "bomb.yaml")
    assert (done.returncode, done.stderr[-500:]) == (0, "")
    assert "aliases expand to too much" in done.stdout


# -- anything at all --


def load_anything(file: Path, content: bytes) -> None:
    """The file is a model, or the error says what is wrong with it; any other error fails the test."""
    file.write_bytes(content)
    found = None
    try:
        KnowledgeModel.load(file)
    except KnowledgeModelError as error:
        found = error
    assert found is None or (found.problems and str(file) in str(found))


@settings(max_examples=200, deadline=None)
@given(st.text(max_size=200).map(str.encode) | st.binary(max_size=100))
def test_any_text_is_a_model_or_found_to_be_none(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    load_anything(tmp_path_factory.getbasetemp() / "any.yaml", content)


PIECES = (
    *(
        "[",
        "]",
        "{",
        "}",
        ": ",
        ", ",
        "- ",
        "\n",
        "  ",
        "&a ",
        "*a",
        "? ",
        "|",
        ">",
        "'",
        '"',
        "#",
        "%",
        "@",
        "\t",
        "\x85",
    ),
    *("null", "true", "1", "-1e9999", "0x1F", ".nan", "~", "<<: ", "2020-13-99", "!!str ", "camera", "priority: 1"),
)


@settings(max_examples=300, deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, len(DRONE)), st.integers(0, 12), st.sampled_from(PIECES) | st.text(max_size=3)),
        min_size=1,
        max_size=4,
    )
)
@example([(0, 0, "")])
def test_a_model_with_something_changed_is_a_model_or_found_to_be_none(
    tmp_path_factory: pytest.TempPathFactory, changes: list[tuple[int, int, str]]
) -> None:
    text = DRONE
    for place, removed, added in changes:
        text = text[:place] + added + text[place + removed :]
    load_anything(tmp_path_factory.getbasetemp() / "changed.yaml", text.encode("utf-8", "surrogatepass"))
