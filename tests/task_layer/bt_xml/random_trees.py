"""Random missions as XML: every node that there is, with ports, conditions and subtrees."""

from __future__ import annotations

from random import Random
from xml.sax.saxutils import escape

from task_layer.bt import Output, Registry
from task_layer.bt.types.node_source import CONDITION_ATTRIBUTES
from task_layer.skill import Skill, SkillStatus


class Wait(Skill):
    def update(self) -> SkillStatus:
        return SkillStatus.RUNNING


def measure(depth: float, times: int = 1, note: str = "{note}") -> bool:
    return depth > times


def report(text: str, said: Output[str]) -> None:
    said.set(text)


LEAVES = Registry({"measure": measure, "report": report, "wait": Wait, "do it": lambda: None}, enums={"RED": 7})

TREE_IDS = ("Main", "Part", "Other part")
_NAMES = ("a name", "a < b & 'c'", 'with "quotes"', "Füße 走る", "two\nlines", " spaces ", "{braces}")
_SCRIPTS = ("a := 1", "a == 1", "true", "b := 'x \"y\" <z>'; c := a + 1", "(a > 2) && !b")
_COUNTS = ("-1", "1", "2", "{n}")

_LEAVES: dict[str, dict[str, tuple[str, ...]]] = {
    "AlwaysSuccess": {},
    "AlwaysFailure": {},
    "Sleep": {"msec": ("0", "5", "{msec}")},
    "Script": {"code": _SCRIPTS},
    "ScriptCondition": {"code": _SCRIPTS},
    "SetBlackboard": {"value": ("text", "", "{other}"), "output_key": ("key", "{which}")},
    "UnsetBlackboard": {"key": ("key",)},
    "measure": {"depth": ("1.5", "{depth}"), "times": ("2", "{times}")},
    "report": {"text": ("a < b", "{text}"), "said": ("{said}",)},
    "wait": {},
    "Action": {"ID": ("do it",)},
    "WasEntryUpdated": {"entry": ("{depth}", "depth")},
    "IsActionFeasible": {"action_name": ("go",)},
    "RosaAction": {"action_name": ("wait",), "preference": ("energy",)},
}
_INNER: dict[str, tuple[int, int, dict[str, tuple[str, ...]]]] = {
    **dict.fromkeys(("Sequence", "AsyncSequence", "SequenceWithMemory", "ReactiveSequence"), (1, 3, {})),
    **dict.fromkeys(("Fallback", "AsyncFallback", "ReactiveFallback"), (1, 3, {})),
    **dict.fromkeys(("IfThenElse", "WhileDoElse"), (2, 3, {})),
    **dict.fromkeys(("Inverter", "ForceSuccess", "ForceFailure", "KeepRunningUntilFailure"), (1, 1, {})),
    "TryCatch": (2, 3, {"catch_on_halt": ("true", "{skip}")}),
    "ManualSelector": (1, 3, {"repeat_last_selection": ("false", "{skip}")}),
    "LoopInt": (1, 1, {"queue": ("1;2", "{numbers}"), "if_empty": ("FAILURE", "{else}"), "value": ("{n}",)}),
    "LoopString": (1, 1, {"queue": ("a;b", "{texts}"), "value": ("{text}",)}),
    "SkipUnlessUpdated": (1, 1, {"entry": ("{depth}",)}),
    "WaitValueUpdate": (1, 1, {"entry": ("depth",)}),
    "Parallel": (2, 3, {"success_count": ("1", "2", "-1"), "failure_count": ("1", "{failures}")}),
    "ParallelAll": (2, 3, {"max_failures": ("1", "-1", "{failures}")}),
    "RetryUntilSuccessful": (1, 1, {"num_attempts": _COUNTS}),
    "Repeat": (1, 1, {"num_cycles": _COUNTS}),
    "Timeout": (1, 1, {"msec": ("100", "{msec}")}),
    "Delay": (1, 1, {"delay_msec": ("100", "{msec}")}),
    "RunOnce": (1, 1, {"then_skip": ("true", "false", "{skip}")}),
    "Precondition": (1, 1, {"if": ("a == 1",), "else": ("SKIPPED", "{else}")}),
    "Switch2": (3, 3, {"variable": ("{v}", "1"), "case_1": ("1", "RED"), "case_2": ("two", "{w}")}),
    "Switch3": (4, 4, {"variable": ("{v}",), "case_1": ("1",), "case_2": ("2",), "case_3": ("3",)}),
}


def mission(random: Random) -> str:
    """A whole file; each of its trees may contain those after it."""
    trees = "".join(f'<BehaviorTree ID="{i}">{_node(random, n, 0)}</BehaviorTree>' for n, i in enumerate(TREE_IDS))
    return f'<root BTCPP_format="4" main_tree_to_execute="{TREE_IDS[0]}">{trees}</root>'


def _node(random: Random, tree: int, depth: int) -> str:
    is_root = tree == depth == 0  # the conditions of a leaf count only below a control node
    if is_root or (depth < 4 and random.random() < 0.7):
        tag = random.choice(sorted(_INNER))
        least, most, ports = _INNER[tag]
        children = [_node(random, tree, depth + 1) for _ in range(random.randint(least, most))]
        if tag == "ReactiveSequence" and sum(child.startswith("<AsyncSequence") for child in children) > 1:
            tag = "Sequence"  # such a ReactiveSequence is refused
        return f"<{tag}{_attributes(random, ports)}>{''.join(children)}</{tag}>"
    if tree + 1 < len(TREE_IDS) and random.random() < 0.2:
        ports = {"ID": TREE_IDS[tree + 1 :], "a": ("{b}", "{=}", "5"), "_autoremap": ("true", "false")}
        return f"<SubTree{_attributes(random, ports, number=random.randrange(10**6))}/>"
    tag = random.choice(sorted(_LEAVES))
    return f"<{tag}{_attributes(random, _LEAVES[tag])}/>"


def _attributes(random: Random, ports: dict[str, tuple[str, ...]], number: int | None = None) -> str:
    """The attributes of a node; with a number its name is one of its own."""
    attributes = {name: random.choice(texts) for name, texts in ports.items()}
    if random.random() < 0.4:
        attributes["name"] = random.choice(_NAMES) + ("" if number is None else str(number))
    for condition in random.sample(sorted(CONDITION_ATTRIBUTES), random.choice((0, 0, 0, 1, 2))):
        attributes[condition] = random.choice(_SCRIPTS)
    entities = {'"': "&quot;", "\n": "&#10;"}
    return "".join(f' {name}="{escape(text, entities)}"' for name, text in attributes.items())
