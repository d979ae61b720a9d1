"""Streams under a knowledge base: measures, formulas and components."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import InputError, KnowledgeBase, KnowledgeModel, Status
from rosa_core.clock import SimulationClock
from rosa_streams.bindings import load_bindings
from rosa_streams.environment import Port, Transformation
from rosa_streams.join import FormulaMeasure, Join, StreamMeasure
from rosa_streams.manager import Manager
from rosa_streams.query import Answer, Query, StreamOf
from rosa_streams.runtime import Function, Sources
from rosa_streams.tags import parse_tag
from rosa_streams.temporal import Verdict

MODEL = """
measures:
  ball_x: {kind: environmental}
  ball_in_their_half: {kind: environmental}
actions:
  attack:
    requires: [track ball]
    constraints: [{measure: ball_in_their_half, operator: ">=", value: 1}]
  defend: {requires: [track ball], constraints: [{measure: ball_x, operator: "<", value: 4.0}]}
functions: {track ball: {}}
components: {tracker: {}}
function_designs: {fd_track: {function: track ball, components: [tracker], priority: 1}}
"""
PATH = [3.0, 3.5, 2.0, 1.0, 0.5, -0.5, -1.0, -1.5, -2.0, -2.5, -3.0, 4.5, 4.6]
"""Where the ball is, second by second; above 0 is the opponents' half."""


def ball(tid: str = "see") -> Transformation:
    return Transformation(tid, tid, (), (Port("ball", parse_tag("Position ⊓ ∃hasSource.Ball")),))


class Field:
    """A field with a ball that is seen once a second."""

    def __init__(self, tmp_path: Path) -> None:
        (tmp_path / "field.yaml").write_text(MODEL)
        self.clock = SimulationClock()
        self.kb = KnowledgeBase(KnowledgeModel.load(tmp_path / "field.yaml"), clock=self.clock)
        known = Sources()

        @known.factory("see")
        def see(parameters: object) -> Function:
            return Function(lambda now: {"x": PATH[min(round(now) - 1, len(PATH) - 1)]}, (), ("ball",), period=1.0)

        self.manager = Manager(self.clock, known)
        self.manager.register([ball()])

    def feasible(self, action: str) -> bool:
        return self.kb.is_action_feasible(action)


@pytest.fixture
def field(tmp_path: Path) -> Field:
    return Field(tmp_path)


def test_a_measure_bound_by_a_tag_is_measured_only_when_a_constraint_can_change(field: Field) -> None:
    join = Join(field.kb, field.manager, [StreamMeasure("ball_x", "Position and (hasSource some Ball)", "x")])
    field.clock.advance_to(13.0)
    taken = field.kb.history("measurements", "ball_x")
    assert join.samples["ball_x"] == 13
    assert join.measurements["ball_x"] == len(taken) == 2
    measured = field.kb.measurement("ball_x")
    assert measured is not None
    assert (measured.value, measured.time) == (4.5, 12.0)
    assert not field.feasible("defend")


def test_a_formula_is_a_measure_that_makes_an_action_unfeasible(field: Field) -> None:
    """The ball must have been in the opponents' half within the last 3 s."""
    join = Join(
        field.kb,
        field.manager,
        [FormulaMeasure("ball_in_their_half", "O[0,3] ball > 0", {"ball": StreamOf("Position", "x")})],
    )
    field.clock.advance_to(8.5)
    assert field.feasible("attack")
    measured = field.kb.measurement("ball_in_their_half")
    assert measured is not None
    assert measured.value == 1.0
    field.clock.advance_to(9.5)
    assert not field.feasible("attack"), "at 9 s it was last there 4 s before"
    field.clock.advance_to(12.5)
    assert field.feasible("attack")
    assert join.measurements["ball_in_their_half"] == 3


def test_a_formula_that_is_not_known_yet_leaves_its_measure_unmeasured(field: Field) -> None:
    Join(
        field.kb,
        field.manager,
        [FormulaMeasure("ball_in_their_half", "F[5,6] x < 0", {"x": StreamOf("Position", "x")})],
    )
    field.clock.advance_to(5.5)
    assert field.kb.measurement("ball_in_their_half") is None
    field.clock.advance_to(6.5)
    measured = field.kb.measurement("ball_in_their_half")
    assert measured is not None
    assert measured.value == 1.0


def test_a_component_whose_stream_nothing_can_give_has_failed_until_something_does(field: Field) -> None:
    join = Join(field.kb, field.manager, [StreamMeasure("ball_x", "Position", "x")], {"tracker": ["ball_x"]})
    field.clock.advance_to(1.5)
    assert field.feasible("defend")
    field.manager.unregister("see")
    assert field.kb.status("component", "tracker") is Status.FAILURE
    assert not field.feasible("defend")
    why = join.why("tracker")
    assert why is not None
    assert "no transformation gives Position" in why
    field.manager.register([ball()])
    assert field.kb.status("component", "tracker") is not Status.FAILURE
    assert field.feasible("defend")
    assert join.why("tracker") is None


def test_closing_a_join_takes_its_targets_back(field: Field) -> None:
    join = Join(
        field.kb, field.manager,
        [
            StreamMeasure("ball_x", "Position", "x"),
            FormulaMeasure("ball_in_their_half", "x > 0", {"x": StreamOf("Position", "x")}),
        ],
    )  # fmt: skip
    assert len(field.manager.environment.targets) == 2
    join.close()
    assert not field.manager.environment.targets
    assert not field.manager.environment.units


def test_a_component_that_needs_what_is_not_bound_is_refused(field: Field) -> None:
    with pytest.raises(InputError, match="'tracker' needs the stream of 'ball_y', which is not bound"):
        Join(field.kb, field.manager, [], {"tracker": ["ball_y"]})


def test_a_query_goes_round_manager_environment_and_engine_and_clears_up(field: Field) -> None:
    """The six arrows of the paper's figure 1."""
    answers: list[Answer] = []
    assert not field.manager.environment.targets
    query = Query(  # (1) the client asks the manager
        field.manager, "G[0,60] x > 0", {"x": StreamOf("Position and (hasSource some Ball)", "x")}, answers.append
    )
    assert [unit.cid for unit in field.manager.environment.units] == ["see.1"]  # (2) the environment is configured
    assert query.targets() == (f"{query.name}.x",)
    field.clock.advance_to(3.0)
    assert query.monitor.open_obligations == 1  # (3) the engine has the formula, (4) and gets states
    assert not answers
    field.clock.advance_to(6.0)
    assert answers == [Answer(Verdict.FALSE, 6.0)]  # (6) the client has the answer, as early as can be
    assert query.ended  # (5) the manager took it and unloaded what is no longer needed
    assert not field.manager.environment.targets
    assert not field.manager.host.units()
    cycles = [str(entry) for entry in field.manager.journal]
    assert "unloaded see.1" in cycles[-1]


def test_a_querys_deadline_passes_without_a_sample(field: Field) -> None:
    answers: list[Answer] = []
    Query(field.manager, "F[0,2.5] x > 100", {"x": StreamOf("Position", "x")}, answers.append, tick_period=0.25)
    field.clock.advance_to(1.1)
    field.manager.unregister("see")
    field.clock.advance_to(5.0)
    assert answers == [Answer(Verdict.FALSE, 3.5)]


def test_a_query_without_a_stream_for_a_variable_is_refused(field: Field) -> None:
    with pytest.raises(InputError, match="the variable 'y' of the formula has no stream"):
        Query(field.manager, "x > y", {"x": "Position"}, print)
    assert not field.manager.environment.targets


def test_bindings_are_read_from_yaml(field: Field, tmp_path: Path) -> None:
    (tmp_path / "bindings.yaml").write_text(
        """
measures:
  ball_x: {tag: "Position and (hasSource some Ball)", field: x}
  ball_in_their_half: {formula: "O[0,3] ball > 0", streams: {ball: {tag: Position, field: x}}, max_age: 5}
components:
  tracker: [ball_x, ball_in_their_half]
"""
    )
    bindings = load_bindings(tmp_path / "bindings.yaml")
    join = Join(field.kb, field.manager, bindings.measures, bindings.components)
    field.clock.advance_to(9.5)
    assert not field.feasible("attack")
    assert field.feasible("defend")
    assert join.samples == {"ball_x": 9, "ball_in_their_half": 9}


def test_mistakes_in_bindings_are_reported_at_once_with_their_lines(tmp_path: Path) -> None:
    (tmp_path / "bindings.yaml").write_text(
        """measures:
  a: {tag: "A or B"}
  b: {tags: A}
  c: {formula: "x > ", streams: {}}
  d: {formula: "x > 3", streams: {y: {tag: A}}, max_age: 0}
components:
  t: a
"""
    )
    with pytest.raises(InputError) as caught:
        load_bindings(tmp_path / "bindings.yaml")
    text = str(caught.value)
    for said in (
        "bindings.yaml:2: a disjunction",
        "bindings.yaml:3: unknown key 'tags' (did you mean 'tag'?)",
        "bindings.yaml:4: expected a formula, found the end",
        "bindings.yaml:5: the variable 'x' of the formula has no stream",
        "bindings.yaml:5: 'max_age' is a number of seconds over 0",
        "bindings.yaml:7: a component has a list of measures",
    ):
        assert said in text
