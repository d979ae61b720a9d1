"""The journal: what is written is there again, and a file that cannot be trusted is refused."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosa_core import (
    InvalidValueError,
    JournalOptions,
    KnowledgeBase,
    KnowledgeModel,
    Result,
    Retention,
    SimulationClock,
)
from rosa_core.journal.journal import compact_journal
from rosa_core.journal.tables import JournalReader
from rosa_core.mape import ConfigurationPlanner
from tests.rosa_core.journal.writes import WRITES, Write, picture, random_writes, robot

FREQUENT = JournalOptions(snapshot_every=3)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "kb.journal"


def reopened(path: Path, clock: SimulationClock, model: KnowledgeModel | None = None) -> KnowledgeBase:
    return KnowledgeBase(model or robot(), SimulationClock(clock.now()), path)


# -- reopening --


def test_everything_is_there_again_after_reopening(path: Path) -> None:
    clock = SimulationClock(10.0)
    with KnowledgeBase(robot(), clock, path) as kb:
        kb.add_measurement("battery", 0.8, 3.5)
        kb.add_measurement("battery", 0.1, 2.0)  # older: remembered, but does not count
        kb.set_component_failure("legs", 4.25)
        kb.request_action("explore", preference="light")
        clock.advance_to(11.0)
        ConfigurationPlanner(kb).plan()
        before = picture(kb)
    with reopened(path, clock) as kb:
        assert picture(kb) == before
        assert kb.measurement("battery").value == 0.8  # type: ignore[union-attr]
        assert kb.required_actions()[0].preference == "light"
        plan = kb.pending_reconfiguration_plan()
        assert plan is not None
        assert plan.start_time == 11.0
        assert kb.set_reconfiguration_result(plan, Result.COMPLETED)


@given(st.lists(st.builds(Write, st.integers(0, len(WRITES) - 1), st.integers(0, 49), st.integers(0, 49)), max_size=40))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_a_reopened_knowledge_base_equals_the_one_that_wrote(tmp_path_factory, writes: list[Write]) -> None:
    path = tmp_path_factory.mktemp("journal") / "kb"
    clock = SimulationClock()
    options = JournalOptions(snapshot_every=5)
    kb = KnowledgeBase(robot(), clock, path, journal_options=options)
    for write in writes:
        write(kb)
    before = picture(kb)
    # Without the snapshot that close() makes: as after a crash.
    assert kb._journal is not None
    kb._journal.release()
    with reopened(path, clock) as again:
        assert picture(again) == before
        live = KnowledgeBase(robot(), SimulationClock())
        for write in writes:
            write(live)
        assert picture(live) == before
        assert ConfigurationPlanner(again).plan() == ConfigurationPlanner(live).plan()
        assert picture(again) == picture(live)
    shutil.rmtree(path.parent)


@pytest.mark.parametrize("seed", range(5))
def test_it_can_be_closed_and_reopened_again_and_again(path: Path, seed: int) -> None:
    clock, reference = SimulationClock(), KnowledgeBase(robot(), SimulationClock())
    writes = random_writes(seed, 120)
    for start in range(0, len(writes), 8):
        with KnowledgeBase(robot(), SimulationClock(clock.now()), path, journal_options=FREQUENT) as kb:
            for write in writes[start : start + 8]:
                write(kb)
                write(reference)
            clock.advance_to(kb.clock.now())
            assert picture(kb) == picture(reference)


def test_a_write_is_durable_before_it_is_announced(path: Path) -> None:
    with KnowledgeBase(robot(), SimulationClock(), path) as kb, JournalReader(path) as reader:
        last = []
        kb.subscribe(lambda event: last.append((event.revision, [w.revision for w in reader.writes()][-1])))
        kb.add_measurement("battery", 0.1)
        kb.add_measurement("battery", 0.9)
        assert last
        assert all(announced == written for announced, written in last)


def test_a_change_that_nothing_announces_is_kept_too(path: Path) -> None:
    """Failing and recovering within one transaction cancel out, but lift the block on a failed plan."""
    with KnowledgeBase(robot(), SimulationClock(), path) as kb:
        kb.request_action("charge")
        plan = ConfigurationPlanner(kb).plan()
        assert plan is not None
        kb.set_reconfiguration_result(plan, Result.FAILED)
        assert ConfigurationPlanner(kb).plan() is None
        revision = kb.revision
        with kb.transaction():
            kb.set_component_failure("motor")
            kb.clear_component_failure("motor")
        assert kb.revision == revision
    with KnowledgeBase(robot(), SimulationClock(), path) as kb:
        assert kb.revision == revision
        assert ConfigurationPlanner(kb).plan() is not None


def test_what_is_rolled_back_is_not_journalled(path: Path) -> None:
    with KnowledgeBase(robot(), SimulationClock(), path) as kb:
        kb.add_measurement("battery", 0.9)
        before = picture(kb)

        def break_off() -> None:
            with kb.transaction():
                kb.add_measurement("battery", 0.1)
                kb.request_action("charge")
                ConfigurationPlanner(kb).plan()
                raise ZeroDivisionError

        with pytest.raises(ZeroDivisionError):
            break_off()
        assert picture(kb) == before
    with KnowledgeBase(robot(), SimulationClock(), path) as kb:
        assert picture(kb) == before


# -- history --


def test_history_older_than_memory_is_read_from_the_journal(path: Path) -> None:
    clock = SimulationClock()
    with KnowledgeBase(robot(), clock, path, history_length=10) as kb:
        for index in range(50):
            clock.advance_to(float(index))
            kb.add_measurement("battery", index % 2)
        assert len(kb.history("measurements")) == 10
        assert [entry.time for entry in kb.history("measurements", limit=3)] == [47.0, 48.0, 49.0]
        assert [entry.time for entry in kb.history("measurements", limit=30)] == [float(i) for i in range(20, 50)]
        assert len(kb.history("measurements", limit=1000)) == 50
        assert len(kb.history("measurements", "light", limit=1000)) == 0
        statuses = kb.history("statuses", "explore", limit=1000)
        assert len(statuses) == 50  # feasible -> unfeasible, and so on
    with KnowledgeBase(robot(), clock, path, history_length=10) as kb:
        assert len(kb.history("measurements")) == 10
        assert kb.history("statuses", "explore", limit=1000) == statuses


def test_history_with_a_limit_needs_no_journal() -> None:
    kb = KnowledgeBase(robot(), SimulationClock())
    kb.add_measurement("battery", 1)
    kb.add_measurement("battery", 2)
    assert [entry.value for entry in kb.history("measurements", limit=1)] == [2]
    assert kb.history("measurements", limit=0) == ()
    with pytest.raises(InvalidValueError, match="negative"):
        kb.history("measurements", limit=-1)


# -- retention --


def test_retention_lets_old_writes_go_and_keeps_the_state(path: Path) -> None:
    options = JournalOptions(retention=Retention(writes=20), snapshot_every=5)
    clock = SimulationClock()
    with KnowledgeBase(robot(), clock, path, journal_options=options) as kb:
        for write in random_writes(3, 400):
            write(kb)
        before = picture(kb)
        with JournalReader(path) as reader:
            first, last = reader.range()
        assert 20 <= last - first + 1 < 60
    with reopened(path, clock) as kb:
        after = picture(kb)
        assert {**after, "history": None} == {**before, "history": None}


def test_retention_by_age(path: Path) -> None:
    options = JournalOptions(retention=Retention(seconds=10.0), snapshot_every=5)
    clock = SimulationClock()
    with KnowledgeBase(robot(), clock, path, journal_options=options) as kb:
        for index in range(100):
            clock.advance_to(float(index))
            kb.add_measurement("tick", index)
    with JournalReader(path) as reader:
        times = [write.time for write in reader.writes()]
    assert times[-1] == 99.0
    assert 84.0 <= times[0] <= 89.0


def test_compacting_applies_the_retention_given(path: Path) -> None:
    clock = SimulationClock()
    with KnowledgeBase(robot(), clock, path, journal_options=JournalOptions(snapshot_every=10)) as kb:
        for write in random_writes(4, 300):
            write(kb)
        before = picture(kb)
    written, left = compact_journal(path, Retention(writes=30))
    assert written > 100
    assert 30 <= left < 50
    assert compact_journal(path, Retention(writes=0)) == (left, 0)
    assert compact_journal(path) == (0, 0)
    with reopened(path, clock) as kb:
        assert {**picture(kb), "history": None} == {**before, "history": None}
        kb.add_measurement("battery", 0.3)
    with reopened(path, clock) as kb:
        assert kb.revision == before["revision"] + 1


@pytest.mark.parametrize("retention", [{"writes": -1}, {"seconds": -0.5}, {"seconds": float("inf")}])
def test_a_retention_that_cannot_be_is_refused(retention: dict[str, float]) -> None:
    with pytest.raises(InvalidValueError, match="retention"):
        Retention(**retention)  # type: ignore[arg-type]


def test_options_that_cannot_be_are_refused() -> None:
    with pytest.raises(InvalidValueError, match="synchronous"):
        JournalOptions(synchronous="OFF")  # type: ignore[arg-type]
    with pytest.raises(InvalidValueError, match="snapshot_every"):
        JournalOptions(snapshot_every=0)


def test_full_synchronous_mode_is_set(path: Path) -> None:
    with KnowledgeBase(robot(), SimulationClock(), path, journal_options=JournalOptions(synchronous="FULL")) as kb:
        assert kb._journal is not None
        assert kb._journal.tables.connection.execute("PRAGMA synchronous").fetchone() == (2,)
