"""What is measured answers the same question: ours, the full recompute, and clingo agree."""

from __future__ import annotations

import json

import pytest

from rosa_core import ElementKind, KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_evaluation.bench.clingo_peer import ClingoPeer
from rosa_evaluation.bench.inference import measure_inference
from rosa_evaluation.bench.recompute import Recompute
from rosa_evaluation.bench.synthetic import many_small_robots, one_measure_for_all
from tests.rosa_cli.cli import rosa

MODELS = [many_small_robots(100), one_measure_for_all(10)]


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("value", [0.5, 1.0, 1.5, 2.5])
def test_the_full_recompute_agrees(model: KnowledgeModel, value: float) -> None:
    kb = KnowledgeBase(model, clock=SimulationClock())
    measure, action = model.measures[0].name, model.actions[0].name
    kb.request_action(action)
    kb.add_measurement(measure, value)
    statuses = Recompute(model).statuses({measure: value}, frozenset({action}))
    for kind in (ElementKind.ACTION, ElementKind.FUNCTION, ElementKind.COMPONENT, ElementKind.FUNCTION_DESIGN):
        assert kb.statuses(kind) == {name: statuses[kind, name] for name in model.names[kind]}


@pytest.mark.parametrize("value", [0.5, 1.5, 2.5])
def test_clingo_agrees(extended_model: KnowledgeModel, value: float) -> None:
    for model in (*MODELS, extended_model):
        kb = KnowledgeBase(model, clock=SimulationClock())
        peer = ClingoPeer(model)
        for measure in model.measures:
            kb.add_measurement(measure.name, value / 10)
            peer.measure(measure.name, value / 10)
        unfeasible = set(model.names[ElementKind.ACTION]) - set(kb.selectable_actions())
        assert peer.unfeasible_actions() == unfeasible


def test_every_figure_is_measured_beside_its_peers() -> None:
    figures = list(measure_inference((100,), with_clingo=True))
    assert figures[0].what == "load and infer"
    assert all(figure.seconds > 0 for figure in figures)
    assert all(figure.clingo_s and figure.recompute_s for figure in figures[1:])


def test_the_command_prints_them() -> None:
    process = rosa("bench", "--most", "100", "--json")
    assert process.returncode == 0
    assert len(json.loads(process.stdout)) == 7
    shown = rosa("bench", "--most", "100").stdout
    for words in ("one measurement, small cone", "best of 10^6 configurations", "journalled", "bytes an element"):
        assert words in shown
