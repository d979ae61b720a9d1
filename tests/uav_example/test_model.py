"""The knowledge model: what the paper counts, and the trap of a gripper that cannot fold itself."""

from __future__ import annotations

import pytest

from rosa_core import KnowledgeBase, KnowledgeModel, Status
from rosa_core.model import ElementKind
from rosa_core.model.effort import count_effort
from rosa_simulation.models import load_models
from uav_example.models import model_files

ACTIONS = ("search", "analyze", "analyze_in_situ", "return_base", "land_fold")


@pytest.fixture
def base() -> KnowledgeBase:
    return KnowledgeBase(KnowledgeModel.load(*model_files(spring=False)))


@pytest.fixture
def with_spring() -> KnowledgeBase:
    return KnowledgeBase(KnowledgeModel.load(*model_files(spring=True)))


def unfeasible(kb: KnowledgeBase) -> set[str]:
    return {name for name in ACTIONS if not kb.is_action_feasible(name)}


def test_the_base_model_counts_as_the_papers_table_7() -> None:
    effort = count_effort(KnowledgeModel.load(*model_files(spring=False)))
    assert (effort.entities, effort.relations, effort.total) == (24, 16, 40)


def test_the_spring_adds_a_component_and_a_design() -> None:
    effort = count_effort(KnowledgeModel.load(*model_files(spring=True)))
    assert (effort.entities, effort.relations) == (25, 17)


@pytest.mark.parametrize(
    ("level", "not_feasible"),
    [
        (1.0, set()),
        (0.5, set()),
        (0.499, {"analyze"}),
        (0.25, {"analyze"}),
        (0.249, {"analyze", "search"}),
        (0.0, {"analyze", "search"}),
    ],
)
def test_the_battery_decides_what_is_feasible(base: KnowledgeBase, level: float, not_feasible: set[str]) -> None:
    base.add_measurement("qa_battery_level", level)
    assert unfeasible(base) == not_feasible


def test_a_failed_gripper_takes_folding_with_it(base: KnowledgeBase) -> None:
    """The trap: what must come before analyze_in_situ is unfeasible for the same reason as analyze."""
    base.set_component_failure("gripper")
    assert unfeasible(base) == {"analyze", "land_fold"}
    shown = str(base.explain("action", "land_fold"))
    assert "component 'gripper' is failure" in shown


def test_with_the_spring_only_analyze_is_lost(with_spring: KnowledgeBase) -> None:
    with_spring.set_component_failure("gripper")
    assert unfeasible(with_spring) == {"analyze"}


def test_the_spring_is_the_second_choice(with_spring: KnowledgeBase) -> None:
    designs = with_spring.selectable_function_designs("fold_gripper")
    best = min(designs, key=lambda name: with_spring.function_design_priority(name) or 0.0)
    assert best == "fd_fold_gripper"


@pytest.mark.parametrize(
    ("component", "not_feasible"),
    [
        ("infra_red_camera", {"analyze_in_situ"}),
        ("generate_home_path_node", {"return_base"}),
        ("control_motion_node", set(ACTIONS)),
        ("release_spring_node", set()),
    ],
)
def test_every_component_carries_what_needs_it(
    with_spring: KnowledgeBase, component: str, not_feasible: set[str]
) -> None:
    with_spring.set_component_failure(component)
    assert unfeasible(with_spring) == not_feasible
    with_spring.clear_component_failure(component)
    assert unfeasible(with_spring) == set()


def test_all_functions_are_feasible_at_first(base: KnowledgeBase) -> None:
    assert set(base.statuses(ElementKind.FUNCTION).values()) == {Status.FEASIBLE}


def test_the_models_are_read_once() -> None:
    assert load_models(model_files(spring=True)) is load_models(model_files(spring=True))
