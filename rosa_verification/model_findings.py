"""All that can be found in a knowledge model alone."""

from __future__ import annotations

from dataclasses import dataclass

from rosa_core.model.elements import ElementRef
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_verification.causes import Cause, Region, cause_document, region_document
from rosa_verification.choices import Choices, Flapping, NeverSelected
from rosa_verification.cut_sets import CutSet, CutSets, MinimalSets, PathSets
from rosa_verification.gaps import Contradiction, Gap, find_contradictions, find_gaps
from rosa_verification.structure import KINDS, Structure


@dataclass(frozen=True, slots=True)
class ModelFindings:
    """What can go wrong with a robot of a model, whatever its mission.

    Args:
        cut_sets: of every element that can be unfeasible.
        path_sets: the same; None for those with too many to be listed.
        gaps: regions of measures in which an action cannot be performed.
        contradictions: constraints that no value satisfies together.
        never_selected: what no situation makes the planner select.
        flapping: choices that change back and forth around a limit.
        undecided: elements with too many situations to say whether they are ever selected or flap.
    """

    cut_sets: dict[ElementRef, MinimalSets]
    path_sets: dict[ElementRef, tuple[CutSet, ...] | None]
    gaps: tuple[Gap, ...]
    contradictions: tuple[Contradiction, ...]
    never_selected: tuple[NeverSelected, ...]
    flapping: tuple[Flapping, ...]
    undecided: tuple[ElementRef, ...]

    @property
    def defects(self) -> tuple[Contradiction | NeverSelected, ...]:
        """What cannot be meant as it is: contradictions, and what is in use but never selected.

        A robot may well have single points of failure, gaps and choices that flap: these are no defects of its model.
        """
        return (*self.contradictions, *(one for one in self.never_selected if one.is_defect))

    def single_points(self, element: ElementRef) -> tuple[Cause, ...]:
        """What alone makes an element unfeasible, by name.

        Args:
            element: one that can be unfeasible.
        """
        return tuple(causes[0] for causes in self.cut_sets[element].sets if len(causes) == 1)

    def document(self) -> dict[str, object]:
        """The findings as JSON has them."""
        cut_sets: dict[str, dict[str, object]] = {kind: {} for kind in KINDS}
        path_sets: dict[str, dict[str, object]] = {kind: {} for kind in KINDS}
        for element, found in self.cut_sets.items():
            cut_sets[element.kind][element.name] = [[cause_document(cause) for cause in one] for one in found.sets]
        for element, sets in self.path_sets.items():
            shown = None if sets is None else [[_working_document(part) for part in one] for one in sets]
            path_sets[element.kind][element.name] = shown
        most = max((found.order or 0 for found in self.cut_sets.values()), default=0)
        return {
            "cut_sets": cut_sets,
            "path_sets": path_sets,
            "incomplete": [
                {"kind": element.kind, "name": element.name, "order": found.order}
                for element, found in self.cut_sets.items()
                if found.order is not None and found.order < most
            ],
            "gaps": [gap.document() for gap in self.gaps],
            "contradictions": [contradiction.document() for contradiction in self.contradictions],
            "never_selected": [one.document() for one in self.never_selected],
            "flapping": [one.document() for one in self.flapping],
            "undecided": [{"kind": element.kind, "name": element.name} for element in self.undecided],
        }


def _working_document(part: Cause) -> dict[str, object]:
    return region_document(part) if isinstance(part, Region) else {"works": part}


def verify_model(model: KnowledgeModel, order: int = 3) -> ModelFindings:
    """Find what can go wrong with a robot of a model.

    >>> from rosa_core.model import Action, Component, ElementKind, Function, FunctionalRequirement, FunctionDesign
    >>> findings = verify_model(
    ...     KnowledgeModel(
    ...         actions=(Action("fly"),),
    ...         functions=(Function("lift"),),
    ...         components=(Component("rotors"),),
    ...         requirements=(FunctionalRequirement("fly", ("lift",)),),
    ...         function_designs=(FunctionDesign("by rotors", "lift", ("rotors",)),),
    ...     )
    ... )
    >>> findings.single_points(ElementRef(ElementKind.ACTION, "fly")), findings.defects
    (('rotors',), ())

    Args:
        model: whose elements are looked at.
        order: the most causes of a cut set.
    """
    structure = Structure(model)
    cut_sets, path_sets = CutSets(structure, order), PathSets(structure)
    choices = Choices(structure, cut_sets)
    elements = structure.elements()
    never_selected, flapping = choices.never_selected(), choices.flapping()
    return ModelFindings(
        cut_sets={element: cut_sets.of(element) for element in elements},
        path_sets={element: path_sets.of(element) for element in elements},
        gaps=tuple(find_gaps(structure, cut_sets)),
        contradictions=tuple(find_contradictions(structure, cut_sets)),
        never_selected=tuple(never_selected),
        flapping=tuple(flapping),
        undecided=tuple(choices.undecided),
    )


def find_defects(model: KnowledgeModel) -> tuple[Contradiction | NeverSelected, ...]:
    """The defects of a model that can be found at once: :attr:`ModelFindings.defects`, of single measures only.

    Args:
        model: whose elements are looked at.
    """
    structure = Structure(model)
    cut_sets = CutSets(structure, 1)
    never_selected = Choices(structure, cut_sets).never_selected()
    return (*find_contradictions(structure, cut_sets), *(one for one in never_selected if one.is_defect))
