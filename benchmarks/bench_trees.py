"""How fast trees tick beside stock py_trees, load from large projects, and notice a change."""

from __future__ import annotations

import math
import random
import statistics
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import WallClock
from task_layer import bt
from task_layer.bt.testing import FakeKnowledgeBase


class Fixed(Behaviour):
    """A leaf that comes to the same at every tick."""

    def __init__(self, name: str, status: Status = Status.SUCCESS) -> None:
        super().__init__(name)
        self._comes_to = status

    def update(self) -> Status:
        return self._comes_to


@dataclass(frozen=True, slots=True)
class Nodes:
    """The nodes that a tree is made of."""

    sequence: Callable[[str, list[Behaviour]], Behaviour]
    reactive: Callable[[str, list[Behaviour]], Behaviour]
    fallback: Callable[[str, list[Behaviour]], Behaviour]
    retry: Callable[[str, Behaviour], Behaviour]


OURS = Nodes(
    bt.Sequence, bt.ReactiveSequence, bt.Fallback, lambda name, child: bt.RetryUntilSuccessful(name, child, -1)
)
STOCK = Nodes(
    lambda name, children: py_trees.composites.Sequence(name, memory=True, children=children),
    lambda name, children: py_trees.composites.Sequence(name, memory=False, children=children),
    lambda name, children: py_trees.composites.Selector(name, memory=True, children=children),
    lambda name, child: py_trees.decorators.Retry(name, child, 10),
)


def mission(nodes: Nodes) -> Behaviour:
    """The 22 nodes of the extended SUAVE mission (ROSA paper, figure 7), all of them visited in one tick."""

    def guarded(action: str, status: Status = Status.SUCCESS) -> Behaviour:
        return nodes.reactive(f"guarded {action}", [Fixed(f"{action} feasible"), Fixed(action, status)])

    search = nodes.sequence("search", [guarded("search_pipeline"), guarded("inspect_pipeline", Status.FAILURE)])
    done = nodes.reactive("done", [Fixed("is_pipeline_found"), Fixed("is_pipeline_inspected")])
    perform = nodes.reactive("perform", [nodes.fallback("or recharge", [search, guarded("recharge")]), done])
    begin = nodes.sequence("begin", [Fixed("arm_thrusters"), Fixed("set_guided_mode")])
    aborted = Fixed("is_mission_aborted", Status.FAILURE)
    return nodes.retry("retry", nodes.fallback("mission", [aborted, nodes.sequence("all", [begin, perform])]))


def thousand(nodes: Nodes) -> Behaviour:
    """A thousand leaves under 111 sequences."""

    def of(name: str, depth: int) -> Behaviour:
        if depth == 0:
            return Fixed(name)
        return nodes.sequence(name, [of(f"{name}.{number}", depth - 1) for number in range(10)])

    return of("tree", 3)


def seconds(tick: Callable[[], object]) -> float:
    """The least mean time of a call, of seven rounds of about 50 ms."""
    began = time.perf_counter()
    tick()
    times = max(1, int(0.05 / (time.perf_counter() - began)))
    rounds = []
    for _ in range(7):
        began = time.perf_counter()
        for _ in range(times):
            tick()
        rounds.append((time.perf_counter() - began) / times)
    return min(rounds)


def ticking() -> None:
    """Print how long a tick takes, both ways of ticking."""
    for what, make in (("22 nodes", mission), ("1000 leaves", thousand)):
        ours, stock = make(OURS), make(STOCK)
        assert (
            len(list(ours.iterate())) == len(list(stock.iterate())) == len(list(ours.tick())) == len(list(stock.tick()))
        )
        for how, mean in (
            ("tick_once", lambda root: seconds(root.tick_once)),
            ("BehaviourTree.tick", lambda root: seconds(py_trees.trees.BehaviourTree(root).tick)),
        ):
            our, their = mean(ours), mean(stock)
            print(f"{what}, {how}: {our * 1e6:.1f} us, stock {their * 1e6:.1f} us, {their / our:.1f} times as fast")


class Noticing(bt.IsActionFeasible):
    """Notes when it is ticked because its action has become feasible or unfeasible."""

    def __init__(self, action_name: str) -> None:
        super().__init__(action_name)
        self.at = math.nan
        self.last = Status.INVALID
        self.noticed = threading.Event()

    def update(self) -> Status:
        status = super().update()
        if status is not self.last:
            self.at, self.last = time.perf_counter(), status
            self.noticed.set()
        return status


def latencies(changes: int = 1000) -> list[float]:
    """Seconds from before a change of the knowledge base to the tick of the condition that reads it."""
    kb = FakeKnowledgeBase("inspect", clock=WallClock())
    condition = Noticing("inspect")
    root = bt.KeepRunningUntilFailure("watch", bt.ForceSuccess("always", condition))
    taken = []
    with bt.TreeRunner(root, kb, period=10.0) as runner:
        thread = threading.Thread(target=runner.run)
        thread.start()
        condition.noticed.wait()
        for change in range(changes):
            time.sleep(0.001)
            condition.noticed.clear()
            began = time.perf_counter()
            (kb.make_feasible if change % 2 else kb.make_unfeasible)("inspect")
            condition.noticed.wait()
            taken.append(condition.at - began)
        runner.interrupt()
        thread.join()
    return taken


def write_project(folder: Path, files: int) -> int:
    """A project whose trees use one another without includes, some eighty nodes in each file; its size in bytes."""
    chance, size = random.Random(1), 0

    def body(depth: int) -> str:
        if depth == 0 or chance.random() < 0.1:
            script = f'<Script code="n := {chance.randrange(99)}"/>'
            return chance.choice(('<move goal="{goal}" speed="0.5"/>', "<stop/>", script))
        tag = chance.choice(("Sequence", "Fallback", "ReactiveSequence"))
        below = "\n".join(body(depth - 1) for _ in range(chance.randint(2, 3)))
        return f"<{tag}>\n{below}\n</{tag}>"

    for number in range(files):
        uses = f'<SubTree ID="Tree {number + 30}" goal="{{goal}}"/>' if number + 30 < files else ""
        model = f'<TreeNodesModel><SubTree ID="Tree {number}"><input_port name="goal"/></SubTree></TreeNodesModel>'
        tree = f'<BehaviorTree ID="Tree {number}"><Sequence>{body(5)}{uses}</Sequence></BehaviorTree>'
        text = f'<root BTCPP_format="4" main_tree_to_execute="Tree {number}">\n{tree}\n{model}\n</root>'
        size += (folder / f"tree_{number}.xml").write_text(text, encoding="utf-8")
    return size


def loading(files: int = 300) -> None:
    """Print how long it takes to load a tree of a large project, and to check all trees of it."""

    def move(goal: str, speed: float) -> None:
        """A leaf with ports."""

    leaves = {"move": move, "stop": lambda: None}
    with tempfile.TemporaryDirectory() as folder:
        size = write_project(Path(folder), files)
        load, check = math.inf, math.inf
        for _ in range(5):
            began = time.perf_counter()
            project = bt.load_trees(folder, leaves)
            project.build("Tree 0", blackboard=bt.Blackboard())
            load = min(load, time.perf_counter() - began)
            began = time.perf_counter()
            assert project.warnings("Tree 0") == []
            check = min(check, time.perf_counter() - began)
    print(
        f"{files} files of {size / files / 1e3:.1f} KB: {load:.2f} s to load a tree, {check:.2f} s to check the others"
    )


def main() -> None:
    """Print the figures."""
    ticking()
    loading()
    taken = latencies()
    percentile = statistics.quantiles(taken, n=100)
    print(
        f"from a change of the knowledge base to the condition: median {statistics.median(taken) * 1e3:.3f} ms, "
        f"95 % {percentile[94] * 1e3:.3f} ms, 99 % {percentile[98] * 1e3:.3f} ms"
    )


if __name__ == "__main__":
    main()
