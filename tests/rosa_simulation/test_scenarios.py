"""Scenarios are found through entry points; a run can be watched."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from rosa_core import InputError
from rosa_simulation.metric import MetricKind
from rosa_simulation.run_record import MissionEvent
from rosa_simulation.scenario import RunRequest, SilentObserver, choose, declared_metrics, find_scenario, scenario_names


class Watching(SilentObserver):
    """Writes down what it is given."""

    def __init__(self) -> None:
        self.time_limit = 0.0
        self.events: list[MissionEvent] = []
        self.times: list[float] = []

    def started(self, time_limit: float) -> None:
        self.time_limit = time_limit

    def event(self, event: MissionEvent) -> None:
        self.events.append(event)

    def progress(self, mission_time: float) -> None:
        self.times.append(mission_time)


def test_both_suave_missions_are_installed() -> None:
    assert {"suave", "suave-extended"} <= set(scenario_names())
    for name in ("suave", "suave-extended"):
        scenario = find_scenario(name)
        assert scenario.name == name
        assert {"rosa", "none"} <= set(scenario.managers)


@pytest.mark.parametrize("name", ["suave", "suave-extended", "uav", "agv"])
def test_a_run_measures_what_its_scenario_declares(name: str) -> None:
    declared = {metric.name: metric for metric in declared_metrics(name)}
    record = find_scenario(name).run(RunRequest(time_limit=20.0 if name != "agv" else None), SilentObserver())
    assert list(record.metrics) == list(declared)
    for metric, value in record.metrics.items():
        assert isinstance(value, bool) == (declared[metric].kind is MetricKind.TRUTH)
        if declared[metric].kind is MetricKind.COUNT:
            assert isinstance(value, int)


def test_an_unknown_scenario_declares_nothing() -> None:
    assert declared_metrics("moon landing") == ()


def test_an_unknown_scenario_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(InputError, match=r"did you mean 'suave-extended'\?"):
        find_scenario("suave_extended")
    with pytest.raises(InputError, match=r"there are: .*suave, suave-extended"):
        find_scenario("moon landing")


def test_a_choice_that_is_not_offered_is_refused() -> None:
    assert choose("manager", "rosa", ("rosa", "none")) == "rosa"
    with pytest.raises(InputError, match="there is no manager 'x' for this scenario"):
        choose("manager", "x", ("rosa", "none"))


def test_an_observer_hears_events_and_progress_while_it_runs() -> None:
    watching = Watching()
    record = find_scenario("suave").run(RunRequest(time_limit=30.0), watching)
    assert watching.time_limit == 30.0
    assert tuple(watching.events) == record.events
    assert [event.time_s for event in record.events] == sorted(event.time_s for event in record.events)
    assert watching.times == pytest.approx([float(second) for second in range(31)])


def test_a_record_written_twice_is_the_same(tmp_path: Path) -> None:
    record = find_scenario("suave").run(RunRequest(time_limit=20.0), SilentObserver())
    record.write(tmp_path / "a")
    dataclasses.replace(record).write(tmp_path / "b")
    for file in (tmp_path / "a").iterdir():
        assert file.read_bytes() == (tmp_path / "b" / file.name).read_bytes()
