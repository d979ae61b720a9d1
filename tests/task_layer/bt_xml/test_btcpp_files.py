"""Ports, blackboards, subtrees and scripts through XML, compared with BehaviorTree.CPP on the same file."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.task_layer.bt_xml.btcpp import mission, script, with_btcpp, with_loader

S = script
_SWITCH = "<AlwaysSuccess/><AlwaysFailure/><AlwaysSuccess/>"

MISSIONS = {
    "an entry that is remapped is the one above": mission(
        S("a:=1"), '<SubTree ID="S" x="{a}"/>', subtree=S("x:=2; y:=3")
    ),
    "an entry above keeps its kind": mission(S("a:=1"), '<SubTree ID="S" x="{a}"/>', subtree=S("x:=2.5")),
    "a subtree makes the entry above": mission('<SubTree ID="S" x="{a}"/>', subtree=S("x:=2.5")),
    "a constant of a subtree is a text": mission('<SubTree ID="S" x="5"/>', subtree=S("@r:=x")),
    "a constant that is no number": mission('<SubTree ID="S" x="5 m"/>', subtree=S("@r:=x+1")),
    "a constant stays a text": mission('<SubTree ID="S" x="5 m"/>', subtree=S("x:=7")),
    "an empty constant": mission('<SubTree ID="S" x=""/>', subtree=S("@r:=x")),
    "autoremap shares all but private entries": mission(
        S("a:=1"), '<SubTree ID="S" _autoremap="true"/>', subtree=S("a:=2; b:=3; _p:=4; @q:=_p")
    ),
    "autoremap may be 1": mission('<SubTree ID="S" _autoremap="1"/>', subtree=S("b:=3")),
    "without autoremap nothing is shared": mission(
        S("a:=1"), '<SubTree ID="S" _autoremap="false"/>', subtree=S("b:=a")
    ),
    "a port wins over autoremap": mission(S("a:=1"), '<SubTree ID="S" a="{b}" _autoremap="true"/>', subtree=S("a:=2")),
    "{=} is the entry of the same name": mission(S("a:=1"), '<SubTree ID="S" a="{=}"/>', subtree=S("a:=2")),
    "a port may be remapped to the root blackboard": mission(
        S("a:=1"), '<SubTree ID="S" x="{@a}"/>', subtree=S("x:=2")
    ),
    "spaces in a key count": mission('<SubTree ID="S" x="{ a }"/>', subtree=S("x:=2")),
    "{} is no key": mission('<SubTree ID="S" x="{}"/>', subtree=S("@r:=x")),
    "@ is the root blackboard": mission('<SubTree ID="S"/>', subtree=S("@a:=1; @b:=@a+1")),
    "SetBlackboard writes a text": mission('<SetBlackboard value="3" output_key="k"/>', S("a:=k")),
    "that text is no number": mission('<SetBlackboard value="3" output_key="k"/>', S("a:=k+1")),
    "SetBlackboard copies an entry": mission(S("k:=1.5"), '<SetBlackboard value="{k}" output_key="j"/>'),
    "SetBlackboard replaces an entry": mission(S("k:=1.5;j:='a'"), '<SetBlackboard value="{k}" output_key="j"/>'),
    "SetBlackboard fails if there is nothing": mission('<SetBlackboard value="{k}" output_key="j"/>'),
    "the key of SetBlackboard may be an entry": mission(S("n:='j'"), '<SetBlackboard value="3" output_key="{n}"/>'),
    "SetBlackboard in a subtree": mission(
        '<SubTree ID="S" x="{a}"/>', subtree='<SetBlackboard value="3" output_key="x"/>'
    ),
    "SetBlackboard on the root blackboard": mission(
        '<SubTree ID="S"/>', subtree='<SetBlackboard value="3" output_key="@k"/>'
    ),
    "SetBlackboard with an empty text": mission('<SetBlackboard value="" output_key="k"/>'),
    "UnsetBlackboard removes": mission(S("k:=1"), '<UnsetBlackboard key="k"/>'),
    "UnsetBlackboard of nothing": mission(S("k:=1"), '<UnsetBlackboard key="nope"/>'),
    "UnsetBlackboard leaves what is above": mission(
        S("a:=1"), '<SubTree ID="S" x="{a}"/>', subtree=S("x:=2") + '<UnsetBlackboard key="x"/>' + S("@w:=x")
    ),
    "a number for a port": mission(S("n:=2"), '<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>'),
    "a text for a port that is a number": mission(
        S("n:='2'"), '<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>', S("m:=n+1")
    ),
    "a decimal for a port that is whole": mission(S("n:=2.0"), '<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>'),
    "a decimal that is not whole": mission(S("n:=2.5"), '<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>'),
    "a text that is no number": mission(S("n:='x'"), '<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>'),
    "an entry that was never written": mission('<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>'),
    "a constant of a subtree as a number": mission(
        '<SubTree ID="S" n="2"/>', subtree='<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>'
    ),
    "a port through two blackboards": mission(
        S("a:=2"), '<SubTree ID="S" n="{a}"/>', subtree='<Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat>'
    ),
    "an optional entry of RunOnce": mission(S("f:=false"), '<RunOnce then_skip="{f}"><AlwaysFailure/></RunOnce>'),
    "a condition that is a variable": mission(S("x:=1"), '<ScriptCondition code="x"/>'),
    "a condition that is neither": mission(S("x:=3"), '<ScriptCondition code="x"/>'),
    "a condition that is a decimal": mission('<ScriptCondition code="1.5"/>'),
    "a condition that is negative": mission('<ScriptCondition code="-1.5"/>'),
    "a condition that is a text": mission("<ScriptCondition code=\"'true'\"/>"),
    "a condition with two statements": mission('<ScriptCondition code="x:=1; 0"/>'),
    "a node is skipped": mission('<AlwaysFailure _skipIf="1.0"/>', S("a:=1")),
    "everything is skipped": mission('<AlwaysFailure _skipIf="true"/>'),
    "a condition on a variable that is not there": mission('<AlwaysSuccess _skipIf="nope"/>'),
    "success instead of a tick": mission(S("a:=1"), '<AlwaysFailure _successIf="a==1"/>', S("b:=1")),
    "failure instead of a tick": mission(S("a:=1"), '<AlwaysSuccess _failureIf="a==1" _onFailure="b:=1"/>'),
    "failure comes before success": mission('<AlwaysSuccess _successIf="1" _failureIf="1"/>'),
    "skipped while not": mission('<AlwaysSuccess _while="0"/>', S("a:=1")),
    "afterwards": mission('<AlwaysSuccess _onSuccess="a:=1; b:=2" _onFailure="d:=1" _post="c:=a+b"/>'),
    "afterwards, in vain": mission('<AlwaysSuccess _onSuccess="a=1"/>'),
    "conditions of a subtree are about the tree above": mission(
        S("a:=1"), '<SubTree ID="S" x="{a}" _onSuccess="a=9; x:=8" _skipIf="a==2"/>', subtree=S("x:=2")
    ),
    "a Switch on nothing": mission(f'<Switch2 variable="{{v}}" case_1="1" case_2="2">{_SWITCH}</Switch2>'),
    "a Switch on a number": mission(S("v:=2"), f'<Switch2 variable="{{v}}" case_1="1" case_2="2">{_SWITCH}</Switch2>'),
    "a Switch on a decimal": mission(
        S("v:=2.0"), f'<Switch2 variable="{{v}}" case_1="1" case_2="2">{_SWITCH}</Switch2>'
    ),
    "a Switch on a text": mission(S("v:='b'"), f'<Switch2 variable="{{v}}" case_1="a" case_2="b">{_SWITCH}</Switch2>'),
    "a Switch with an entry as case": mission(
        S("v:=2;w:=2"), f'<Switch2 variable="{{v}}" case_1="1" case_2="{{w}}">{_SWITCH}</Switch2>'
    ),
    "a Switch on a constant": mission(f'<Switch2 variable="2" case_1="1" case_2="2">{_SWITCH}</Switch2>'),
    "a precondition that holds": mission('<Precondition if="1==1" else="RUNNING"><AlwaysSuccess/></Precondition>'),
    "a precondition that does not": mission('<Precondition if="1==2" else="RUNNING"><AlwaysSuccess/></Precondition>'),
    "a precondition fails by default": mission('<Precondition if="1==2"><AlwaysSuccess/></Precondition>'),
    "a precondition that skips": mission('<Precondition if="0" else="SKIPPED"><AlwaysFailure/></Precondition>'),
    "a loop with a counter": mission(
        S("i:=0"),
        '<KeepRunningUntilFailure><Sequence><ScriptCondition code="i&lt;3"/><Script code="i+=1"/></Sequence>'
        "</KeepRunningUntilFailure>",
    ),
    "a loop over a text": mission(
        '<LoopInt queue="1;2;3" value="{v}"><Script code="sum := v"/></LoopInt>', S("done := 1")
    ),
    "a loop whose child fails": mission(
        '<LoopInt queue="1;2;3" value="{v}"><ScriptCondition code="v &lt; 2"/></LoopInt>'
    ),
    "a loop over texts": mission('<LoopString queue="a;b" value="{v}"><AlwaysSuccess/></LoopString>'),
    "a loop over decimals": mission('<LoopDouble queue="0.5;1.5" value="{v}"><AlwaysSuccess/></LoopDouble>'),
    "a loop over truth values": mission('<LoopBool queue="true;false" value="{v}"><AlwaysSuccess/></LoopBool>'),
    "a loop over nothing": mission('<LoopInt queue="" value="{v}"><AlwaysSuccess/></LoopInt>', S("a := 1")),
    "a loop over nothing that fails": mission('<LoopInt queue="" if_empty="FAILURE"><AlwaysSuccess/></LoopInt>'),
    "a loop over nothing that is skipped": mission('<LoopInt queue="" if_empty="SKIPPED"><AlwaysSuccess/></LoopInt>'),
    "a loop whose child is skipped": mission('<LoopInt queue="1;2" value="{v}"><AlwaysFailure _skipIf="1"/></LoopInt>'),
    "a loop that begins again": mission(
        '<Repeat num_cycles="2"><LoopInt queue="1" value="{v}"><AlwaysSuccess/></LoopInt></Repeat>'
    ),
    "an entry was updated": mission(S("a := 1"), '<WasEntryUpdated entry="{a}"/>', S("b := 1")),
    "an entry was not updated": mission(S("a := 1"), '<WasEntryUpdated entry="{b}"/>'),
    "an entry was not updated again": mission(
        S("a := 1; n := 0"),
        '<Repeat num_cycles="-1"><Sequence><WasEntryUpdated entry="a"/><Script code="n += 1"/></Sequence></Repeat>',
    ),
    "an entry was updated by the same value": mission(
        S("a := 1; n := 0"),
        '<Repeat num_cycles="-1"><Sequence><WasEntryUpdated entry="a"/><Script code="n += 1; a := 1"/>'
        "</Sequence></Repeat>",
    ),
    "a constant of a subtree is an update": mission(
        '<SubTree ID="S" x="a"/>', subtree='<WasEntryUpdated entry="{x}"/>'
    ),
    "skipped unless there is an entry": mission(
        '<SkipUnlessUpdated entry="{a}"><AlwaysFailure/></SkipUnlessUpdated>', S("b := 1")
    ),
    "not skipped after an update": mission(
        S("a := 1"), '<SkipUnlessUpdated entry="{a}"><AlwaysFailure/></SkipUnlessUpdated>'
    ),
    "an update is waited for": mission('<WaitValueUpdate entry="{a}"><AlwaysSuccess/></WaitValueUpdate>', S("b := 1")),
    "an update has come": mission(
        S("a := 1"), '<WaitValueUpdate entry="{a}"><AlwaysSuccess/></WaitValueUpdate>', S("b := 1")
    ),
    "the ID form of built-in nodes": mission('<Decorator ID="Inverter"><Action ID="AlwaysFailure"/></Decorator>'),
    "attributes of the editor": mission('<AlwaysSuccess _description="d" _uid="7" _fullpath="x" name="n"/>'),
}


@pytest.mark.parametrize("name", MISSIONS)
def test_the_same_file_comes_to_the_same(name: str, tmp_path: Path) -> None:
    xml = MISSIONS[name]
    theirs, ours = with_btcpp(xml, ticks=3), with_loader(xml, tmp_path, ticks=3)
    assert (theirs.raised is None) == (ours.raised is None), (theirs.raised, ours.raised)
    if theirs.raised is None:
        assert (ours.statuses, ours.entries) == (theirs.statuses, theirs.entries)
