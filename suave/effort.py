"""SUAVE's rows of table 7, and how the baseline of managing behaviour trees over system modes grows."""

from __future__ import annotations

import json
from importlib.resources import as_file, files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree.ElementTree import Element, ElementTree, SubElement

from rosa_evaluation.effort import (
    BT_MANAGING,
    EffortRow,
    GrowthModel,
    count_guards,
    count_nodes,
    guarded_row,
    model_row,
    outline,
)
from rosa_simulation.system_modes import load_system_modes
from task_layer.bt.xml.outline import read_outline

_MODELS, _MISSIONS, _MANAGERS = "suave.models", "suave.missions", "suave.managers"


def effort_rows() -> list[EffortRow]:
    """ROSA's models, the baseline, and the guards of ROSA's task trees, each for both missions."""
    rows = []
    for use_case, name, models, ours, theirs in (
        ("SUAVE", "suave", ("suave.yaml",), 30, 57),
        ("SUAVE extended", "suave_extended", ("suave.yaml", "suave_extended.yaml"), 38, 72),
    ):
        model = model_row(use_case, _MODELS, models, ours)
        rows += [model, _baseline_row(use_case, name, theirs), guarded_row(model, _MISSIONS, f"{name}.xml")]
    return rows


def _baseline_row(use_case: str, name: str, published: int) -> EffortRow:
    """The managing tree less the nodes of the task without adaptation, which are those of ROSA's without its guards."""
    tree, mission, modes = f"{name}_bt.xml", f"{name}.xml", f"{name}_modes.yaml"
    task = outline(_MISSIONS, mission)
    nodes = count_nodes(outline(_MANAGERS, tree)) - (count_nodes(task) - count_guards(task))
    with as_file(files(_MANAGERS).joinpath(modes)) as path:
        entries = sum(load_system_modes(path).effort().values())
    counted = (f"{_MANAGERS}/{tree}", f"{_MISSIONS}/{mission}", f"{_MANAGERS}/{modes}")
    return EffortRow(use_case, BT_MANAGING, {"BT nodes": nodes, "system modes": entries}, counted, published)


def count_baseline(structural: int, parameter: int) -> int:
    """The size of a baseline for one action with that many adaptations, written to files in the patterns of SUAVE's.

    It is for the same system as :func:`rosa_evaluation.effort.growing_model`: every design has a component of its
    own. The tree tries the designs in turn, each with a condition and a change of mode, as SUAVE's does for the search
    altitude, and changes the mode back when the action is over. The leaf that performs the action is task, not counted.

    Args:
        structural: how many designs there are to change to.
        parameter: how many changes of a parameter.

    Returns:
        nodes of the tree, and what the modes file declares.
    """
    with TemporaryDirectory() as directory:
        tree, modes = Path(directory) / "tree.xml", Path(directory) / "modes.yaml"
        ElementTree(_tree(structural, parameter)).write(tree, encoding="utf-8")
        # JSON is YAML.
        modes.write_text(json.dumps(_modes(structural, parameter)), encoding="utf-8")
        return count_nodes(read_outline(tree)[0]) - 1 + sum(load_system_modes(modes).effort().values())


def _modes_of_function(structural: int, parameter: int) -> dict[str, tuple[int, str]]:
    """The modes of the function by name: the number of the component that is active, and its mode."""
    modes = {"design_0": (0, "__DEFAULT__")}
    modes |= {f"design_0_{number}": (0, f"mode_{number}") for number in range(1, parameter + 1)}
    return modes | {f"design_{number}": (number, "__DEFAULT__") for number in range(1, structural + 1)}


def _tree(structural: int, parameter: int) -> Element:
    root = Element("root", BTCPP_format="4", main_tree_to_execute="growing")
    action = SubElement(SubElement(root, "BehaviorTree", ID="growing"), "ReactiveSequence")
    designs = SubElement(action, "Fallback")
    for number, mode in enumerate(_modes_of_function(structural, parameter)):
        design = SubElement(designs, "Sequence")
        SubElement(design, "quality", threshold=str(1.0 / (number + 1)))
        SubElement(design, "change_mode", node_name="function", mode_name=mode)
    SubElement(action, "act")
    SubElement(action, "change_mode", node_name="function", mode_name="unground")
    nodes = SubElement(root, "TreeNodesModel")
    for kind, name in (("Condition", "quality"), ("Action", "change_mode"), ("Action", "act")):
        SubElement(nodes, kind, ID=name)
    return root


def _modes(structural: int, parameter: int) -> dict[str, Any]:
    components = [f"component_{number}" for number in range(structural + 1)]

    def state(active: int | None, mode: str) -> dict[str, str]:
        return {name: f"active.{mode}" if n == active else "inactive" for n, name in enumerate(components)}

    function = {"__DEFAULT__": state(None, ""), "unground": state(None, "")}
    function |= {name: state(*wanted) for name, wanted in _modes_of_function(structural, parameter).items()}
    parts: dict[str, Any] = {"function": _part("system", function, parts=components)}
    for number, name in enumerate(components):
        own = ["__DEFAULT__", *(f"mode_{n}" for n in range(1, parameter + 1) if number == 0)]
        parts[name] = _part("node", {mode: {"ros__parameters": {"mode": n}} for n, mode in enumerate(own)})
    return parts


def _part(kind: str, modes: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"ros__parameters": {"type": kind, **more, "modes": modes}}


BASELINE_GROWTH = GrowthModel(BT_MANAGING, count_baseline)
