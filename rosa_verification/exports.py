"""Fault trees in the formats of other tools: Open-PSA model exchange format (XML) and Galileo."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from xml.etree import ElementTree as ET

from rosa_verification.causes import Cause, Region, cause_text
from rosa_verification.fault_tree import FaultTree, TreeGate, inputs_of
from rosa_verification.reliability_file import Reliability
from rosa_verification.structure import Combination
from task_layer.svg import xml_text

_WORDS = {Combination.ANY: "or", Combination.ALL: "and"}
_NOTHING_KNOWN = Reliability({}, {})


def open_psa(
    tree: FaultTree, reliability: Reliability | None = None, measured: Mapping[str, float] | None = None
) -> str:
    """A fault tree in the Open-PSA Model Exchange Format, version 2.0d, which SCRAM and XFTA read.

    Args:
        tree: when something is unfeasible.
        reliability: of components: probabilities, or failure rates over the mission time of the tool that reads it.
        measured: values of measures, in their units. What lies in a region or not by these is a house event. Other
            regions are basic events without a probability; that those of one measure exclude each other is not said.
    """
    root = ET.Element("opsa-mef")
    definition = ET.SubElement(root, "define-fault-tree", {"name": f"{tree.top.name}_tree"})
    for gate in tree.gates.values():
        _define_gate(definition, tree, gate)
    for cause, name in tree.causes.items():
        _define_event(definition, cause, name, reliability or _NOTHING_KNOWN, measured or {})
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _define_gate(definition: ET.Element, tree: FaultTree, gate: TreeGate) -> None:
    element = ET.SubElement(definition, "define-gate", {"name": gate.name})
    ET.SubElement(element, "label").text = xml_text(gate.label)
    inputs = list(inputs_of(tree, gate))
    if not inputs:
        ET.SubElement(element, "constant", {"value": _truth(gate.combination is Combination.ALL)})
        return
    # A gate of one input is written as that input: "or" and "and" take two at least.
    formula = element if len(inputs) == 1 else ET.SubElement(element, _WORDS[gate.combination])
    for name, is_gate in inputs:
        ET.SubElement(formula, "gate" if is_gate else "event", {"name": name})


def _define_event(
    definition: ET.Element, cause: Cause, name: str, reliability: Reliability, measured: Mapping[str, float]
) -> None:
    if isinstance(cause, Region) and cause.measure in measured:
        event = ET.SubElement(definition, "define-house-event", {"name": name})
        ET.SubElement(event, "label").text = xml_text(cause_text(cause))
        ET.SubElement(event, "constant", {"value": _truth(cause.holds(measured.get(cause.measure)))})
        return
    event = ET.SubElement(definition, "define-basic-event", {"name": name})
    ET.SubElement(event, "label").text = xml_text(cause_text(cause))
    if isinstance(cause, Region):
        return
    if cause in reliability.rates:
        exponential = ET.SubElement(event, "exponential")
        ET.SubElement(exponential, "float", {"value": repr(reliability.rates[cause])})
        ET.SubElement(exponential, "system-mission-time")
    elif cause in reliability.probabilities:
        ET.SubElement(event, "float", {"value": repr(reliability.probabilities[cause])})


def galileo(
    tree: FaultTree, reliability: Reliability | None = None, measured: Mapping[str, float] | None = None
) -> str:
    """A fault tree in the Galileo textual format, which Storm and DFTCalc read.

    Args:
        tree: when something is unfeasible.
        reliability: of components: probabilities, or failure rates per second. What nothing is said of never fails.
        measured: values of measures, in their units: what lies in a region by these always does, all else never.
    """
    return "\n".join((*_galileo_lines(tree, reliability or _NOTHING_KNOWN, measured or {}), ""))


def _galileo_lines(tree: FaultTree, reliability: Reliability, measured: Mapping[str, float]) -> Iterator[str]:
    yield f'toplevel "{tree.top.name}";'
    for gate in tree.gates.values():
        inputs = [f'"{name}"' for name, _ in inputs_of(tree, gate)]
        if inputs:
            yield f'"{gate.name}" {_WORDS[gate.combination]} {" ".join(inputs)};'
        else:
            yield f'"{gate.name}" prob={1 if gate.combination is Combination.ALL else 0};'
    for cause, name in tree.causes.items():
        if isinstance(cause, Region):
            yield f'"{name}" prob={1 if cause.holds(measured.get(cause.measure)) else 0};'
        elif cause in reliability.rates:
            yield f'"{name}" lambda={reliability.rates[cause]!r} dorm=0;'
        else:
            yield f'"{name}" prob={reliability.probabilities.get(cause, 0)!r};'


def _truth(holds: bool) -> str:
    return "true" if holds else "false"
