"""Tags: their spellings, and what is part of what."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import InputError
from rosa_streams.tags import Axioms, Individual, Ontology, Role, load_ontology, parse_tag

CAMERA = """
classes:
  Camera: {}
  RawImage: {is: Image}
roles:
  hasSource: {is: relatedTo}
  partOf: {transitive: true}
individuals:
  cam1: {is: Camera, links: {partOf: [head]}}
  head: {is: BodyPart, links: {partOf: [piff]}}
  piff: {is: NAO}
"""


@pytest.fixture
def camera(tmp_path: Path) -> Ontology:
    (tmp_path / "camera.yaml").write_text(CAMERA)
    return load_ontology(tmp_path / "camera.yaml")


@pytest.mark.parametrize(
    "spelling",
    [
        "Undistorted ⊓ ∃hasSource.cam1",
        "∃hasSource.(cam1) ⊓ (Undistorted)",
        "Undistorted and (hasSource some cam1)",
        "Undistorted and hasSource value cam1",
        "Undistorted ⊓ ∃hasSource.{cam1}",
        "[ owl:intersectionOf ( :Undistorted [ owl:onProperty :hasSource ; owl:hasValue :cam1 ] ) ]",
    ],
)
def test_a_tag_means_the_same_in_every_spelling(camera: Ontology, spelling: str) -> None:
    assert camera.resolve(parse_tag(spelling)) == camera.resolve(parse_tag("Undistorted ⊓ ∃hasSource.{cam1}"))


def test_a_predicate_matches_the_same_predicate_and_nothing_else(camera: Ontology) -> None:
    assert camera.matches(parse_tag("Undistorted(cam1)"), parse_tag("Undistorted( cam1 )"))
    for other in ("Undistorted(cam2)", "Undistorted", "Undistorted ⊓ ∃hasSource.cam1", "Undistorted(cam1, cam1)"):
        assert not camera.matches(parse_tag("Undistorted(cam1)"), parse_tag(other))
        assert not camera.matches(parse_tag(other), parse_tag("Undistorted(cam1)"))


def test_a_target_for_any_camera_is_matched_by_a_stream_of_one_camera_but_not_the_other_way_round(
    camera: Ontology,
) -> None:
    one, any_camera = parse_tag("Undistorted ⊓ ∃hasSource.cam1"), parse_tag("Undistorted and (hasSource some Camera)")
    assert camera.matches(one, any_camera)
    assert not camera.matches(any_camera, one)
    assert not Ontology().matches(one, any_camera), "without Camera(cam1) nothing says so"


@pytest.mark.parametrize(
    ("output", "wanted", "holds"),
    [
        ("RawImage", "Image", True),
        ("Image", "RawImage", False),
        ("Image ⊓ ∃hasSource.cam1", "∃relatedTo.Camera", True),
        ("Image ⊓ ∃hasSource.cam1", "∃hasSource.(Camera ⊓ ∃partOf.NAO)", True),
        ("Image ⊓ ∃hasSource.head", "∃hasSource.Camera", False),
        ("Image", "⊤", True),
        ("⊤", "Image", False),
        ("Image ⊓ ∃hasSource.(cam1 ⊓ Broken)", "∃hasSource.(Broken ⊓ ∃partOf.head)", True),
        ("∃hasSource.(cam1 ⊓ Broken) ⊓ ∃seenBy.cam1", "∃seenBy.Broken", True),
        ("∃hasSource.(head ⊓ cam1)", "∃hasSource.(BodyPart ⊓ Camera)", True),
        ("∃hasSource.cam9", "∃hasSource.cam9", True),
    ],
)
def test_subsumption_follows_classes_roles_types_and_links(
    camera: Ontology, output: str, wanted: str, holds: bool
) -> None:
    assert camera.matches(parse_tag(output), parse_tag(wanted)) is holds


def test_what_one_tag_says_of_an_individual_holds_for_that_tag_only(camera: Ontology) -> None:
    assert camera.matches(parse_tag("∃r.(cam1 ⊓ Broken) ⊓ ∃s.cam1"), parse_tag("∃s.Broken"))
    assert not camera.matches(parse_tag("∃s.cam1"), parse_tag("∃s.Broken"))


def test_a_defined_class_is_recognised_and_unfolded(tmp_path: Path) -> None:
    (tmp_path / "o.yaml").write_text("classes: {BallPosition: {equals: 'Position and hasSource some Ball'}}")
    ontology = load_ontology(tmp_path / "o.yaml")
    long = parse_tag("Position ⊓ ∃hasSource.(Ball ⊓ Red) ⊓ New")
    assert ontology.matches(long, parse_tag("BallPosition"))
    assert ontology.matches(parse_tag("BallPosition"), parse_tag("∃hasSource.Ball"))
    assert not ontology.matches(parse_tag("Position"), parse_tag("BallPosition"))


def test_classes_that_are_part_of_each_other_in_a_circle_are_one(tmp_path: Path) -> None:
    (tmp_path / "o.yaml").write_text("classes: {A: {is: B}, B: {is: 'C and r some A'}, C: {is: A}}")
    ontology = load_ontology(tmp_path / "o.yaml")
    assert ontology.matches(parse_tag("C"), parse_tag("B ⊓ ∃r.∃r.∃r.C"))


@pytest.mark.parametrize(
    ("text", "said", "column"),
    [
        ("Image or Video", "disjunction", 7),
        ("not Image", "negation", 1),
        ("Image and (hasSource only Camera)", "universal", 22),
        ("hasSource max Camera", "number restriction", 11),
        ("Image and", "expected a concept", 10),
        ("Image ⊓ (Raw", "expected ')'", 13),
        ("∃hasSource Camera", "expected '.'", 12),
        ("Image $", "cannot read '$'", 7),
        ("Image Raw", "expected 'and' or the end", 7),
        ("{a, b}", "one individual", 3),
        ("", "expected a concept", 1),
        ("and and and", "expected a concept", 1),
    ],
)
def test_a_tag_that_cannot_be_read_is_an_error_that_points_at_the_place(text: str, said: str, column: int) -> None:
    with pytest.raises(InputError, match="column") as caught:
        parse_tag(text)
    lines = str(caught.value).splitlines()
    assert said in lines[0]
    assert f"column {column}" in lines[0]
    assert lines[2].index("^") - 4 == column - 1


@pytest.mark.parametrize("text", ["(" * 5000, "∃r." * 3000 + "A", "A" * 20_000, "[ owl:intersectionOf", "[ :x 1"])
def test_hostile_tags_are_refused_at_once(text: str) -> None:
    with pytest.raises(InputError):
        parse_tag(text)


def test_an_owl_file_in_turtle_says_the_same_as_yaml(tmp_path: Path) -> None:
    (tmp_path / "camera.ttl").write_text(
        """
        @prefix : <http://example.org/camera#> . @prefix owl: <http://www.w3.org/2002/07/owl#> .
        @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
        :Camera a owl:Class . :NAO a owl:Class . :Image a owl:Class . :Colour a owl:Class .
        :RawImage a owl:Class ; rdfs:subClassOf :Image ,
            [ a owl:Restriction ; owl:onProperty :hasSource ; owl:someValuesFrom :Camera ] ,
            [ a owl:Class ; owl:unionOf ( :Colour :Image ) ] .
        :hasSource a owl:ObjectProperty . :partOf a owl:ObjectProperty, owl:TransitiveProperty .
        :cam1 a owl:NamedIndividual , :Camera ; :partOf :head . :head a owl:NamedIndividual ; :partOf :piff .
        :piff a owl:NamedIndividual , :NAO .
        """
    )
    ontology = load_ontology(tmp_path / "camera.ttl")
    assert ontology.matches(parse_tag("RawImage"), parse_tag("Image ⊓ ∃hasSource.Camera"))
    assert ontology.matches(parse_tag("∃hasSource.cam1"), parse_tag("∃hasSource.∃partOf.NAO"))
    assert ontology.individuals_of("NAO") == ("piff",)
    assert any("unionOf" in each for each in ontology.axioms.ignored)


def test_owl_in_xml_with_entities_is_refused(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><r>&b;</r>'
    (tmp_path / "bomb.owl").write_text(bomb)
    with pytest.raises(InputError, match="entities"):
        load_ontology(tmp_path / "bomb.owl")


def test_a_misspelt_key_of_an_ontology_is_named_with_its_line_and_the_nearest(tmp_path: Path) -> None:
    (tmp_path / "o.yaml").write_text("classes:\n  A: {equal: B}\nroles:\n  r: {transitiv: true}\n")
    with pytest.raises(InputError) as caught:
        load_ontology(tmp_path / "o.yaml")
    assert "o.yaml:2: unknown key 'equal' (did you mean 'equals'?)" in str(caught.value)


def test_ontologies_add_up() -> None:
    first = Axioms(individuals={"a": Individual(types=(parse_tag("A"),))})
    second = Axioms(individuals={"a": Individual(links=(("r", "b"),))}, roles={"r": Role(("s",))})
    ontology = Ontology(first.merged(second))
    assert ontology.matches(parse_tag("{a}"), parse_tag("A ⊓ ∃s.{b}"))
