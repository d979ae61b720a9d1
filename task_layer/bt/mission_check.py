"""Checks a mission before it is run, against its file and the knowledge model."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from rosa_core import InputError, KnowledgeModel
from rosa_core.errors import Location, Problem, nearest
from task_layer.bt.ports.bound_ports import Literal
from task_layer.bt.types.node_source import NodeKind
from task_layer.bt.types.registry import FEASIBILITY_CONDITIONS, Registry
from task_layer.bt.xml.file_reader import NO_PACKAGES, AnyPath, Packages, read_tree_files
from task_layer.bt.xml.leaf_types import optional
from task_layer.bt.xml.loader import TreeProject
from task_layer.bt.xml.node_specs import NodeSpec
from task_layer.bt.xml.possible_outcomes import PossibleOutcomes
from task_layer.bt.xml.tree_files import TreeFiles
from task_layer.skill import Skill

_GUARDING = ("ReactiveSequence",)
_GUARDING_ONCE = ("Sequence", "AsyncSequence", "SequenceWithMemory")


@dataclass(frozen=True, slots=True)
class MissionFindings:
    """The findings of a check.

    Attributes:
        problems: reasons why the mission cannot be run.
        warnings: parts that are probably not intended.
        nodes: the number of nodes of its tree.
    """

    problems: tuple[Problem, ...] = ()
    warnings: tuple[Problem, ...] = ()
    nodes: int = 0


def check_mission(
    path: AnyPath | Sequence[AnyPath],
    model: KnowledgeModel,
    registry: Registry | Mapping[str, Any] | None = None,
    *,
    tree: str | None = None,
    nodes: Iterable[AnyPath] = (),
    ros_packages: Packages = NO_PACKAGES,
) -> MissionFindings:
    """Check a mission against a knowledge model.

    Args:
        path: the XML file, several files, or the folder of a project.
        model: the model with the actions.
        registry: the robot's leaves; by default the model's actions, and the leaves that the TreeNodesModel of the
            mission's files and of ``nodes`` declares.
        tree: the ID of the tree to be run, as for :func:`~task_layer.bt.load_tree`.
        nodes: files with models of nodes.
        ros_packages: the folders that ``<include ros_pkg=...>`` means, by the packages' names.

    Returns:
        the findings; problems of the file itself are among them, not raised.
    """
    try:
        files = read_tree_files(path, nodes=nodes, ros_packages=ros_packages)
        leaves = _declared_leaves(model, files) if registry is None else Registry.of(registry)
        project = TreeProject(files, leaves)
        main, specs = project.specs(tree)
        root = project.build(main)
    except InputError as error:
        return MissionFindings(problems=tuple(error.problems))
    inspection = _Inspection(specs, model)
    inspection.inspect(main, files.where)
    if not files.is_project:
        inspection.find_unused(files)
    nodes_in_tree = sum(1 for _ in root.iterate())
    return MissionFindings(
        tuple(inspection.problems), (*inspection.sorted_warnings(), *project.warnings(main)), nodes_in_tree
    )


class _EmptySkill(Skill):
    """A skill for trees that are not run."""


def _declared_leaves(model: KnowledgeModel, files: TreeFiles) -> Registry:
    registry = Registry()
    for tag, declared in files.models.items():
        if declared.kind in (NodeKind.ACTION, NodeKind.CONDITION) and tag not in registry:
            registry.add(tag, lambda: None, ports=optional(declared.ports), kind=declared.kind)
    for action in model.actions:
        registry.add(action.name, _EmptySkill)
    return registry


@dataclass(frozen=True, slots=True)
class _Guarded:
    """The actions whose feasibility has been checked before a node."""

    always: frozenset[str] = frozenset()
    once: frozenset[str] = frozenset()


@dataclass(slots=True)
class _Inspection:
    """Walks through the trees that are used, and collects findings."""

    specs: Mapping[str, NodeSpec]
    model: KnowledgeModel
    problems: list[Problem] = field(default_factory=list)
    warnings: list[Problem] = field(default_factory=list)
    performed: set[str] = field(default_factory=set)
    used: set[str] = field(default_factory=set)

    def inspect(self, main: str, file: Location) -> None:
        """Walk through the main tree, and find actions that are not in it."""
        self._tree(main, _Guarded())
        for action in self.model.actions:
            if action.name not in self.performed:
                self._warn(f"the action '{action.name}' of the model is never performed", file)

    def find_unused(self, files: TreeFiles) -> None:
        """Find trees that the main tree does not use."""
        for tree_id in files.trees.keys() - self.used:
            self._warn(f"the tree '{tree_id}' is never used", files.trees[tree_id][0].where)

    def sorted_warnings(self) -> list[Problem]:
        """The warnings by place."""
        return sorted(self.warnings, key=lambda warning: (str(warning.where and warning.where.file), _line(warning)))

    def _tree(self, tree_id: str, guarded: _Guarded) -> None:
        if tree_id not in self.used:
            self.used.add(tree_id)
            outcomes = PossibleOutcomes(self.specs)
            for spec in _iterate(self.specs[tree_id]):
                for child, before, never in outcomes.unreachable(spec):
                    self._warn(f"'{child.name}' is never reached: '{before.name}' before it never {never}", child.where)
        self._node(self.specs[tree_id], guarded)

    def _node(self, spec: NodeSpec, guarded: _Guarded) -> None:
        if spec.type is None:
            self._tree(spec.subtree, guarded)
            return
        action = _action_of(spec)
        if action is not None:
            self._action(spec, action, guarded)
        for child in spec.children:
            self._node(child, guarded)
            guarded = _after(spec.type.tag, child, guarded)

    def _action(self, spec: NodeSpec, action: str, guarded: _Guarded) -> None:
        names = [known.name for known in self.model.actions]
        if action not in names:
            self.problems.append(Problem(f"the model has no action '{action}'", spec.where, nearest(action, names)))
        elif not _is_guard(spec):
            self.performed.add(action)
            if action in guarded.always:
                return
            hint = f'put <is_action_feasible action_name="{action}"/> before it in a <ReactiveSequence>'
            how = "checked only once" if action in guarded.once else "not checked"
            self._warn(f"whether '{action}' is feasible is {how} before it is performed", spec.where, hint)

    def _warn(self, what: str, where: Location, hint: str | None = None) -> None:
        warning = Problem(what, where, hint)
        if warning not in self.warnings:
            self.warnings.append(warning)


def _after(tag: str, child: NodeSpec, guarded: _Guarded) -> _Guarded:
    """The guarded actions for the children after one."""
    action = _action_of(child) if _is_guard(child) else None
    if action is None:
        return guarded
    if tag in _GUARDING:
        return _Guarded(guarded.always | {action}, guarded.once)
    return _Guarded(guarded.always, guarded.once | {action}) if tag in _GUARDING_ONCE else guarded


def _is_guard(spec: NodeSpec) -> bool:
    return spec.type is not None and spec.type.tag in FEASIBILITY_CONDITIONS


def _action_of(spec: NodeSpec) -> str | None:
    value = spec.values.get("action_name")
    return str(value.value) if isinstance(value, Literal) else None


def _iterate(spec: NodeSpec) -> Iterator[NodeSpec]:
    to_do = [spec]
    while to_do:
        node = to_do.pop()
        yield node
        to_do.extend(reversed(node.children))


def _line(problem: Problem) -> int:
    return 0 if problem.where is None else problem.where.line or 0
