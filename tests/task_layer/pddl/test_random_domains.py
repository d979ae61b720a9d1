"""Random domains with everything of ADL, beside a naive reading of what their formulas mean."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any, TypeAlias

from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from rosa_core import InputError, SimulationClock
from task_layer.pddl import ExecutionLimits, ExecutionStatus, GroundTask, PlanExecutor, Planner, parse_task
from tests.task_layer.pddl.kit import Scripted, knowledge

OBJECTS = ("a", "b")
FACTS = (*(f"({name} {item})" for name in "pq" for item in OBJECTS), "(r)")
QUIET = settings(deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow])

Formula: TypeAlias = tuple[Any, ...]
State = frozenset[str]
Binding = dict[str, str]


@dataclass(frozen=True)
class Change:
    """``when`` the condition holds, an atom becomes true or false; for all objects if it is about ``?z``."""

    condition: Formula
    atom: Formula
    value: bool


@dataclass(frozen=True)
class Deed:
    """An action of plain PDDL."""

    name: str
    parameters: tuple[str, ...]
    precondition: Formula
    changes: tuple[Change, ...]


def text(formula: Formula) -> str:
    """A formula in PDDL."""
    head, *rest = formula
    if head in ("forall", "exists"):
        return f"({head} ({rest[0]} - thing) {text(rest[1])})"
    return f"({' '.join([head, *(part if isinstance(part, str) else text(part) for part in rest)])})"


def meant(formula: Formula, state: State, binding: Binding) -> bool:
    """Whether a formula holds in a state."""
    match formula:
        case ("and", *parts):
            return all(meant(part, state, binding) for part in parts)
        case ("or", *parts):
            return any(meant(part, state, binding) for part in parts)
        case ("not", part):
            return not meant(part, state, binding)
        case ("imply", one, other):
            return not meant(one, state, binding) or meant(other, state, binding)
        case ("forall", variable, part):
            return all(meant(part, state, {**binding, variable: item}) for item in OBJECTS)
        case ("exists", variable, part):
            return any(meant(part, state, {**binding, variable: item}) for item in OBJECTS)
        case ("=", one, other):
            return binding.get(one, one) == binding.get(other, other)
    return atom(formula, binding) in state


def atom(formula: Formula, binding: Binding) -> str:
    """An atom of objects."""
    head, *terms = formula
    return f"({' '.join([head, *(binding.get(term, term) for term in terms)])})"


def after(deed: Deed, binding: Binding, state: State) -> State | None:
    """The state after an action; None if it cannot be performed."""
    if not meant(deed.precondition, state, binding):
        return None
    made, removed = set(), set()
    for change in deed.changes:
        for item in OBJECTS:
            inner = {**binding, "?z": item}
            if meant(change.condition, state, inner):
                (made if change.value else removed).add(atom(change.atom, inner))
    return state - removed | made


def ways(deed: Deed) -> Iterator[Binding]:
    """Every choice of objects for the parameters."""
    for items in product(OBJECTS, repeat=len(deed.parameters)):
        yield dict(zip(deed.parameters, items, strict=True))


def reachable(deeds: list[Deed], state: State, goal: Formula) -> bool:
    """Whether the goal can be reached, by trying everything."""
    queue, seen = deque([state]), {state}
    while queue:
        now = queue.popleft()
        if meant(goal, now, {}):
            return True
        for deed in deeds:
            for binding in ways(deed):
                then = after(deed, binding, now)
                if then is not None and then not in seen:
                    seen.add(then)
                    queue.append(then)
    return False


@st.composite
def formulas(draw: Callable[..., Any], terms: tuple[str, ...], depth: int = 2) -> Formula:
    kinds = ("atom", "atom", "not", *(("and", "or", "imply", "forall", "exists", "=") if depth else ()))
    kind = draw(st.sampled_from(kinds))
    if kind in ("and", "or", "imply"):
        return kind, draw(formulas(terms, depth - 1)), draw(formulas(terms, depth - 1))
    if kind in ("forall", "exists"):
        variable = f"?v{depth}"
        return kind, variable, draw(formulas((*terms, variable), depth - 1))
    if kind == "=":
        return kind, draw(st.sampled_from(terms)), draw(st.sampled_from(terms))
    name = draw(st.sampled_from("pqr"))
    found = (name,) if name == "r" else (name, draw(st.sampled_from(terms)))
    return found if kind == "atom" else ("not", found)


@st.composite
def changes(draw: Callable[..., Any], terms: tuple[str, ...]) -> Change:
    name = draw(st.sampled_from("pqr"))
    reached = (*terms, "?z")
    about = (name,) if name == "r" else (name, draw(st.sampled_from(reached)))
    condition = draw(st.one_of(st.just(("and",)), formulas(reached, 0)))
    return Change(condition, about, draw(st.booleans()))


@st.composite
def deeds(draw: Callable[..., Any]) -> list[Deed]:
    found = []
    for number in range(draw(st.integers(1, 3))):
        parameters = draw(st.sampled_from([(), ("?x",), ("?x", "?y")]))
        terms = (*parameters, "a")
        several = tuple(draw(st.lists(changes(terms), min_size=1, max_size=3)))
        found.append(Deed(f"do{number}", parameters, draw(formulas(terms)), several))
    return found


def written(found: list[Deed], state: set[str], goal: Formula) -> GroundTask:
    """The same in PDDL."""
    actions = "".join(
        f"\n(:action {deed.name} :parameters ({' '.join(deed.parameters)}{' - thing' * bool(deed.parameters)})"
        f" :precondition {text(deed.precondition)}\n :effect (and {' '.join(map(_effect, deed.changes))}))"
        for deed in found
    )
    domain = (
        "(define (domain random) (:requirements :adl) (:types thing) (:constants a b - thing)\n"
        f"(:predicates (p ?o - thing) (q ?o - thing) (r)){actions})"
    )
    problem = f"(define (problem one) (:domain random) (:init {' '.join(sorted(state))}) (:goal {text(goal)}))"
    try:
        return parse_task(domain, problem)
    except InputError as error:
        raise AssertionError(f"{error}\n{domain}\n{problem}") from error


def _effect(change: Change) -> str:
    literal = text(change.atom) if change.value else f"(not {text(change.atom)})"
    conditional = literal if change.condition == ("and",) else f"(when {text(change.condition)} {literal})"
    return f"(forall (?z - thing) {conditional})" if "?z" in f"{change.atom}{change.condition}" else conditional


@QUIET
@given(deeds(), st.sets(st.sampled_from(FACTS)), formulas(("a", "b")), st.booleans())
def test_a_plan_is_found_exactly_if_there_is_one_and_its_execution_reaches_the_goal(
    found: list[Deed], initial: set[str], goal: Formula, parallel: bool
) -> None:
    task = written(found, initial, goal)
    try:
        planner = Planner(task, parallel=parallel)
    except InputError as error:
        assume("outcomes" not in str(error))
        raise
    by_name = {deed.name: deed for deed in found}
    plan = planner.plan().plan
    assert (plan is not None) is reachable(found, frozenset(initial), goal)
    state: State | None = frozenset(initial)
    for step in plan.steps if plan is not None else ():
        deed = by_name[step.operator.action]
        assert state is not None
        state = after(deed, dict(zip(deed.parameters, step.operator.arguments, strict=True)), state)
    assert state is not None
    assert meant(goal, state, {}) or plan is None
    executor = PlanExecutor(
        planner,
        knowledge((), SimulationClock()),
        {name: (lambda *_: Scripted(2)) for name in by_name},
        limits=ExecutionLimits(patience=1.0),
    )
    ended = executor.run(timeout=1000.0)
    assert ended is (ExecutionStatus.FAILURE if plan is None else ExecutionStatus.SUCCESS)
    assert len(executor.plans) == (0 if meant(goal, frozenset(initial), {}) else 1)
