"""Verifying a knowledge model: ``python benchmarks/bench_verify.py``.

Measured is finding the cut sets of every element, up to order 3, and then everything that ``rosa verify`` finds, in
models of two forms: many small robots in one model, that have nothing in common, and one large robot whose actions
share functions, whose functions share components, and whose components are constrained by a few measures.
"""

from __future__ import annotations

import random
import sys
import time
from pathlib import Path

from rosa_core import KnowledgeModel
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from rosa_evaluation.bench.synthetic import many_small_robots
from rosa_verification import CutSets, Structure, verify_model
from rosa_verification.reliability import action_reliabilities
from suave.models import model_files

AGV = Path(__file__).resolve().parent.parent / "agv_example" / "models"


def one_large_robot(elements: int, seed: int = 0) -> KnowledgeModel:
    """One robot of about so many elements, relations included.

    For every ten components: two actions of four functions each, of these five in all, with three designs of one to
    four components each; four configurations; nine constraints on ten measures, of both directions.
    """
    chance = random.Random(seed)
    tens = max(1, elements // 52)
    components = [f"c{n}" for n in range(10 * tens)]
    functions = [f"f{n}" for n in range(5 * tens)]
    actions = [f"a{n}" for n in range(2 * tens)]
    designs = [
        FunctionDesign(f"{f}.{n}", f, tuple(chance.sample(components, chance.randint(1, 4))), n)
        for f in functions
        for n in range(3)
    ]
    configurations = [ComponentConfiguration(f"k{n}", components[n // 2 * 5], (), n % 2) for n in range(4 * tens)]
    refs = [
        *(ElementRef(ElementKind.COMPONENT_CONFIGURATION, k.name) for k in configurations),
        *(ElementRef(ElementKind.FUNCTION_DESIGN, d.name) for d in designs),
        *(ElementRef(ElementKind.ACTION, a) for a in actions),
    ]
    operators = (ConstraintOperator.GREATER_OR_EQUAL, ConstraintOperator.LESS)
    constraints = [
        Constraint(f"m{chance.randrange(10)}", ref, operator, (-3 if operator is operators[0] else 3) + chance.random())
        for ref in chance.sample(refs, min(len(refs), 9 * tens))
        for operator in (chance.choice(operators),)
    ]
    return KnowledgeModel(
        measures=tuple(Measure(f"m{n}") for n in range(10)),
        actions=tuple(map(Action, actions)),
        functions=tuple(Function(f, always_improve=bool(n % 2)) for n, f in enumerate(functions)),
        components=tuple(map(Component, components)),
        requirements=tuple(FunctionalRequirement(a, tuple(chance.sample(functions, 4))) for a in actions),
        function_designs=tuple(designs),
        component_configurations=tuple(configurations),
        constraints=tuple(constraints),
    )


def size_of(model: KnowledgeModel) -> int:
    """Elements and relations."""
    kinds = (model.measures, model.actions, model.functions, model.components, model.requirements)
    return sum(map(len, (*kinds, model.function_designs, model.component_configurations, model.constraints)))


def report(name: str, model: KnowledgeModel) -> None:
    """Print a row."""
    began = time.perf_counter()
    structure = Structure(model)
    cut_sets = CutSets(structure)
    found = [cut_sets.of(element) for element in structure.elements()]
    cut = time.perf_counter() - began
    began = time.perf_counter()
    findings = verify_model(model)
    everything = time.perf_counter() - began
    began = time.perf_counter()
    action_reliabilities(structure, dict.fromkeys(model.names[ElementKind.COMPONENT], 0.01))
    likely = time.perf_counter() - began
    count = sum(len(one.sets) for one in found)
    open_questions = len(findings.undecided) + sum(one.order != 3 for one in found)
    print(f"{name:28}{size_of(model):10}{count:12}{cut:12.3f}{everything:12.3f}{likely:14.3f}{open_questions:8}")


def main() -> None:
    """Print the table."""
    columns = ("elements", "cut sets", "to order 3", "everything", "reliability", "open")
    print(f"{'':28}{columns[0]:>10}{columns[1]:>12}{columns[2]:>12}{columns[3]:>12}{columns[4]:>14}{columns[5]:>8}")
    report("SUAVE extended", KnowledgeModel.load(*model_files(extended=True)))
    report("AGV", KnowledgeModel.load(AGV / "agv.yaml", AGV / "agv_move.yaml", AGV / "agv_mission.yaml"))
    for size in (1_000, 10_000) if len(sys.argv) < 2 else map(int, sys.argv[1:]):
        report("many small robots", many_small_robots(size))
        report("one large robot", one_large_robot(size))


if __name__ == "__main__":
    main()
