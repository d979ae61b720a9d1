"""Metric temporal logic over states: formulas, and monitors that give early verdicts."""

from rosa_streams.temporal.formula import Formula, variables
from rosa_streams.temporal.monitor import Monitor, Verdict
from rosa_streams.temporal.parsing import parse_formula

__all__ = ["Formula", "Monitor", "Verdict", "parse_formula", "variables"]
