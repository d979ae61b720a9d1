"""The same rules in clingo, grounded once and solved again after every change. Needs the extra ``bench``."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files
from typing import Any

import clingo

from rosa_core import ElementKind, KnowledgeModel
from rosa_core.inference.rules import constraint_status
from rosa_core.model.status import Status

_PREFIX = {
    ElementKind.ACTION: "a",
    ElementKind.FUNCTION: "f",
    ElementKind.COMPONENT: "k",
    ElementKind.FUNCTION_DESIGN: "d",
    ElementKind.COMPONENT_CONFIGURATION: "g",
}


class ClingoPeer:
    """A knowledge base whose inference is an answer-set solver's; elements are numbered within their kinds."""

    def __init__(self, model: KnowledgeModel) -> None:
        self._model = model
        self._ids = {
            (kind, name): f"{prefix}({index})"
            for kind, prefix in _PREFIX.items()
            for index, name in enumerate(model.names[kind])
        }
        self._control = clingo.Control(["--warn=none"])
        self._control.add("base", [], files(__package__).joinpath("status_rules.lp").read_text("utf-8"))
        self._control.add("base", [], "\n".join(self._facts()))
        self._control.ground([("base", [])])
        self._on_measure: dict[str, list[int]] = {}
        for index, constraint in enumerate(model.constraints):
            self._on_measure.setdefault(constraint.measure, []).append(index)

    def measure(self, measure: str, value: float) -> None:
        """Set the constraints on a measure, and solve.

        Args:
            measure: its name; one without constraints changes nothing.
            value: in the measure's unit.
        """
        for index in self._on_measure.get(measure, ()):
            constraint = self._model.constraints[index]
            violated = constraint_status(constraint.operator, constraint.value, value) is Status.VIOLATED
            self._assign(f"violated(c({index}))", violated)
        self.solve()

    def require(self, action: str, required: bool) -> None:
        """Require an action, or no longer, and solve.

        Args:
            action: its name.
            required: whether it is to be performed.

        Raises:
            KeyError: if there is no such action.
        """
        self._assign(f"required({self._ids[ElementKind.ACTION, action]})", required)
        self.solve()

    def solve(self) -> Any:
        """The statuses: every atom of the one stable model.

        Raises:
            RuntimeError: if there is no stable model, which the rules exclude.
        """
        with self._control.solve(yield_=True) as handle:
            model = handle.model()
            if model is None:
                raise RuntimeError("the rules have no stable model")
            return model.symbols(atoms=True)

    def unfeasible_actions(self) -> set[str]:
        """Their names, for comparing with the knowledge base."""
        names = self._model.names[ElementKind.ACTION]
        return {
            names[atom.arguments[0].arguments[0].number]
            for atom in self.solve()
            if atom.name == "unfeasible" and atom.arguments[0].name == "a"
        }

    def _assign(self, atom: str, value: bool) -> None:
        self._control.assign_external(clingo.parse_term(atom), value)

    def _facts(self) -> Iterator[str]:
        ids, model = self._ids, self._model
        for action in model.actions:
            a = ids[ElementKind.ACTION, action.name]
            yield f"action({a}). #external required({a})."
        for requirement in model.requirements:
            for function in requirement.functions:
                yield f"requires({ids[ElementKind.ACTION, requirement.action]},{ids[ElementKind.FUNCTION, function]})."
        for name in model.names[ElementKind.FUNCTION]:
            yield f"function({ids[ElementKind.FUNCTION, name]})."
        for name in model.names[ElementKind.COMPONENT]:
            k = ids[ElementKind.COMPONENT, name]
            yield f"component({k}). #external failed({k}). #external active({k})."
        for design in model.function_designs:
            d = ids[ElementKind.FUNCTION_DESIGN, design.name]
            yield f"design({d},{ids[ElementKind.FUNCTION, design.function]}). #external selected_design({d})."
            for component in design.components:
                yield f"member({ids[ElementKind.COMPONENT, component]},{d})."
        for configuration in model.component_configurations:
            g = ids[ElementKind.COMPONENT_CONFIGURATION, configuration.name]
            k = ids[ElementKind.COMPONENT, configuration.component]
            yield f"configuration({g},{k}). #external selected_configuration({g})."
        for index, constraint in enumerate(model.constraints):
            element = ids[constraint.constrained.kind, constraint.constrained.name]
            yield f"on(c({index}),{element}). #external violated(c({index}))."
