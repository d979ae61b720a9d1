"""Fault trees and their files say when an element is unfeasible, as the knowledge base does."""

from __future__ import annotations

import re
from itertools import combinations
from xml.etree.ElementTree import Element

import pytest
from defusedxml.ElementTree import fromstring
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import ElementKind, InputError, KnowledgeBase, KnowledgeModel, SimulationClock, Situation, Status
from rosa_core.model.elements import ElementRef
from rosa_verification.causes import Region
from rosa_verification.drawing import fault_tree_svg
from rosa_verification.exports import galileo, open_psa
from rosa_verification.fault_tree import FaultTree, fault_tree
from rosa_verification.reliability import action_reliabilities
from rosa_verification.reliability_file import Reliability
from rosa_verification.structure import Structure
from tests.rosa_core.inference.random_knowledge import LIMITS, models
from tests.rosa_core.sample_models import knowledge_model
from tests.rosa_verification.test_cut_sets import NO_CHECKS


def tree_of(model: KnowledgeModel, action: str) -> FaultTree:
    return fault_tree(Structure(model), ElementRef(ElementKind.ACTION, action))


class XmlTree:
    """What an Open-PSA file says, read without regard to how it was made."""

    def __init__(self, text: str) -> None:
        self.root = fromstring(text)
        self.gates = {gate.get("name"): gate for gate in self.root.iter("define-gate")}
        self.house = {e.get("name"): self._constant(e) for e in self.root.iter("define-house-event")}

    def _constant(self, event: Element) -> bool:
        constant = event.find("constant")
        assert constant is not None
        return constant.get("value") == "true"

    def holds(self, name: str | None, true: set[str]) -> bool:
        gate = self.gates[name]
        (formula,) = (part for part in gate if part.tag != "label")
        return self._holds(formula, true)

    def _holds(self, formula: Element, true: set[str]) -> bool:
        if formula.tag == "constant":
            return formula.get("value") == "true"
        if formula.tag == "gate":
            return self.holds(formula.get("name"), true)
        if formula.tag == "event":
            name = str(formula.get("name"))
            return self.house.get(name, name in true)
        parts = [self._holds(part, true) for part in formula]
        assert len(parts) > 1
        return {"or": any, "and": all}[formula.tag](parts)


def galileo_holds(text: str, true: set[str]) -> bool:
    """Whether the top event of a Galileo file comes about."""
    top = re.match(r'toplevel "(\w+)";', text)
    assert top is not None
    lines = dict(re.findall(r'^"(\w+)" (.*);$', text, re.MULTILINE))

    def holds(name: str) -> bool:
        kind, *rest = lines[name].split()
        if kind in ("or", "and"):
            return (any if kind == "or" else all)(holds(part.strip('"')) for part in rest)
        return kind == "prob=1" or name in true

    return holds(top[1])


@settings(max_examples=60, deadline=None, suppress_health_check=NO_CHECKS)
@given(models(), st.data())
def test_both_files_hold_exactly_where_the_action_is_unfeasible(model: KnowledgeModel, data: st.DataObject) -> None:
    action = data.draw(st.sampled_from(model.names[ElementKind.ACTION]))
    measures = model.names[ElementKind.MEASURE]
    measured = {measure: data.draw(st.sampled_from(LIMITS)) for measure in measures}
    tree = tree_of(model, action)
    xml, dft = XmlTree(open_psa(tree, None, measured)), galileo(tree, None, measured)
    kb = KnowledgeBase(model, clock=SimulationClock())
    components = model.names[ElementKind.COMPONENT]
    for size in range(len(components) + 1):
        for failed in combinations(components, size):
            with kb.supposing(Situation(measured, failed)):
                unfeasible = kb.status(ElementKind.ACTION, action) is Status.UNFEASIBLE
            true = {tree.causes[component] for component in failed if component in tree.causes}
            assert xml.holds(tree.top.name, true) == unfeasible
            assert galileo_holds(dft, true) == unfeasible


MODEL = """
measures: {light: {}}
actions:
  drive: {requires: [see], constraints: [{measure: light, value: 0.5}, {measure: light, operator: "<", value: 9}]}
functions: {see: {}}
components: {"2 cameras <b>": {}, Lidar: {}, lidar: {}}
function_designs:
  one: {function: see, components: ["2 cameras <b>", Lidar]}
  two: {function: see, components: [lidar]}
"""


def test_names_are_ones_that_every_tool_takes_and_labels_are_as_written() -> None:
    tree = tree_of(knowledge_model(MODEL), "drive")
    names = [*tree.gates, *tree.causes.values()]
    assert all(re.fullmatch("[a-z][a-z0-9_]*", name.lower()) for name in names)
    assert len({name.lower() for name in names}) == len(names)
    assert {"light_below_0_5", "light_from_9", "the_2_cameras_b_failed"} <= set(names)
    labels = {label.text for label in XmlTree(open_psa(tree)).root.iter("label")}
    assert "2 cameras <b> failed" in labels


def test_rates_and_probabilities_are_in_both_files() -> None:
    tree = tree_of(knowledge_model(MODEL), "drive")
    reliability = Reliability({"lidar": 0.5, "Lidar": 0.25}, {"lidar": 0.001})
    xml, dft = XmlTree(open_psa(tree, reliability)), galileo(tree, reliability)
    events = {event.get("name"): event for event in xml.root.iter("define-basic-event")}
    rate = events[tree.causes["lidar"]].find("exponential/float")
    chance = events[tree.causes["Lidar"]].find("float")
    assert rate is not None
    assert chance is not None
    assert (rate.get("value"), chance.get("value")) == ("0.001", "0.25")
    assert f'"{tree.causes["lidar"]}" lambda=0.001 dorm=0;' in dft
    assert f'"{tree.causes["Lidar"]}" prob=0.25;' in dft


def test_the_probability_is_that_of_the_exported_tree(extended_model: KnowledgeModel) -> None:
    chances = dict.fromkeys(extended_model.names[ElementKind.COMPONENT], 0.25)
    tree = tree_of(extended_model, "recharge")
    xml = XmlTree(open_psa(tree))
    events = [name for cause, name in tree.causes.items() if not isinstance(cause, Region)]
    total = 0.0
    for size in range(len(events) + 1):
        for true in combinations(events, size):
            if xml.holds(tree.top.name, set(true)):
                total += 0.25**size * 0.75 ** (len(events) - size)
    (recharge,) = (r for r in action_reliabilities(Structure(extended_model), chances) if r.action == "recharge")
    assert recharge.unfeasible == pytest.approx(total)


def test_the_drawing_shows_every_cause_once_and_escapes_names() -> None:
    tree = tree_of(knowledge_model(MODEL), "drive")
    svg = fromstring(fault_tree_svg(tree))
    titles = [title.text for title in svg.iter("{http://www.w3.org/2000/svg}title")]
    for cause in ("2 cameras <b> failed", "Lidar failed", "lidar failed", "light < 0.5", "light >= 9"):
        assert titles.count(cause) == 1
    assert len(list(svg.iter("{http://www.w3.org/2000/svg}circle"))) == 3


def test_a_tree_too_large_to_look_at_is_not_drawn() -> None:
    names = [f"c{n}" for n in range(2001)]
    model = knowledge_model(
        "actions: {a: {requires: [f]}}\nfunctions: {f: {}}\n"
        f"components: {{{', '.join(f'{name}: {{}}' for name in names)}}}\n"
        f"function_designs: {{d: {{function: f, components: [{', '.join(names)}]}}}}\n"
    )
    with pytest.raises(InputError, match="more than 2000 leaves"):
        fault_tree_svg(tree_of(model, "a"))
