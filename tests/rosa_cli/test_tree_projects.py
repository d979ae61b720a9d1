"""``rosa tree`` and ``rosa check --mission`` on the folder of a project, and on files of version 3."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rosa_cli.cli import refused, rosa

MODEL = Path(__file__).resolve().parents[2] / "suave" / "models" / "suave.yaml"
MAIN = """<root BTCPP_format="4">
  <BehaviorTree ID="Inspect">
    <Sequence><SubTree ID="Search"/><Action ID="inspect_pipeline"/></Sequence>
  </BehaviorTree>
</root>"""
SEARCH = """<root BTCPP_format="4">
  <BehaviorTree ID="Search"><Sequence><calm depth="3"/><search_pipeline/></Sequence></BehaviorTree>
</root>"""
NODES = '<root><TreeNodesModel><Condition ID="calm"><input_port name="depth"/></Condition></TreeNodesModel></root>'


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "mission"
    (folder / "parts").mkdir(parents=True)
    (folder / "main.xml").write_text(MAIN, encoding="utf-8")
    (folder / "parts" / "search.xml").write_text(SEARCH, encoding="utf-8")
    (tmp_path / "nodes.xml").write_text(NODES, encoding="utf-8")
    return folder


def test_the_tree_of_a_folder_is_shown(project: Path) -> None:
    process = rosa("tree", project, "--tree", "Inspect", "--nodes", project.parent / "nodes.xml")
    assert (process.returncode, process.stderr) == (0, "")
    assert "calm depth=3" in process.stdout
    assert "inspect_pipeline" in process.stdout
    part = rosa("tree", project, "--tree", "Search")
    assert "inspect_pipeline" not in part.stdout
    assert "calm" in rosa("tree", project / "main.xml", project / "parts" / "search.xml", "--tree", "Inspect").stdout


def test_a_folder_with_several_trees_and_none_named(project: Path) -> None:
    assert "it does not say which tree to run (name one of its trees: Inspect)" in refused(rosa("tree", project))
    assert "there is no tree 'Insepct' (did you mean 'Inspect'?)" in refused(rosa("tree", project, "--tree", "Insepct"))


def test_a_mission_in_a_folder_is_checked(project: Path) -> None:
    nodes = ("--nodes", project.parent / "nodes.xml")
    process = rosa("check", MODEL, "--mission", project, "--tree", "Inspect", *nodes)
    assert process.returncode == 0, process.stderr
    assert "ok: a mission of 6 nodes" in process.stdout
    assert "search.xml:2: unknown node 'calm'" in refused(
        rosa("check", MODEL, "--mission", project, "--tree", "Inspect")
    )


def test_the_folder_of_a_ros_package_is_given(project: Path) -> None:
    (project / "main.xml").write_text(
        MAIN.replace("<BehaviorTree", '<include ros_pkg="shared" path="search.xml"/><BehaviorTree', 1), encoding="utf-8"
    )
    main, parts = project / "main.xml", project / "parts"
    assert "calm depth=3" in rosa("tree", main, "--ros-package", f"shared={parts}").stdout
    process = rosa("tree", main)
    assert process.returncode == 0
    assert "the folder of the ROS package 'shared' is not known" in process.stderr
    assert "does not say where the package is" in refused(rosa("tree", main, "--ros-package", "shared"))
    assert "there is no folder 'nowhere'" in refused(rosa("tree", main, "--ros-package", "shared=nowhere"))


def test_a_file_of_version_3_is_converted(tmp_path: Path) -> None:
    old, new = tmp_path / "old.xml", tmp_path / "new.xml"
    old.write_text(
        '<root main_tree_to_execute="M"><BehaviorTree ID="M"><SequenceStar><AlwaysSuccess/></SequenceStar>'
        "</BehaviorTree></root>",
        encoding="utf-8",
    )
    assert "this is BehaviorTree.CPP v3 (<SequenceStar> in line 1)" in refused(rosa("tree", old))
    process = rosa("tree", old, "--upgrade", new)
    assert process.returncode == 0, process.stderr
    assert "SequenceWithMemory" in rosa("tree", new).stdout
    assert "cannot write it" in refused(rosa("tree", old, "--upgrade", new))
    assert "it is of version 4 already" in refused(rosa("tree", new, "--upgrade", tmp_path / "newer.xml"))


def test_a_tree_of_a_folder_is_run(tmp_path: Path) -> None:
    folder = tmp_path / "mission"
    folder.mkdir()
    (folder / "main.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="Find"><Sequence><arm_thrusters/><set_guided_mode/>'
        '<SubTree ID="Search"/></Sequence></BehaviorTree></root>',
        encoding="utf-8",
    )
    (folder / "search.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="Search"><ReactiveSequence>'
        '<is_action_feasible action_name="search_pipeline"/><search_pipeline/>'
        "</ReactiveSequence></BehaviorTree></root>",
        encoding="utf-8",
    )
    run = rosa("run", "suave", "--mission", folder, "--tree", "Find", "-q", "--time-limit", "300")
    assert run.returncode == 0, run.stderr
    assert "ended by mission done" in run.stdout
    assert "it does not say which tree to run" not in run.stderr
    assert "there is no tree 'Fnid' (did you mean 'Find'?)" in refused(
        rosa("run", "suave", "--mission", folder, "--tree", "Fnid", "-q")
    )
    assert "--tree, --nodes and --ros-package are about a mission" in refused(rosa("run", "suave", "--tree", "Find"))
