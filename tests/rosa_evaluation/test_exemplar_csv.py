"""The exemplar's CSV files: what is written is read again, and what is wrong is reported with file and line."""

from __future__ import annotations

import dataclasses
from datetime import datetime
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import InputError
from rosa_evaluation.exemplar_csv import (
    MISSION_COLUMNS,
    ExemplarMission,
    ExemplarReaction,
    mission_of,
    reaction_file,
    reactions_of,
    read_missions,
    read_reactions,
    write_missions,
    write_reactions,
)
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario

# As the exemplar writes it: numbers of whole seconds, distances of single precision, a position in quotes.
UPSTREAM = (
    'mission name,datetime,"initial pos (x,y)",mission duration (s),pipeline found,time searching pipeline (s),'
    "distance inspected (m),mean reaction time (s)\n"
    'suave none,04-Feb-2023-00-56-36,"(-17.0, 2.59)",300,True,204,27.1139621734619,0.0\n'
    'suave bt,12-Oct-2024-13-42-32,"(-17.0, 2.57)",300,False,300,0.0,0.0823\n'
)

numbers = st.floats(0, 1e6, allow_nan=False)
positions = st.floats(-1e3, 1e3, allow_nan=False)
names = st.text(st.characters(exclude_categories=("C", "Z"), include_characters=" ,\"'"), min_size=1).filter(
    lambda name: name == name.strip() and name
)
dates = st.datetimes().map(lambda date: date.replace(microsecond=0))
missions = st.builds(
    ExemplarMission,
    names,
    dates,
    st.tuples(positions, positions),
    numbers,
    st.booleans(),
    numbers,
    numbers,
    st.none() | st.floats(1e-9, 1e6),
)


def test_a_file_of_the_exemplar_is_read(tmp_path: Path) -> None:
    path = tmp_path / "results.csv"
    path.write_text(UPSTREAM, encoding="utf-8")
    first, second = read_missions(path)
    assert first == ExemplarMission(
        "suave none",
        datetime.fromisoformat("2023-02-04T00:56:36"),
        (-17.0, 2.59),
        300.0,
        True,
        204.0,
        27.1139621734619,
        None,
    )
    assert (second.pipeline_found, second.mean_reaction_time_s) == (False, 0.0823)


def test_and_written_as_it_was_but_for_points_after_whole_numbers(tmp_path: Path) -> None:
    path = tmp_path / "results.csv"
    path.write_text(UPSTREAM, encoding="utf-8")
    write_missions(tmp_path / "copy.csv", read_missions(path))
    written = (tmp_path / "copy.csv").read_text(encoding="utf-8")
    assert written == UPSTREAM.replace(",0.0,", ",0,").replace(",0.0\n", ",0\n")


@given(st.lists(missions, max_size=5))
def test_missions_come_back_as_they_were(tmp_path_factory: pytest.TempPathFactory, some: list[ExemplarMission]) -> None:
    path = tmp_path_factory.mktemp("csv") / "results.csv"
    write_missions(path, some)
    assert read_missions(path) == some


@given(st.lists(st.builds(ExemplarReaction, names, dates, numbers), max_size=5))
def test_reactions_come_back_as_they_were(
    tmp_path_factory: pytest.TempPathFactory, some: list[ExemplarReaction]
) -> None:
    path = tmp_path_factory.mktemp("csv") / "results.csv"
    write_reactions(path, some)
    assert read_reactions(path) == some


def test_columns_come_in_any_order_with_others_among_them_and_blank_lines_do_not_count(tmp_path: Path) -> None:
    path = tmp_path / "sorted.csv"
    path.write_text(
        "\ufeffrun_idx,reaction time (s),datetime,mission_name\n\n7,0.5,Feb-04-2023-01-02-03,suave bt\n,,,\n",
        encoding="utf-8",
    )
    assert read_reactions(path) == [ExemplarReaction("suave bt", datetime.fromisoformat("2023-02-04T01:02:03"), 0.5)]


def test_files_of_reactions_are_called_as_upstream() -> None:
    assert [reaction_file("results/x.csv", name).name for name in ("U1", "U2", "U3")] == [
        "x_component_recovery_time.csv",
        "x_wv_reaction_time.csv",
        "x_battery_reaction_time.csv",
    ]


def test_a_run_of_ours_has_the_exemplars_figures(tmp_path: Path) -> None:
    record = find_scenario("suave").run(RunRequest(time_limit=50.0), SilentObserver())
    date = datetime.fromisoformat("2024-05-06T07:08:09")
    mission, reactions = mission_of(record, date), reactions_of(record, date)
    assert mission.mission_name == "suave rosa"
    assert mission.initial_position == pytest.approx((-17.0, 1.95), abs=0.8)
    assert (mission.duration_s, mission.search_time_s) == (50.0, record.metrics["search_time_s"])
    assert len(reactions["U1"]) == 1
    every = [reaction.reaction_time_s for several in reactions.values() for reaction in several]
    assert mission.mean_reaction_time_s == pytest.approx(sum(every) / len(every))
    write_missions(tmp_path / "ours.csv", [mission])
    assert read_missions(tmp_path / "ours.csv") == [mission]
    pddl = mission_of(dataclasses.replace(record, task_layer="pddl", reactions={}), date)
    assert (pddl.mission_name, pddl.mean_reaction_time_s) == ("suave rosa-pddl", None)


ROW = 'suave bt,04-Feb-2023-00-56-36,"(-17.0, 2.59)",300,True,204,27.1,0.1'


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (
            ROW.replace("204", "soon"),
            r"time searching pipeline \(s\): 'soon' does not fit here \(a number from 0 up is expected\)",
        ),
        (ROW.replace("204", "-1"), "a number from 0 up is expected"),
        (ROW.replace("204", "nan"), "a finite number from 0 up"),
        (ROW.replace("204", "1e999"), "a finite number from 0 up"),
        (ROW.replace("True", "yes"), "true or false is expected"),
        (ROW.replace("04-Feb", "31-Feb"), "not like 04-Feb-2023-13-42-32"),
        (ROW.replace("Feb", "Fev"), "datetime: '04-Fev-2023-00-56-36' does not fit here"),
        (ROW.replace("(-17.0, 2.59)", "somewhere"), r"not like \(-17.0, 2.57\)"),
        (ROW.replace("(-17.0, 2.59)", "(inf, 2.59)"), r"initial pos \(x,y\): .*a finite number"),
        (ROW + ",1", "9 values for 8 columns"),
        (ROW.replace(",0.1", ""), "7 values for 8 columns"),
        (ROW + ',"x"y', "not valid CSV"),
    ],
)
def test_what_is_wrong_is_reported_with_file_and_line(tmp_path: Path, row: str, words: str) -> None:
    path = tmp_path / "results.csv"
    path.write_text(UPSTREAM + row + "\n", encoding="utf-8")
    with pytest.raises(InputError, match=words) as refusal:
        read_missions(path)
    assert f"{path}:4: " in str(refusal.value)


def test_every_line_that_is_wrong_is_named(tmp_path: Path) -> None:
    path = tmp_path / "results.csv"
    path.write_text(UPSTREAM + ROW.replace("204", "x") + "\n" + ROW.replace("300", "x") + "\n", encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        read_missions(path)
    assert [problem.where and problem.where.line for problem in refusal.value.problems] == [4, 5]


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("", "there is no column 'mission name'"),
        (",".join(f'"{name}"' for name in MISSION_COLUMNS).replace("pipeline found", "pipline found"), "did you mean"),
        ('"initial pos (x,y)",' + ",".join(f'"{name}"' for name in MISSION_COLUMNS), "is there twice"),
    ],
)
def test_a_first_line_without_the_columns_is_refused(tmp_path: Path, header: str, words: str) -> None:
    path = tmp_path / "results.csv"
    path.write_text(header + "\n", encoding="utf-8")
    with pytest.raises(InputError, match=words):
        read_missions(path)


def test_files_that_are_not_there_or_cannot_be_written_are_reported(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_missions(tmp_path / "none.csv")
    with pytest.raises(InputError, match="name another file"):
        write_reactions(tmp_path / "none" / "x.csv", [])
