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


def test_rosa_check_warns_of_defects_and_the_model_is_still_valid(tmp_path: Path) -> None:
    model = tmp_path / "model.yaml"
    model.write_text("actions: {fly: {requires: [lift]}}\nfunctions: {lift: {}}\n", encoding="utf-8")
    process = rosa("check", model)
    assert process.returncode == 0
    assert process.stderr == "warning: action 'fly': it is never feasible: what it needs has no design\n"
    assert process.stdout == "ok: 2 entities, 1 relations\n"
    assert rosa("check", SUAVE, SUAVE_EXTENDED).stderr == ""


def test_bad_input_is_exit_code_2(tmp_path: Path) -> None:
    assert "nothing.yaml" in refused(rosa("verify", tmp_path / "nothing.yaml"))


RELIABILITY = """
reliability:
  f_generate_search_path_node: {probability: 0.125}
  c_thruster_1: {probability: 0.25}
  f_maintain_motion_node: {probability: 0.5}
"""


def test_with_a_reliability_file_it_says_how_likely_actions_are_to_be_unfeasible(tmp_path: Path) -> None:
    file = tmp_path / "reliability.yaml"
    file.write_text(RELIABILITY, encoding="utf-8")
    document = json.loads(rosa("verify", SUAVE, "--reliability", file, "--json").stdout)
    found = {one["action"]: one for one in document["reliability"]}
    assert found["search_pipeline"]["unfeasible"] == 1 - 0.875 * 0.875
    assert found["inspect_pipeline"]["importances"] == [
        {"component": "c_thruster_1", "birnbaum": 0.5, "fussell_vesely": 1.0},
        {"component": "f_maintain_motion_node", "birnbaum": 0.25, "fussell_vesely": 1.0},
    ]
    process = rosa("verify", SUAVE, "--reliability", file, "-m", "water_visibility=1", "--json")
    assert json.loads(process.stdout)["reliability"][0]["unfeasible"] == 1.0


def test_fault_trees_are_written_in_every_format(tmp_path: Path) -> None:
    files = [tmp_path / f"tree.{kind}" for kind in ("svg", "xml", "dft")]
    options = [part for file in files for part in ("--fault-tree", file)]
    assert rosa("verify", SUAVE, "--action", "search_pipeline", *options).returncode == 0
    starts = ["<svg", "<?xml", "toplevel"]
    assert [file.read_text(encoding="utf-8").startswith(start) for file, start in zip(files, starts, strict=True)]


def test_options_that_do_not_fit_are_bad_input(tmp_path: Path) -> None:
    tree = ("--fault-tree", tmp_path / "tree.svg")
    assert "say --action search_pipeline" in refused(rosa("verify", SUAVE, *tree))
    assert "did you mean 'search_pipeline'?" in refused(rosa("verify", SUAVE, *tree, "--action", "search_pipe"))
    assert ".dft for Galileo" in refused(rosa("verify", SUAVE, "--fault-tree", tmp_path / "tree.png"))
    assert "no measure has that name" in refused(rosa("verify", SUAVE, "-m", "light=1"))
    nowhere = tmp_path / "nowhere" / "tree.dft"
    assert "cannot write it" in refused(rosa("verify", SUAVE, "--fault-tree", nowhere, "--action", "search_pipeline"))
    assert not (tmp_path / "tree.svg").exists()
