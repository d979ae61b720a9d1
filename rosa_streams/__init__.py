"""Streams by meaning: what is asked for by its tag is configured, repaired and improved at run time."""

from rosa_streams.costs import DeclaredCosts, Estimator, LearnedCosts, Objective, update_cost
from rosa_streams.environment import Change, Environment, Port, Sample, Target, Transformation, Unit, update
from rosa_streams.errors import FormulaError, StreamError, TagError
from rosa_streams.life_cycle import JournalEntry, Perturbation, PerturbationKind
from rosa_streams.manager import Manager
from rosa_streams.matching import ValidityMatrix
from rosa_streams.planning import Plan, PlanStatus, Search, pareto_front, plan
from rosa_streams.query import Answer, Query, StreamOf
from rosa_streams.runtime import Computation, Function, Host, LostUnit, Sources, Synchroniser, TimedState
from rosa_streams.specification import Specification, load_specification, load_transformations, specifications_xml
from rosa_streams.tags import Concept, Ontology, load_ontology, parse_tag
from rosa_streams.temporal import Monitor, Verdict, parse_formula
from rosa_streams.validity import Violation, ViolationKind, is_valid, violations

__all__ = [
    "Answer",
    "Change",
    "Computation",
    "Concept",
    "DeclaredCosts",
    "Environment",
    "Estimator",
    "FormulaError",
    "Function",
    "Host",
    "JournalEntry",
    "LearnedCosts",
    "LostUnit",
    "Manager",
    "Monitor",
    "Objective",
    "Ontology",
    "Perturbation",
    "PerturbationKind",
    "Plan",
    "PlanStatus",
    "Port",
    "Query",
    "Sample",
    "Search",
    "Sources",
    "Specification",
    "StreamError",
    "StreamOf",
    "Synchroniser",
    "TagError",
    "Target",
    "TimedState",
    "Transformation",
    "Unit",
    "ValidityMatrix",
    "Verdict",
    "Violation",
    "ViolationKind",
    "is_valid",
    "load_ontology",
    "load_specification",
    "load_transformations",
    "pareto_front",
    "parse_formula",
    "parse_tag",
    "plan",
    "specifications_xml",
    "update",
    "update_cost",
    "violations",
]
