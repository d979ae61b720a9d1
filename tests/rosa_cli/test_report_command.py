"""``rosa report`` and ``rosa compare`` as a user runs them."""

from __future__ import annotations

import json
import re
import shutil
import sqlite3
import subprocess
from contextlib import closing
from html.parser import HTMLParser
from pathlib import Path

import pytest

from rosa_evaluation.exemplar_csv import read_missions, read_reactions
from tests.rosa_cli.cli import refused, rosa

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
SHORT = "name: <b>short</b>\nparameters: {time_limit: 40, thruster_events: ['(1,failure,10)']}"
FOREIGN = (
    'mission name,datetime,"initial pos (x,y)",mission duration (s),pipeline found,time searching pipeline (s),'
    "distance inspected (m),mean reaction time (s)\n"
    'suave planta,04-Feb-2025-00-56-36,"(-17.0, 2.59)",250,True,101,44.5,2.1\n'
    'suave planta,04-Feb-2025-01-02-11,"(-17.0, 2.55)",250,False,250,0.0,1.9\n'
    'suave <script>alert(1)</script>,04-Feb-2025-01-02-11,"(-17.0, 2.55)",250,False,250,0.0,1.9\n'
)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small campaign, both as the scenario is and varied, with its report."""
    out = tmp_path_factory.mktemp("campaign") / "results"
    experiment = out.parent / "short.yaml"
    experiment.write_text(SHORT, encoding="utf-8")
    for more in ((), ("--experiment", experiment)):
        command = ("campaign", "suave", "--managers", "none,bt,rosa", "--runs", 3, "--out", out, "-q", *more)
        assert rosa(*command).returncode == 0
    process = rosa("report", out, "--figures", out / "figures", "--parquet", out / "parquet")
    assert process.returncode == 0, process.stderr
    return out


@pytest.fixture(scope="module")
def html(results: Path) -> str:
    return (results / "report.html").read_text(encoding="utf-8")


class Outside(HTMLParser):
    """Everything that a page would fetch, and every script in it."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag in ("script", "iframe", "object", "embed", "base"):
            self.found.append(tag)
        for name, value in attrs:
            fetched = name in ("src", "href", "srcset", "xlink:href") and not (value or "").startswith(("#", "data:"))
            if fetched or name.startswith("on"):
                self.found.append(f"{tag} {name}={value}")


def test_the_page_needs_nothing_else_and_runs_nothing(html: str) -> None:
    outside = Outside()
    outside.feed(html)
    assert outside.found == []
    assert "@import" not in html
    assert not re.search(r"url\(", html)


def test_the_published_rows_stand_beside_ours_with_the_conditions_of_both(html: str) -> None:
    for words in ("ROSA paper, table 6", "85.11 (32.48)", "SUAVE, runs of 2023", "Here: MuJoCo", "in Gazebo"):
        assert words in html


def test_it_says_how_to_make_it_again(html: str, results: Path) -> None:
    assert f"rosa campaign suave --managers none,bt,rosa --runs 3 --seed 10000 --out {results}" in html
    assert "time_limit: 40" in html
    assert "mujoco " in html


def test_names_from_files_are_text_and_never_markup(html: str) -> None:
    assert "<b>short" not in html
    assert "&lt;b&gt;short&lt;/b&gt;" in html


def test_the_same_results_make_the_same_page(results: Path, html: str, tmp_path: Path) -> None:
    out = tmp_path / "again.html"
    assert rosa("report", results, "--out", out).returncode == 0
    assert out.read_text(encoding="utf-8") == html


def test_the_csv_files_are_the_exemplars(results: Path) -> None:
    missions = read_missions(results / "report_csv" / "suave.csv")
    assert [m.mission_name for m in missions] == ["suave none"] * 3 + ["suave bt"] * 3 + ["suave rosa"] * 3
    assert len(read_reactions(results / "report_csv" / "suave_component_recovery_time.csv")) == 6


def test_figures_are_files_that_stand_on_their_own(results: Path) -> None:
    from defusedxml.ElementTree import parse

    names = {path.stem for path in (results / "figures").glob("*.svg")}
    assert {"suave_search_time_s", "suave_from_above_rosa", "suave_timeline_none", "growth"} <= names
    for path in (results / "figures").glob("*.svg"):
        assert parse(path).getroot().tag == "{http://www.w3.org/2000/svg}svg"


def test_parquet_has_a_row_for_each_run_and_reaction(results: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    runs = parquet.read_table(results / "parquet" / "runs.parquet").to_pylist()
    assert len(runs) == 18
    assert {row["manager"] for row in runs} == {"none", "bt", "rosa"}
    reactions = parquet.read_table(results / "parquet" / "reactions.parquet").to_pylist()
    assert all(row["total_s"] == row["delay_s"] + row["compute_s"] for row in reactions)


def test_other_peoples_csv_files_stand_in_the_same_report(results: Path, tmp_path: Path) -> None:
    foreign = tmp_path / "planta.csv"
    foreign.write_text(FOREIGN, encoding="utf-8")
    out = tmp_path / "both.html"
    process = rosa("report", results, foreign, "--out", out)
    assert process.returncode == 0, process.stderr
    html = out.read_text(encoding="utf-8")
    assert "planta (planta.csv)" in html
    assert "175.50 (105.36)" in html  # the mean of 101 s and 250 s
    assert "<script" not in html
    assert html.count("<h2 id=") == 4


def test_csv_files_alone_make_a_report(tmp_path: Path) -> None:
    (tmp_path / "planta.csv").write_text(FOREIGN, encoding="utf-8")
    process = rosa("report", tmp_path)
    assert process.returncode == 0, process.stderr
    assert "CSV" not in process.stdout  # they are there already
    assert "planta" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_single_runs_of_every_robot_are_drawn_as_they_draw_themselves(tmp_path: Path) -> None:
    for scenario in ("agv", "uav"):
        assert rosa("run", scenario, "--out", tmp_path / scenario, "-q").returncode == 0
    process = rosa("report", tmp_path / "agv", tmp_path / "uav", "--out", tmp_path / "r.html")
    assert process.returncode == 0, process.stderr
    html = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "agv, single runs" in html
    assert "reaction" in html


def test_what_cannot_be_reported_is_said_and_nothing_is_written(tmp_path: Path, results: Path) -> None:
    assert "no such file" in refused(rosa("report", tmp_path / "nowhere"))
    assert "nothing here that can be reported" in refused(rosa("report", tmp_path))
    wrong = tmp_path / "wrong.csv"
    wrong.write_text(FOREIGN.replace(",101,", ",a hundred,"), encoding="utf-8")
    assert f"{wrong}:2" in refused(rosa("report", results, wrong, "--out", tmp_path / "r.html"))
    assert not (tmp_path / "r.html").exists()
    assert not (tmp_path / "r_csv").exists()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("UPDATE events SET facts = '[{'", "damaged"),
        ('UPDATE events SET facts = \'[{"fact": "actions"}]\'', "cannot be drawn"),
        ("UPDATE runs SET finished_at = 'yesterday'", "damaged"),
        ("UPDATE trajectories SET data = x'00'", "damaged"),
    ],
)
def test_damaged_results_are_bad_input(results: Path, tmp_path: Path, change: str, said: str) -> None:
    shutil.copy(results / "runs.sqlite", tmp_path)
    with closing(sqlite3.connect(tmp_path / "runs.sqlite")) as connection:
        connection.execute(change)
        connection.commit()
    assert said in refused(rosa("report", tmp_path))


def test_results_of_a_scenario_that_is_not_installed_are_reported_with_unknown_units(
    results: Path, tmp_path: Path
) -> None:
    shutil.copy(results / "runs.sqlite", tmp_path)
    with closing(sqlite3.connect(tmp_path / "runs.sqlite")) as connection:
        for table in ("runs", "campaigns"):
            connection.execute(f"UPDATE {table} SET scenario = 'elsewhere'")
        connection.commit()
    assert rosa("report", tmp_path).returncode == 0
    html = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<h2 id=" in html
    assert "search time s (unit unknown)" in html
    assert re.search(r"No installed scenario declares [\w, ]*search_time_s[\w, ]*: their units are not known", html)
    # It is known without a declaration that a value of type bool is a truth value; a count of 0 and 1 is none.
    assert "pipeline found (unit" not in html
    assert re.search(r"<td>100% \(\d+ to 100%\)</td>", html)
    assert "distributions of recharges" in html


def test_what_a_column_means_and_which_values_are_better_is_shown_at_its_head(html: str) -> None:
    assert re.search(r'<th title="time until [^"]*; less is better">search time s</th>', html)
    assert '<th title="a thruster fails">U1 s</th>' in html


def test_a_count_that_is_0_or_1_in_every_run_is_no_truth_value(tmp_path: Path) -> None:
    assert rosa("run", "agv", "--out", tmp_path / "agv", "-q").returncode == 0
    assert rosa("report", tmp_path / "agv").returncode == 0
    html = (tmp_path / "agv" / "report.html").read_text(encoding="utf-8")
    assert "distributions of goals reached" in html
    assert "% (" not in html.split("<h3>Distributions</h3>")[0]


def test_a_directory_that_cannot_be_written_is_bad_input(results: Path, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert "cannot write" in refused(rosa("report", results, "--out", tmp_path / "file" / "r.html"))


@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_a_browser_shows_it_without_network_and_without_complaint(results: Path, tmp_path: Path) -> None:
    assert CHROMIUM is not None
    picture = tmp_path / "page.png"
    process = subprocess.run(
        [
            CHROMIUM,
            *("--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--v=0"),
            # Whatever the page asked for would fail, and be reported on the console.
            *("--proxy-server=127.0.0.1:9", f"--user-data-dir={tmp_path / 'profile'}"),
            *("--window-size=1280,2000", f"--screenshot={picture}", "--virtual-time-budget=5000"),
            (results / "report.html").as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert ":CONSOLE" not in process.stderr
    from PIL import Image

    with Image.open(picture) as image:
        colours = image.convert("RGB").getcolors(1 << 24)
    assert colours is not None
    found = {colour for _, colour in colours}
    assert {(29, 39, 51), (47, 109, 181)} <= found  # ink and the accent: text, lines and boxes are drawn
    assert len(found) > 200


def test_two_runs_are_shown_side_by_side(tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    for path, manager in ((one, "rosa"), (other, "none")):
        assert rosa("run", "suave", "--manager", manager, "--time-limit", 60, "--out", path, "-q").returncode == 0
    shown = rosa("compare", one, other)
    assert shown.returncode == 0, shown.stderr
    assert re.search(r"manager +rosa +none", shown.stdout)
    assert re.search(r"U1 reactions +1 +0 +-1", shown.stdout)
    assert "thruster 1 failed" in shown.stdout
    document = json.loads(rosa("compare", one, other, "--json").stdout)
    assert [run["manager"] for run in document["runs"]] == ["rosa", "none"]
    assert "search_time_s" in document["differences"]
    assert document["inputs"] == {}
    assert "no run record" in refused(rosa("compare", one, tmp_path))


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("run.json", "[]"),
        ("run.json", "{"),
        ("run.json", '{"scenario": "suave"}'),
        ("events.jsonl", '{"time_s": 0}\n'),
        ("events.jsonl", '{"time_s": NaN, "text": "", "facts": []}\n'),
        ("trajectory.csv", "time_s,x_m\n1\n"),
        ("trajectory.csv", "time_s,x_m\n1,far\n"),
        ("wall_clock.json", '{"wall_clock_s": 1, "managing_s": 1, "metrics": 3}'),
    ],
)
def test_a_damaged_run_record_is_bad_input(tmp_path: Path, file: str, text: str) -> None:
    assert rosa("run", "suave", "--time-limit", 5, "--out", tmp_path, "-q").returncode == 0
    (tmp_path / file).write_text(text, encoding="utf-8")
    assert file in refused(rosa("compare", tmp_path, tmp_path))
