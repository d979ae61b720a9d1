"""Probabilities and importances: exact, held to summing over all situations; and the file they are read from."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import ElementKind, InputError, KnowledgeBase, KnowledgeModel, SimulationClock, Situation, Status
from rosa_verification.reliability import action_reliabilities
from rosa_verification.reliability_file import read_reliability
from rosa_verification.structure import Structure
from tests.rosa_core.inference.random_knowledge import LIMITS, models
from tests.rosa_core.sample_models import knowledge_model
from tests.rosa_verification.test_cut_sets import NO_CHECKS

PROBABILITIES = st.sampled_from([0.0, 0.125, 0.5, 0.9, 1.0])


@settings(max_examples=60, deadline=None, suppress_health_check=NO_CHECKS)
@given(models(), st.data())
def test_the_figures_are_those_of_all_situations_together(model: KnowledgeModel, data: st.DataObject) -> None:
    components = model.names[ElementKind.COMPONENT]
    chances = {name: data.draw(PROBABILITIES) for name in components}
    measures = model.names[ElementKind.MEASURE]
    measured = data.draw(st.dictionaries(st.sampled_from(measures), st.sampled_from(LIMITS)))
    kb = KnowledgeBase(model, clock=SimulationClock())
    cuts: dict[str, list[frozenset[str]]] = {name: [] for name in model.names[ElementKind.ACTION]}
    for size in range(len(components) + 1):
        for failed in combinations(components, size):
            with kb.supposing(Situation(measured, failed)):
                for action, status in kb.statuses(ElementKind.ACTION).items():
                    if status is Status.UNFEASIBLE:
                        cuts[action].append(frozenset(failed))
    for found in action_reliabilities(Structure(model), chances, measured):
        unfeasible = cuts[found.action]
        assert found.unfeasible == pytest.approx(chance(unfeasible, chances))
        minimal = [one for one in unfeasible if not any(other < one for other in unfeasible)]
        minimal = [one for one in minimal if all(chances[c] for c in one)]
        importances = {one.component: one for one in found.importances}
        for component in components:
            failed_and_works = [chance(unfeasible, {**chances, component: p}) for p in (1.0, 0.0)]
            mine = importances.get(component)
            if chances[component]:
                birnbaum = 0.0 if mine is None else mine.birnbaum
                assert birnbaum == pytest.approx(failed_and_works[0] - failed_and_works[1])
            if mine is not None and found.unfeasible:
                with_it = [one for one in unfeasible if any(component in cut and cut <= one for cut in minimal)]
                assert mine.fussell_vesely == pytest.approx(chance(with_it, chances) / found.unfeasible)


def chance(situations: list[frozenset[str]], chances: dict[str, float]) -> float:
    total = 0.0
    for failed in situations:
        product = 1.0
        for component, probability in chances.items():
            product *= probability if component in failed else 1 - probability
        total += product
    return total


def test_thousands_of_components_in_a_row_are_exact_too() -> None:
    names = [f"c{n}" for n in range(3000)]
    model = knowledge_model(
        "actions: {a: {requires: [f]}}\nfunctions: {f: {}}\n"
        f"components: {{{', '.join(f'{name}: {{}}' for name in names)}}}\n"
        f"function_designs: {{d: {{function: f, components: [{', '.join(names)}]}}}}\n"
    )
    (found,) = action_reliabilities(Structure(model), dict.fromkeys(names, 0.001))
    assert found.unfeasible == pytest.approx(1 - 0.999**3000)


MODEL = """
actions: {fly: {requires: [lift]}}
functions: {lift: {}}
components: {rotors: {}, wing: {}}
function_designs: {d: {function: lift, components: [rotors, wing]}}
"""


def test_a_rate_counts_for_the_time_of_the_mission(tmp_path: Path) -> None:
    file = tmp_path / "reliability.yaml"
    file.write_text("time: 100\nreliability:\n  rotors: {rate: 0.01}\n  wing: {probability: 0.25}\n", encoding="utf-8")
    read = read_reliability(file, knowledge_model(MODEL))
    assert read.probabilities == {"rotors": pytest.approx(0.6321205588), "wing": 0.25}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("reliability: {rotor: {probability: 0.1}}", "1: no component 'rotor' in the model (did you mean 'rotors'?)"),
        ("reliability:\n  wing: {}", "2: 'wing' needs either a probability or a rate"),
        ("reliability:\n  wing: {probability: 0.1, rate: 1}", "2: 'wing' needs either a probability or a rate"),
        ("reliability:\n  wing: {rate: 1}", "2: 'wing' has a rate, and the file has no time (add 'time: 3600'"),
        ("reliability:\n  wing: {probability: 1.5}", "a number from 0 to 1 is expected"),
        ("- wing", "not a reliability file"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_line(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "reliability.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_reliability(file, knowledge_model(MODEL))
    assert message in str(error.value)
