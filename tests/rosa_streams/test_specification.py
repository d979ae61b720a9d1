"""Specifications: the paper's listings unchanged, YAML, templates, and what is said of mistakes."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import InputError
from rosa_streams.environment import Target, Transformation
from rosa_streams.specification import load_specification, specifications_xml
from rosa_streams.tags import parse_tag
from tests.rosa_streams.nao import DATA


def test_the_papers_transformation_listing_loads_unchanged() -> None:
    (each,) = load_specification(DATA / "listing1.xml").environment.transformations
    assert each.tid == "undistort(cam1)"
    assert each.source == "package/Undistort"
    assert each.parameters == (("configPath", "/path/to/configuration/cam1/"),)
    assert [(port.name, port.tag) for port in each.inputs] == [("rawCamera", parse_tag("RawRGB(cam1)"))]
    assert [(port.name, port.tag) for port in each.outputs] == [("undist", parse_tag("Undistorted(cam1)"))]


def test_the_papers_target_listing_loads_unchanged() -> None:
    specification = load_specification(DATA / "listing2.xml")
    assert specification.environment.targets == {Target("undistortSub", parse_tag("Undistorted(cam1)"), "/result")}


def test_a_template_gives_one_set_of_transformations_for_each_individual() -> None:
    library = load_specification(DATA / "table1.xml", DATA / "piff_and_puff.yaml").environment.library()
    assert len(library) == 10
    for name in ("piff", "puff"):
        subsampler = library[f"subsampler({name})"]
        assert len(subsampler.outputs) == 15
        assert subsampler.inputs[0].tag == parse_tag(f"YUVImage ⊓ ∃hasSource.{name}")
        assert f"bottom_cam({name})" in library


def test_a_template_over_a_class_without_individuals_gives_nothing_and_over_an_unknown_one_is_an_error(
    tmp_path: Path,
) -> None:
    (tmp_path / "none.yaml").write_text("classes: {NAO: {}}")
    assert not load_specification(DATA / "table1.xml", tmp_path / "none.yaml").environment.transformations
    with pytest.raises(InputError, match=r"table1.xml:4: no class 'NAO' is known for the template \$\{NAO\}"):
        load_specification(DATA / "table1.xml")


def test_what_is_written_as_xml_reads_back_the_same(tmp_path: Path) -> None:
    environment = load_specification(
        DATA / "table1.xml", DATA / "fuse.xml", DATA / "piff.yaml", DATA / "ball.xml", DATA / "listing1.xml"
    ).environment
    text = specifications_xml(environment.library().values(), environment.goal().values())
    (tmp_path / "again.xml").write_text(text)
    again = load_specification(tmp_path / "again.xml").environment
    assert again == environment


def test_yaml_says_the_same_as_xml(tmp_path: Path) -> None:
    (tmp_path / "fuse.yaml").write_text(
        """
transformations:
  fuse_ball_pos:
    source: nao/FuseBallPositions
    inputs: {first: "Position ⊓ ∃hasSource.Ball", second: "Position and (hasSource some Ball)"}
    outputs: {fused: "FusedPosition ⊓ ∃hasSource.Ball"}
    labor: 0.5
    upkeep: 0.05
    quality: 2
targets:
  q0: {tag: "Position ⊓ ∃hasSource.Ball", channel: /result}
units:
  fuse_ball_pos.1: {transformation: fuse_ball_pos, inputs: {first: /a, second: /b}, outputs: {fused: /result}}
planning: {horizon: 30, max_cost: 9}
"""
    )
    ours = load_specification(tmp_path / "fuse.yaml")
    theirs = load_specification(DATA / "fuse.xml", DATA / "ball.xml")
    assert ours.environment.transformations == theirs.environment.transformations
    assert ours.environment.targets == theirs.environment.targets
    assert (ours.horizon, ours.max_cost) == (30, 9)
    (unit,) = ours.environment.units
    assert unit.channels() == ("/result",)


MISTAKES = {
    "a misspelt element": (
        "<transformation><lable>a</lable></transformation>",
        "unknown element 'lable' (did you mean 'label'?)",
    ),
    "a port without a tag": (
        "<transformation><label>a</label><source>s</source><ports>"
        "\n<port type='in'>raw</port></ports></transformation>",
        "x.xml:2: the port 'raw' has no tag",
    ),
    "a tag without a port": (
        "<transformation><label>a</label><source>s</source><ports><port type='in'>raw</port></ports>"
        "<tags><tag port='raw'>A</tag><tag port='rwa'>B</tag></tags></transformation>",
        "a tag is for the port 'rwa', and there is none (did you mean 'raw'?)",
    ),
    "a port type": (
        "<transformation><label>a</label><source>s</source><ports><port type='inn'>raw</port></ports>"
        "<tags><tag port='raw'>A</tag></tags></transformation>",
        "unknown port type 'inn' (did you mean 'in'?)",
    ),
    "a tag that cannot be read": (
        "<target><label>q</label><topic>/r</topic>\n\n<tag>A or B</tag></target>",
        "x.xml:3: a disjunction ('or') is beyond the tag language at column 3",
    ),
    "a number": (
        "<transformation><label>a</label><source>s</source><params>"
        "<param name='n' type='int'>x</param></params></transformation>",
        "'x' is no int",
    ),
    "a cost": (
        "<transformation><label>a</label><source>s</source><cost labor='-1'/></transformation>",
        "labor is a number of at least 0, not '-1'",
    ),
    "a missing source": ("<transformation><label>a</label></transformation>", "a transformation needs a <source>"),
    "no XML": ("<transformation>", "not valid XML"),
    "another root": ("<transform/>", "unknown element 'transform' (did you mean 'transformation'?)"),
    "an entity bomb": (
        '<!DOCTYPE t [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><target><label>&b;</label></target>',
        "document types and entities are not allowed",
    ),
    "an outside entity": (
        '<!DOCTYPE t [<!ENTITY a SYSTEM "file:///etc/passwd">]><target><label>&a;</label></target>',
        "document types and entities are not allowed",
    ),
    "too deep": ("<specifications>" * 500 + "</specifications>" * 500, "nested more than 20 levels deep"),
    "a label that stands twice": (
        "<targets>" + 2 * "<target><label>q</label><topic>/r</topic><tag>A</tag></target>" + "</targets>",
        "the label 'q' stands twice",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_in_xml_is_one_clear_error(tmp_path: Path, case: str) -> None:
    text, said = MISTAKES[case]
    (tmp_path / "x.xml").write_text(text)
    with pytest.raises(InputError) as caught:
        load_specification(tmp_path / "x.xml")
    assert said in str(caught.value)
    assert "x.xml" in str(caught.value)


def test_all_mistakes_of_a_file_are_reported_at_once(tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_text(
        "transformations:\n  a:\n    sources: s\n    inputs: {i: 3}\ntargets:\n  q: {tag: A}\nunit: {}\n"
    )
    with pytest.raises(InputError) as caught:
        load_specification(tmp_path / "x.yaml")
    text = str(caught.value)
    assert "x.yaml:3: unknown key 'sources' (did you mean 'source'?)" in text
    assert "x.yaml:4: the tag of 'i' is a text" in text
    assert "'channel' is missing" in text
    assert "x.yaml:7: unknown key 'unit' (did you mean 'units'?)" in text


def test_a_template_that_would_expand_without_end_is_refused(tmp_path: Path) -> None:
    individuals = ", ".join(f"i{number}: {{is: A}}" for number in range(200))
    (tmp_path / "o.yaml").write_text(
        f"classes: {{A: {{}}, B: {{}}}}\nindividuals: {{{individuals}}}\n"
        "targets: {'q ${A}': {tag: 'X ⊓ ∃r.${A}', channel: '/${A}'}}\n"
    )
    assert len(load_specification(tmp_path / "o.yaml").environment.targets) == 200
    both = (tmp_path / "o.yaml").read_text().replace("B: {}", "B: {is: A}, C: {}").replace("is: A}", "is: [A, C]}")
    (tmp_path / "o.yaml").write_text(both.replace("'/${A}'", "'/${A}/${C}'"))
    with pytest.raises(InputError, match="expands to 40,000 copies"):
        load_specification(tmp_path / "o.yaml")


def test_a_name_that_looks_misspelt_is_noted(tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_text(
        "classes: {Position: {}}\ntargets: {q: {tag: Positon, channel: /r}}\n"
        "transformations: {t: {outputs: {o: Position}}}"
    )
    assert load_specification(tmp_path / "x.yaml").notes == (
        "'Positon' is not in the ontology, did you mean 'Position'?",
    )


def test_an_unknown_kind_of_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a file of the kind '.json' cannot be read"):
        load_specification(tmp_path / "x.json")
    with pytest.raises(InputError, match="cannot read it"):
        load_specification(tmp_path / "missing.xml")


def test_parameters_are_read_by_their_type(tmp_path: Path) -> None:
    (tmp_path / "x.xml").write_text(
        "<transformation><label>a</label><source>s</source><params>"
        "<param name='i' type='int'>3</param><param name='d' type='double'>2.5</param>"
        "<param name='b' type='bool'>true</param><param name='s'>x</param></params></transformation>"
    )
    (each,) = load_specification(tmp_path / "x.xml").environment.transformations
    assert isinstance(each, Transformation)
    assert dict(each.parameters) == {"i": 3, "d": 2.5, "b": True, "s": "x"}
