"""What is found in models whose weaknesses are known."""

from __future__ import annotations

from rosa_core import ElementKind, KnowledgeModel
from rosa_core.model.elements import ElementRef
from rosa_verification import verify_model
from rosa_verification.causes import cause_text
from tests.rosa_core.sample_models import knowledge_model

DAY_AND_NIGHT = """
measures: {light: {}, load: {}}
actions: {drive: {requires: [see, move]}}
functions: {see: {}, move: {always_improve: true}}
components: {camera: {}, lamp: {}, wheels: {}, tracks: {}}
function_designs:
  by day: {function: see, components: [camera], priority: 1, constraints: [{measure: light, value: 0.5}]}
  by night:
    {function: see, components: [camera, lamp], priority: 1, constraints: [{measure: light, operator: "<", value: 0.5}]}
  with a lamp by day: {function: see, components: [camera, lamp], constraints: [{measure: light, value: 0.7}]}
  on wheels: {function: move, components: [wheels], priority: 1}
  on both: {function: move, components: [wheels, tracks], priority: 2}
component_configurations:
  slow: {component: wheels, constraints: [{measure: load, operator: "<", value: 2}, {measure: load, value: 3}]}
  fast: {component: wheels, constraints: [{measure: load, operator: "<=", value: 3}]}
  crawling: {component: tracks}
"""


def test_each_weakness_of_a_model_is_found() -> None:
    findings = verify_model(knowledge_model(DAY_AND_NIGHT))
    drive = ElementRef(ElementKind.ACTION, "drive")
    assert [", ".join(map(cause_text, one)) for one in findings.cut_sets[drive].sets] == [
        "camera failed",
        "load > 3",
        "wheels failed",
        "lamp failed, light < 0.5",
    ]
    assert [str(gap) for gap in findings.gaps] == ["load > 3: drive"]
    assert [str(one) for one in findings.contradictions] == [
        "component configuration 'slow' is unfeasible at any value of load: constraints contradict"
    ]
    assert [str(one) for one in findings.flapping] == [
        "light around 0.5: function 'see' changes between 'by night' and 'by day' (neither is feasible on both sides)"
    ]
    never = {one.element.name: one.reason for one in findings.never_selected}
    assert never == {
        "with a lamp by day": "'by day' always wins",
        "on both": "'on wheels' always wins",
        "tracks": "no design that is ever selected uses it",
        "crawling": "component 'tracks' is never used",
    }
    assert len(findings.defects) == 3


def test_what_a_preference_may_select_is_no_defect() -> None:
    text = DAY_AND_NIGHT.replace("tracks: {}", "tracks: {estimations: [{measure: load, value: 5}]}")
    (both,) = (one for one in verify_model(knowledge_model(text)).never_selected if one.element.name == "on both")
    assert both.has_estimations
    assert not both.is_defect


def test_an_action_that_needs_what_nothing_can_do_is_never_feasible() -> None:
    findings = verify_model(knowledge_model("actions: {fly: {requires: [lift]}}\nfunctions: {lift: {}}\n"))
    assert [str(one) for one in findings.defects] == ["action 'fly': it is never feasible: what it needs has no design"]


def test_suave_has_its_known_single_points_of_failure(extended_model: KnowledgeModel) -> None:
    findings = verify_model(extended_model)
    single = {
        element.name: [cause_text(cause) for cause in findings.single_points(element)]
        for element in findings.cut_sets
        if element.kind is ElementKind.ACTION
    }
    assert single == {
        "search_pipeline": [
            "battery_level < 0.25",
            "f_generate_search_path_node failed",
            "water_visibility < 1.25",
        ],
        "inspect_pipeline": ["battery_level < 0.25", "f_follow_pipeline_node failed"],
        "recharge": ["generate_recharge_path_node failed"],
    }
    recover = findings.cut_sets[ElementRef(ElementKind.FUNCTION, "recover motion")].sets
    assert recover == tuple((f"c_thruster_{n}", "f_maintain_motion_node") for n in range(1, 7))
    assert findings.defects == ()


def test_too_many_situations_leave_a_question_open() -> None:
    measures = ", ".join(f"m{n}: {{}}" for n in range(12))
    constraints = ", ".join(f"{{measure: m{n}, value: 1}}" for n in range(12))
    findings = verify_model(
        knowledge_model(
            f"measures: {{{measures}}}\nactions: {{a: {{requires: [f]}}}}\n"
            "functions: {f: {}}\ncomponents: {c: {}}\n"
            f"function_designs:\n  one: {{function: f, components: [c], constraints: [{constraints}]}}\n"
            "  two: {function: f, components: [c], priority: 2}\n"
        )
    )
    assert [element.name for element in findings.undecided] == ["one", "f"]
    assert findings.never_selected == ()
