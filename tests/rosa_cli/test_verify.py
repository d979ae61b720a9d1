"""``rosa verify``."""

from __future__ import annotations

import json
from pathlib import Path

from tests.conftest import SUAVE, SUAVE_EXTENDED
from tests.rosa_cli.cli import refused, rosa


def test_the_document_has_minimal_cut_sets_smallest_first_then_by_name() -> None:
    process = rosa("verify", SUAVE, SUAVE_EXTENDED, "--json")
    assert process.returncode == 0
    document = json.loads(process.stdout)
    assert document["cut_sets"]["action"]["recharge"] == [
        [{"failed": "generate_recharge_path_node"}],
        *([{"failed": f"c_thruster_{n}"}, {"failed": "f_maintain_motion_node"}] for n in range(1, 7)),
    ]
    assert document["cut_sets"]["component_configuration"] == {
        "low altitude": [[{"measure": "water_visibility", "above": None, "below": 1.25}]],
        "medium altitude": [[{"measure": "water_visibility", "above": None, "below": 2.25}]],
        "high altitude": [[{"measure": "water_visibility", "above": None, "below": 3.25}]],
    }
    assert "water_visibility < 1.25: search_pipeline" in [gap["text"] for gap in document["gaps"]]
    assert document["never_selected"] == []
    assert document["path_sets"]["function"]["follow pipeline"] == [[{"works": "f_follow_pipeline_node"}]]


def test_up_to_order_one_there_are_single_points_of_failure_only() -> None:
    document = json.loads(rosa("verify", SUAVE, "--order", "1", "--json").stdout)
    assert document["cut_sets"]["function"]["recover motion"] == []


def test_a_defect_of_the_model_is_exit_code_1(tmp_path: Path) -> None:
    model = tmp_path / "model.yaml"
    model.write_text("actions: {fly: {requires: [lift]}}\nfunctions: {lift: {}}\n", encoding="utf-8")
    process = rosa("verify", model)
    assert process.returncode == 1
    assert "action 'fly': it is never feasible" in process.stdout
    document = json.loads(rosa("verify", model, "--json").stdout)
    assert document["cut_sets"]["action"] == {"fly": [[]]}
    assert document["never_selected"][0]["name"] == "fly"


def test_bad_input_is_exit_code_2(tmp_path: Path) -> None:
    assert "nothing.yaml" in refused(rosa("verify", tmp_path / "nothing.yaml"))
