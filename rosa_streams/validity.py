"""Whether an environment is valid (definition 9 of the paper), with a reason for each violation."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from rosa_streams.environment import Environment, Transformation, Unit, in_order, subscriptions


class ViolationKind(StrEnum):
    """Which condition does not hold; the first four are those of definition 9."""

    NO_TRANSFORMATION = "no transformation"
    NO_STREAM = "no stream"
    UNSATISFIED_TARGET = "unsatisfied target"
    TAG_MISMATCH = "tag mismatch"
    SHARED_CHANNEL = "shared channel"
    SHARED_NAME = "shared name"
    UNGROUNDED = "ungrounded"


@dataclass(frozen=True, slots=True)
class Violation:
    """One condition that does not hold: which, of what unit or target, and why in words."""

    kind: ViolationKind
    about: str
    reason: str

    def __str__(self) -> str:
        return f"{self.about}: {self.reason}"


def violations(environment: Environment, *, well_founded: bool = True) -> tuple[Violation, ...]:
    """Everything that makes an environment invalid, in a fixed order; none if it is valid.

    Args:
        environment: what is checked.
        well_founded: also require that every unit is fed, in the end, by sources. Definition 9 does not: by it, units
            that feed each other in a circle are valid though no sample ever comes. With False it is definition 9 as
            printed.
    """
    found = [
        *_shared_names(environment),
        *_shared_channels(environment),
        *_missing_transformations(environment),
        *_inputs(environment),
        *_targets(environment),
    ]
    if well_founded:
        found += _ungrounded(environment)
    return tuple(found)


def is_valid(environment: Environment, *, well_founded: bool = True) -> bool:
    """Whether there is no violation."""
    return not violations(environment, well_founded=well_founded)


def grounded_units(environment: Environment) -> frozenset[str]:
    """The cids of the units that sources feed, directly or through others."""
    writers = {channel: units[0][0].cid for channel, units in environment.writers().items()}
    waiting: dict[str, int] = {}
    fed: dict[str, list[str]] = {}
    for unit in environment.units:
        waiting[unit.cid] = 0
    for unit, _, channel in subscriptions(environment):
        waiting[unit.cid] += 1
        if channel in writers:
            fed.setdefault(writers[channel], []).append(unit.cid)
    work = [cid for cid, count in waiting.items() if count == 0]
    grounded = set(work)
    while work:
        for cid in fed.get(work.pop(), ()):
            waiting[cid] -= 1
            if waiting[cid] == 0:
                grounded.add(cid)
                work.append(cid)
    return frozenset(grounded)


def _shared_names(environment: Environment) -> list[Violation]:
    found = []
    for kind, names in (
        ("unit", [unit.cid for unit in environment.units]),
        ("transformation", [each.tid for each in environment.transformations]),
        ("target", [target.qid for target in environment.targets]),
    ):
        for name in sorted({name for name in names if names.count(name) > 1}):
            found.append(Violation(ViolationKind.SHARED_NAME, name, f"two of the kind {kind} have this name"))
    return found


def _shared_channels(environment: Environment) -> list[Violation]:
    return [
        Violation(
            ViolationKind.SHARED_CHANNEL,
            channel,
            f"several write to this channel: {', '.join(f'{unit.cid}.{port}' for unit, port in writers)}",
        )
        for channel, writers in sorted(environment.writers().items())
        if len(writers) > 1
    ]


def _missing_transformations(environment: Environment) -> list[Violation]:
    library = environment.library()
    return [
        Violation(ViolationKind.NO_TRANSFORMATION, unit.cid, f"its transformation '{unit.tid}' is not in the library")
        for unit in in_order(environment.units)
        if unit.tid not in library
    ]


def _inputs(environment: Environment) -> list[Violation]:
    library, writers = environment.library(), environment.writers()
    found = []
    for unit, port, channel in subscriptions(environment):
        about = f"{unit.cid}.{port}"
        if channel is None:
            found.append(Violation(ViolationKind.NO_STREAM, about, "it subscribes to no channel"))
        elif channel not in writers:
            found.append(Violation(ViolationKind.NO_STREAM, about, f"no unit writes to its channel '{channel}'"))
        else:
            for writer, output in writers[channel]:
                reason = _mismatch(environment, library, (unit, port), (writer, output))
                if reason:
                    found.append(Violation(ViolationKind.TAG_MISMATCH, about, reason))
    return found


def _mismatch(
    environment: Environment, library: dict[str, Transformation], into: tuple[Unit, str], out_of: tuple[Unit, str]
) -> str | None:
    reader, writer = library.get(into[0].tid), library.get(out_of[0].tid)
    if reader is None or writer is None:
        return None
    wanted = {port.name: port.tag for port in reader.inputs}.get(into[1])
    given = {port.name: port.tag for port in writer.outputs}.get(out_of[1])
    if wanted is None or given is None:
        return f"'{reader.tid if wanted is None else writer.tid}' has no such port"
    if environment.similarity.matches(given, wanted):
        return None
    return f"it asks for {wanted} and gets {given} from {out_of[0].cid}.{out_of[1]}"


def _targets(environment: Environment) -> list[Violation]:
    library, writers = environment.library(), environment.writers()
    found = []
    for qid, target in environment.goal().items():
        providers = [
            (unit, given)
            for unit, output in writers.get(target.channel, ())
            if unit.tid in library
            for given in (port.tag for port in library[unit.tid].outputs if port.name == output)
        ]
        if not any(environment.similarity.matches(given, target.tag) for _, given in providers):
            what = f"{providers[0][1]} from {providers[0][0].cid} is not that" if providers else "no unit writes there"
            reason = f"it asks for {target.tag} on '{target.channel}'; {what}"
            found.append(Violation(ViolationKind.UNSATISFIED_TARGET, qid, reason))
    return found


def _ungrounded(environment: Environment) -> list[Violation]:
    grounded, writers = grounded_units(environment), environment.writers()
    complete = {unit.cid for unit in environment.units}
    for unit, _, channel in subscriptions(environment):
        if channel not in writers:
            complete.discard(unit.cid)
    found = []
    for unit in in_order(environment.units):
        if unit.cid in grounded or unit.cid not in complete:
            continue
        loop = _loop_from(unit.cid, environment, grounded)
        if loop and unit.cid in loop:
            reason = f"it feeds itself and no source feeds it: {' -> '.join((*loop, loop[0]))}"
            found.append(Violation(ViolationKind.UNGROUNDED, unit.cid, reason))
    return found


def _loop_from(cid: str, environment: Environment, grounded: frozenset[str]) -> tuple[str, ...] | None:
    """The shortest circle of ungrounded units through this one, in the order in which samples would flow."""
    writers = {channel: units[0][0].cid for channel, units in environment.writers().items()}
    feeds: dict[str, list[str]] = {}
    for unit, _, channel in subscriptions(environment):
        writer = writers.get(channel) if channel is not None else None
        if writer is not None and writer not in grounded:
            feeds.setdefault(writer, []).append(unit.cid)
    paths: list[tuple[str, ...]] = [(cid,)]
    seen = set()
    for path in paths:
        for following in feeds.get(path[-1], ()):
            if following == cid:
                return path
            if following not in seen:
                seen.add(following)
                paths.append((*path, following))
    return None
