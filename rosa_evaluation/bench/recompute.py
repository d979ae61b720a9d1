"""All statuses from scratch, in one linear pass with the same rules: what inference costs without being incremental."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from rosa_core import ElementKind, KnowledgeModel, Status
from rosa_core.inference.rules import (
    action_status,
    component_configuration_status,
    component_status,
    constraint_status,
    function_design_status,
    function_status,
)

Key = tuple[ElementKind, str]


class Recompute:
    """The model indexed once; :meth:`statuses` then infers everything for one set of measurements and requests.

    Nothing is selected, active or failed, so that the peers answer the same question.
    """

    def __init__(self, model: KnowledgeModel) -> None:
        self._model = model
        self._functions_of: dict[str, list[str]] = defaultdict(list)
        for requirement in model.requirements:
            self._functions_of[requirement.action].extend(requirement.functions)

    def statuses(self, measured: Mapping[str, float], required: frozenset[str] = frozenset()) -> dict[Key, Status]:
        """The status of every element.

        Args:
            measured: the value of each measure that was measured.
            required: the actions that are required.
        """
        model = self._model
        on: dict[Key, set[Status]] = defaultdict(set)
        statuses: dict[Key, Status] = {}
        for c in model.constraints:
            status = constraint_status(c.operator, c.value, measured.get(c.measure))
            on[c.constrained.kind, c.constrained.name].add(status)
        of: dict[Key, set[Status]] = defaultdict(set)
        for g in model.component_configurations:
            key = (ElementKind.COMPONENT_CONFIGURATION, g.name)
            statuses[key] = status = component_configuration_status(on.get(key, ()))
            of[ElementKind.COMPONENT, g.component].add(status)
        for k in model.components:
            key = (ElementKind.COMPONENT, k.name)
            statuses[key] = component_status(
                failed=False,
                required=False,
                active=False,
                constraints=on.get(key, ()),
                configurations=of.get(key, ()),
                selected_configurations=(),
            )
        for d in model.function_designs:
            key = (ElementKind.FUNCTION_DESIGN, d.name)
            components = {statuses[ElementKind.COMPONENT, name] for name in d.components}
            statuses[key] = status = function_design_status(
                selected=False, constraints=on.get(key, ()), components=components
            )
            of[ElementKind.FUNCTION, d.function].add(status)
        needed = {name for action in required for name in self._functions_of[action]}
        for f in model.functions:
            key = (ElementKind.FUNCTION, f.name)
            designs = of.get(key, ())
            statuses[key] = function_status(required=f.name in needed, designs=designs, selected_designs=())
        for a in model.actions:
            key = (ElementKind.ACTION, a.name)
            functions = {statuses[ElementKind.FUNCTION, name] for name in self._functions_of.get(a.name, ())}
            statuses[key] = action_status(required=a.name in required, constraints=on.get(key, ()), functions=functions)
        return statuses
