"""Real programs: started, ready, given parameters, stopped, killed."""

from __future__ import annotations

import json
import os
import signal
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from rosa_core.mape import ComponentState
from rosa_processes import ProcessEntry, ProcessSystem
from rosa_processes.keeper import marked
from tests.rosa_processes.programs import FOR_EVER, SOON, Changes, kill, lines_of, program, wait_for_end

ACTIVE, INACTIVE, UNKNOWN = ComponentState.ACTIVE, ComponentState.INACTIVE, ComponentState.UNKNOWN


@contextmanager
def managed(folder: Path = Path(), **entries: ProcessEntry) -> Iterator[tuple[ProcessSystem, Changes]]:
    with ProcessSystem(entries, folder) as system:
        yield system, Changes(system)


def test_a_program_is_started_and_stopped() -> None:
    with managed(camera=program(FOR_EVER)) as (system, changes):
        assert system.state("camera") is INACTIVE
        system.activate("camera")
        changes.become("camera", ACTIVE)
        pid = system.pid("camera")
        assert pid is not None
        system.activate("camera")
        assert system.pid("camera") == pid
        system.deactivate("camera")
        changes.become("camera", INACTIVE)
        assert system.pid("camera") is None
        wait_for_end([pid])


def test_its_environment_and_folder_are_as_declared(tmp_path: Path) -> None:
    text = "import os; print(os.environ['LENS'], os.getcwd(), flush=True); import signal; signal.pause()"
    (tmp_path / "there").mkdir()
    entry = program(text, env={"LENS": "wide"}, folder=Path("there"), log=Path("camera.log"))
    with managed(tmp_path, camera=entry) as (system, changes):
        system.activate("camera")
        changes.become("camera", ACTIVE)
        assert lines_of(tmp_path / "camera.log", 1) == [f"wide {tmp_path / 'there'}"]


def test_a_program_that_is_not_there_is_refused() -> None:
    with managed(camera=ProcessEntry(command=("/no/such/program",))) as (system, _):
        with pytest.raises(FileNotFoundError, match="no program '/no/such/program'"):
            system.activate("camera")
        assert system.state("camera") is INACTIVE


def test_a_folder_that_is_not_there_ends_the_start(tmp_path: Path) -> None:
    with managed(tmp_path, camera=program(FOR_EVER, folder=Path("nowhere"))) as (system, changes):
        system.activate("camera")
        changes.become("camera", INACTIVE)


# -- ready --


def test_it_is_ready_by_a_line_that_it_prints() -> None:
    text = "import sys; sys.stdin.read(1); print('the stream is open', flush=True); import signal; signal.pause()"
    entry = program(text, ready={"line": "stream is open"}, parameters={"stdin": "json"})
    with managed(camera=entry) as (system, changes):
        system.activate("camera")
        changes.wait(lambda: system.pid("camera"))
        assert system.state("camera") is UNKNOWN
        system.set_parameters("camera", {"go": True}).result(SOON)
        changes.become("camera", ACTIVE)


def test_it_is_ready_by_a_file_and_one_left_over_does_not_count(tmp_path: Path) -> None:
    (tmp_path / "ready").touch()
    text = f"import sys, pathlib; sys.stdin.read(1); pathlib.Path({str(tmp_path / 'ready')!r}).touch(); {FOR_EVER}"
    entry = program(text, ready={"file": "ready"}, parameters={"stdin": "json"})
    with managed(tmp_path, camera=entry) as (system, changes):
        system.activate("camera")
        changes.wait(lambda: system.pid("camera"))
        assert system.state("camera") is UNKNOWN
        system.set_parameters("camera", {"go": True}).result(SOON)
        changes.become("camera", ACTIVE)


def test_it_is_ready_by_a_port_or_by_a_probe() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    text = f"import socket; s = socket.create_server(('127.0.0.1', {port})); {FOR_EVER}"
    probe = ("sh", "-c", f"exec 3<>/dev/tcp/127.0.0.1/{port}") if Path("/bin/bash").exists() else ("true",)
    entries = {
        "by port": program(text, ready={"port": port}),
        "by probe": program(FOR_EVER, ready={"probe": ("bash", *probe[1:])}),
    }
    with managed(**entries) as (system, changes):
        system.activate("by probe")
        changes.wait(lambda: system.pid("by probe"))
        assert system.state("by probe") is UNKNOWN
        system.activate("by port")
        changes.become("by port", ACTIVE)
        changes.become("by probe", ACTIVE)


# -- parameters --

ARGUMENTS = "import sys; print(sys.argv[1:], flush=True); import signal; signal.pause()"


def test_by_argument_it_is_started_again_when_they_change(tmp_path: Path) -> None:
    entry = program(ARGUMENTS, parameters={"argument": "--{key}={value}"}, log=Path("log"), ready={"line": "["})
    with managed(tmp_path, camera=entry) as (system, changes):
        system.set_parameters("camera", {"rate": 10, "wide": True}).result(SOON)
        system.activate("camera")
        changes.become("camera", ACTIVE)
        pid = system.pid("camera")
        system.set_parameters("camera", {"rate": 10}).result(SOON)
        assert (system.state("camera"), system.pid("camera")) == (ACTIVE, pid)
        system.set_parameters("camera", {"rate": 5}).result(SOON)
        assert system.state("camera") is UNKNOWN
        changes.become("camera", ACTIVE)
        assert system.pid("camera") != pid
        assert lines_of(tmp_path / "log", 2) == ["['--rate=10', '--wide=true']", "['--rate=5', '--wide=true']"]


def test_by_standard_input_it_gets_them_at_the_start_and_when_they_change(tmp_path: Path) -> None:
    text = "import sys\nfor line in sys.stdin: print('got', line, end='', flush=True)"
    entry = program(text, parameters={"stdin": "json"}, log=Path("log"))
    with managed(tmp_path, camera=entry) as (system, changes):
        system.set_parameters("camera", {"rate": 10}).result(SOON)
        system.activate("camera")
        changes.become("camera", ACTIVE)
        system.set_parameters("camera", {"gain": 2.5}).result(SOON)
        assert lines_of(tmp_path / "log", 2) == ['got {"rate": 10}', 'got {"rate": 10, "gain": 2.5}']


def test_by_file_it_reads_them_when_a_signal_says_so(tmp_path: Path) -> None:
    text = (
        "import signal\nsignal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGHUP])\n"
        "while True: print(open('parameters.json').read(), end='', flush=True); signal.sigwait([signal.SIGHUP])"
    )
    entry = program(
        text, parameters={"file": "parameters.json", "signal": "HUP"}, log=Path("log"), ready={"line": "rate"}
    )
    with managed(tmp_path, camera=entry) as (system, changes):
        system.set_parameters("camera", {"rate": 10}).result(SOON)
        system.activate("camera")
        changes.become("camera", ACTIVE)
        system.set_parameters("camera", {"rate": 5}).result(SOON)
        assert [json.loads(line) for line in lines_of(tmp_path / "log", 2)] == [{"rate": 10}, {"rate": 5}]


def test_without_a_way_for_parameters_they_are_refused() -> None:
    with managed(camera=program(FOR_EVER)) as (system, _), pytest.raises(ValueError, match="not declared"):
        system.set_parameters("camera", {"rate": 1}).result(SOON)


# -- ends --


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSEGV])
def test_that_it_was_killed_is_known_without_asking(number: int) -> None:
    with managed(camera=program(FOR_EVER)) as (system, changes):
        system.activate("camera")
        changes.become("camera", ACTIVE)
        os.kill(system.pid("camera") or 0, number)
        changes.become("camera", INACTIVE)
        system.activate("camera")
        changes.become("camera", ACTIVE)


def test_one_that_ends_before_it_is_ready_is_inactive(caplog: pytest.LogCaptureFixture) -> None:
    with managed(camera=program("print('no lens'); raise SystemExit(3)", ready={"line": "never"})) as (system, changes):
        system.activate("camera")
        changes.become("camera", INACTIVE)
    assert "'camera' has ended by itself with exit code 3; it said: no lens" in caplog.text


def test_one_that_does_not_obey_is_killed() -> None:
    stubborn = "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); " + FOR_EVER
    entry = program(stubborn, ready={"line": "ready"}, stop={"within": 0.05})
    with managed(camera=entry) as (system, changes):
        system.activate("camera")
        changes.become("camera", ACTIVE)
        system.deactivate("camera")
        changes.become("camera", INACTIVE)


def test_what_is_asked_for_while_it_stops_comes_after_that() -> None:
    with managed(camera=program(FOR_EVER, ready={"line": "ready"})) as (system, changes):
        system.activate("camera")
        changes.become("camera", ACTIVE)
        pid = system.pid("camera")
        system.deactivate("camera")
        system._supervisor.call(lambda: None).result(SOON)  # it has been told to stop
        system.activate("camera")
        changes.wait(lambda: system.state("camera") is ACTIVE and system.pid("camera") != pid)


GRANDCHILDREN = (
    "import subprocess, sys\n"
    "sleep = [sys.executable, '-I', '-S', '-c', 'import signal; signal.pause()']\n"
    "one, two = subprocess.Popen(sleep), subprocess.Popen(sleep, start_new_session=True)\n"
    "print('ready', one.pid, two.pid, flush=True)\n"
    "import signal; signal.pause()"
)


def test_its_children_end_with_it(tmp_path: Path) -> None:
    entry = program(GRANDCHILDREN, ready={"line": "ready"}, log=Path("log"))
    with managed(tmp_path, camera=entry) as (system, changes):
        system.activate("camera")
        changes.become("camera", ACTIVE)
        one, two = map(int, lines_of(tmp_path / "log", 1)[0].split()[1:])
        kill(system.pid("camera"))
        wait_for_end([one])
        changes.become("camera", INACTIVE)
    wait_for_end([two])  # it had left the group: the keeper finds it at the end


def test_a_keeper_that_is_killed_is_replaced() -> None:
    with managed(camera=program(FOR_EVER)) as (system, changes):
        supervisor = system._supervisor
        first = supervisor._keeper
        kill(first.pid)
        wait_for_end([first.pid])
        system.activate("camera")
        changes.become("camera", ACTIVE)
        mark = supervisor.mark
        assert supervisor.call(lambda: supervisor._keeper.pid).result(SOON) != first.pid
    assert marked(mark) == []


def test_at_the_end_all_have_ended() -> None:
    with managed(camera=program(FOR_EVER), lidar=program(FOR_EVER, stop={"signal": "INT"})) as (system, changes):
        for name in ("camera", "lidar"):
            system.activate(name)
            changes.become(name, ACTIVE)
        pids = [system.pid("camera") or 0, system.pid("lidar") or 0]
    wait_for_end(pids)
    system.close()


# -- standby --

OBEDIENT = "import sys\nprint('ready', flush=True)\nfor line in sys.stdin: print('told', line, end='', flush=True)"


def test_one_on_standby_runs_already_and_is_only_told_to_be_active(tmp_path: Path) -> None:
    entry = program(OBEDIENT, standby=True, ready={"line": "ready"}, log=Path("log"))
    with managed(tmp_path, spare=entry) as (system, changes):
        lines_of(tmp_path / "log", 1)
        assert system.state("spare") is INACTIVE
        pid = system.pid("spare")
        system.activate("spare")
        changes.become("spare", ACTIVE)
        system.deactivate("spare")
        changes.become("spare", INACTIVE)
        assert system.pid("spare") == pid
        assert lines_of(tmp_path / "log", 3)[1:] == ['told {"active": true}', 'told {"active": false}']


def test_one_on_standby_that_is_killed_while_it_is_active_is_inactive_and_stands_by_again(tmp_path: Path) -> None:
    entry = program(OBEDIENT, standby=True, ready={"line": "ready"}, log=Path("log"))
    with managed(tmp_path, spare=entry) as (system, changes):
        system.activate("spare")
        changes.become("spare", ACTIVE)
        pid = system.pid("spare")
        kill(pid)
        changes.become("spare", INACTIVE)
        changes.wait(lambda: system.pid("spare") not in (pid, None))
        assert system.state("spare") is INACTIVE
