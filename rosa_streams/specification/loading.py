"""Files of any kind, put together into an environment."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from rosa_core.errors import InputError, Location, Problem, nearest
from rosa_streams.environment import Environment, Target, Transformation, Unit
from rosa_streams.errors import StreamError
from rosa_streams.specification.drafts import TargetDraft, TransformationDraft, targets_of, transformations_of
from rosa_streams.specification.xml_format import read_specifications
from rosa_streams.specification.yaml_format import read_yaml
from rosa_streams.tags import Ontology
from rosa_streams.tags.concepts import names_in
from rosa_streams.tags.loading import OWL_SUFFIXES, load_axioms
from rosa_streams.tags.ontology import Axioms, unknown_names

_FileName = str | PathLike[str]


@dataclass(frozen=True)
class Specification:
    """What files say.

    Attributes:
        environment: transformations, targets and the units that already run.
        ontology: the meaning of tags.
        horizon: seconds over which upkeep counts, if a file says so.
        max_cost: the most that an update may cost, if a file says so.
        quality_weight: what a unit of quality is worth, if a file says so.
        notes: what is allowed and looks like a mistake, in words.
    """

    environment: Environment
    ontology: Ontology
    horizon: float | None = None
    max_cost: float | None = None
    quality_weight: float | None = None
    notes: tuple[str, ...] = ()


def load_specification(*files: _FileName, ontology: Ontology | None = None) -> Specification:
    """Read XML specifications, YAML and ontologies (YAML, OWL, Turtle), in any order, and put them together.

    Args:
        files: ``.xml``, ``.yaml`` or ``.yml``, and ``.ttl``, ``.owl``, ``.rdf`` or ``.nt``.
        ontology: in addition to what the files say.

    Raises:
        InputError: with every problem of a file, each with its line and a hint.
    """
    axioms = ontology.axioms if ontology else Axioms()
    drafts: list[TransformationDraft | TargetDraft] = []
    units: list[Unit] = []
    settings: dict[str, float] = {}
    for file in files:
        suffix = Path(file).suffix
        if suffix == ".xml":
            drafts += read_specifications(file)
        elif suffix in {".yaml", ".yml"}:
            read = read_yaml(file)
            axioms = axioms.merged(read.axioms)
            drafts += read.drafts
            units += read.units
            settings.update(read.planning)
        elif suffix in OWL_SUFFIXES:
            axioms = axioms.merged(load_axioms(file))
        else:
            hint = "known are .xml, .yaml, .yml, .ttl, .owl, .rdf and .nt"
            raise StreamError(Problem(f"a file of the kind '{suffix}' cannot be read", Location(str(file)), hint))
    known = Ontology(axioms)
    transformations, targets = _expanded(drafts, known)
    _check_units(units, transformations)
    environment = Environment(frozenset(units), frozenset(transformations), frozenset(targets), known)
    return Specification(
        environment,
        known,
        settings.get("horizon"),
        settings.get("max_cost"),
        settings.get("quality_weight"),
        (*axioms.ignored, *_notes(known, transformations, targets)),
    )


def load_transformations(*files: _FileName, ontology: Ontology | None = None) -> tuple[Transformation, ...]:
    """The transformations of files, in order of their names, such as those that a robot registers when it joins."""
    environment = load_specification(*files, ontology=ontology).environment
    return tuple(environment.library().values())


def _expanded(
    drafts: Iterable[TransformationDraft | TargetDraft], ontology: Ontology
) -> tuple[list[Transformation], list[Target]]:
    transformations: dict[str, Transformation] = {}
    targets: dict[str, Target] = {}
    problems: list[Problem] = []
    for draft in drafts:
        try:
            if isinstance(draft, TransformationDraft):
                for each in transformations_of(draft, ontology):
                    if each.tid in transformations:
                        problems.append(Problem(f"the label '{each.tid}' stands twice", draft.where, "rename one"))
                    transformations[each.tid] = each
            else:
                for target in targets_of(draft, ontology):
                    if target.qid in targets:
                        problems.append(Problem(f"the label '{target.qid}' stands twice", draft.where, "rename one"))
                    targets[target.qid] = target
        except InputError as error:
            problems.extend(error.problems)
    if problems:
        raise StreamError(problems)
    return list(transformations.values()), list(targets.values())


def _check_units(units: Iterable[Unit], transformations: Iterable[Transformation]) -> None:
    library = {each.tid: each for each in transformations}
    problems = []
    for unit in units:
        known = library.get(unit.tid)
        if known is None:
            continue  # Allowed: it is what a unit looks like whose transformation is gone; validity says so.
        for port, ports in ((unit.inputs, known.inputs), (unit.outputs, known.outputs)):
            names = [each.name for each in ports]
            for name, _ in port:
                if name not in names:
                    what = f"the unit '{unit.cid}' connects '{name}', and '{unit.tid}' has no such port"
                    problems.append(Problem(what, None, nearest(name, names)))
    if problems:
        raise StreamError(problems)


def _notes(ontology: Ontology, transformations: Iterable[Transformation], targets: Iterable[Target]) -> list[str]:
    """Names of tags that the ontology does not declare though one like it does."""
    used = [name for each in transformations for port in (*each.inputs, *each.outputs) for name in names_in(port.tag)]
    used += [name for target in targets for name in names_in(target.tag)]
    declared = ontology.known_names()
    given = {name for each in transformations for port in each.outputs for name in names_in(port.tag)}
    notes = []
    for name in unknown_names(ontology, used):
        near = nearest(name, declared)
        if near and name not in given:
            notes.append(f"'{name}' is not in the ontology, {near}")
    return notes
