"""Specifications before their template variables are filled in and their tags are read."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass

from rosa_core.errors import InputError, Location, Problem, nearest
from rosa_streams.environment import ParameterValue, Port, Target, Transformation
from rosa_streams.errors import StreamError
from rosa_streams.tags import Ontology, parse_tag

MOST_COPIES = 10_000
"""How many transformations one template may expand to."""

_VARIABLE = re.compile(r"\$\{([^\W\d][\w\-]*)\}")


@dataclass(frozen=True, slots=True)
class PortDraft:
    """A port: its name, the text of its tag, and where that stands."""

    name: str
    tag: str
    where: Location


@dataclass(frozen=True, slots=True)
class TransformationDraft:
    """A transformation as its file has it."""

    label: str
    source: str
    inputs: tuple[PortDraft, ...]
    outputs: tuple[PortDraft, ...]
    parameters: tuple[tuple[str, ParameterValue], ...]
    where: Location
    quality: float = 0.0
    labor: float | None = None
    upkeep: float | None = None

    def texts(self) -> Iterator[str]:
        """Every text in which a template variable may stand."""
        yield self.label
        yield self.source
        yield from (text for port in (*self.inputs, *self.outputs) for text in (port.name, port.tag))
        yield from (value for _, value in self.parameters if isinstance(value, str))


@dataclass(frozen=True, slots=True)
class TargetDraft:
    """A target as its file has it."""

    label: str
    tag: str
    channel: str
    where: Location


def transformations_of(draft: TransformationDraft, ontology: Ontology) -> Iterator[Transformation]:
    """The transformations of a draft: one for each choice of individuals for its variables.

    ``${NAO}`` stands for each individual of the class ``NAO``. A label without the variable gets the individual in
    parentheses, as in ``segmenter(piff)``.

    Raises:
        InputError: for tags that cannot be read, and variables that name no class with individuals.
    """
    for chosen in _choices(draft.texts(), ontology, draft.where):
        label = _labelled(draft.label, chosen)
        parameters = tuple(
            (name, _filled(value, chosen) if isinstance(value, str) else value) for name, value in draft.parameters
        )
        try:
            yield Transformation(
                label,
                _filled(draft.source, chosen),
                tuple(_port(port, chosen) for port in draft.inputs),
                tuple(_port(port, chosen) for port in draft.outputs),
                parameters,
                draft.quality,
                draft.labor,
                draft.upkeep,
            )
        except InputError as error:
            raise StreamError(
                [each if each.where else Problem(each.what, draft.where) for each in error.problems]
            ) from None


def targets_of(draft: TargetDraft, ontology: Ontology) -> Iterator[Target]:
    """The targets of a draft, one for each choice of individuals for its variables; see :func:`transformations_of`."""
    for chosen in _choices((draft.label, draft.tag, draft.channel), ontology, draft.where):
        channel = _filled(draft.channel, chosen)
        yield Target(_labelled(draft.label, chosen), parse_tag(_filled(draft.tag, chosen), draft.where), channel)


def _choices(texts: Iterator[str] | tuple[str, ...], ontology: Ontology, where: Location) -> Iterator[dict[str, str]]:
    variables = list(dict.fromkeys(name for text in texts for name in _VARIABLE.findall(text)))
    domains = []
    copies = 1
    for name in variables:
        individuals = ontology.individuals_of(name)
        if not individuals and name not in ontology.axioms.classes:
            hint = nearest(name, ontology.axioms.classes) or f"declare individuals of the class {name} in the ontology"
            raise StreamError(Problem(f"no class '{name}' is known for the template ${{{name}}}", where, hint))
        domains.append(individuals)
        copies *= len(individuals)
    if copies > MOST_COPIES:
        raise StreamError(Problem(f"the template expands to {copies:,} copies; {MOST_COPIES:,} are allowed", where))
    for individuals in itertools.product(*domains):
        yield dict(zip(variables, individuals, strict=True))


def _labelled(label: str, chosen: dict[str, str]) -> str:
    missing = [chosen[name] for name in chosen if f"${{{name}}}" not in label]
    return _filled(label, chosen) + (f"({', '.join(missing)})" if missing else "")


def _filled(text: str, chosen: dict[str, str]) -> str:
    return _VARIABLE.sub(lambda match: chosen[match[1]], text) if chosen else text


def _port(port: PortDraft, chosen: dict[str, str]) -> Port:
    return Port(_filled(port.name, chosen), parse_tag(_filled(port.tag, chosen), port.where))
