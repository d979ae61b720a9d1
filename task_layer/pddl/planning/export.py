"""Plans for people and for other programs: a table in time, a graph, a behaviour tree."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from xml.etree import ElementTree

from task_layer.pddl.grounding.ground_task import Operator
from task_layer.pddl.planning.plan import Plan

_BAR_WIDTH = 40


def plan_rows(plan: Plan) -> Iterator[tuple[float, str, float, str]]:
    """For each step its planned start (s), itself as PDDL writes it, its duration (s), and a bar in time.

    The bars are drawn to scale, 40 characters for the whole plan; they are empty if the domain gives no durations.
    """
    scale = _BAR_WIDTH / plan.duration if plan.duration else 0.0
    for step in plan.steps:
        before = round(step.start * scale)
        width = max(1, round(step.end * scale) - before) if scale else 0
        yield step.start, step.operator.name, step.operator.duration, " " * before + "█" * width


def plan_dot(plan: Plan) -> str:
    """The plan as a graph in Graphviz' language: an edge from each step to those that must wait for its end.

    What follows from other edges is left out.
    """
    import networkx as nx
    import pydot

    order: nx.DiGraph[int] = nx.DiGraph()
    order.add_nodes_from(range(len(plan)))
    order.add_edges_from((earlier, later) for later, before in enumerate(plan.after_ends) for earlier in sorted(before))
    graph = pydot.Dot("plan", graph_type="digraph", rankdir="LR")
    for index, step in enumerate(plan.steps):
        label = (
            f"{step.operator.name.strip('()')}\\n{step.start:g} s" if plan.duration else step.operator.name.strip("()")
        )
        graph.add_node(pydot.Node(f"s{index}", label=_quoted(label), shape="box"))
    for earlier, later in sorted(nx.transitive_reduction(order).edges):
        graph.add_edge(pydot.Edge(f"s{earlier}", f"s{later}"))
    text: str = graph.to_string()
    return text


def _quoted(label: str) -> str:
    return '"' + label.replace('"', '\\"') + '"'


def plan_tree(plan: Plan, actions: Callable[[Operator], tuple[str, ...]]) -> str:
    """The plan as a behaviour tree, in the XML of BehaviorTree.CPP 4.

    A sequence with memory of the steps, each behind the feasibility of its actions (ROSA paper, figure 5). The leaf of
    a step has the name of the action that it requests. A step that requests none, or several, has the name of its
    action in the domain; the TreeNodesModel says that there are such leaves besides the knowledge base's actions.

    Args:
        plan: the plan; steps that may run at once come one after the other.
        actions: the actions of the knowledge base that a step requests.
    """
    root = ElementTree.Element("root", BTCPP_format="4", main_tree_to_execute="plan")
    tree = ElementTree.SubElement(root, "BehaviorTree", ID="plan")
    sequence = ElementTree.SubElement(tree, "SequenceWithMemory", name="plan")
    others: list[str] = []
    for step in plan.steps:
        names = actions(step.operator)
        parent = sequence
        if names:
            parent = ElementTree.SubElement(sequence, "ReactiveSequence", name=step.operator.name)
            for name in names:
                ElementTree.SubElement(parent, "is_action_feasible", action_name=name)
        leaf = names[0] if len(names) == 1 else step.operator.action
        if leaf not in names:
            others.append(leaf)
        _add_leaf(parent, leaf, step.operator.name)
    if others:
        models = ElementTree.SubElement(root, "TreeNodesModel")
        for leaf in dict.fromkeys(others):
            ElementTree.SubElement(models, "Action", ID=leaf)
    ElementTree.indent(root)
    return f"<?xml version='1.0' encoding='utf-8'?>\n{ElementTree.tostring(root, encoding='unicode')}\n"


def _add_leaf(parent: ElementTree.Element, action: str, name: str) -> None:
    """A leaf by its tag, or if XML has no such tag as ``<Action ID=...>``."""
    if re.fullmatch(r"[A-Za-z_][\w.-]*", action):
        ElementTree.SubElement(parent, action, name=name)
    else:
        ElementTree.SubElement(parent, "Action", ID=action, name=name)
