"""Table 7 and the growth of section 7.6, counted from files and generated systems."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from py_trees.behaviours import Success
from py_trees.composites import Sequence

from rosa_evaluation.effort import (
    BT_MANAGING,
    ROSA_MODEL,
    ROSA_TASK,
    count_nodes,
    count_rosa_model,
    effort_rows,
    growing_model,
    growths,
    outline,
)
from suave.effort import count_baseline
from tests.rosa_cli.cli import refused, rosa

counts = st.integers(0, 12)


def rows(approach: str) -> dict[str, tuple[int, ...]]:
    return {row.use_case: (*row.parts.values(), row.total) for row in effort_rows() if row.approach == approach}


def test_the_models_count_as_in_table_7() -> None:
    assert rows(ROSA_MODEL) == {
        "SUAVE": (18, 12, 30),
        "SUAVE extended": (22, 16, 38),
        "AGV": (18, 36, 54),
        "UAV": (24, 16, 40),
    }


def test_the_baseline_counts_as_in_table_7() -> None:
    assert rows(BT_MANAGING) == {"SUAVE": (27, 30, 57), "SUAVE extended": (34, 38, 72)}
    assert count_nodes(outline("suave.managers", "suave_bt.xml")) == 37
    assert count_nodes(outline("suave.managers", "suave_extended_bt.xml")) == 50


def test_the_guards_of_the_task_trees_are_counted_beyond_the_paper() -> None:
    guarded = rows(ROSA_TASK)
    assert guarded["SUAVE"] == (18, 12, 4, 34)
    assert guarded["SUAVE extended"] == (22, 16, 6, 44)
    assert all(row.published is None for row in effort_rows() if row.approach == ROSA_TASK)


def test_what_is_counted_is_what_was_published() -> None:
    assert all(row.total == row.published for row in effort_rows() if row.published is not None)


def test_every_node_of_a_tree_counts_one() -> None:
    root = Sequence("a", memory=True, children=[Success("b"), Sequence("c", memory=True, children=[Success("d")])])
    assert count_nodes(root) == 4


@given(counts, counts)
def test_models_grow_as_section_7_6_says(structural: int, parameter: int) -> None:
    assert count_rosa_model(structural, parameter) == 10 + 6 * structural + 3 * parameter


@settings(max_examples=20, deadline=None)
@given(counts, counts)
def test_the_baseline_grows_linearly_as_well_but_faster(structural: int, parameter: int) -> None:
    assert count_baseline(structural, parameter) == 13 + 7 * structural + 6 * parameter


def test_every_design_and_configuration_of_a_growing_model_is_constrained() -> None:
    model = growing_model(3, 2)
    constrained = {constraint.constrained.name for constraint in model.constraints}
    named = {d.name for d in model.function_designs} | {c.name for c in model.component_configurations}
    assert constrained == named


def test_growth_is_measured_not_supposed() -> None:
    rosa_growth, baseline = growths(5)
    assert (rosa_growth.base, rosa_growth.per_structural, rosa_growth.per_parameter) == (10, 6, 3)
    assert rosa_growth.structural == {1: 16, 2: 22, 3: 28, 4: 34, 5: 40}
    assert baseline.approach == BT_MANAGING


def test_the_command_prints_the_table_and_the_growth() -> None:
    table = rosa("effort", "--table")
    for words in ("27 BT nodes + 30 system modes", "18 entities + 36 relations", "not in the paper"):
        assert words in table.stdout
    document = json.loads(rosa("effort", "--table", "--json").stdout)
    assert {"use_case", "approach", "total", "published_total", "files"} <= set(document["rows"][0])
    assert "ROSA: 10 + 6 n_sa + 3 n_pa" in rosa("effort", "--growth").stdout
    growth = json.loads(rosa("effort", "--growth", "--most", 2, "--json").stdout)["growth"]
    assert growth[0]["structural"] == {"1": 16, "2": 22}


@pytest.mark.parametrize("arguments", [(), ("--table", "--growth"), ("model.yaml", "--table")])
def test_one_thing_is_counted_at_a_time(arguments: tuple[str, ...]) -> None:
    assert "only one of them" in refused(rosa("effort", *arguments))
