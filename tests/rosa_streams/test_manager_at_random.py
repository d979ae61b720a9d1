"""A manager through random perturbations: whatever happens, what can be had is had, validly."""

from __future__ import annotations

import random

import pytest

from benchmarks.stream_libraries import random_library, structured_library
from rosa_core.clock import SimulationClock
from rosa_streams.costs import DeclaredCosts, Objective
from rosa_streams.environment import Transformation
from rosa_streams.manager import Manager
from rosa_streams.planning import problem_of
from rosa_streams.runtime import Function, Sources
from rosa_streams.tags import Concept
from rosa_streams.validity import ViolationKind, violations


def check(manager: Manager) -> None:
    """What the manager promises after every review."""
    environment = manager.environment
    assert environment.units == manager.host.units()
    missing = {target.qid for target in problem_of(environment, DeclaredCosts()).unsatisfiable_goals()}
    assert set(manager.unsatisfied()) == missing
    found = violations(environment)
    if not missing:
        assert not found
        return
    unsatisfied = {each.about for each in found if each.kind is ViolationKind.UNSATISFIED_TARGET}
    assert unsatisfied <= missing, "the streams of the others are there"
    assert not [each for each in found if each.kind in {ViolationKind.SHARED_CHANNEL, ViolationKind.NO_TRANSFORMATION}]
    for qid in environment.goal():
        assert manager.why(qid).satisfied == (qid not in missing)


@pytest.mark.parametrize("seed", range(24))
def test_after_every_perturbation_what_can_be_had_is_had_validly(seed: int) -> None:
    rng = random.Random(seed)
    odd = seed % 2
    library = random_library(25, seed) if odd else structured_library(25, seed, branching=3, layers=3, targets=3)
    sources = Sources()
    sources.factory("none")(lambda parameters: Function(lambda *values: None, ("a", "b"), ("c", "d")))
    clock = SimulationClock()
    manager = Manager(clock, sources, objective=Objective(horizon=50.0), cpu_time=lambda: 0.0, tries=1000)
    tags = [target.tag for target in library.targets]
    tags += [port.tag for each in library.transformations for port in each.outputs]
    tags.sort(key=str)
    ordered = list(library.library().values())
    manager.register(ordered[: len(ordered) // 2])
    for step in range(40):
        if rng.random() < 0.4:
            change_targets(manager, rng, tags, step)
        elif rng.random() < 0.4:
            change_library(manager, rng, ordered)
        else:
            disturb(manager, rng, clock)
        check(manager)


def change_targets(manager: Manager, rng: random.Random, tags: list[Concept], step: int) -> None:
    goal = manager.environment.goal()
    if not goal or (len(goal) < 4 and rng.random() < 0.5):
        channel = f"/s{step}" if _taken(manager, step) else f"/r{step % 6}"
        manager.add_target(f"q{step}", rng.choice(tags), channel)
    elif rng.random() < 0.5:
        manager.remove_target(rng.choice(sorted(goal)))
    else:
        manager.replace_target(rng.choice(sorted(goal)), rng.choice(tags))


def change_library(manager: Manager, rng: random.Random, everything: list[Transformation]) -> None:
    known = manager.environment.library()
    new = [each for each in everything if each.tid not in known]
    if new and (not known or rng.random() < 0.6):
        manager.register([rng.choice(new)])
    else:
        manager.unregister(rng.choice(sorted(known)))


def disturb(manager: Manager, rng: random.Random, clock: SimulationClock) -> None:
    units = manager.environment.graph()
    choice = rng.random()
    if choice < 0.5 and units:
        for cid in rng.sample(sorted(units), min(2, len(units))):
            manager.host.lose(cid)
        clock.advance_to(clock.now())
    elif choice < 0.75 and units:
        unit = units[rng.choice(sorted(units))]
        for port in [port for port, channel in unit.inputs if channel is not None][:1]:
            manager.drop_subscription(unit.cid, port)
    else:
        clock.advance_to(clock.now() + rng.choice([1.0, 60.0]))


def _taken(manager: Manager, step: int) -> bool:
    return f"/r{step % 6}" in {target.channel for target in manager.environment.targets}
