"""Queries in TypeQL: what they find, what rows look like, and what is said of those that cannot be."""

from __future__ import annotations

import json
from itertools import permutations
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeBase, KnowledgeModel, QueryError, SimulationClock
from rosa_typeql.matching.facts import Attribute, Thing
from rosa_typeql.queries.query import PreparedQuery
from rosa_typeql.queries.snapshot import snapshot
from rosa_typeql.schema.table import subtypes

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests" / "data"
MODEL = KnowledgeModel.load(DATA / "suave.tql", DATA / "suave_extended.tql")


@pytest.fixture
def clock() -> SimulationClock:
    return SimulationClock()


@pytest.fixture
def kb(clock) -> KnowledgeBase:
    return KnowledgeBase(MODEL, clock=clock)


def refusal(kb: KnowledgeBase, text: str) -> str:
    with pytest.raises(QueryError) as error:
        kb.query(text)
    return str(error.value)


class TestThePaper:
    LISTING_3 = """match $a isa Action, has name $name;
not {$a has status 'unfeasible';};
fetch $name;"""

    def test_listing_3_as_printed(self, kb):
        assert kb.query(self.LISTING_3) == [{"name": n} for n in ("search_pipeline", "inspect_pipeline", "recharge")]
        kb.add_measurement("battery_level", 0.2)
        assert kb.query(self.LISTING_3) == [{"name": "recharge"}]
        assert [row["name"] for row in kb.query(self.LISTING_3)] == kb.selectable_actions()

    def test_all_reconfiguration_plans_that_were_executed(self, kb, clock):
        """The example that the paper gives for what custom queries are good for."""
        executed = "match $p isa reconfiguration-plan, has result 'completed'; fetch $p: start-time, end-time;"
        kb.request_action("inspect_pipeline")
        plan = kb.select_configuration(["fd_recover_motion", "follow pipeline function design"], [])
        assert kb.query(executed) == []
        clock.advance_to(2.5)
        kb.set_reconfiguration_result(plan, "completed")
        assert kb.query(executed) == [{"p": {"start-time": 0.0, "end-time": 2.5}}]


class TestInferredFacts:
    @pytest.fixture
    def busy(self, kb, clock) -> KnowledgeBase:
        """Searching at low altitude, with the plan for it pending, after an inspection that failed."""
        kb.add_measurement("water_visibility", 3.0, time=0.5)
        kb.add_measurement("water_visibility", 2.0, time=1.5)
        kb.request_action("inspect_pipeline", preference="battery_level")
        clock.advance_to(2.0)
        kb.finish_action("inspect_pipeline", "failed")
        kb.request_action("search_pipeline")
        kb.set_component_active("c_thruster_1", True)
        kb.select_configuration(
            ["fd_recover_motion_inactive", "generate spiral search path function design"], ["low altitude"]
        )
        return kb

    @pytest.mark.parametrize(
        ("text", "rows"),
        [
            ("$a isa Action, has is-required true, has name $x;", ["search_pipeline"]),
            ("$f isa Function, has is-required true, has name $x;", ["generate search path", "recover motion"]),
            (
                "$d isa function-design, has is-selected true, has priority $p, has name $x;",
                ["fd_recover_motion_inactive"],
            ),
            ("$c isa component-configuration, has is-selected true, has name $x;", ["low altitude"]),
            ("$c isa Component, has is-active true, has name $x;", ["c_thruster_1"]),
            ("$c isa Component, has status 'solved', has name $x;", ["c_thruster_1"]),
            (
                "$c isa component-configuration, has status 'unfeasible', has name $x;",
                ["medium altitude", "high altitude"],
            ),
            (
                "$c (constrained: $e, $m) isa constraint, has constraint-status 'not evaluated'; $e has name $x;",
                ["search_pipeline", "inspect_pipeline"],
            ),
            ("$m isa measurement, has latest true, has measurement-value $x;", [2.0]),
            ("$m isa measurement, has value $x;", [3.0, 2.0]),
            ("$m (measure: $w) isa measurement, has latest false, has measurement-time $x;", [0.5]),
            ("(action: $a) isa required-action, has result 'failed', has end-time $x;", [2.0]),
            ("$r (action: $a) isa required-action; not {$r has result $any;}; $a has name $x;", ["search_pipeline"]),
            ("(action: $a, preference: $m) isa required-action; $m has name $x;", ["battery_level"]),
            (
                "$p (structural-adaptation: $s) isa reconfiguration-plan; not {$p has result $r;}; "
                "$s (component: $c) isa component-activation; $c has name $x; $x contains 'NODE';",
                ["f_generate_search_path_node"],
            ),
            (
                "(parameter-adaptation: $s) isa reconfiguration-plan; "
                "(component-configuration: $c) $s isa parameter-adaptation; $c has name $x;",
                ["low altitude"],
            ),
        ],
    )
    def test_are_found_like_stored_ones(self, busy, text, rows):
        assert [row["x"] for row in busy.query(f"match {text} get $x;")] == rows

    def test_abandoned_plans_stay_with_their_activations(self, busy, clock):
        busy.select_configuration(
            ["fd_recover_motion", "generate spiral search path function design"], ["low altitude"]
        )
        rows = busy.query(
            """match $p isa reconfiguration-plan, has result 'abandoned'; $p ($s); $s isa component-activation;
            $s (component: $c); $c has name $name; fetch $name; sort $name; limit 1;"""
        )
        assert rows == [{"name": "c_thruster_2"}]

    def test_a_deactivation(self, busy):
        busy.set_component_active("f_maintain_motion_node", True)
        busy.set_component_active("c_thruster_2", True)
        busy.select_configuration(
            ["fd_recover_motion_inactive", "generate spiral search path function design"], ["low altitude"]
        )
        assert busy.query("match (component: $c) isa component-deactivation; $c has name $n; fetch $n;") == [
            {"n": "f_maintain_motion_node"}
        ]

    def test_the_latest_measurement_is_known_even_if_the_history_has_forgotten_it(self, clock):
        kb = KnowledgeBase(MODEL, clock=clock, history_length=2)
        kb.add_measurement("battery_level", 0.9)
        for value in (1.0, 2.0, 3.0):
            kb.add_measurement("water_visibility", value)
        rows = kb.query("match ($m) isa measurement, has value $v, has latest $l; $m has name $n; get $n, $v, $l;")
        assert [tuple(row.values()) for row in rows] == [
            ("water_visibility", 2.0, False),
            ("water_visibility", 3.0, True),
            ("battery_level", 0.9, True),
        ]

    def test_a_late_measurement_is_not_the_latest(self, kb):
        kb.add_measurement("battery_level", 0.9, time=5.0)
        kb.add_measurement("battery_level", 0.1, time=3.0)
        assert kb.query("match $m isa measurement, has latest true, has value $v; get $v;") == [{"v": 0.9}]

    def test_the_same_measurement_twice_is_latest_once(self, kb):
        kb.add_measurement("battery_level", 0.9, time=5.0)
        kb.add_measurement("battery_level", 0.9, time=5.0)
        assert kb.query("match $m isa measurement, has latest true; get $m; count;") == [{"count": 1}]
        assert kb.query("match $m isa measurement; get $m; count;") == [{"count": 2}]

    def test_what_an_open_transaction_has_written_is_seen(self, kb):
        with kb.transaction():
            kb.add_measurement("battery_level", 0.2)
            assert kb.query("match $m isa measurement, has value $v; get $v;") == [{"v": 0.2}]
            assert len(kb.query(TestThePaper.LISTING_3)) == 1


class TestPatterns:
    @pytest.mark.parametrize(
        ("text", "count"),
        [
            ("$x isa Component;", 10),
            ("$x isa! Component;", 6),
            ("$x isa LifeCycleNode;", 4),
            ("$x isa! ROSNode;", 0),
            ("$x isa Attribute;", 2),
            ("$x isa! Measure;", 0),
            ("$x isa entity; not {$x isa Component;}; not {$x isa Measure;};", 3 + 4 + 3),
            ("$x isa Component, has package 'suave';", 4),
            ("$x isa Component, has name like 'c_thruster_[1-3]';", 3),
            ("$x isa Component, has name like 'thruster';", 0),
            ("$x has name $n; $n like '(c_.*|.*_node)';", 10),
            ("$x isa component-configuration, has priority > 1;", 2),
            ("$x isa component-configuration, has priority 1;", 1),
            ("$x isa component-configuration, has priority $p; $p >= 1; $p != 2.0;", 2),
            ("$x isa component-configuration, has priority $p; $p == 2;", 1),
            (
                "$x isa component-configuration, has priority $p; "
                "$y isa component-configuration, has priority $q; $p < $q;",
                2,
            ),
            ("$x isa function-design; not {$x has priority $p;};", 3),
            ("$x isa function-design; not {$x has priority $p; $p < 2;};", 4),
            ("$x (required-component: $c) isa function-design;", 5),
            ("$x (required-component: $c, required-component: $d) isa function-design;", 1),
            (
                "$x isa Component; (required-component: $x) isa function-design; "
                "not {(component: $x) isa component-configuration;};",
                9,
            ),
            (
                "$x isa Function; (required-function: $x, action: $a); "
                "(required-function: $x, action: $b); not {$a is $b;};",
                1,
            ),
            ("{$x isa Action;} or {$x isa Function;};", 7),
            ("{$x isa Action;} or {$x isa Action, has name 'recharge';};", 3),
            (
                "$x isa Function; {$x has always-improve true;} "
                "or {$x has name 'follow pipeline';} or {$x has name 'no';};",
                2,
            ),
            ("{$x isa Action; {$x has name 'recharge';};};", 1),
            ("$x isa Action; not {not {$x has name 'recharge';};};", 1),
            ("$x isa Action; not {{$x has name 'recharge';} or {$x has name 'search_pipeline';};};", 1),
            ("$x ($m) isa constraint; $m isa Measure, has name 'battery_level';", 2),
            ("$x (function: $f) isa function-design; {$x isa Action;} or {$x has priority 1;};", 1),
            ("$x isa Action; not {$x has priority 1;}; not {(function: $x) isa constraint;};", 3),
            ("$x has description $d;", 1),
            ("$x isa name;", 3 + 4 + 10 + 5 + 3 + 2),
            ("$x isa ComponentParameter, has key 'spiral_altitude', has value '1.0', has type 'double';", 1),
            ("$x isa thing, has name 'recharge';", 1),
            ("$x has name 'recharge'; $x isa Function;", 0),
            ("$_ (function: $x, required-component: $_) isa function-design;", 4),
            ("$x isa Action, has is-required false;", 3),
            ("$x isa Action, has name $n; $x has name $n;", 3),
            ("$x isa Action, has name > 'm';", 2),
            ("$x isa Action, has name > 3;", 0),
            (
                "(constraint: $m, constrained: $x) isa constraint; "
                "(constraint: $m, constrained: $y) isa constraint; not {$x is $y;};",
                5,
            ),
        ],
    )
    def test_find(self, kb, text, count):
        assert kb.query(f"match {text} get $x; count;") == [{"count": count}]

    @pytest.mark.parametrize(
        "statements",
        [
            (
                "$a isa Action, has name $n",
                "(action: $a, required-function: $f) isa functional-requirement",
                "$f has always-improve false",
                "(function: $f, required-component: $c) isa function-design",
                "$c has name $m",
            ),
            (
                "$x (component: $c, parameter: $p) isa component-configuration",
                "$p has value $n",
                "$n != '1.0'",
                "not {$x has priority 2}",
                "$c has status $m",
            ),
            (
                "{$f isa Function} or {$f isa Action}",
                "$f has name $n",
                "$n like '.*e.*'",
                "{$f has status $m} or {$f has name $m}",
            ),
        ],
    )
    def test_find_the_same_in_any_order(self, kb, statements):
        expected = None
        for order in list(permutations(statements))[::7]:
            rows = kb.query(f"match {'; '.join(order)}; get $n, $m; sort $n; sort $m;".replace("; sort $m", ", $m"))
            assert rows
            assert expected in (None, rows)
            expected = rows

    def test_what_rosas_own_interfaces_ask_of_typedb(self, kb):
        """The shapes of the reference implementation's own queries: what is adaptable, selectable, obsolete."""
        kb.request_action("search_pipeline")
        kb.select_configuration(["fd_recover_motion", "generate spiral search path function design"], ["low altitude"])
        adaptable = """match $t isa Function, has function-name $name;
            { $t has function-status $status; $status like 'unsolved|configuration error'; }
            or { $t has always-improve true; $t has function-status $status; $status like 'solved'; };
            fetch $name;"""
        assert [row["name"] for row in kb.query(adaptable)] == kb.adaptable_functions()
        selectable = """match $f isa Function, has function-name "recover motion";
            $fd (function: $f) isa function-design, has function-design-name $name;
            not { $fd has function-design-status 'unfeasible'; }; fetch $name;"""
        assert [row["name"] for row in kb.query(selectable)] == kb.selectable_function_designs("recover motion")
        kb.cancel_action("search_pipeline")
        obsolete = """match $cc (component:$c) isa component-configuration, has component-configuration-name $name,
            has is-selected true;
            not { $fd (function:$func, required-component:$c) isa function-design; $func has is-required true; };
            fetch $name;"""
        assert kb.query(obsolete) == [{"name": "low altitude"}]


def _names(thing: Thing) -> list[Attribute]:
    return [
        Attribute(label, v) for label, values in thing.attributes.items() if label.endswith("-name") for v in values
    ]


def _plays(relation: Thing, role: str, player: Thing) -> bool:
    return (role, player) in relation.players


_NAIVE = {
    "$x isa Component;": lambda x, y, n: x.type in ("Component", "LifeCycleNode"),
    "$y isa Function;": lambda x, y, n: y.type == "Function",
    "$x isa! Component;": lambda x, y, n: x.type == "Component",
    "$x isa relation;": lambda x, y, n: bool(x.players),
    "$y has always-improve true;": lambda x, y, n: y.attributes.get("always-improve") == (True,),
    "$x has priority > 1;": lambda x, y, n: x.attributes.get("priority", (0,))[0] > 1,
    "$y has name $n;": lambda x, y, n: n in _names(y),
    "$x has name $n;": lambda x, y, n: n in _names(x),
    "$n like '.*path.*|c_.*';": lambda x, y, n: "path" in n.value or n.value.startswith("c_"),
    "$n != 'recover motion';": lambda x, y, n: n.value != "recover motion",
    "$x (required-component: $y) isa function-design;": lambda x, y, n: _plays(x, "required-component", y),
    "$x (function: $y);": lambda x, y, n: _plays(x, "function", y),
    "$y (constrained: $x) isa constraint;": lambda x, y, n: _plays(y, "constrained", x) and y.type == "constraint",
    "$x ($y);": lambda x, y, n: any(player is y for _, player in x.players),
    "not {$x has priority $p;};": lambda x, y, n: "priority" not in x.attributes,
    "not {$x is $y;};": lambda x, y, n: x is not y,
    "not {$y has status 'feasible';};": lambda x, y, n: (
        "feasible" not in [v for label, values in y.attributes.items() if label.endswith("-status") for v in values]
    ),
    "{$x isa Action;} or {$x has name $n;};": lambda x, y, n: x.type == "Action" or n in _names(x),
    "{$y has package 'suave';} or {$y isa Function;};": lambda x, y, n: (
        "package" in y.attributes or y.type == "Function"
    ),
}


class TestAgainstTryingEverything:
    """Rows are what is found by trying every thing and every name for the variables, one condition after the other."""

    @settings(max_examples=40, deadline=None)
    @given(st.sets(st.sampled_from(sorted(_NAIVE)), min_size=1, max_size=4), st.randoms(use_true_random=False))
    def test_finds_the_same(self, conditions, random):
        kb = KnowledgeBase(KnowledgeModel.load(DATA / "suave.tql"), clock=SimulationClock())
        order = ["$x isa thing;", "$y isa thing;", "$n isa name;", *sorted(conditions)]
        random.shuffle(order)
        text = f"match {' '.join(order)} get $x, $y, $n;"
        facts = snapshot(kb._state, kb._history, subtypes("thing"))
        things = [thing for label in subtypes("thing") for thing in facts.of(label)]
        names = {name: None for thing in things for name in _names(thing)}
        expected = {
            (x, y, n)
            for x in things
            for y in things
            for n in names
            if all(_NAIVE[condition](x, y, n) for condition in conditions)
        }
        try:
            prepared = PreparedQuery(text)
        except QueryError:
            # What can never be is refused at once; then there is nothing to find.
            found = []
        else:
            found = [(s["x"], s["y"], s["n"]) for s in prepared._match.solutions(facts, 10**7)]
        assert len(found) == len(set(found))
        assert set(found) == expected


class TestRows:
    def test_the_same_every_time_and_in_order_of_declaration(self, kb):
        text = "match $c isa Component, has status $s, has name $n; get $n;"
        names = [row["n"] for row in kb.query(text)]
        assert sorted(names) == sorted(MODEL.names["component"])
        assert names == [row["n"] for row in kb.query(text)]
        thrusters = [name for name in names if "thruster" in name]
        assert thrusters == [f"c_thruster_{i}" for i in range(1, 7)]

    def test_are_distinct(self, kb):
        assert kb.query("match $c isa LifeCycleNode, has package $p; get $p;") == [{"p": "suave"}]

    def test_sorted_by_several_variables(self, kb):
        rows = kb.query(
            "match $c isa component-configuration, has status $s, has priority $p; get $s, $p; sort $s, $p desc;"
        )
        assert [row["p"] for row in rows] == [3.0, 2.0, 1.0]

    def test_sorted_by_what_is_not_fetched(self, kb):
        rows = kb.query("match $c isa component-configuration, has name $n, has priority $p; fetch $n; sort $p asc;")
        assert [row["n"].split()[0] for row in rows] == ["high", "medium", "low"]

    @pytest.mark.parametrize(
        ("modifiers", "expected"),
        [
            ("limit 2;", ["1", "2"]),
            ("offset 4;", ["5", "6"]),
            ("offset 1; limit 2;", ["2", "3"]),
            ("sort $n desc; limit 1; offset 1;", ["5"]),
            ("limit 0;", []),
            ("offset 99;", []),
        ],
    )
    def test_limited(self, kb, modifiers, expected):
        rows = kb.query(f"match $c isa! Component, has name $n; fetch $n; {modifiers}")
        assert [row["n"][-1] for row in rows] == expected

    @pytest.mark.parametrize(
        ("aggregate", "value"),
        [
            ("count", 3),
            ("sum $p", 6.0),
            ("min $p", 1.0),
            ("max $p", 3.0),
            ("mean $p", 2.0),
            ("median $p", 2.0),
            ("std $p", 1.0),
        ],
    )
    def test_aggregated(self, kb, aggregate, value):
        rows = kb.query(f"match $c isa component-configuration, has priority $p; get $p; {aggregate};")
        assert rows == [{aggregate.split()[0]: value}]

    def test_aggregates_of_nothing(self, kb):
        nothing = "match $c isa! ROSNode, has $p; $p > 3; get $p;"
        assert kb.query(f"{nothing} count;") == [{"count": 0}]
        assert kb.query(f"{nothing} sum $p;") == [{"sum": 0}]
        assert kb.query(f"{nothing} mean $p;") == [{"mean": None}]

    def test_without_a_projection_give_all_variables(self, kb):
        recharge = {"isa": "Action", "action-name": "recharge", "action-status": "feasible", "is-required": False}
        expected = [{"a": recharge, "n": "recharge"}]
        text = "match $a isa Action, has name $n; $n = 'recharge';"
        assert kb.query(text) == kb.query(f"{text} get;") == expected

    def test_of_things_with_several_values(self, kb):
        kb.request_action("recharge")
        kb.finish_action("recharge")
        assert kb.query("match $r isa required-action; fetch $r: time, result;") == [
            {"r": {"time": [0.0, 0.0], "result": "completed"}}
        ]

    def test_are_plain_enough_for_json(self, kb):
        kb.add_measurement("battery_level", 0.5)
        rows = kb.query("match $x isa thing; get;")
        assert json.loads(json.dumps(rows)) == rows
        assert len(rows) > 30

    def test_times_can_be_given_as_datetimes(self):
        kb = KnowledgeBase(MODEL)
        kb.request_action("recharge")
        assert kb.query("match $r isa required-action, has start-time $t; $t > 2024-01-01; get $r; count;") == [
            {"count": 1}
        ]
        assert kb.query("match $r isa required-action, has start-time < 2024-01-01T00:00:00.5; get $r; count;") == [
            {"count": 0}
        ]
