"""Conditions of unified-planning under a binding of their variables: choices between conjunctions of ground facts."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import product
from typing import Any

from task_layer.pddl.grounding.ground_task import NOTHING, Condition

Atom = tuple[str, tuple[str, ...]]
"""A ground atom: a predicate's plain name, and those of its arguments."""

Binding = dict[str, str]
"""Objects by the names of the parameters and variables that they stand for."""


class UngroundableError(Exception):
    """A condition that cannot be turned into ground facts, and what to do about it."""

    def __init__(self, what: str, hint: str) -> None:
        super().__init__(what)
        self.hint = hint


class TooManyAlternativesError(UngroundableError):
    """There would be too much of it."""


class Formulas:
    """Evaluates what never changes, and numbers the facts that do.

    Args:
        problem: the unified-planning problem, for the objects of a type.
        values: the initial values that are given; predicates without one are false, functions zero.
        changing: the names of predicates and functions that change.
        most_alternatives: how many conjunctions a condition may be a choice of.
    """

    def __init__(self, problem: Any, values: Mapping[Atom, Any], changing: set[str], most_alternatives: int) -> None:
        self._problem = problem
        self._values = values
        self._changing = changing
        self._most = most_alternatives
        self._fitting: dict[tuple[str, int, tuple[int, ...]], dict[tuple[str, ...], set[str]]] = {}
        self.facts: dict[Atom, int] = {}

    def mask(self, atom: Atom) -> int:
        """The bit of a fact that can change."""
        return 1 << self.facts.setdefault(atom, len(self.facts))

    def initially(self, atom: Atom) -> bool:
        """Whether it holds in the initial state."""
        return bool(self._values.get(atom, False))

    def atom(self, node: Any, binding: Binding) -> Atom:
        """A predicate or function applied to objects."""
        return node.fluent().name, tuple(self._object(argument, binding) for argument in node.args)

    def is_fixed(self, node: Any) -> bool:
        """Whether it is a predicate that never changes, applied to parameters and objects."""
        return node.is_fluent_exp() and node.fluent().name not in self._changing

    def fitting(self, node: Any, parameter: str, binding: Binding) -> Collection[str]:
        """The objects for which a parameter can stand in a predicate that never changes, others being bound or not."""
        names = [argument.parameter().name if argument.is_parameter_exp() else None for argument in node.args]
        bound = [place for place, name in enumerate(names) if name is None or name in binding]
        key = (node.fluent().name, names.index(parameter), tuple(bound))
        if key not in self._fitting:
            found: dict[tuple[str, ...], set[str]] = {}
            for (fluent, objects), value in self._values.items():
                if fluent == key[0] and value is True:
                    found.setdefault(tuple(objects[place] for place in bound), set()).add(objects[key[1]])
            self._fitting[key] = found
        return self._fitting[key].get(tuple(self._object(node.args[place], binding) for place in bound), ())

    def all_of(self, nodes: Iterable[Any], binding: Binding) -> list[Condition]:
        """The conjunctions of which one must hold for all nodes to hold; none if they cannot."""
        return self._conjunction(self._alternatives(node, binding, True) for node in nodes)

    def choices(self, variables: Iterable[Any], binding: Binding) -> Iterator[Binding]:
        """The binding with every choice of objects for quantified variables."""
        variables = list(variables)
        for items in product(*(self._problem.objects(variable.type) for variable in variables)):
            chosen = {variable.name: item.name for variable, item in zip(variables, items, strict=True)}
            yield {**binding, **chosen}

    def number(self, node: Any, binding: Binding) -> float:
        """The value of an expression in which nothing changes.

        Raises:
            UngroundableError: if something in it does change.
        """
        if node.is_constant():
            return _finite(node.constant_value())
        if node.is_fluent_exp():
            if node.fluent().name in self._changing:
                raise UngroundableError(
                    f"conditions and durations on '{node.fluent().name}', a number that changes, are not supported",
                    "use a predicate; a constraint of the knowledge model, or a sensed one, can stand for a limit",
                )
            return _finite(self._values.get(self.atom(node, binding), 0.0))
        values = [self.number(argument, binding) for argument in node.args]
        if node.is_plus():
            return sum(values)
        if node.is_minus():
            return values[0] - sum(values[1:])
        if node.is_times():
            product_of_all = 1.0
            for value in values:
                product_of_all *= value
            return product_of_all
        if node.is_div() and values[1]:
            return values[0] / values[1]
        raise UngroundableError(
            f"'{node}' cannot be evaluated", "use numbers, + - * / and functions that do not change"
        )

    def _object(self, node: Any, binding: Binding) -> str:
        if node.is_parameter_exp():
            return binding[node.parameter().name]
        if node.is_variable_exp():
            return binding[node.variable().name]
        name: str = node.object().name
        return name

    def _alternatives(self, node: Any, binding: Binding, wanted: bool) -> list[Condition]:
        """The conjunctions of which one must hold for the node to be as wanted, true or false."""
        if node.is_fluent_exp() and node.fluent().type.is_bool_type():
            return self._literal(self.atom(node, binding), wanted)
        if node.is_not():
            return self._alternatives(node.args[0], binding, not wanted)
        if node.is_implies():
            premise, conclusion = node.args
            parts = [(premise, False), (conclusion, True)]
            options = [self._alternatives(part, binding, truth is wanted) for part, truth in parts]
            return self._disjunction(options) if wanted else self._conjunction(options)
        if node.is_and() or node.is_or():
            options = [self._alternatives(part, binding, wanted) for part in node.args]
            return self._conjunction(options) if node.is_and() is wanted else self._disjunction(options)
        if node.is_forall() or node.is_exists():
            inner = self.choices(node.variables(), binding)
            options = [self._alternatives(node.args[0], choice, wanted) for choice in inner]
            return self._conjunction(options) if node.is_forall() is wanted else self._disjunction(options)
        return [NOTHING] if self._fixed_truth(node, binding) is wanted else []

    def _literal(self, atom: Atom, wanted: bool) -> list[Condition]:
        if atom[0] not in self._changing:
            return [NOTHING] if self.initially(atom) is wanted else []
        mask = self.mask(atom)
        return [Condition(positive=mask) if wanted else Condition(negative=mask)]

    def _fixed_truth(self, node: Any, binding: Binding) -> bool:
        if node.is_bool_constant():
            return bool(node.bool_constant_value())
        if node.is_equals() and node.args[0].type.is_user_type():
            left, right = (self._object(argument, binding) for argument in node.args)
            return left == right
        if node.is_equals() or node.is_le() or node.is_lt():
            left_value, right_value = (self.number(argument, binding) for argument in node.args)
            if node.is_equals():
                return left_value == right_value
            return left_value <= right_value if node.is_le() else left_value < right_value
        raise UngroundableError(
            f"'{node}' is not supported in a condition", "use and, or, not, imply, forall, exists, ="
        )

    def _conjunction(self, options: Iterable[list[Condition]]) -> list[Condition]:
        found = [NOTHING]
        for option in options:
            combined = dict.fromkeys(one.also(other) for one, other in product(found, option))
            found = [condition for condition in combined if not condition.impossible]
            self._limit(found)
        return found

    def _disjunction(self, options: Iterable[list[Condition]]) -> list[Condition]:
        found = list(dict.fromkeys(condition for option in options for condition in option))
        self._limit(found)
        return [NOTHING] if NOTHING in found else found

    def _limit(self, found: list[Condition]) -> None:
        if len(found) > self._most:
            raise TooManyAlternativesError(
                f"a condition is a choice between more than {self._most} combinations of facts",
                "split the action into several with simpler conditions",
            )


def _finite(value: Any) -> float:
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if math.isinf(number):
        raise UngroundableError("a number is too large", "use numbers below 1e308")
    return number
