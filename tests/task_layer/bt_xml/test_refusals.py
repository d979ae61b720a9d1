"""Files that cannot be used: one clear error each, with file, line and hint."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import py_trees
import pytest

from rosa_core import InputError
from task_layer.bt import Output, Registry, load_tree


def drive(speed: float, gear: int = 1) -> None:
    """A leaf with two ports."""


def look(seen: Output[str]) -> bool:
    seen.set("fish")
    return True


LEAVES = Registry({"drive": drive, "look": look, "stop": lambda: None, "Choose": py_trees.composites.Selector})


def refusal(folder: Path, text: str | bytes, tree: str | None = None) -> list[str]:
    """What is wrong with a file, each as ``line: what (hint)``."""
    path = folder / "mission.xml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError) as error:
        load_tree(path, LEAVES, tree=tree)
    problems = []
    for problem in error.value.problems:
        assert problem.where is not None
        assert problem.where.file == str(path)
        problems.append(str(problem).removeprefix(f"{path}:"))
    return problems


def mission(nodes: str) -> str:
    part = '<BehaviorTree ID="P"><stop/></BehaviorTree>'
    start = '<root BTCPP_format="4" main_tree_to_execute="M">'
    return f'{start}\n<BehaviorTree ID="M">\n{nodes}\n</BehaviorTree>\n{part}</root>'


NODES: dict[str, tuple[str, str]] = {
    "an unknown node": ("<ReactivSequence/>", "3: unknown node 'ReactivSequence' (did you mean 'ReactiveSequence'?)"),
    "an unknown leaf": ('<Action ID="drvie"/>', "3: unknown node 'drvie' (did you mean 'drive'?)"),
    "a leaf that is not registered": ("<xyzzy/>", "3: unknown node 'xyzzy' (register it, or declare the tree)"),
    "a node of version 3": (
        "<SequenceStar><stop/></SequenceStar>",
        "3: the node 'SequenceStar' is of BehaviorTree.CPP v3 (write SequenceWithMemory)",
    ),
    "a node that each program must register": (
        "<ConsumeQueue><stop/></ConsumeQueue>",
        "3: the node 'ConsumeQueue' of BehaviorTree.CPP is not built in (write <LoopInt>,",
    ),
    "a tree as a node": ("<M/>", "3: 'M' is a tree, not a node (write <SubTree ID=\"M\"/>)"),
    "an action without an ID": ("<Action/>", '3: <Action> without an ID (write <Action ID="..."/>)'),
    "an ID too many": (
        '<stop ID="x"/>',
        '3: <stop> cannot have an ID (write name="..." or <Action ID="stop">)',
    ),
    "no child": ("<Inverter/>", "3: <Inverter> has 0 children (Inverter takes 1)"),
    "no children": ("<Sequence/>", "3: <Sequence> has 0 children (Sequence takes at least 1)"),
    "too few children": (
        "<IfThenElse><stop/></IfThenElse>",
        "3: <IfThenElse> has 1 children (IfThenElse takes 2 to 3)",
    ),
    "a child of a leaf": ("<stop><stop/></stop>", "3: <stop> has 1 children (stop takes none)"),
    "more children needed to succeed than there are": (
        '<Parallel success_count="3"><stop/><stop/></Parallel>',
        "3: success_count is 3, but <Parallel> has 2 children (at most 2, or -1 for all of them)",
    ),
    "more children needed to fail than there are": (
        '<ParallelAll max_failures="2"><stop/></ParallelAll>',
        "3: max_failures is 2, but <ParallelAll> has 1 children (at most 1, or -1 for all of them)",
    ),
    "an unknown port": (
        '<drive speed="1" gaer="2"/>',
        "3: drive has no port 'gaer' (did you mean 'gear'?)",
    ),
    "a port of a node without ports": (
        '<Sequence foo="1"><stop/></Sequence>',
        "3: Sequence has no port 'foo' (it has none)",
    ),
    "a missing port": ("<drive/>", "3: drive needs the port 'speed' (write speed=\"...\")"),
    "a missing port of a decorator": (
        "<RetryUntilSuccessful><stop/></RetryUntilSuccessful>",
        "3: RetryUntilSuccessful needs the port 'num_attempts' (write num_attempts=\"...\")",
    ),
    "a port of the wrong type": (
        '<drive speed="fast"/>',
        "3: speed: 'fast' is not a number (a value of type float, or {key})",
    ),
    "a decimal for a whole number": (
        '<drive speed="1" gear="1.5"/>',
        "3: gear: 1.5 is not a whole number (a value of type int, or {key})",
    ),
    "neither true nor false": (
        '<RunOnce then_skip="perhaps"><stop/></RunOnce>',
        "3: then_skip: 'perhaps' is not true or false (a value of type bool, or {key})",
    ),
    "an output that names no entry": (
        '<look seen="animal"/>',
        "3: the port 'seen' must name an entry of the blackboard (write seen=\"{animal}\")",
    ),
    "a number of attempts that means nothing": (
        '<RetryUntilSuccessful num_attempts="-2"><stop/></RetryUntilSuccessful>',
        "3: 'RetryUntilSuccessful' cannot be made: num_attempts of 'RetryUntilSuccessful' must be a number, "
        "or -1 for ever, not -2",
    ),
    "one entry with two types": (
        '<Sequence><Repeat num_cycles="{n}"><stop/></Repeat>\n<drive speed="{n}"/></Sequence>',
        "4: speed: the entry 'n' is int and cannot be float too",
    ),
    "an action name that is not known yet": (
        '<is_action_feasible action_name="{a}"/>',
        "3: 'is_action_feasible' cannot be made: port 'action_name': nothing was written to the entry 'a' on the "
        "blackboard; it must be known when the tree is loaded",
    ),
    "an action without a skill": (
        '<RosaAction action_name="stop"/>',
        "3: 'RosaAction' cannot be made: there is no skill for the action 'stop' in the registry",
    ),
    "a script that cannot be read": (
        '<Script code="x := (1"/>',
        "3: code: it ends in the middle of a statement; expected ')'",
    ),
    "a condition that cannot be read": ('<stop _skipIf="a = = 1"/>', "3: _skipIf: column 5: '=' cannot stand here"),
    "an empty condition": ('<stop _while=""/>', "3: _while: the script is empty (leave it out)"),
    "a misspelt condition": ('<stop _skipif="1"/>', "3: unknown attribute '_skipif' (did you mean '_skipIf'?)"),
    "a subtree that is not there": ('<SubTree ID="N"/>', "3: there is no tree 'N', which 'M' uses"),
    "two subtrees of one name": (
        '<Sequence><SubTree ID="P" name="part"/>\n<SubTree ID="P" name="part"/></Sequence>',
        "4: there is a second SubTree named 'part' in this tree (give it another name, or leave the name out)",
    ),
    "a time to sleep that is negative": (
        '<Sleep msec="-5"/>',
        "3: msec is -5: a time cannot be negative (a number of ms, 0 or more)",
    ),
    "a negative timeout": ('<Timeout msec="-5"><stop/></Timeout>', "3: msec is -5: a time cannot be negative"),
    "a negative delay": ('<Delay delay_msec="-1"><stop/></Delay>', "3: delay_msec is -1: a time cannot be negative"),
    "a loop over what is no number": (
        '<LoopInt queue="1;x"><stop/></LoopInt>',
        "3: 'LoopInt' cannot be made: 'x' is not a whole number",
    ),
    "a loop that ends in something unknown": (
        '<LoopInt queue="1" if_empty="DONE"><stop/></LoopInt>',
        "3: 'LoopInt' cannot be made: if_empty: 'DONE' is not one of SUCCESS, FAILURE, RUNNING, SKIPPED",
    ),
    "an update of no entry": ("<WasEntryUpdated/>", "3: WasEntryUpdated needs the port 'entry'"),
    "an update of an empty entry": (
        '<WaitValueUpdate entry=""><stop/></WaitValueUpdate>',
        "3: 'WaitValueUpdate' cannot be made: port 'entry' must name an entry of the blackboard",
    ),
    "nothing to try": ("<TryCatch><stop/></TryCatch>", "3: <TryCatch> has 1 children (TryCatch takes at least 2)"),
    "a port with JSON that is none": (
        '<drive speed="json:{"/>',
        "3: speed: 'json:{' is no JSON: ",
    ),
    "two asynchronous children of a reactive sequence": (
        "<ReactiveSequence><AsyncSequence><stop/></AsyncSequence>\n"
        '<Control ID="AsyncSequence"><stop/></Control></ReactiveSequence>',
        "4: a ReactiveSequence cannot have more than one AsyncSequence",
    ),
    "a subtree without an ID": ("<SubTree/>", "3: <SubTree> without an ID"),
    "a subtree with children": ('<SubTree ID="M"><stop/></SubTree>', "3: <SubTree> cannot have children"),
    "an autoremap that is neither": (
        '<SubTree ID="M" _autoremap="yes"/>',
        "3: _autoremap: 'yes' is not true or false (a value of type bool, or {key})",
    ),
    "a tree that contains itself": ('<SubTree ID="M"/>', "3: a tree contains itself: M > M"),
    "conditions of a root that is a leaf": (
        '<stop _skipIf="1"/>',
        "3: the conditions of 'stop' do not count at the root (put it in a <Sequence>)",
    ),
    "conditions below a composite of py_trees": (
        '<Choose memory="true"><stop _skipIf="1"/></Choose>',
        "3: the conditions of 'stop' do not count below a 'Choose' (put it in a <Sequence>)",
    ),
    "two roots": ("<stop/><stop/>", "2: <BehaviorTree> has 2 nodes in it (it must have exactly one: its root)"),
    "no root": ("", "2: <BehaviorTree> has 0 nodes in it (it must have exactly one: its root)"),
}


@pytest.mark.parametrize("name", NODES)
def test_a_node_that_cannot_be(name: str, tmp_path: Path) -> None:
    nodes, message = NODES[name]
    (problem,) = refusal(tmp_path, mission(nodes))
    assert problem.startswith(message)


FILES: dict[str, tuple[str, str]] = {
    "another root": ("<Root/>", '1: the outermost element is <Root> (it must be <root BTCPP_format="4">)'),
    "version 3": (
        '<root BTCPP_format="3"/>',
        "1: this is BehaviorTree.CPP v3 (it says so); only version 4 is read (convert it: rosa tree OLD.xml --upgrade "
        "NEW.xml)",
    ),
    "no tree": ('<root BTCPP_format="4"/>', " it does not say which tree to run (add <BehaviorTree>)"),
    "no main tree": (
        '<root><BehaviorTree ID="A"><stop/></BehaviorTree><BehaviorTree ID="B"><stop/></BehaviorTree></root>',
        " it does not say which tree to run (say main_tree_to_execute= one of A, B)",
    ),
    "a main tree that is not there": (
        '<root main_tree_to_execute="Main"><BehaviorTree ID="Mian"><stop/></BehaviorTree></root>',
        " there is no tree 'Main' (did you mean 'Mian'?)",
    ),
    "a tree twice": (
        '<root><BehaviorTree ID="A"><stop/></BehaviorTree>\n<BehaviorTree ID="A"><stop/></BehaviorTree></root>',
        "2: there is more than one tree 'A': ",
    ),
    "something else at the top": (
        '<root><BehaviourTree ID="A"/></root>',
        "1: <BehaviourTree> cannot stand here (did you mean 'BehaviorTree'?)",
    ),
    "an include without a path": (
        '<root><include/><BehaviorTree ID="A"><stop/></BehaviorTree></root>',
        '1: <include> without a path (write <include path="other.xml"/>)',
    ),
    "an include of a ROS package": (
        '<root><include ros_pkg="p" path="a.xml"/><BehaviorTree ID="A"><stop/></BehaviorTree></root>',
        "1: the folder of the ROS package 'p' is not known (say where it is: ros_packages=, --ros-package NAME=DIR)",
    ),
    "an include that is not there": (
        '<root>\n<include path="a.xml"/><BehaviorTree ID="A"><stop/></BehaviorTree></root>',
        "2: 'a.xml': cannot read it: No such file or directory",
    ),
    "an include of itself": (
        '<root><include path="mission.xml"/><BehaviorTree ID="A"><stop/></BehaviorTree></root>',
        "1: 'mission.xml' includes itself, directly or through others",
    ),
    "an include outside the folder": (
        '<root><include path="../a.xml"/><BehaviorTree ID="A"><stop/></BehaviorTree></root>',
        "1: '../a.xml' is outside the mission's folder (put it beside or below the mission)",
    ),
    "an absolute include": (
        '<root><include path="/etc/passwd"/><BehaviorTree ID="A"><stop/></BehaviorTree></root>',
        "1: '/etc/passwd' is outside the mission's folder (put it beside or below the mission)",
    ),
    "a model of a port that the leaf has not": (
        '<root><BehaviorTree ID="A"><drive speed="1"/></BehaviorTree>\n'
        '<TreeNodesModel><Action ID="drive">\n<input_port name="sped"/></Action></TreeNodesModel></root>',
        "2: the model of 'drive' has a port 'sped', which the registered leaf has not (did you mean 'speed'?)",
    ),
    "a model of a port in the wrong direction": (
        '<root><BehaviorTree ID="A"><drive speed="1"/></BehaviorTree>\n'
        '<TreeNodesModel><Action ID="drive"><output_port name="speed"/></Action></TreeNodesModel></root>',
        "2: the port 'speed' of 'drive' is an input_port, not an output_port",
    ),
    "a tree that has the name of a built-in node": (
        '<root><BehaviorTree ID="Sequence"><stop/></BehaviorTree></root>',
        "1: the tree 'Sequence' has the name of a node (give it another ID)",
    ),
    "a tree that has the name of a leaf": (
        '<root main_tree_to_execute="A"><BehaviorTree ID="A"><SubTree ID="stop"/></BehaviorTree>\n'
        '<BehaviorTree ID="stop"><stop/></BehaviorTree></root>',
        "2: the tree 'stop' has the name of a node",
    ),
    "a tree without an ID beside another": (
        '<root main_tree_to_execute="A"><BehaviorTree ID="A"><stop/></BehaviorTree>\n'
        "<BehaviorTree><stop/></BehaviorTree></root>",
        "2: <BehaviorTree> without an ID, beside others (give it a name)",
    ),
    "a subtree without a port that its model demands": (
        '<root main_tree_to_execute="A"><BehaviorTree ID="A">\n<SubTree ID="B"/></BehaviorTree>'
        '<BehaviorTree ID="B"><stop/></BehaviorTree>'
        '<TreeNodesModel><SubTree ID="B"><input_port name="n"/></SubTree></TreeNodesModel></root>',
        "2: the SubTree 'B' needs the port 'n' (write n=\"...\", or _autoremap=\"true\")",
    ),
    "no XML": ("hello", "1: not valid XML: syntax error"),
    "an empty file": ("", "1: not valid XML: no element found"),
    "an element that does not end": ("<root>\n<a>\n</root>", "3: not valid XML: mismatched tag"),
    "an attribute twice": ('<root a="1" a="2"/>', "1: not valid XML: duplicate attribute"),
    "a bare && in a script": (
        '<root>\n<a code="x &gt; 1 && y"/></root>',
        "2: not valid XML: a bare '&' (in XML, && is written &amp;&amp; and < is written &lt;)",
    ),
    "a bare < in a script": (
        '<root>\n<a code="x < 1"/></root>',
        "2: not valid XML: a bare '<' in an attribute (in XML, && is written &amp;&amp; and < is written &lt;)",
    ),
    "an entity that does not end": ('<root><a code="x &lt 1"/></root>', "1: not valid XML: a bare '&'"),
    "an entity of HTML": ('<root><a code="&nbsp;"/></root>', "1: not valid XML: an entity that XML has not"),
    "-- in a comment": ("<root>\n<!-- a -- b --></root>", "2: not valid XML: '--' inside a comment"),
    "a comment that ends with --->": ("<root><!-- a ---></root>", "1: not valid XML: '--' inside a comment"),
    "a line before the declaration": (
        '\n<?xml version="1.0"?><root/>',
        "2: not valid XML: there is something before the XML begins (delete what stands before",
    ),
    "text before the root": ("// mission\n<root/>", "1: not valid XML: there is something before the XML begins"),
    "two roots of a file": ("<root/>\n<root/>", "2: not valid XML: there is something after the outermost element"),
    "a file of version 3 that does not say so": (
        '<root><BehaviorTree ID="A">\n<SequenceStar><stop/><SequenceStar/></SequenceStar></BehaviorTree></root>',
        "1: this is BehaviorTree.CPP v3 (<SequenceStar> in line 2); only version 4 is read (convert it: rosa tree",
    ),
    "an entity": (
        '<!DOCTYPE r [<!ENTITY a "b">]>\n<root>&a;</root>',
        "1: document types and entities are not allowed (leave the <!DOCTYPE ...> out)",
    ),
    "an external document type": (
        '<!DOCTYPE root SYSTEM "http://127.0.0.1:9/x.dtd">\n<root/>',
        "1: document types and entities are not allowed",
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_cannot_be_used(name: str, tmp_path: Path) -> None:
    text, message = FILES[name]
    (problem,) = refusal(tmp_path, text)
    assert problem.startswith(message)


def test_everything_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    nodes = '<Sequence>\n<Inverter/>\n<drive sped="1"/>\n<Nope/>\n</Sequence>'
    assert [problem.partition(":")[0] for problem in refusal(tmp_path, mission(nodes))] == ["4", "5", "5", "6"]


def test_what_an_included_file_has_wrong_is_told_with_its_name(tmp_path: Path) -> None:
    (tmp_path / "part.xml").write_text('<root>\n<BehaviorTree ID="P"><Nope/></BehaviorTree></root>', encoding="utf-8")
    path = tmp_path / "mission.xml"
    path.write_text('<root><include path="part.xml"/><BehaviorTree ID="A"><SubTree ID="P"/></BehaviorTree></root>')
    with pytest.raises(InputError, match=r"part\.xml:2: unknown node 'Nope'"):
        load_tree(path, LEAVES)


def test_a_circle_of_subtrees_is_told_in_full(tmp_path: Path) -> None:
    text = '<root main_tree_to_execute="A">' + "".join(
        f'<BehaviorTree ID="{one}"><SubTree ID="{other}"/></BehaviorTree>' for one, other in ("AB", "BC", "CB")
    )
    assert refusal(tmp_path, text + "</root>") == ["1: a tree contains itself: B > C > B"]


def test_a_tree_that_was_asked_for_must_be_there(tmp_path: Path) -> None:
    assert refusal(tmp_path, mission("<stop/>"), tree="N") == [" there is no tree 'N' (there is: M, P)"]


def _deep(depth: int) -> str:
    return mission("<Inverter>" * depth + "<stop/>" + "</Inverter>" * depth)


def _doubling(levels: int) -> str:
    trees = "".join(
        f'<BehaviorTree ID="T{n}"><Sequence><SubTree ID="T{n + 1}"/><SubTree ID="T{n + 1}"/></Sequence></BehaviorTree>'
        for n in range(levels)
    )
    return f'<root main_tree_to_execute="T0">{trees}<BehaviorTree ID="T{levels}"><stop/></BehaviorTree></root>'


def _chain(length: int) -> str:
    trees = "".join(
        f'<BehaviorTree ID="T{n}"><Inverter><SubTree ID="T{n + 1}"/></Inverter></BehaviorTree>' for n in range(length)
    )
    return f'<root main_tree_to_execute="T0">{trees}<BehaviorTree ID="T{length}"><stop/></BehaviorTree></root>'


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: _deep(10_000), "nested more than 200 levels deep"),
        (lambda: _deep(200), "more than 200 levels deep"),
        (lambda: _chain(1000), "the tree is more than 200 levels deep, subtrees counted in"),
        (lambda: _doubling(30), "the tree has more than 20000 nodes"),
        (lambda: "<root>" + " " * 4_000_001 + "</root>", "it has more than 4,000,000 bytes"),
        (lambda: mission(f'<stop {"x" * 3_000_000}="1"/>'), "stop has no port 'xxxx"),
        (lambda: mission(f'<drive speed="{"9" * 3_000_000}"/>'), "speed: '9999"),
        (lambda: mission(f'<Script code="{"(" * 3_000_000}"/>'), "it has 3000000 characters"),
    ],
)
def test_what_is_too_much_is_one_short_error(make: Callable[[], str], message: str, tmp_path: Path) -> None:
    (problem,) = refusal(tmp_path, make())
    assert message in problem
    assert len(problem) < 500


def test_the_deepest_tree_that_is_allowed_is_loaded_and_halted(tmp_path: Path) -> None:
    path = tmp_path / "deep.xml"
    path.write_text(_deep(199), encoding="utf-8")
    root = load_tree(path, LEAVES)
    root.tick_once()
    root.stop()


@pytest.mark.parametrize("nodes", ["<Nothing/>\n" * 1000, "<stop " + " ".join(f'p{n}="1"' for n in range(1000)) + "/>"])
def test_of_a_thousand_problems_a_hundred_are_told(nodes: str, tmp_path: Path) -> None:
    problems = refusal(tmp_path, mission(f"<Sequence>{nodes}</Sequence>"))
    assert len(problems) == 101
    assert problems[-1].endswith("that is enough; there may be more")


def test_problems_of_included_files_are_counted_once(tmp_path: Path) -> None:
    (tmp_path / "more.xml").write_text("<root>" + "<Oops/>\n" * 1000 + "</root>", encoding="utf-8")
    path = tmp_path / "mission.xml"
    path.write_text('<root><include path="more.xml"/></root>', encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_tree(path, LEAVES)
    assert len(error.value.problems) == 101


def test_built_in_names_cannot_be_registered() -> None:
    with pytest.raises(ValueError, match="'Sequence' is the name of a built-in node"):
        Registry({"Sequence": lambda: None})
    with pytest.raises(TypeError, match="must be a behaviour class, a Skill or a function"):
        Registry({"x": 3})
    with pytest.raises(TypeError, match="has no name"):
        Registry({"x": lambda *args: None})
