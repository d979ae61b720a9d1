"""TypeQL, PDDL, trees in XML, scripts of trees."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import suave
from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.errors import QueryError
from task_layer.bt import load_tree
from task_layer.bt.ports.blackboard import Blackboard
from task_layer.bt.scripting import Scope, ScriptError, compile_script
from task_layer.pddl import parse_task
from tests.fuzz.harness import fuzzed, result_or_refusal
from tests.fuzz.mutations import Change, changed_bytes, changed_tokens, changed_xml, tokens_of
from tests.task_layer.bt_xml.random_trees import LEAVES

SUAVE = Path(str(suave.__file__)).parent

MODEL = """
insert
$light isa MeasurableAttribute, has name "light"; $light2 isa QualityAttribute, has name "speed";
$explore isa Action, has name "explore"; $see isa Function, has name "see", has always-improve true;
$camera isa Component, has name "camera"; $lidar isa LifeCycleNode, has name "lidar", has package "p";
$need (action:$explore, required-function:$see) isa functional-requirement;
$look (function:$see, required-component:$camera, required-component:$lidar) isa function-design,
  has name "look", has priority 1.5;
$enough (measure:$light, constrained:$look) isa constraint, has operator ">=", has value 2.5;
$p isa ComponentParameter, has key "rate", has value "10", has type "double";
$fast (component:$lidar, parameter:$p) isa component-configuration, has name "fast", has priority 1.0;
"""
TYPEQL = (
    "isa ", "has ", "name ", "insert ", "match ", "delete ", "fetch ", "get ", "$x ", "$_ ", "; ", ", ", "(", ")",
    "Action ",
    "function-design ", "constraint ", "relation ", "like ", "contains ", "not {", "} or {", "limit 3;", "offset -1;",
    "sort $x desc;", "group $x;", "count;", "99999999999999999999 ", "'\\", "#", "iid 0x1 ", "rule ", "$x == $y; ",
)  # fmt: skip
QUERY = """match $a isa Action, has name $n; $f isa Function, has name like "^s.*";
(action: $a, required-function: $f) isa functional-requirement; not { $n == "x"; }; get $n, $a; sort $n; limit 5;"""

DOMAIN = """(define (domain d) (:requirements :strips :typing :durative-actions :negative-preconditions)
(:types place - object robot) (:predicates (at ?r - robot ?p - place) (action_feasible ?a) (seen ?p - place))
(:constants look - object)
(:durative-action go :parameters (?r - robot ?a ?b - place) :duration (= ?duration 5)
 :condition (and (at start (at ?r ?a)) (over all (action_feasible look)))
 :effect (and (at start (not (at ?r ?a))) (at end (at ?r ?b))))
(:action look :parameters (?p - place) :precondition (and (action_feasible look) (or (seen ?p) (not (seen ?p))))
 :effect (when (not (seen ?p)) (seen ?p))))"""
PROBLEM = """(define (problem p) (:domain d) (:objects a b c - place r - robot) (:init (at r a) (action_feasible look))
(:goal (and (at r b) (seen c) (forall (?p - place) (seen ?p)))))"""
PDDL = (
    "(", ")", "and ", "or ", "not ", "forall ", "exists ", "when ", "imply ", "(:action x)", ":parameters ", "?x ",
    "- ",
    "- (either place robot) ", "at start ", "at end ", "over all ", "(increase (total-cost) 1)",
    "(:functions (total-cost))",
    "(:derived (x) (y))", "(= ?x ?y)", "object ", "number ", ":adl ", "define ", ";", "1e9 ", "(assign (f) 1)", "#t ",
    "(:metric minimize (total-cost))", "?a ?b ?c ?d ?e ?f ?g ?h - object ",
)  # fmt: skip

TREE = """<root BTCPP_format="4" main_tree_to_execute="main"><BehaviorTree ID="main"><Sequence name="s">
<Script code="x := 1; y:='a'"/><Repeat num_cycles="3"><AlwaysSuccess _skipIf="x == 1" name="{n}"/></Repeat>
<Fallback _onSuccess="x = 2"><ForceFailure><SubTree ID="other" a="{x}" _autoremap="true"/></ForceFailure><Delay
 delay_msec="5"><AlwaysFailure/></Delay></Fallback><Parallel success_count="1" failure_count="1"><AlwaysSuccess/>
<RetryUntilSuccessful num_attempts="{x}"><ScriptCondition code="x &gt; 1"/></RetryUntilSuccessful></Parallel>
<Switch2 variable="{x}" case_1="1" case_2="2"><AlwaysSuccess/><AlwaysFailure/><SetBlackboard value="3" output_key="z"/>
</Switch2></Sequence></BehaviorTree>
<BehaviorTree ID="other"><Timeout msec="10"><Sleep msec="1"/></Timeout></BehaviorTree>
<TreeNodesModel><Action ID="Move"><input_port name="speed" type="double" default="1">x</input_port></Action>
<SubTree ID="other"><input_port name="a"/></SubTree></TreeNodesModel></root>"""
XML = (
    "Sequence", "Fallback", "ReactiveSequence", "Parallel", "ParallelAll", "Repeat", "SubTree", "BehaviorTree",
    "include",
    "TreeNodesModel", "Switch3", "Switch99", "Inverter", "KeepRunningUntilFailure", "IfThenElse", "WhileDoElse",
    "root",
    "AlwaysSuccess", "Script", "Action", "Condition", "Control", "Decorator", "ID", "name", "code", "path", "ros_pkg",
    "_skipIf", "_while", "_onHalted", "_autoremap", "num_cycles", "msec", "main", "other", "x := x + 'a'", "{x}",
    "{@x}",
    "x:=1;y:=x", "BTCPP_format", "3", "4", "-1", "main_tree_to_execute", "RunOnce", "SetBlackboard", "UnsetBlackboard",
)  # fmt: skip
SCRIPT = (
    "x := 1; y := 'ab' .. 'c'; z := (x + 2.5) * 3 / x; y += y; f := x < 2 && !(z > 3) ? x : -z; "
    "x = 0x1F & 3 | ~2; x -= 1"
)
SCRIPT_WORDS = (
    ":=", "=", "+=", "*=", "==", "&&", "||", "..", "?", ":", "(", ")", "!", "~", "-", "x", "y", "1e300", "'a'",
    "true", ";",
    "9223372036854775807", "0xFFFFFFFFFFFFFFFF", "1.", ".5", "@x", "y += y;", "RED",
)  # fmt: skip


@cache
def _knowledge() -> KnowledgeBase:
    return KnowledgeBase(KnowledgeModel.load(SUAVE / "models" / "suave.yaml"), clock=SimulationClock())


def test_models_in_typeql(folder: Path) -> None:
    path = folder / "model.tql"
    path.write_text(MODEL)
    tokens = tokens_of(MODEL)

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        path.write_text(changed_tokens(tokens, changes, TYPEQL), "utf-8", "replace")
        result_or_refusal(lambda: KnowledgeModel.load(path))

    check()


def test_queries_in_typeql() -> None:
    tokens = tokens_of(QUERY)

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        text = changed_tokens(tokens, changes, TYPEQL)
        result_or_refusal(lambda: _knowledge().query(text), QueryError)

    check()


def test_domains_and_problems_in_pddl() -> None:
    domain, problem = tokens_of(DOMAIN), tokens_of(PROBLEM)
    assert result_or_refusal(lambda: parse_task(DOMAIN, PROBLEM)) is not None

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        in_domain = changed_tokens(domain, [c for c in changes if c.where % 3], PDDL)
        in_problem = changed_tokens(problem, [c for c in changes if not c.where % 3], PDDL)
        result_or_refusal(lambda: parse_task(in_domain, in_problem))

    check()


def test_trees_with_other_elements_and_attributes(folder: Path) -> None:
    path = folder / "mission.xml"
    path.write_text(TREE)
    load_tree(path, LEAVES)

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        path.write_text(changed_xml(TREE, changes, XML), "utf-8", "replace")
        result_or_refusal(lambda: load_tree(path, LEAVES))

    check()


def test_text_that_is_hardly_xml(folder: Path) -> None:
    path = folder / "hardly.xml"
    tokens = tokens_of(TREE)
    vocabulary = (
        "<",
        "/>",
        "</",
        "<!DOCTYPE a [<!ENTITY b 'c'>]>",
        "&b;",
        "<![CDATA[",
        "]]>",
        "<!--",
        "-->",
        "<?x?>",
        *XML,
    )

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        text = changed_tokens(tokens, changes, vocabulary).encode("utf-8", "replace")
        path.write_bytes(changed_bytes(text, changes[4:]))
        result_or_refusal(lambda: load_tree(path, LEAVES))

    check()


def test_scripts_that_run_again_and_again() -> None:
    tokens = tokens_of(SCRIPT)

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        text = changed_tokens(tokens, changes, SCRIPT_WORDS)
        blackboard = Blackboard()

        def run() -> object:
            script = compile_script(text)
            for _ in range(20):
                script.run(Scope(blackboard, {"RED": 2.0}))
            return script

        result_or_refusal(run, ScriptError)
        for name in blackboard.names():
            assert len(str(blackboard.entry(name).value)) <= 10_000

    check()
