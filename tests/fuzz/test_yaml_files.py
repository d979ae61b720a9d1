"""Files in YAML and JSON: models, missions, maps, experiments, system modes."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml

import agv_example
import suave
import uav_example
from agv_example.map_formats.files import load_map
from agv_example.missions.mission_config import load_mission
from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_evaluation.campaign import Experiment, make_plan, read_managers
from rosa_simulation.scenario import find_scenario
from rosa_simulation.system_modes.reader import load_system_modes
from suave.mission_config import load_mission_config
from tests.agv_example.brass_map import brass_document
from tests.fuzz.harness import fuzzed, result_or_refusal
from tests.fuzz.mutations import Change, changed_bytes, changed_document, changed_tokens, tokens_of

SUAVE, AGV, UAV = (Path(str(package.__file__)).parent for package in (suave, agv_example, uav_example))

MISSION = """
/mission_node:
  ros__parameters:
    time_limit: 300
    thruster_events: ["(1,failure,35)", "(2, recovery, 20.5)"]
    water_visibility_threshold: [3.25, 2.25, 1.25]
    expected_altitude: [3.0, 2.0, 1.0]
/water_visibility_observer_node:
  ros__parameters: {water_visibility_period: 80, water_visibility_min: 1.25, f_generate_search_path_mode: fd_spiral_low}
"""
EXPERIMENT = """
name: varied uncertainties
parameters:
  time_limit: 250
  water_visibility_sec_shift: {uniform: [0, 80]}
  thruster_events: [[1, failure, {uniform: [20, 60]}], [2, recovery, {choice: [1, 2]}]]
  discharge_time: {normal: [100, 3]}
"""


def _model(path: Path) -> object:
    model = KnowledgeModel.load(path)
    return KnowledgeBase(model, clock=SimulationClock()).selectable_actions()


def _overlay(path: Path) -> object:
    return KnowledgeModel.load(SUAVE / "models" / "suave.yaml", path)


def _experiment(path: Path) -> object:
    scenario = find_scenario("suave")
    return make_plan(scenario, read_managers("rosa", scenario), range(2), Experiment.load(path)).runs


READERS: dict[str, tuple[Any, Callable[[Path], object]]] = {
    "model": (SUAVE / "models" / "suave.yaml", _model),
    "model with relations": (UAV / "models" / "uav.yaml", _model),
    "overlay": (SUAVE / "models" / "suave_extended.yaml", _overlay),
    "suave mission": (MISSION, load_mission_config),
    "agv mission": (AGV / "missions" / "crossing.yaml", load_mission),
    "agv map": (AGV / "maps" / "paper.yaml", load_map),
    "rainbow map": (json.dumps(brass_document(2, 2)), load_map),
    "system modes": (SUAVE / "managers" / "suave_extended_modes.yaml", load_system_modes),
    "experiment": (EXPERIMENT, _experiment),
}


def _text(source: Any) -> str:
    return source.read_text(encoding="utf-8") if isinstance(source, Path) else source


def _dumped(document: Any) -> str:
    return yaml.dump(document, sort_keys=False, allow_unicode=True, Dumper=getattr(yaml, "CDumper", yaml.Dumper))


@pytest.mark.parametrize("kind", READERS)
def test_documents_with_other_contents(kind: str, folder: Path) -> None:
    source, read = READERS[kind]
    document, path = yaml.safe_load(_text(source)), folder / f"{kind}.yaml"
    path.write_text(_dumped(document), encoding="utf-8")
    assert result_or_refusal(lambda: read(path)) is not None

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        path.write_text(_dumped(changed_document(document, changes)), encoding="utf-8", errors="replace")
        result_or_refusal(lambda: read(path))

    check()


@pytest.mark.parametrize("kind", ["model", "agv map"])
def test_text_that_is_hardly_yaml(kind: str, folder: Path) -> None:
    source, read = READERS[kind]
    tokens, path = tokens_of(_text(source)), folder / f"{kind}.yaml"
    vocabulary = (
        "&a ",
        "*a",
        "<<: *a",
        "? ",
        "- ",
        "|",
        ">",
        "!!int ",
        "!!set ",
        "{",
        "}",
        "[",
        "]",
        "---\n",
        "%YAML 9.9\n",
    )

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        text = changed_tokens(tokens, changes, vocabulary).encode("utf-8", "replace")
        path.write_bytes(changed_bytes(text, changes[3:]))
        result_or_refusal(lambda: read(path))

    check()
