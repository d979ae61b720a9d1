"""``rosa up`` as a user runs it: real programs, killed by hand, and the command itself killed and started again."""

from __future__ import annotations

import json
import queue
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from rosa_core import KnowledgeBase, KnowledgeModel
from tests.rosa_processes.programs import SOON, kill, wait_for_end

EXAMPLE = Path(__file__).parents[2] / "examples" / "real_processes"
ROSA = Path(sys.executable).with_name("rosa")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the example, that runs with the Python of the tests."""
    copy = tmp_path / "robot"
    shutil.copytree(EXAMPLE, copy)
    robot = copy / "robot.yaml"
    robot.write_text(robot.read_text().replace("python3", sys.executable))
    return copy


class Up:
    """The running command, its messages, and its standard input."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.said: list[str] = []
        self._lines: queue.Queue[str] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self._lines.put(line.strip())

    def hear(self, *texts: str) -> None:
        """Until it has said all of these, in any order, since it was last listened to."""
        wanted = set(texts)
        while wanted:
            try:
                line = self._lines.get(timeout=SOON)
            except queue.Empty:
                raise AssertionError(f"{wanted} is missing after {self.said}") from None
            self.said.append(line)
            wanted.discard(line)

    def tell(self, **diagnostic: object) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(diagnostic) + "\n")
        self.process.stdin.flush()

    def end(self, number: int = signal.SIGTERM) -> int:
        self.process.send_signal(number)
        return self.process.wait(SOON)


@contextmanager
def up(folder: Path, *options: str) -> Iterator[Up]:
    command = [str(ROSA), "up", "robot.yaml", *options]
    with subprocess.Popen(
        command, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            yield Up(process)
        finally:
            process.kill()


def programs_in(folder: Path) -> dict[str, int]:
    """The example's programs that run in this folder, by their command without the interpreter."""
    found = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if (entry / "cwd").readlink() == folder and b".py" in (command := (entry / "cmdline").read_bytes()):
                    found[" ".join(command.decode().rstrip("\0").split("\0")[1:])] = int(entry.name)
            except OSError:
                continue
    return found


def test_a_camera_killed_by_hand_is_replaced_and_comes_back_and_everything_ends_in_order(folder: Path) -> None:
    robot = folder / "robot.yaml"
    robot.write_text(robot.read_text().replace("recovery: 10", "recovery: 0.5"))
    with up(folder, "--journal", "journal.sqlite") as running:
        running.hear("watch is required", "camera runs", "reporter runs")
        kill(programs_in(folder)["camera.py frames.txt"])
        running.hear("camera has failed", "spare_camera runs")
        running.hear("camera works again", "camera runs", "spare_camera runs no longer")
        running.tell(component="camera", status="FALSE")
        running.hear("camera has failed", "spare_camera runs")
        assert running.end() == 0
        running.hear("the mission ended: interrupted")
    assert programs_in(folder) == {}
    assert still_active(folder) == []


def still_active(folder: Path) -> list[str]:
    model = KnowledgeModel.load(folder / "model.yaml")
    with KnowledgeBase(model, journal=folder / "journal.sqlite") as kb:
        return [component.name for component in model.components if kb.is_component_active(component.name)]


def test_a_command_that_is_killed_leaves_nothing_and_goes_on_when_it_is_started_again(folder: Path) -> None:
    with up(folder, "--journal", "journal.sqlite") as running:
        running.hear("camera runs", "reporter runs")
        running.tell(measure="light", value=80)
        kill(programs_in(folder)["camera.py frames.txt"])
        running.hear("camera has failed", "spare_camera runs")
        left = list(programs_in(folder).values())
        kill(running.process.pid)
        wait_for_end(left)
    with up(folder, "--journal", "journal.sqlite") as running:
        running.hear("reporter runs", "spare_camera runs")
        assert "camera runs" not in running.said  # that it has failed is still known
        assert running.end(signal.SIGINT) == 0
    model = KnowledgeModel.load(folder / "model.yaml")
    with KnowledgeBase(model, journal=folder / "journal.sqlite") as kb:
        assert kb.measurement("light").value == 80  # type: ignore[union-attr]


def test_a_mission_that_comes_to_its_end_ends_it(folder: Path) -> None:
    robot = folder / "robot.yaml"
    robot.write_text(robot.read_text().replace("duration: 60", "duration: 0.2"))
    mission = folder / "once.xml"
    mission.write_text('<root BTCPP_format="4"><BehaviorTree ID="T"><Action ID="watch"/></BehaviorTree></root>')
    with up(folder, "--mission", "once.xml", "--json") as running:
        out, _ = running.process.communicate(timeout=SOON)
        assert json.loads(out) == {"mission": "success", "feedback": ""}
        assert running.process.returncode == 0


def test_an_action_as_a_skill_of_the_robots_own(folder: Path) -> None:
    (folder / "own_skills.py").write_text(
        "from task_layer.skill import Skill, SkillStatus\n"
        "class Look(Skill):\n"
        "    def update(self):\n"
        "        return SkillStatus.FAILURE\n"
    )
    robot = folder / "robot.yaml"
    robot.write_text(robot.read_text().replace("duration: 60", "skill: own_skills:Look"))
    mission = folder / "once.xml"
    mission.write_text('<root BTCPP_format="4"><BehaviorTree ID="T"><Action ID="watch"/></BehaviorTree></root>')
    with up(folder, "--mission", "once.xml") as running:
        running.hear("watch has ended: failed", "the mission ended: failure")
        assert running.process.wait(SOON) == 1


def test_a_mission_in_pddl(folder: Path) -> None:
    robot = folder / "robot.yaml"
    robot.write_text(robot.read_text().replace("duration: 60", "until: light >= 50"))
    (folder / "domain.pddl").write_text(
        "(define (domain guard) (:requirements :strips) (:predicates (watched))"
        " (:action watch :parameters () :precondition (and) :effect (watched)))"
    )
    (folder / "problem.pddl").write_text("(define (problem p) (:domain guard) (:init) (:goal (watched)))")
    with up(folder, "--mission", "domain.pddl", "--mission", "problem.pddl") as running:
        running.hear("watch is required", "camera runs")
        running.tell(measure="light", value=80)
        running.hear("watch has ended: completed", "the mission ended: success")
        assert running.process.wait(SOON) == 0


def test_without_a_mission_actions_are_required_until_it_ends(folder: Path) -> None:
    robot = folder / "robot.yaml"
    text = robot.read_text().replace("mission: mission.xml", "require: watch")
    robot.write_text(text.replace("stdin: true", "{socket: rosa.sock}").replace("monitors:\n  {", "monitors: {"))
    with up(folder) as running:
        running.hear("watch is required", "camera runs", "reporter runs")
        import socket

        with socket.socket(socket.AF_UNIX) as monitor:
            monitor.connect(str(folder / "rosa.sock"))
            monitor.sendall(b'{"component": "camera", "status": "FALSE"}\nnonsense\n{"measure": "light"}\n')
            refused = "a line is no diagnostic: Expecting value: line 1 column 1 (char 0)"
            running.hear("camera has failed", "spare_camera runs", refused)
        assert running.end() == 0


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "  camera:\n    command",
            "  camra:\n    command",
            "the model has no component 'camra' (did you mean 'camera'?)",
        ),
        ("parameters: {stdin: json}", "env: {A: b}", "it is not said how 'camera' takes its parameters"),
        ("ready: {line: the stream is open}", "ready: {}", "a process is ready by one of line, file, port and probe"),
        ("[python3, reporter.py, frames.txt]", "reporter.py", "a command is a list, not one text"),
        ("watch: {duration: 60}", "wach: {duration: 60}", "the model has no action 'wach' (did you mean 'watch'?)"),
        ("watch: {duration: 60}", "watch: {until: lihgt > 3}", "the model has no measure 'lihgt'"),
        ("watch: {duration: 60}", "watch: {skill: 'nowhere:Skill'}", "there is no 'nowhere:Skill'"),
        ("mission: mission.xml", "mission: {domain: d.pddl}", "no 'problem'"),
        ("limits: {restarts: 3}", "limits: {restart: 3}", "did you mean 'restarts'?"),
        ("stdin: true", "stdout: true", "unknown key 'stdout'"),
    ],
)
def test_what_is_wrong_with_a_robots_file_is_said_with_its_line(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    from rosa_core import InputError
    from rosa_processes import read_robot

    shutil.copytree(EXAMPLE, tmp_path / "robot")
    file = tmp_path / "robot" / "robot.yaml"
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as refused:
        read_robot(file)
    assert message in str(refused.value)
    line = text[: text.index(old)].count("\n") + 1
    assert any(f"robot.yaml:{near}:" in str(refused.value) for near in range(line - 3, line + 3))


def test_a_mission_that_is_not_there_is_bad_input(folder: Path) -> None:
    done = subprocess.run(
        [str(ROSA), "up", "robot.yaml", "--mission", "no.xml"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert "no.xml" in done.stderr
    assert "Traceback" not in done.stderr
