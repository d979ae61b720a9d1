"""Domains, robots and skills for trying plans out, and a naive idea of what planning means."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from importlib.resources import files

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.model.elements import Action, Constraint, ConstraintOperator, ElementKind, ElementRef, Measure
from task_layer.pddl import GroundTask, parse_task
from task_layer.skill import Skill, SkillStatus

MISSIONS = files("suave.missions")
SUAVE_DOMAIN = MISSIONS.joinpath("suave_domain.pddl").read_text(encoding="utf-8")
SUAVE_PROBLEM = MISSIONS.joinpath("suave_extended_problem.pddl").read_text(encoding="utf-8")


def suave_problem(*feasible: str, targets: int = 1, started: bool = False) -> str:
    """The extended mission with some actions feasible, and as many pipelines as wanted."""
    pipelines = [f"p{number}" for number in range(1, targets + 1)]
    facts = [f"(action_feasible {name})" for name in feasible]
    facts += ["(robot_started bluerov)"] if started else []
    goals = [f"(pipeline_found {name}) (pipeline_inspected {name})" for name in pipelines]
    text = SUAVE_PROBLEM.replace("p1 - pipeline", f"{' '.join(pipelines)} - pipeline")
    text = text.replace("(:init", f"(:init {' '.join(facts)}")
    return text.replace("(pipeline_found p1)", "").replace("(pipeline_inspected p1)", " ".join(goals))


def names(steps: Iterable[str]) -> list[str]:
    """The actions of steps, without their arguments."""
    return [step.strip("()").split()[0] for step in steps]


def knowledge(actions: Iterable[str], clock: SimulationClock | None = None) -> KnowledgeBase:
    """A knowledge base of actions, each feasible unless the measure ``ok ACTION`` is below 1."""
    actions = list(actions)
    constraints = [
        Constraint(f"ok {name}", ElementRef(ElementKind.ACTION, name), ConstraintOperator.GREATER_OR_EQUAL, 1.0)
        for name in actions
    ]
    model = KnowledgeModel(
        measures=tuple(Measure(f"ok {name}") for name in actions),
        actions=tuple(Action(name) for name in actions),
        constraints=tuple(constraints),
    )

    def fail(error: BaseException, _subscriber: object, _event: object) -> None:
        raise error

    return KnowledgeBase(model, clock=clock or SimulationClock(), on_subscriber_error=fail)


def set_feasible(kb: KnowledgeBase, action: str, feasible: bool) -> None:
    """Make an action of :func:`knowledge` feasible or unfeasible."""
    kb.add_measurement(f"ok {action}", 1.0 if feasible else 0.0)


class Scripted(Skill):
    """A skill that takes some updates and then ends as a test wants; it writes down what is done to it."""

    def __init__(
        self,
        updates: int = 1,
        outcomes: Sequence[SkillStatus] = (),
        *,
        on_start: Callable[[], None] = lambda: None,
        on_success: Callable[[], None] = lambda: None,
    ) -> None:
        self.updates = updates
        self.outcomes = deque(outcomes)
        self.on_start = on_start
        self.on_success = on_success
        self.calls: list[str] = []
        self._left = 0

    def start(self) -> None:
        self.calls.append("start")
        self._left = self.updates
        self.on_start()

    def update(self) -> SkillStatus:
        self._left -= 1
        if self._left > 0:
            return SkillStatus.RUNNING
        outcome = self.outcomes.popleft() if self.outcomes else SkillStatus.SUCCESS
        self.calls.append(outcome.value)
        if outcome is SkillStatus.SUCCESS:
            self.on_success()
        return outcome

    def stop(self) -> None:
        self.calls.append("stop")


Literals = tuple[frozenset[str], frozenset[str]]
"""Facts that hold, and facts that do not."""
EMPTY: Literals = (frozenset(), frozenset())


@dataclass(frozen=True)
class Act:
    """A durative action of a small domain, whose facts have no arguments."""

    name: str
    at_start: Literals = EMPTY
    over_all: Literals = EMPTY
    at_end: Literals = EMPTY
    start_effect: Literals = EMPTY
    end_effect: Literals = EMPTY

    @property
    def text(self) -> str:
        """The action in PDDL."""
        conditions = [
            f"({time} {literal})"
            for time, literals in (("at start", self.at_start), ("over all", self.over_all), ("at end", self.at_end))
            for literal in written(literals)
        ]
        conditions.append(f"(over all (action_feasible {self.name}))")
        effects = [
            f"({time} {literal})"
            for time, literals in (("at start", self.start_effect), ("at end", self.end_effect))
            for literal in written(literals)
        ]
        return (
            f"(:durative-action {self.name} :parameters () :duration (= ?duration 1)\n"
            f" :condition (and {' '.join(conditions)})\n :effect (and {' '.join(effects)}))"
        )


@dataclass
class World:
    """What is naively believed: a set of facts."""

    facts: set[str] = field(default_factory=set)

    def holds(self, literals: Literals) -> bool:
        """Whether literals hold."""
        return literals[0] <= self.facts and not literals[1] & self.facts

    def apply(self, literals: Literals) -> None:
        """Make literals hold; what is made both true and false is true."""
        self.facts -= literals[1]
        self.facts |= literals[0]

    def can_start(self, act: Act) -> bool:
        """Whether what an action needs at its start, and throughout after its own start, holds."""
        if not self.holds(act.at_start):
            return False
        after = World(set(self.facts))
        after.apply(act.start_effect)
        return after.holds(act.over_all)

    def after(self, act: Act) -> World | None:
        """The world after an action that nothing disturbs; None if it cannot be carried out."""
        if not self.can_start(act):
            return None
        world = World(set(self.facts))
        world.apply(act.start_effect)
        if not world.holds(act.over_all) or not world.holds(act.at_end):
            return None
        world.apply(act.end_effect)
        return world


def written(literals: Literals) -> list[str]:
    """Literals in PDDL, in order."""
    return [f"({fact})" for fact in sorted(literals[0])] + [f"(not ({fact}))" for fact in sorted(literals[1])]


def small_task(acts: Sequence[Act], initial: Iterable[str], goal: Literals, facts: Sequence[str]) -> GroundTask:
    """A task of actions without arguments; the actions are also the objects of the feasibility predicate."""
    acts_text = "\n".join(act.text for act in acts)
    domain = (
        "(define (domain small) (:requirements :strips :typing :durative-actions :negative-preconditions)\n"
        f"(:types action) (:constants {' '.join(act.name for act in acts)} - action)\n"
        f"(:predicates (action_feasible ?a - action) {' '.join(f'({fact})' for fact in facts)})\n{acts_text})"
    )
    problem = (
        f"(define (problem p) (:domain small) (:init {' '.join(f'({fact})' for fact in sorted(initial))})\n"
        f"(:goal (and {' '.join(written(goal))})))"
    )
    return parse_task(domain, problem)


def reachable(acts: Iterable[Act], world: World, goal: Literals) -> bool:
    """Whether some order of actions leads to the goal, by trying all."""
    acts = list(acts)
    queue, seen = deque([world]), {frozenset(world.facts)}
    while queue:
        now = queue.popleft()
        if now.holds(goal):
            return True
        for act in acts:
            then = now.after(act)
            if then is not None and frozenset(then.facts) not in seen:
                seen.add(frozenset(then.facts))
                queue.append(then)
    return False
