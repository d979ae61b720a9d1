"""Rules: what they mean, and what is wrong with them."""

from __future__ import annotations

import math

import pytest

from rosa_reflexes import Readings, RuleError, SensorLimits, parse_rule


def readings(**values: float) -> Readings:
    result = Readings([SensorLimits(name.replace("_", ".")) for name in values], {"limit": 0.35}, 0.0)
    for name, value in values.items():
        result.sample(name.replace("_", "."), value, 0.0)
    return result


@pytest.mark.parametrize(
    ("trigger", "front", "left", "fires"),
    [
        ("range.front < 0.35", 0.34, 9.0, True),
        ("range.front < 0.35", 0.35, 9.0, False),
        ("range.front <= 0.35", 0.35, 9.0, True),
        ("range.front < limit", 0.3, 9.0, True),
        ("min(range.front, range.left) < 0.35", 0.9, 0.2, True),
        ("range.front < 0.35 and range.left < 0.35", 0.2, 0.9, False),
        ("range.front < 0.35 or range.left < 0.35", 0.2, 0.9, True),
        ("not (range.front > 0.35)", math.nan, 0.9, True),
        ("range.front - range.left > 0.1 * 2 + 0.1", 1.0, 0.6, True),
        ("abs(range.front - range.left) >= 0.5", 0.0, 0.5, True),
        ("-range.front > -0.5", 0.4, 0.0, True),
        ("range.front < 2 * (limit - 0.05)", 0.59, 0.0, True),
        ("faulty(range.front)", math.nan, 0.0, True),
        ("faulty(range.front)", 1.0, 0.0, False),
        ("range.front < 1 / 0", 0.0, 0.0, False),
    ],
)
def test_a_trigger_holds_as_it_reads(trigger: str, front: float, left: float, fires: bool) -> None:
    rule = parse_rule(f"{trigger} -> stop")
    assert rule.trigger(readings(range_front=front, range_left=left)) is fires
    assert rule.trigger_text == trigger


@pytest.mark.parametrize(
    ("release", "front", "released"),
    [
        ("> 0.5", 0.51, True),
        ("> 0.5", 0.5, False),
        (">= 0.5 for 0.3 s", 0.5, True),
        ("range.front > limit + 0.1", 0.46, True),
        ("> 0.5", math.nan, False),
    ],
)
def test_a_release_condition_holds_as_it_reads(release: str, front: float, released: bool) -> None:
    rule = parse_rule(f"range.front < 0.35 -> stop; release {release}")
    assert rule.release is not None
    assert rule.release(readings(range_front=front)) is released


def test_a_rule_names_what_it_needs() -> None:
    rule = parse_rule("range.front < limit or faulty(range.left) -> turn; release range.back > 1 for 2.5 s")
    assert set(rule.names) == {"range.front", "limit", "range.left", "range.back"}
    assert rule.sensors == {"range.left"}
    assert (rule.command, rule.release_after) == ("turn", 2.5)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("range.front < 0.35", "says what is commanded"),
        ("range.front < -> stop", "from '> stop', at column 16"),
        ("range.front < 0.35 -> ", "too early"),
        ("range.front -> stop", "cannot be read"),
        ("range.front == 0.35 -> stop", "at column 13"),
        ("range.front < 0.35 -> stop; release > 0.2", "fire again at once"),
        ("range.front < 0.35 -> stop; release < 0.2", "never ends"),
        ("a < 1 and b < 1 -> stop; release > 2", "needs what it compares"),
        ("abs(a, b) < 1 -> stop", "abs takes one value"),
        ("a < 1 -> stop; release > 2 for 3", "too early"),
        ("(" * 30 + "a" + ")" * 30 + " < 1 -> stop", "nest at most 20 deep"),
        ("a < 1 -> stop" + " " * 2000, "at most 1000 characters"),
        ("__import__('os') < 1 -> stop", "cannot be read"),
    ],
)
def test_what_is_no_rule_says_why(text: str, why: str) -> None:
    with pytest.raises(RuleError, match=why):
        parse_rule(text)
