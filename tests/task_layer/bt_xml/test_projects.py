"""Missions of many files: trees that use one another without an include."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest
from py_trees.common import Status

from rosa_core import InputError
from task_layer.bt import TreeSource, load_tree, load_trees
from task_layer.bt.mission_check import check_mission
from task_layer.bt.testing import fake_model
from task_layer.bt.xml import file_reader
from task_layer.bt.xml.outline import read_outline

LEAVES = {"stop": lambda: None, "go": lambda: True}


def tree(tree_id: str, body: str) -> str:
    return f'<BehaviorTree ID="{tree_id}">{body}</BehaviorTree>'


def use(*tree_ids: str) -> str:
    return "<Sequence>" + "\n".join(f'<SubTree ID="{tree_id}"/>' for tree_id in tree_ids) + "</Sequence>"


def write(folder: Path, **files: str) -> Path:
    """A folder with XML files of that content, each inside a root element; ``sub__a`` is the file ``sub/a.xml``."""
    for name, content in files.items():
        path = folder.joinpath(*f"{name}.xml".split("__"))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'<root BTCPP_format="4">\n{content}</root>', encoding="utf-8")
    return folder


def problems(error: pytest.ExceptionInfo[InputError], folder: Path) -> list[str]:
    return [str(problem).replace(f"{folder}/", "") for problem in error.value.problems]


def test_a_tree_uses_trees_of_other_files_of_the_folder(tmp_path: Path) -> None:
    write(
        tmp_path, main=tree("Main", use("Drive")), parts__drive=tree("Drive", use("Turn")), turn=tree("Turn", "<go/>")
    )
    project = load_trees(tmp_path, LEAVES)
    assert project.ids == ("Main", "Turn", "Drive")
    root = project.build("Main")
    root.tick_once()
    assert root.status is Status.SUCCESS
    assert project.warnings("Main") == []
    assert load_tree(tmp_path, LEAVES, tree="Drive").name == "Sequence"


def test_files_may_be_named_one_by_one(tmp_path: Path) -> None:
    write(tmp_path, main=tree("Main", use("Drive")), drive=tree("Drive", "<go/>"), other=tree("Other", "<nobody/>"))
    root = load_tree([tmp_path / "main.xml", str(tmp_path / "drive.xml")], LEAVES, tree="Main")
    root.tick_once()
    assert root.status is Status.SUCCESS


def test_the_main_tree_is_the_one_that_the_files_name(tmp_path: Path) -> None:
    write(tmp_path, a=tree("A", "<go/>"), b=tree("B", use("A")), c=tree("C", "<go/>"))
    with pytest.raises(InputError) as error:
        load_tree(tmp_path, LEAVES)
    assert str(error.value).endswith("it does not say which tree to run (name one of its trees: B, C)")
    (tmp_path / "c.xml").write_text(f'<root main_tree_to_execute="B">{tree("C", "<go/>")}</root>', encoding="utf-8")
    assert load_trees(tmp_path, LEAVES).main_tree() == "B"


def test_a_fault_in_a_tree_that_nothing_uses_is_a_warning(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    draft = tree("Draft", '\n<Repeat times="2"><go/></Repeat>')
    file = write(tmp_path, main=f"{tree('Main', '<Sequence><go/></Sequence>')}{draft}") / "main.xml"
    with caplog.at_level(logging.WARNING):
        root = load_tree(file, LEAVES, tree="Main")
    root.tick_once()
    assert root.status is Status.SUCCESS
    expected = f"{file}:3: Repeat has no port 'times' (it has num_cycles)"
    assert caplog.messages[0] == expected
    assert str(load_trees(file, LEAVES).warnings("Main")[0]) == expected
    with pytest.raises(InputError, match="Repeat has no port 'times'"):
        load_tree(file, LEAVES, tree="Draft")


def test_a_file_that_is_no_xml_is_a_warning_until_something_in_it_is_needed(tmp_path: Path) -> None:
    write(tmp_path, main=tree("Main", use("Part")), part=tree("Part", "<go/>"), broken='<a code="x && y"/>')
    project = load_trees(tmp_path, LEAVES)
    assert project.build("Main").name == "Sequence"
    (warning,) = project.warnings("Main")
    assert "broken.xml:2: not valid XML: a bare '&'" in str(warning)
    (tmp_path / "part.xml").write_text("<root", encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_tree(tmp_path, LEAVES, tree="Main")
    (problem,) = problems(error, tmp_path)
    assert problem.startswith("main.xml:2: there is no tree 'Part', which 'Main' uses (perhaps it is in a file that")
    assert "part.xml" in problem


def test_a_tree_that_is_nowhere_is_named_with_who_asks_for_it(tmp_path: Path) -> None:
    write(tmp_path, main=tree("Main", use("Part")), part=tree("Part", use("Nowhere")), other=tree("Other", use("No")))
    with pytest.raises(InputError) as error:
        load_tree(tmp_path, LEAVES, tree="Main")
    assert problems(error, tmp_path) == ["part.xml:2: there is no tree 'Nowhere', which 'Part' uses"]


def test_an_id_that_several_files_give_is_an_error_only_where_it_is_used(tmp_path: Path) -> None:
    write(
        tmp_path, a=tree("Twice", "<go/>"), b=tree("Twice", "<stop/>"), c=tree("C", use("Twice")), d=tree("D", "<go/>")
    )
    project = load_trees(tmp_path, LEAVES)
    assert project.build("D").name == "go"
    with pytest.raises(InputError) as error:
        project.build("C")
    assert problems(error, tmp_path) == [
        "b.xml:2: there is more than one tree 'Twice': a.xml:2, b.xml:2 (rename all but one)"
    ]
    assert "more than one tree 'Twice'" in str(project.warnings("D")[0])


def test_a_file_that_is_included_and_in_the_folder_is_read_once(tmp_path: Path) -> None:
    write(tmp_path, main='<include path="part.xml"/>' + tree("Main", use("Part")), part=tree("Part", "<go/>"))
    assert load_tree(tmp_path, LEAVES, tree="Main").name == "Sequence"


def test_other_files_of_the_folder_are_passed_over(tmp_path: Path) -> None:
    write(tmp_path, main=tree("Main", "<go/>"))
    (tmp_path / "package.xml").write_text("<package><name>p</name></package>", encoding="utf-8")
    (tmp_path / "notes.txt").write_text("<", encoding="utf-8")
    write(tmp_path / ".backup", main=tree("Main", "<stop/>"))
    project = load_trees(tmp_path, LEAVES)
    assert (project.ids, project.main_tree(), project.warnings()) == (("Main",), "Main", [])


def test_a_project_file_of_groot2_is_read_too(tmp_path: Path) -> None:
    write(tmp_path, main=tree("Main", '<do_it speed="2"/>'))
    models = '<TreeNodesModel><Action ID="do_it"><input_port name="speed" type="int"/></Action></TreeNodesModel>'
    (tmp_path / "robot.btproj").write_text(
        f'<root BTCPP_format="4" project_name="Project"><include path="main.xml"/>{models}</root>', encoding="utf-8"
    )
    assert load_tree(tmp_path, {"do_it": lambda: None}).name == "do_it"


def test_includes_of_ros_packages_are_found_where_the_map_says(tmp_path: Path) -> None:
    share = write(
        tmp_path / "share" / "robot_trees", trees__part='<include path="deep.xml"/>' + tree("Part", use("Deep"))
    )
    write(share, trees__deep=tree("Deep", "<go/>"))
    include = '<include ros_pkg="robot_trees" path="trees/part.xml"/>'
    file = write(tmp_path / "mission", main=include + tree("Main", use("Part"))) / "main.xml"
    root = load_tree(file, LEAVES, tree="Main", ros_packages={"robot_trees": share})
    root.tick_once()
    assert root.status is Status.SUCCESS
    with pytest.raises(
        InputError, match=r"the folder of the ROS package 'robot_trees' is not known \(did you mean 'rob"
    ):
        load_tree(file, LEAVES, tree="Main", ros_packages={"robot_tree": share})


def test_an_include_does_not_leave_the_folder_of_its_ros_package(tmp_path: Path) -> None:
    share = write(tmp_path / "share", part=tree("Part", "<go/>"))
    write(tmp_path, secret=tree("Part", "<go/>"))
    include = '<include ros_pkg="p" path="../secret.xml"/>'
    file = write(tmp_path / "mission", main=include + tree("Main", use("Part"))) / "main.xml"
    with pytest.raises(InputError, match=r"'\.\./secret\.xml' is outside the mission's folder"):
        load_tree(file, LEAVES, tree="Main", ros_packages={"p": share})


def test_there_may_be_more_than_a_hundred_files(tmp_path: Path) -> None:
    names = [f"T{number}" for number in range(150)]
    write(tmp_path, **{name: tree(name, "<go/>") for name in names}, main=tree("Main", use(*names)))
    root = load_tree(tmp_path, LEAVES, tree="Main")
    root.tick_once()
    assert root.status is Status.SUCCESS


def test_a_file_that_is_included_and_is_no_xml_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "broken.xml").write_text("<root", encoding="utf-8")
    file = write(tmp_path, main='<include path="broken.xml"/>' + tree("Main", "<go/>")) / "main.xml"
    with pytest.raises(InputError, match=r"broken\.xml:1: not valid XML"):
        load_tree(file, LEAVES)
    (warning,) = load_trees(tmp_path, LEAVES).warnings("Main")[:1]
    assert "broken.xml:1: not valid XML" in str(warning)


@pytest.mark.parametrize(
    ("limit", "value", "message"),
    [
        ("MAX_FILES", 3, "there are more than 3 files"),
        ("MAX_TOTAL_BYTES", 200, "the files have more than 200 bytes"),
        ("MAX_ENTRIES", 3, "there are more than 3 files and folders in it (name the folder of the mission)"),
    ],
)
def test_there_is_an_end_to_what_is_read(
    limit: str, value: int, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tmp_path, **{name: tree(name, "<go/>") for name in "abcde"})
    monkeypatch.setattr(file_reader, limit, value)
    with pytest.raises(InputError) as error:
        load_trees(tmp_path, LEAVES)
    assert str(error.value) == f"{tmp_path}: {message}"


def test_a_tree_of_a_project_is_one_thing_to_hand_on(tmp_path: Path) -> None:
    write(tmp_path, main=tree("Main", use("Part")), part=tree("Part", '<leaf speed="2"/>'))
    nodes = tmp_path / "nodes.txt"
    nodes.write_text(
        '<root><TreeNodesModel><Action ID="leaf"><input_port name="speed"/></Action></TreeNodesModel></root>',
        encoding="utf-8",
    )
    source = TreeSource(tmp_path, "Main", (nodes,))
    assert (str(source), Path(source)) == (f"{tmp_path} (Main)", tmp_path)
    assert [node.name for node in load_tree(source, {"leaf": lambda: None}).iterate()] == ["leaf", "Part", "Sequence"]
    with pytest.raises(InputError, match="leaf has no port 'speed'"):
        load_tree(TreeSource(tmp_path, "Main"), {"leaf": lambda: None})


def test_a_folder_without_trees(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"it does not say which tree to run \(add <BehaviorTree>\)"):
        load_tree(tmp_path, LEAVES)
    with pytest.raises(InputError, match="no file to read trees from was given"):
        load_tree([], LEAVES)


def test_an_outline_and_a_check_of_a_folder(tmp_path: Path) -> None:
    write(tmp_path, main=tree("Main", use("Part")), part=tree("Part", "<search/>"), draft=tree("Draft", "<Repeat/>"))
    root, found = read_outline(tmp_path, "Main")
    assert [node.name for node in root.iterate()] == ["search", "Part", "Sequence"]
    assert found == []
    findings = check_mission(tmp_path, fake_model("search"), tree="Main")
    assert (findings.problems, findings.nodes) == ((), 3)
    assert [warning.what for warning in findings.warnings] == [
        "whether 'search' is feasible is not checked before it is performed",
        "<Repeat> has 0 children",
        "Repeat needs the port 'num_cycles'",
    ]
