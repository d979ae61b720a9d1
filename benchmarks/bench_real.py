"""From a process that is killed to the spare that has taken over: ``python benchmarks/bench_real.py [N]``.

Real processes, the adaptation loop with a thread for each of its parts, and the watch, as ``rosa up`` runs them. The
camera is killed with SIGKILL N times (by default 200); measured from the call of ``kill``

- until the knowledge base knows that it has failed,
- until the knowledge base has the spare active: a process that is started then and counts as ready when it runs, one
  that prints a line when it is (a shell), and one on standby that runs already and only has to be told.

At the end, what it costs to compare 200 components, which all run, with the knowledge base: what the watch does once in
a period. Beside the times stands the load of the machine, since they depend on it.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from rosa_core import KnowledgeBase, KnowledgeModel, WallClock
from rosa_core.kb import ComponentActivity, Event, MonitoringData
from rosa_core.mape import AdaptationLoop, ComponentState, Watch
from rosa_core.model.elements import Component, ComponentType, ParameterValue
from rosa_processes import ProcessEntry, ProcessSystem

MODEL = """
actions: {watch: {requires: [see]}}
functions: {see: {always_improve: true}}
components: {camera: {type: ros_node}, spare: {type: ros_node}}
function_designs:
  by camera: {function: see, components: [camera], priority: 1}
  by spare: {function: see, components: [spare], priority: 2}
"""
IDLE = ("sleep", "1000000")
SPARES = {
    "started when needed": ProcessEntry(command=IDLE),
    "started, ready by a line": ProcessEntry(
        command=("sh", "-c", "echo ready; exec sleep 1000000"), ready={"line": "ready"}
    ),
    "on standby": ProcessEntry(command=("cat",), standby=True),
}
PATIENCE = 30.0


class Seen:
    """When the knowledge base learnt what."""

    def __init__(self, kb: KnowledgeBase) -> None:
        self._changed = threading.Condition()
        self._times: dict[str, float] = {}
        kb.subscribe(self._on_event, (MonitoringData, ComponentActivity))

    def _on_event(self, event: Event) -> None:
        now = time.perf_counter()
        with self._changed:
            if isinstance(event, MonitoringData):
                self._times.update(dict.fromkeys((f"{name} failed" for name in event.failures), now))
            elif isinstance(event, ComponentActivity):
                self._times.update(dict.fromkeys((f"{name} runs" for name in event.activated), now))
                self._times.update(dict.fromkeys((f"{name} stopped" for name in event.deactivated), now))
            self._changed.notify_all()

    def reset(self) -> None:
        """Begin anew."""
        with self._changed:
            self._times.clear()

    def wait(self, *names: str) -> tuple[float, ...]:
        """When these were seen, in s; waits until they are."""
        with self._changed:
            if not self._changed.wait_for(lambda: all(name in self._times for name in names), PATIENCE):
                raise TimeoutError(f"{names} was not seen, only {list(self._times)}")
            return tuple(self._times[name] for name in names)


def measure(model: KnowledgeModel, spare: ProcessEntry, times: int) -> tuple[list[float], list[float]]:
    """Seconds from the kill until the failure is known, and until the spare is active."""
    known: list[float] = []
    active: list[float] = []
    system = ProcessSystem({"camera": ProcessEntry(command=IDLE), "spare": spare})
    with system, KnowledgeBase(model, WallClock(), dispatch="threads") as kb, AdaptationLoop(kb, system) as loop:
        if loop.watch is None:
            raise TypeError("processes can be observed")
        threading.Thread(target=loop.watch.run, daemon=True).start()
        seen = Seen(kb)
        kb.request_action("watch")
        seen.wait("camera runs")
        for _ in range(times):
            seen.reset()
            pid = system.pid("camera")
            began = time.perf_counter()
            os.kill(pid or 0, signal.SIGKILL)
            failed, runs = seen.wait("camera failed", "spare runs")
            known.append(failed - began)
            active.append(runs - began)
            seen.reset()
            kb.clear_component_failure("camera")
            seen.wait("camera runs", "spare stopped")
    return known, active


class Running:
    """A managed system of which everything runs."""

    def activate(self, component: str) -> None:
        """Nothing is to be done."""

    def deactivate(self, component: str) -> None:
        """Nothing is to be done."""

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> None:
        """Nothing is to be done."""

    def state(self, component: str) -> ComponentState:  # noqa: ARG002
        """It runs."""
        return ComponentState.ACTIVE


def measure_watch(components: int, times: int) -> list[float]:
    """Seconds of the processor for one look at all components."""
    model = KnowledgeModel(
        components=tuple(Component(f"c{number}", ComponentType.ROS_NODE) for number in range(components))
    )
    watch = Watch(KnowledgeBase(model, WallClock()), Running())
    watch.adopt()
    looks = []
    for _ in range(times):
        began = time.process_time()
        watch.check_all()
        looks.append(time.process_time() - began)
    return looks


def row(name: str, seconds: list[float]) -> str:
    """Percentiles in ms."""
    ordered = sorted(seconds)
    p50, p99 = (ordered[min(int(len(ordered) * share), len(ordered) - 1)] * 1e3 for share in (0.5, 0.99))
    return f"{name:48}{len(ordered):6}{p50:10.2f}{p99:10.2f}{ordered[-1] * 1e3:10.2f}"


def main(times: int = 200) -> None:
    """Print the table."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "model.yaml"
        file.write_text(MODEL, encoding="utf-8")
        model = KnowledgeModel.load(file)
    print(f"load of the machine at the beginning: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    print(f"{'killed -9, in ms':48}{'n':>6}{'p50':>10}{'p99':>10}{'longest':>10}")
    for name, spare in SPARES.items():
        known, active = measure(model, spare, times)
        print(row(f"spare {name}: failure known", known))
        print(row(f"spare {name}: spare active", active))
    print(row("the watch looks at 200 components (processor)", measure_watch(200, times)))
    print(f"load of the machine at the end: {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
