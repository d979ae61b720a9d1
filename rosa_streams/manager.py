"""The stream reasoning manager (figure 1 and section IV-C of the paper): keeps the environment valid and its cost low.

A cycle is a review, in which the best change set is searched for and applied, and a stable interval that lasts until
the horizon is reached or something disturbs the configuration. What disturbs it during a review is dealt with right
after.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace

from rosa_core.clock import Clock, SimulationClock, Timer
from rosa_core.errors import Problem, nearest
from rosa_streams.costs import LearnedCosts, Objective
from rosa_streams.environment import Change, Environment, Target, Transformation, update
from rosa_streams.errors import StreamError
from rosa_streams.life_cycle import JournalEntry, Perturbation, PerturbationKind
from rosa_streams.losses import Losses
from rosa_streams.matching import ValidityMatrix
from rosa_streams.planning import Plan, PlanStatus, Search, UnitNames, plan, problem_of
from rosa_streams.planning.explanation import why_unsatisfiable
from rosa_streams.reasons import TargetReason, reason_of
from rosa_streams.runtime import Host, LostUnit, Sources
from rosa_streams.runtime.instance import Callback
from rosa_streams.tags import Concept, Similarity, parse_tag
from rosa_streams.upkeep import UpkeepMeter
from rosa_streams.validity import ViolationKind, violations

_KEPT_ENTRIES = 10_000


class Manager:
    """Targets in, streams out: configures a host, repairs it and improves it.

    Args:
        clock: of the host; with simulated time reviews happen while time passes, otherwise in a thread (see ``start``).
        sources: the implementations.
        similarity: of tags, an ontology for example.
        costs: what labor and upkeep cost; they are learned on the way.
        objective: horizon in seconds, MAX_COST, weight of quality.
        search: at the horizon and when the library or the targets change.
        repair: after a loss, when time presses.
        deadline: seconds that a search may take.
        queue_size, hang_timeout, cpu_time: of the host; see :class:`~rosa_streams.runtime.Host`.
        refine: seconds after a repair whose plan is not proven optimal, it is searched for a better one; None waits for
            the horizon.
        tries: a transformation whose units are lost so often within a horizon is set aside for a horizon.
    """

    def __init__(
        self,
        clock: Clock,
        sources: Sources,
        similarity: Similarity | None = None,
        *,
        costs: LearnedCosts | None = None,
        objective: Objective | None = None,
        search: Search | str = Search.EXACT,
        repair: Search | str = Search.FAST,
        deadline: float = 1.0,
        queue_size: int = 1000,
        hang_timeout: float = 2.0,
        tries: int = 3,
        refine: float | None = 1.0,
        cpu_time: Callable[[], float] = time.thread_time,
    ) -> None:
        self.clock = clock
        self.costs = costs or LearnedCosts()
        self.objective = objective or Objective()
        self.journal: deque[JournalEntry] = deque(maxlen=_KEPT_ENTRIES)
        self.cycle = 0
        self._refine = refine
        self._search, self._repair, self._deadline = Search(search), Search(repair), deadline
        self._environment = Environment() if similarity is None else Environment(similarity=similarity)
        self._matrix = ValidityMatrix(self._environment.similarity)
        self._names = UnitNames()
        self._lock = threading.RLock()
        self._pending: list[Perturbation] = []
        self._noted = Change()
        self._posted: deque[Callable[[], None]] = deque()
        self._reviewing = False
        self._scheduled = False
        self._timer: Timer | None = None
        self._wake = threading.Event()
        self._thread: threading.Thread | None = None
        self._closed = False
        self._next_review, self._next_kind = clock.now() + self.objective.horizon, PerturbationKind.HORIZON
        self._losses = Losses(tries, self.objective.horizon)
        self._meter = UpkeepMeter()
        self._unsatisfied: dict[str, str] = {}
        self._listeners: list[Callable[[JournalEntry], None]] = []
        self._lost: deque[LostUnit] = deque()
        self.host = Host(
            clock, sources, on_lost=self._on_lost, queue_size=queue_size, hang_timeout=hang_timeout, cpu_time=cpu_time
        )
        if not isinstance(clock, SimulationClock):
            self._thread = threading.Thread(target=self._keep, name="streams-manager", daemon=True)
            self._thread.start()

    # -- what is wished for --

    def add_target(self, qid: str, tag: Concept | str, channel: str) -> bool:
        """Wish for a stream by its meaning. Returns whether it is there now; :meth:`why` says why not.

        Raises:
            StreamError: if there is such a target already, or the channel is another target's.
        """
        with self._lock:
            target = Target(qid, parse_tag(tag) if isinstance(tag, str) else tag, channel)
            for known in self._environment.targets:
                if known.qid == qid or known.channel == channel:
                    what = f"the target '{known.qid}' on '{known.channel}' is there already"
                    raise StreamError(Problem(what, hint="remove or replace it"))
            self._note(Change(targets_added=frozenset({target})), PerturbationKind.TARGETS_CHANGED, qid)
            return self.is_satisfied(qid)

    def remove_target(self, qid: str) -> None:
        """Take a wish back; units that nothing needs any more are unloaded. Raises: StreamError."""
        with self._lock:
            target = self._target(qid)
            self._note(Change(targets_removed=frozenset({target})), PerturbationKind.TARGETS_CHANGED, qid)

    def replace_target(self, qid: str, tag: Concept | str) -> bool:
        """Wish for another stream on the same channel. Returns whether it is there now. Raises: StreamError."""
        with self._lock:
            before = self._target(qid)
            after = replace(before, tag=parse_tag(tag) if isinstance(tag, str) else tag)
            if after != before:
                change = Change(targets_added=frozenset({after}), targets_removed=frozenset({before}))
                self._note(change, PerturbationKind.TARGETS_CHANGED, qid)
            return self.is_satisfied(qid)

    # -- what there is --

    def register(self, transformations: Iterable[Transformation]) -> None:
        """Transformations are available from now on, such as those of a robot that joins.

        Raises:
            StreamError: if another one of the same name is registered.
        """
        with self._lock:
            library = self._environment.library()
            new = []
            for each in transformations:
                if each.tid in library and library[each.tid] != each:
                    hint = "unregister the other one before"
                    raise StreamError(Problem(f"another transformation '{each.tid}' is registered", hint=hint))
                if each.tid not in library:
                    library[each.tid] = each
                    new.append(each)
            if new:
                change = Change(transformations_added=frozenset(new))
                self._note(change, PerturbationKind.TRANSFORMATIONS_CHANGED, ", ".join(each.tid for each in new))

    def unregister(self, *tids: str) -> None:
        """Transformations are no longer available; their units go. Raises: StreamError."""
        with self._lock:
            library = self._environment.library()
            for tid in tids:
                if tid not in library:
                    raise StreamError(Problem(f"no transformation '{tid}' is registered", hint=nearest(tid, library)))
            change = Change(transformations_removed=frozenset(library[tid] for tid in tids))
            self._note(change, PerturbationKind.TRANSFORMATIONS_CHANGED, ", ".join(tids))

    def unload(self, cid: str, reason: str = "it was unloaded from outside") -> None:
        """A unit is lost, as when somebody else unloads it; the configuration is repaired. Raises: StreamError."""
        with self._lock:
            self.host.lose(cid, reason)
            self._review_now()

    def drop_subscription(self, cid: str, port: str) -> None:
        """A subscription is lost, as when somebody else removes it; it is made again. Raises: StreamError."""
        with self._lock:
            unit = self._environment.graph().get(cid)
            if unit is None or unit.subscription(port) is None:
                raise StreamError(f"no unit '{cid}' subscribes with '{port}'")
            cut = replace(
                unit, inputs=tuple((name, None if name == port else channel) for name, channel in unit.inputs)
            )
            self._apply(Change(units_added=frozenset({cut}), units_removed=frozenset({unit})))
            self._perturb(PerturbationKind.SUBSCRIPTION_LOST, f"{cid}.{port}")
            self._review_now()

    # -- streams --

    def subscribe(self, channel: str, callback: Callback) -> Callable[[], None]:
        """Call back with every sample on a channel. Returns what ends the subscription."""
        return self.host.subscribe(channel, callback)

    # -- looking --

    @property
    def environment(self) -> Environment:
        """The environment as it is."""
        return self._environment

    def is_satisfied(self, qid: str) -> bool:
        """Whether a target has its stream. Raises: StreamError."""
        self._target(qid)
        return qid not in self._unsatisfied and not any(
            unit_lost.kind is PerturbationKind.UNIT_LOST for unit_lost in self._pending
        )

    def unsatisfied(self) -> Mapping[str, str]:
        """The targets without a stream, each with the reason."""
        return dict(self._unsatisfied)

    def why(self, qid: str) -> TargetReason:
        """Why a target has its stream, or has none: which input could not be had, what was lost, what would help."""
        with self._lock:
            return reason_of(
                self._environment,
                self._target(qid),
                self._unsatisfied.get(qid),
                self._losses.recent,
                self._losses.set_aside(self.clock.now()),
                self._remedies(qid),
            )

    def on_review(self, listener: Callable[[JournalEntry], None]) -> None:
        """Call with the journal's entry after every review."""
        self._listeners.append(listener)

    def post(self, work: Callable[[], None]) -> None:
        """Do something soon outside of sample processing: what a callback that gets samples uses to change targets."""
        self._posted.append(work)
        self._soon()

    # -- the life cycle --

    def review(self) -> JournalEntry:
        """Review now, as at the horizon."""
        with self._lock:
            self._perturb(PerturbationKind.REQUESTED, "")
            self._review_now()
            return self.journal[-1]

    def close(self) -> None:
        """Unload everything and stop."""
        self._closed = True
        if self._timer is not None:
            self._timer.cancel()
        self._wake.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()
        self.host.close()

    def _note(self, change: Change, kind: PerturbationKind, about: str) -> None:
        self._environment = update(self._environment, change)
        for each in change.transformations_removed:
            self._matrix.remove(each)
            self._losses.discard(each.tid)
        for each in sorted(change.transformations_added, key=lambda added: added.tid):
            self._matrix.add(each)
        for target in change.targets_removed:
            self._matrix.remove_target(target)
            self._unsatisfied.pop(target.qid, None)
        for target in change.targets_added:
            self._matrix.add_target(target)
        self._noted = replace(
            self._noted,
            transformations_added=self._noted.transformations_added | change.transformations_added,
            transformations_removed=self._noted.transformations_removed | change.transformations_removed,
            targets_added=self._noted.targets_added | change.targets_added,
            targets_removed=self._noted.targets_removed | change.targets_removed,
        )
        self._perturb(kind, about)
        self._review_now()

    def _perturb(self, kind: PerturbationKind, about: str, reason: str = "") -> None:
        self._pending.append(Perturbation(kind, about, self.clock.now(), reason))

    def _on_lost(self, lost: LostUnit) -> None:
        # Called by whatever thread found it, possibly in the middle of processing a sample: review later.
        self._lost.append(lost)
        self._pending.append(Perturbation(PerturbationKind.UNIT_LOST, lost.cid, lost.time, lost.reason))
        self._soon()

    def _soon(self) -> None:
        if isinstance(self.clock, SimulationClock):
            if not self._scheduled:
                self._scheduled = True
                self.clock.call_at(self.clock.now(), self._later)
        else:
            self._wake.set()

    def _later(self) -> None:
        self._scheduled = False
        with self._lock:
            self._do_posted()
            self._review_now()

    def _keep(self) -> None:
        """In real time: review when woken, and at the horizon."""
        while not self._closed:
            self.clock.wait(self._wake, max(0.0, self._next_review - self.clock.now()))
            self._wake.clear()
            if self._closed:
                return
            with self._lock:
                self._do_posted()
                if self.clock.now() >= self._next_review:
                    self._perturb(self._next_kind, "")
                self._review_now()

    def _when_due(self) -> None:
        with self._lock:
            self._perturb(self._next_kind, "")
            self._review_now()

    def _do_posted(self) -> None:
        while self._posted:
            self._posted.popleft()()

    def _review_now(self) -> None:
        if self._reviewing:
            return
        self._reviewing = True
        try:
            while self._pending and not self._closed:
                perturbations = tuple(self._pending)
                del self._pending[: len(perturbations)]
                self._review(perturbations)
        finally:
            self._reviewing = False

    def _review(self, perturbations: tuple[Perturbation, ...]) -> None:
        self.cycle += 1
        while self._lost:
            lost = self._lost.popleft()
            self._losses.add(lost.tid, lost)
        self._observe_upkeep()
        self._environment = replace(self._environment, units=self.host.units())
        premature = any(each.kind is PerturbationKind.UNIT_LOST for each in perturbations)
        search = self._repair if premature else self._search
        found = self._plan(search)
        change = replace(self._noted, units_added=found.change.units_added, units_removed=found.change.units_removed)
        self._noted = Change()
        self._apply(found.change)
        entry = JournalEntry(
            self.cycle, self.clock.now(), perturbations, str(search), found, change, dict(self._unsatisfied)
        )
        self.journal.append(entry)
        self._start_stable_interval(found, search)
        for listener in list(self._listeners):
            listener(entry)

    def _start_stable_interval(self, found: Plan, search: Search) -> None:
        now = self.clock.now()
        self._next_review, self._next_kind = now + self.objective.horizon, PerturbationKind.HORIZON
        hasty = found.status is PlanStatus.FEASIBLE and search is not self._search
        if hasty and self._refine is not None and now + self._refine < self._next_review:
            self._next_review, self._next_kind = now + self._refine, PerturbationKind.REFINEMENT
        if isinstance(self.clock, SimulationClock) and self.objective.horizon > 0:
            if self._timer is not None:
                self._timer.cancel()
            self._timer = self.clock.call_at(self._next_review, self._when_due)

    # -- planning and applying --

    def _plan(self, search: Search) -> Plan:
        set_aside = self._losses.set_aside(self.clock.now())
        usable = frozenset(each for each in self._environment.transformations if each.tid not in set_aside)
        available = replace(self._environment, transformations=usable)
        problem = problem_of(available, self.costs, self.objective, self._matrix)
        missing = problem.unsatisfiable_goals()
        self._unsatisfied = {target.qid: str(why_unsatisfiable(problem, target)) for target in missing}
        wanted = [target for target in problem.targets if target not in missing]
        found = plan(
            available,
            self.costs,
            self.objective,
            search=search,
            deadline=self._deadline,
            matrix=self._matrix,
            targets=wanted,
            names=self._names,
            remove_unneeded=not missing,
        )
        if found.status is PlanStatus.NONE:
            for target in wanted:
                if not self._is_served(target):
                    self._unsatisfied[target.qid] = found.why or "there is no plan"
        return found

    def _is_served(self, target: Target) -> bool:
        return not any(
            each.kind is ViolationKind.UNSATISFIED_TARGET and each.about == target.qid
            for each in violations(self._environment)
        )

    def _apply(self, change: Change) -> None:
        created = {unit.cid: unit for unit in change.created()}
        library = self._environment.library()
        labor = self.host.apply(change, library)
        for cid, seconds in labor.items():
            self.costs.observe_labor(library[created[cid].tid], seconds)
        self._environment = replace(self._environment, units=self.host.units())

    def _observe_upkeep(self) -> None:
        """At the end of a cycle: what each unit took per second, averaged over the units of a transformation."""
        library = self._environment.library()
        for tid, rates in self._meter.read(self.host.instances(), self.clock.now()).items():
            if tid in library:
                self.costs.observe_upkeep(library[tid], rates)

    def _remedies(self, qid: str) -> tuple[str, ...]:
        with suppress(StreamError):
            problem = problem_of(self._environment, self.costs, self.objective, self._matrix)
            target = self._target(qid)
            if target in problem.unsatisfiable_goals():
                return tuple(str(each) for each in why_unsatisfiable(problem, target).remedies)
        return ()

    def _target(self, qid: str) -> Target:
        goal = self._environment.goal()
        if qid not in goal:
            raise StreamError(Problem(f"no target '{qid}' is known", hint=nearest(qid, goal)))
        return goal[qid]
