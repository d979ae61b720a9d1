"""How much had to be modelled, counted as in the ROSA paper (section 7.5, table 7)."""

from __future__ import annotations

from dataclasses import dataclass

from rosa_core.model.knowledge_model import KnowledgeModel


@dataclass(frozen=True, slots=True)
class Effort:
    """How much had to be modelled.

    Args:
        entities: how many.
        relations: how many.
        by_kind: how many actions, functions, ..., estimations these are.
    """

    entities: int
    relations: int
    by_kind: dict[str, int]

    @property
    def total(self) -> int:
        """The development effort of table 7."""
        return self.entities + self.relations


def count_effort(model: KnowledgeModel) -> Effort:
    """Count a model's entities and relations (ROSA paper, table 7).

    A relation counts once however many elements it relates. A parameter value counts once per component, key and
    value, however many configurations give it.

    Args:
        model: to count; annotations do not count.

    Example:
        >>> from rosa_core.model import Action, Function, FunctionalRequirement, KnowledgeModel
        >>> requirement = FunctionalRequirement("fly", ("stabilise",))
        >>> model = KnowledgeModel(actions=(Action("fly"),), functions=(Function("stabilise"),),
        ...                        requirements=(requirement,))
        >>> effort = count_effort(model)
        >>> effort.entities, effort.relations, effort.total
        (2, 1, 3)
    """
    parameters = {p for c in model.component_configurations for p in c.parameters}
    entities = {
        "actions": len(model.actions),
        "functions": len(model.functions),
        "components": len(model.components),
        "component_parameters": len(parameters),
        "measures": len(model.measures),
    }
    relations = {
        "functional_requirements": len(model.requirements),
        "function_designs": len(model.function_designs),
        "component_configurations": len(model.component_configurations),
        "constraints": len(model.constraints),
        "estimations": len(model.estimations),
    }
    return Effort(sum(entities.values()), sum(relations.values()), {**entities, **relations})
