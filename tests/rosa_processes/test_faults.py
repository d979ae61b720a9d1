"""The whole loop over real programs that are absent, late, slow, refuse, and are killed at the worst time."""

from __future__ import annotations

import random
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from rosa_core import KnowledgeBase, Status, WallClock
from rosa_core.mape import AdaptationLoop, ComponentState, Limits
from rosa_processes import ProcessEntry, ProcessSystem
from tests.rosa_core.sample_models import knowledge_model
from tests.rosa_processes.programs import FOR_EVER, SOON, kill, program

MODEL = """
measures: {light: {kind: environmental}}
actions: {watch: {requires: [see]}}
functions: {see: {always_improve: true}}
components: {camera: {type: ros_node}, spare: {type: ros_node}}
function_designs:
  by camera: {function: see, components: [camera], priority: 1}
  by spare: {function: see, components: [spare], priority: 2}
component_configurations:
  day: {component: camera, parameters: {rate: 10}, priority: 1, constraints: [{measure: light, value: 50}]}
  night: {component: camera, parameters: {rate: 2}, priority: 2}
"""
PERIOD = 0.05
READY = {"ready": {"line": "ready"}}
STDIN = {"parameters": {"stdin": "json"}}
SPARE = program(FOR_EVER, **READY)


class Robot:
    """What a test looks at: the knowledge base, and how the programs really are."""

    def __init__(self, kb: KnowledgeBase, system: ProcessSystem) -> None:
        self.kb = kb
        self.system = system
        self._changed = threading.Condition()
        kb.subscribe(self._notify)
        system.subscribe(self._notify)

    def _notify(self, _: object) -> None:
        with self._changed:
            self._changed.notify_all()

    def wait(self, so: Callable[[], object]) -> None:
        # The time-out only bounds how long a failing test takes; a look now and then costs nothing.
        with self._changed:
            for _ in range(int(SOON / PERIOD)):
                if self._changed.wait_for(so, PERIOD):
                    return
        raise AssertionError("it did not come to that")

    def wait_until_by(self, name: str) -> None:
        """Until the knowledge base says that this one runs, alone, and so it is."""
        other = "spare" if name == "camera" else "camera"
        self.wait(
            lambda: (
                self.kb.is_component_active(name)
                and not self.kb.is_component_active(other)
                and self.system.state(name) is ComponentState.ACTIVE
                and self.system.state(other) is ComponentState.INACTIVE
                and self.kb.status("action", "watch") is Status.SOLVED
            )
        )


@contextmanager
def robot(
    folder: Path, camera: ProcessEntry, limits: Limits | None = None, journal: Path | None = None
) -> Iterator[Robot]:
    with (
        ProcessSystem({"camera": camera, "spare": SPARE}, folder) as system,
        KnowledgeBase(knowledge_model(MODEL), WallClock(), journal, dispatch="threads") as kb,
        AdaptationLoop(kb, system, limits={"camera": limits or Limits()}, watch_period=PERIOD) as loop,
    ):
        assert loop.watch is not None
        loop.watch.adopt()
        threading.Thread(target=loop.watch.run, daemon=True).start()
        yield Robot(kb, system)


def test_absent(tmp_path: Path) -> None:
    absent = ProcessEntry(command=(str(tmp_path / "camera"),), **STDIN)
    with robot(tmp_path, absent) as r:
        r.kb.request_action("watch")
        r.wait_until_by("spare")
        assert r.kb.status("component", "camera") is Status.FAILURE


def test_absent_at_first_and_tried_again_after_its_recovery(tmp_path: Path) -> None:
    file = tmp_path / "camera"
    with robot(tmp_path, ProcessEntry(command=(str(file),), **STDIN), Limits(recovery=0.1)) as r:
        r.kb.request_action("watch")
        r.wait_until_by("spare")
        beside = tmp_path / "beside"
        beside.write_text("#!/bin/sh\nexec cat\n")
        beside.chmod(0o755)
        beside.rename(file)
        r.wait_until_by("camera")


def test_late_but_within_the_attempts(tmp_path: Path) -> None:
    """It is ready when somebody has seen it start, which is after its first attempt."""
    text = "import pathlib, time\nwhile not pathlib.Path('go').exists(): time.sleep(0.01)\n" + FOR_EVER
    with robot(tmp_path, program(text, **READY, **STDIN), Limits(activation=0.2, attempts=1000)) as r:
        r.kb.request_action("watch")
        r.wait(lambda: r.system.pid("camera"))
        pid = r.system.pid("camera")
        threading.Timer(0.5, (tmp_path / "go").touch).start()
        r.wait_until_by("camera")
        assert r.system.pid("camera") == pid


def test_too_late(tmp_path: Path) -> None:
    with robot(tmp_path, program("import signal; signal.pause()", **READY, **STDIN), Limits(0.1, attempts=2)) as r:
        r.kb.request_action("watch")
        r.wait_until_by("spare")


@pytest.mark.parametrize(("times", "by"), [(1, "camera"), (10**6, "spare")])
def test_refusing_once_and_always(tmp_path: Path, times: int, by: str) -> None:
    text = "import pathlib; log = pathlib.Path('starts').open('a'); log.write('x'); log.close()\n" + (
        f"if len(pathlib.Path('starts').read_text()) <= {times}: raise SystemExit(1)\n{FOR_EVER}"
    )
    with robot(tmp_path, program(text, **READY, **STDIN)) as r:
        r.kb.request_action("watch")
        r.wait_until_by(by)
    assert len((tmp_path / "starts").read_text()) == (2 if by == "camera" else 3)


def test_parameters_refused(tmp_path: Path) -> None:
    entry = program(FOR_EVER, parameters={"file": "no/such/folder/parameters.json"})
    with robot(tmp_path, entry) as r:
        r.kb.request_action("watch")
        r.wait_until_by("spare")


def test_killed_while_it_starts(tmp_path: Path) -> None:
    """At its first start it waits to be killed; the second is good."""
    text = (
        "import pathlib, signal\nfirst = pathlib.Path('first')\nif not first.exists(): first.touch(); signal.pause()\n"
    )
    with robot(tmp_path, program(text + FOR_EVER, **READY, **STDIN)) as r:
        r.kb.request_action("watch")
        r.wait(lambda: (tmp_path / "first").exists() and r.system.pid("camera"))
        kill(r.system.pid("camera"))
        r.wait_until_by("camera")


def test_killed_idle_and_restarted_with_its_parameters(tmp_path: Path) -> None:
    text = "import sys\nfor line in sys.stdin: print('ready', line, end='', flush=True)"
    entry = program(text, **READY, **STDIN, log=Path("log"))
    with robot(tmp_path, entry, Limits(restarts=3)) as r:
        r.kb.request_action("watch")
        r.wait_until_by("camera")
        for _ in range(3):
            pid = r.system.pid("camera")
            kill(pid)
            r.wait(lambda old=pid: r.system.pid("camera") not in (None, old))  # type: ignore[misc]
            r.wait_until_by("camera")
        kill(r.system.pid("camera"))
        r.wait_until_by("spare")
    assert (tmp_path / "log").read_text().splitlines().count('ready {"rate": 10}') == 4


def test_killed_while_it_stops(tmp_path: Path) -> None:
    stubborn = "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); " + FOR_EVER
    with robot(tmp_path, program(stubborn, **READY, **STDIN, stop={"within": 1000})) as r:
        r.kb.request_action("watch")
        r.wait_until_by("camera")
        pid = r.system.pid("camera")
        r.kb.finish_action("watch")
        r.wait(lambda: r.system.state("camera") is ComponentState.UNKNOWN)
        kill(pid)
        r.wait(lambda: not r.kb.is_component_active("camera"))
        assert r.kb.status("component", "camera") is Status.FEASIBLE


def test_the_spare_killed_too(tmp_path: Path) -> None:
    with robot(tmp_path, program(FOR_EVER, **READY, **STDIN)) as r:
        r.kb.request_action("watch")
        r.wait_until_by("camera")
        kill(r.system.pid("camera"))
        r.wait_until_by("spare")
        kill(r.system.pid("spare"))
        r.wait(lambda: r.kb.status("action", "watch") is Status.UNFEASIBLE)
        r.wait(lambda: not r.kb.is_component_active("spare"))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_killed_again_and_again_at_any_time_what_is_known_is_what_is(tmp_path: Path, seed: int) -> None:
    chance = random.Random(seed)
    limits = Limits(activation=5, restarts=2, restarts_within=0.3, recovery=0.05)
    with robot(tmp_path, program(FOR_EVER, **READY, **STDIN), limits) as r:
        r.kb.request_action("watch")
        for _ in range(60):
            names = [name for name in ("camera", "spare") if r.system.pid(name)]
            if names and chance.random() < 0.7:
                pid = r.system.pid(chance.choice(names))
                if pid is not None:
                    kill(pid)
            else:
                r.kb.add_measurement("light", chance.choice((10, 90)))
            r.kb.clear_component_failure("spare")
            threading.Event().wait(chance.random() * 0.05)
        r.kb.clear_component_failure("spare")
        r.wait(lambda: r.kb.pending_reconfiguration_plan() is None and r.kb.status("action", "watch") is Status.SOLVED)
        for name in ("camera", "spare"):
            r.wait(
                lambda n=name: r.kb.is_component_active(n) == (r.system.state(n) is ComponentState.ACTIVE)  # type: ignore[misc]
            )
