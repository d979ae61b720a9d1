"""Development effort as in the ROSA paper: table 7's rows from the files themselves, and the growth of section 7.6.

Robots bring their rows along: an entry point of the group ``rosa.effort_rows`` names a function without arguments that
returns :class:`EffortRow` objects, one of ``rosa.effort_growth`` a :class:`GrowthModel`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from importlib.resources import as_file, files
from typing import Any

from py_trees.behaviour import Behaviour

from rosa_core import InputError, KnowledgeModel
from rosa_core.errors import Problem
from rosa_core.model.effort import count_effort
from task_layer.bt.types.node_source import source_of
from task_layer.bt.xml.outline import read_outline

ROWS, GROWTH = "rosa.effort_rows", "rosa.effort_growth"
"""The groups of entry points."""

ROSA_MODEL, BT_MANAGING, ROSA_TASK = "ROSA", "BT managing system", "ROSA with its guards"
"""The approaches: two as in table 7; the third adds what ROSA's own task trees need, which the paper leaves out."""

_GUARD = "is_action_feasible"


@dataclass(frozen=True, slots=True)
class EffortRow:
    """A row of table 7: what had to be modelled for a use case, by kind.

    ``files`` are those that were counted, ``published`` the paper's total, None for what it does not count.
    """

    use_case: str
    approach: str
    parts: Mapping[str, int]
    files: tuple[str, ...]
    published: int | None = None

    @property
    def total(self) -> int:
        """The development effort."""
        return sum(self.parts.values())

    def document(self) -> dict[str, Any]:
        """The row as JSON."""
        return {
            "use_case": self.use_case,
            "approach": self.approach,
            **{name.replace(" ", "_"): count for name, count in self.parts.items()},
            "total": self.total,
            "published_total": self.published,
            "files": list(self.files),
        }


@dataclass(frozen=True, slots=True)
class GrowthModel:
    """How one approach grows: ``count`` makes and counts a system with so many structural and parameter adaptations."""

    approach: str
    count: Callable[[int, int], int]


@dataclass(frozen=True, slots=True)
class Growth:
    """What was counted: the base scenario, and totals by number of structural, or of parameter adaptations."""

    approach: str
    base: int
    structural: Mapping[int, int]
    parameter: Mapping[int, int]

    @property
    def per_structural(self) -> float:
        """Elements that a structural adaptation adds, on average."""
        return _slope(self.base, self.structural)

    @property
    def per_parameter(self) -> float:
        """Elements that a parameter adaptation adds, on average."""
        return _slope(self.base, self.parameter)

    @property
    def formula(self) -> str:
        """The growth as in section 7.6."""
        return f"{self.base} + {self.per_structural:g} n_sa + {self.per_parameter:g} n_pa"

    def document(self) -> dict[str, Any]:
        """The growth as JSON."""
        return {
            "approach": self.approach,
            "base": self.base,
            "per_structural_adaptation": self.per_structural,
            "per_parameter_adaptation": self.per_parameter,
            "structural": {str(n): total for n, total in self.structural.items()},
            "parameter": {str(n): total for n, total in self.parameter.items()},
        }


def _slope(base: int, totals: Mapping[int, int]) -> float:
    most = max(totals)
    return (totals[most] - base) / most


def effort_rows() -> list[EffortRow]:
    """The rows of all installed robots (ROSA paper, table 7).

    Returns:
        the paper's two approaches first, then what goes beyond it.

    Raises:
        InputError: if an entry point names something that cannot be used.
    """
    rows = [row for entry in _entries(ROWS) for row in _load(entry)()]
    order = (ROSA_MODEL, BT_MANAGING, ROSA_TASK)
    return sorted(rows, key=lambda row: order.index(row.approach) if row.approach in order else len(order))


def growths(most: int = 10) -> list[Growth]:
    """The growth of ROSA's models and of every installed approach (ROSA paper, section 7.6).

    Args:
        most: up to how many adaptations of each sort are counted.

    Returns:
        one growth for each approach, ROSA's first.

    Raises:
        InputError: if an entry point names something that cannot be used.
    """
    models = [GrowthModel(ROSA_MODEL, count_rosa_model), *(_load(entry) for entry in _entries(GROWTH))]
    return [measure_growth(model, most) for model in models]


def measure_growth(model: GrowthModel, most: int) -> Growth:
    """Count systems with 1, 2, ... adaptations of one sort.

    Args:
        model: what makes and counts a system.
        most: up to how many adaptations; beyond ten only ten numbers of them are counted.

    Example:
        >>> growth = measure_growth(GrowthModel(ROSA_MODEL, count_rosa_model), 3)
        >>> growth.formula
        '10 + 6 n_sa + 3 n_pa'
    """
    numbers = sorted({max(1, round(most * share / 10)) for share in range(1, 11)})
    return Growth(
        model.approach,
        model.count(0, 0),
        {number: model.count(number, 0) for number in numbers},
        {number: model.count(0, number) for number in numbers},
    )


def count_rosa_model(structural: int, parameter: int) -> int:
    """The size of the model of one action, in entities and relations.

    Args:
        structural: how many structural adaptations it has.
        parameter: how many parameter adaptations it has.

    Example:
        >>> count_rosa_model(0, 0), count_rosa_model(1, 0), count_rosa_model(0, 1)
        (10, 16, 13)
    """
    return count_effort(growing_model(structural, parameter)).total


def growing_model(structural: int, parameter: int) -> KnowledgeModel:
    """The model of section 7.6: one action with one function, whose every design is one component with a parameter.

    A structural adaptation is another design, component and configuration, a parameter adaptation another configuration
    of the first component. Every design and every configuration has a priority and a constraint on the one measure.

    Args:
        structural: how many structural adaptations it has.
        parameter: how many parameter adaptations it has.
    """
    from rosa_core.model import elements as e

    designs = range(structural + 1)
    configurations = [(0, number) for number in range(parameter + 1)] + [(design, 0) for design in designs[1:]]
    constraints = [
        *((e.ElementKind.FUNCTION_DESIGN, f"design {number}", number) for number in designs),
        *(
            (e.ElementKind.COMPONENT_CONFIGURATION, f"configuration {component}.{number}", number)
            for component, number in configurations
        ),
    ]
    return KnowledgeModel(
        measures=(e.Measure("quality", e.MeasureKind.QUALITY),),
        actions=(e.Action("act"),),
        functions=(e.Function("function"),),
        components=tuple(e.Component(f"component {number}") for number in designs),
        requirements=(e.FunctionalRequirement("act", ("function",)),),
        function_designs=tuple(
            e.FunctionDesign(f"design {number}", "function", (f"component {number}",), number) for number in designs
        ),
        component_configurations=tuple(
            e.ComponentConfiguration(
                f"configuration {component}.{number}",
                f"component {component}",
                (e.ComponentParameter(f"component {component}", "mode", number, e.ParameterType.LONG),),
                number,
            )
            for component, number in configurations
        ),
        constraints=tuple(
            e.Constraint("quality", e.ElementRef(kind, name), e.ConstraintOperator.GREATER_OR_EQUAL, 1.0 / (number + 1))
            for kind, name, number in constraints
        ),
    )


def model_row(use_case: str, package: str, names: tuple[str, ...], published: int) -> EffortRow:
    """The row of a knowledge model.

    Args:
        use_case: what the table calls it.
        package: where the files are.
        names: of the model's files; later ones extend earlier ones.
        published: the paper's total.

    Raises:
        InputError: if a file cannot be read.
    """
    root = files(package)
    with as_file(root) as directory:
        effort = count_effort(KnowledgeModel.load(*(directory / name for name in names)))
    parts = {"entities": effort.entities, "relations": effort.relations}
    return EffortRow(use_case, ROSA_MODEL, parts, tuple(f"{package}/{name}" for name in names), published)


def guarded_row(model: EffortRow, package: str, name: str) -> EffortRow:
    """A model's row with the guards of a task tree: the nodes that ask what is feasible.

    Args:
        model: the row of the model that the tree is used with.
        package: where the tree's file is.
        name: of the tree's file, in BehaviorTree.CPP XML.

    Raises:
        InputError: if the file cannot be read.
    """
    guards = count_guards(outline(package, name))
    return EffortRow(model.use_case, ROSA_TASK, {**model.parts, "guards": guards}, (*model.files, f"{package}/{name}"))


def outline(package: str, name: str) -> Behaviour:
    """The tree in a BehaviorTree.CPP XML file of a package, nothing in it bound to code.

    Args:
        package: the package's dotted name.
        name: the file's, relative to the package.

    Raises:
        InputError: if the file cannot be read.
    """
    with as_file(files(package).joinpath(name)) as path:
        return read_outline(path)[0]


def count_nodes(root: Behaviour) -> int:
    """The nodes of a tree, as the paper counts them: every element of the XML file is one."""
    return sum(1 for _ in root.iterate())


def count_guards(root: Behaviour) -> int:
    """The nodes that a tree would not have if no action was ever unfeasible.

    These are the conditions that ask, and above each the node that is there to put it before something else, or to
    invert it.
    """
    guards = 0
    for node in root.iterate():
        if _tag(node) == _GUARD:
            guards += 1
            parent = node.parent
            guards += int(parent is not None and len(parent.children) <= 2)
    return guards


def _tag(node: Behaviour) -> str:
    source = source_of(node)
    return "" if source is None else source.tag


def _entries(group: str) -> Iterator[EntryPoint]:
    return iter(sorted(entry_points(group=group), key=lambda entry: (entry.name, entry.value)))


def _load(entry: EntryPoint) -> Any:
    try:
        return entry.load()
    except (ImportError, AttributeError) as error:
        hint = f"correct the entry point '{entry.name} = {entry.value}' of the group {entry.group}"
        raise InputError(Problem(f"it cannot be loaded: {error}", hint=hint)) from error
