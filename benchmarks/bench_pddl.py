"""How fast plans are made, checked and replaced: ``python benchmarks/bench_pddl.py``."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from importlib.resources import files

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario
from task_layer.pddl import GroundTask, PlanExecutor, Planner, PlannerFailedError, parse_task
from task_layer.pddl.planning.engines import planners
from task_layer.skill import Skill, SkillStatus

MISSIONS, MODELS = files("suave.missions"), files("suave.models")
DOMAIN = MISSIONS.joinpath("suave_domain.pddl").read_text(encoding="utf-8")
PROBLEM = MISSIONS.joinpath("suave_extended_problem.pddl").read_text(encoding="utf-8")


class Forever(Skill):
    """Never done."""

    def update(self) -> SkillStatus:
        """Still at it."""
        return SkillStatus.RUNNING


class AtOnce(Skill):
    """Done at once."""

    def update(self) -> SkillStatus:
        """Done."""
        return SkillStatus.SUCCESS


def targets(count: int) -> GroundTask:
    """The mission with so many pipelines, and only recharge feasible."""
    names = [f"p{number}" for number in range(count)]
    goals = " ".join(f"(pipeline_found {name}) (pipeline_inspected {name})" for name in names)
    text = PROBLEM.replace("p1 - pipeline", f"{' '.join(names)} - pipeline").replace("(pipeline_found p1)", goals)
    return parse_task(DOMAIN, text.replace("(pipeline_inspected p1)", ""))


def median_of(work: Callable[[], object], times: int) -> float:
    """Median wall-clock ms."""
    taken = []
    for _ in range(times):
        began = time.perf_counter()
        work()
        taken.append((time.perf_counter() - began) * 1e3)
    return statistics.median(taken)


def replan_after_event(times: int = 200) -> tuple[float, float]:
    """Median and 99 % ms from a measurement that stops what runs to the next step requested; no plan is remembered."""
    taken = []
    model = KnowledgeModel.load(str(MODELS.joinpath("suave.yaml")), str(MODELS.joinpath("suave_extended.yaml")))
    task = parse_task(DOMAIN, PROBLEM)
    planner = Planner(task, remembered=0)
    for _ in range(times):
        kb = KnowledgeBase(model, clock=SimulationClock())
        skills = {name: Forever() for name in ("search_pipeline", "inspect_pipeline", "recharge")}
        with PlanExecutor(planner, kb, {**skills, "start_robot": AtOnce()}) as executor:
            executor.tick()
            began = time.perf_counter()
            kb.add_measurement("battery_level", 0.2)
            executor.tick()
            taken.append((time.perf_counter() - began) * 1e3)
            if [action.action for action in kb.required_actions()] != ["recharge"]:
                raise RuntimeError("recharge was not requested")
    return statistics.median(taken), sorted(taken)[int(times * 0.99)]


def main() -> None:
    """Print the figures."""
    median, worst = replan_after_event()
    print(f"SUAVE, from the KB event to the next step requested: median {median:.2f} ms, 99 % {worst:.2f} ms")
    others = [name for name in ("fast-downward",) if name in planners()]
    for count in (5, 20, 50, 100):
        task = targets(count)
        state = task.initial | task.feasibility["recharge"]
        planner = Planner(task, remembered=0)
        plan = planner.plan(state).plan
        if plan is None:
            raise RuntimeError("there is a plan")
        planning = median_of(lambda p=planner, s=state: p.plan(s), 5)
        checking = median_of(lambda p=plan, s=state: p.reaches_goal(s), 200)
        line = f"{count} targets: pyperplan {planning:.1f} ms, {len(plan)} steps; rest checked in {checking:.3f} ms"
        for name in others:
            other = Planner(task, engine=name, remembered=0)
            try:
                found = other.plan(state).plan
                took = median_of(lambda p=other, s=state: p.plan(s), 3)
                line += f"; {name} {took:.0f} ms, {0 if found is None else len(found)} steps"
            except PlannerFailedError as error:
                line += f"; {error}"
        print(line, flush=True)
    for layer in ("bt", "pddl"):
        scenario = find_scenario("suave-extended")
        runs = [scenario.run(RunRequest(task_layer=layer, seed=seed), SilentObserver()) for seed in range(8)]
        compute = [reaction.compute_s * 1e3 for run in runs for reaction in run.reactions["U3"]]
        print(f"U3 through {layer}: computing {statistics.median(compute):.2f} ms (median)")


if __name__ == "__main__":
    main()
