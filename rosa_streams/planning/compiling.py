"""From chosen options to a change set: who subscribes to whom, on which channels, and what goes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from rosa_streams.environment import Change, Environment, Transformation, Unit, in_order
from rosa_streams.planning.problem import Option, Problem
from rosa_streams.tags import Concept


class UnitNames:
    """Gives new units names of their own: ``segmenter.2`` after ``segmenter.1``, also when that one is gone."""

    def __init__(self, units: Iterable[Unit] = ()) -> None:
        self._used: dict[str, int] = {}
        for unit in units:
            self.note(unit.cid)

    def note(self, cid: str) -> None:
        """This name is taken."""
        base, _, number = cid.rpartition(".")
        if base and number.isdecimal():
            self._used[base] = max(self._used.get(base, 0), int(number))

    def new(self, tid: str) -> str:
        """A name for a unit of this transformation; arguments in parentheses are left out."""
        base = tid.partition("(")[0].strip() or tid
        self._used[base] = self._used.get(base, 0) + 1
        return f"{base}.{self._used[base]}"

    def copy(self) -> UnitNames:
        """The same names, to try something out."""
        names = UnitNames()
        names._used = dict(self._used)
        return names


_Output = tuple[int, str]
"""An option and one of its output ports."""


def compiled_change(
    environment: Environment,
    problem: Problem,
    chosen: Iterable[int],
    names: UnitNames | None = None,
    *,
    remove_unneeded: bool = True,
) -> tuple[Change, tuple[Unit, ...], frozenset[int]]:
    """The change set that makes the chosen options run, connected so that sources feed everything.

    Connections that exist and are right are kept. Options that turn out to be needless are left out.

    Returns:
        the change, the units after it, and the options that are in use.
    """
    return _Compiling(environment, problem, frozenset(chosen), names or UnitNames(environment.units)).change(
        remove_unneeded
    )


class _Compiling:
    """One compilation."""

    def __init__(self, environment: Environment, problem: Problem, chosen: frozenset[int], names: UnitNames) -> None:
        self._environment, self._problem, self._names = environment, problem, names
        self._chosen = sorted(chosen)
        self._matches = environment.similarity.matches
        self._needs = {tag: need for need, tag in enumerate(problem.tags)}
        self._option_of_unit = {
            option.unit.cid: number for number in self._chosen if (option := problem.options[number]).unit is not None
        }
        self._writers = {
            channel: (self._option_of_unit[writers[0][0].cid], writers[0][1])
            for channel, writers in environment.writers().items()
            if writers[0][0].cid in self._option_of_unit
        }
        self._feeds: dict[int, dict[str, _Output]] = {}
        self._order: list[int] = []

    def change(self, remove_unneeded: bool) -> tuple[Change, tuple[Unit, ...], frozenset[int]]:
        self._connect()
        served = self._serve_targets()
        used = self._used(served.values())
        units = self._units(used, served)
        kept = {unit.cid for unit in units}
        others = [unit for unit in self._environment.units if unit.cid not in kept]
        before = {unit.cid: unit for unit in self._environment.units}
        added = frozenset(unit for unit in units if before.get(unit.cid) != unit)
        removed = {before[unit.cid] for unit in added if unit.cid in before}
        if remove_unneeded:
            removed.update(others)
            return Change(units_added=added, units_removed=frozenset(removed)), in_order(units), frozenset(used)
        staying = [self._without_targets(unit, set(served)) for unit in others if self._is_known(unit)]
        removed.update(unit for unit in others if unit not in staying)
        added |= frozenset(unit for unit in staying if unit not in others)
        return (
            Change(units_added=added, units_removed=frozenset(removed)),
            in_order([*units, *staying]),
            frozenset(used),
        )

    def _is_known(self, unit: Unit) -> bool:
        return any(each.tid == unit.tid for each in self._environment.transformations)

    def _without_targets(self, unit: Unit, served: set[str]) -> Unit:
        """A unit that stays beside the plan, off the channels on which the plan serves targets."""
        taken = {target.channel for target in self._problem.targets if target.qid in served}
        outputs = tuple(
            (port, tuple(channel for channel in channels if channel not in taken)) for port, channels in unit.outputs
        )
        return replace(unit, outputs=outputs)

    # -- who feeds whom --

    def _connect(self) -> None:
        """Connect options in an order in which each is fed by earlier ones, present connections first."""
        done: set[int] = set()
        waiting = list(self._chosen)
        while waiting:
            progress = False
            for keep in (True, False):
                for number in list(waiting):
                    feeds = self._fed(number, done, keep_present=keep)
                    if feeds is not None:
                        self._feeds[number] = feeds
                        self._order.append(number)
                        done.add(number)
                        waiting.remove(number)
                        progress = True
                        if not keep:
                            break
                if progress:
                    break
            if not progress:
                return  # What is left is fed by nothing; it is not in use.

    def _fed(self, number: int, done: set[int], *, keep_present: bool) -> dict[str, _Output] | None:
        option = self._problem.options[number]
        feeds: dict[str, _Output] = {}
        if option.unit is not None:
            for port, channel in option.unit.inputs:
                present = self._writers.get(channel or "")
                if present is not None and self._right(option, port, present) and present not in feeds.values():
                    if present[0] in done and present[0] != number:
                        feeds[port] = present
                    elif keep_present:
                        return None
        for port_ in option.transformation.inputs:
            if port_.name not in feeds:
                output = self._provider(port_.tag, number, done, self._taken(option, port_.name, feeds))
                if output is None:
                    return None
                feeds[port_.name] = output
        return feeds

    def _right(self, option: Option, port: str, output: _Output) -> bool:
        wanted = {each.name: each.tag for each in option.transformation.inputs}.get(port)
        given = {each.name: each.tag for each in self._transformation(output[0]).outputs}.get(output[1])
        return wanted is not None and given is not None and self._matches(given, wanted)

    def _taken(self, option: Option, port: str, feeds: Mapping[str, _Output]) -> set[int]:
        tag = option.transformation.input(port).tag
        return {feeds[each.name][0] for each in option.transformation.inputs if each.tag == tag and each.name in feeds}

    def _provider(self, tag: Concept, number: int, done: set[int], taken: set[int]) -> _Output | None:
        need = self._needs[tag]
        for provider in self._problem.providers[need]:
            if provider in done and provider not in taken and provider != number:
                for port in self._transformation(provider).outputs:
                    if self._matches(port.tag, self._problem.tags[need]):
                        return provider, port.name
        return None

    def _transformation(self, number: int) -> Transformation:
        return self._problem.options[number].transformation

    def _serve_targets(self) -> dict[str, _Output]:
        served: dict[str, _Output] = {}
        weight = self._problem.objective.quality_weight
        for target, goal in zip(self._problem.targets, self._problem.goals, strict=True):
            ready = [number for number in self._problem.providers[goal] if number in self._feeds]
            present = self._writers.get(target.channel)
            if weight:
                best = max(self._transformation(number).quality for number in ready)
                ready = [number for number in ready if self._transformation(number).quality == best]
            outputs = [
                (number, port.name)
                for number in ready
                for port in self._transformation(number).outputs
                if self._matches(port.tag, target.tag)
            ]
            served[target.qid] = present if present in outputs else self._cheapest(outputs)
        return served

    def _cheapest(self, outputs: list[_Output]) -> _Output:
        """The output that needs fewest other units: the earliest in the order of connection."""
        order = {number: place for place, number in enumerate(self._order)}
        return min(outputs, key=lambda output: (self._needed_cost(output[0]), order[output[0]]))

    def _needed_cost(self, number: int) -> float:
        return self._problem.cost(self._used([(number, "")]))

    def _used(self, outputs: Iterable[_Output]) -> list[int]:
        used: dict[int, None] = {}
        work = [number for number, _ in outputs]
        while work:
            number = work.pop()
            if number not in used:
                used[number] = None
                work.extend(provider for provider, _ in self._feeds[number].values())
        return sorted(used)

    # -- channels --

    def _units(self, used: list[int], served: dict[str, _Output]) -> list[Unit]:
        cids = {number: self._cid(number) for number in used}
        channels = self._channels(used, cids, served)
        units = []
        for number in used:
            option = self._problem.options[number]
            inputs = tuple(
                (port.name, self._subscription(option, port.name, channels[self._feeds[number][port.name]]))
                for port in option.transformation.inputs
            )
            outputs = tuple((port.name, channels[number, port.name]) for port in option.transformation.outputs)
            present = option.unit
            units.append(
                Unit(cids[number], option.transformation.tid, inputs, outputs)
                if present is None
                else Unit(present.cid, present.tid, inputs, outputs, present.state, present.parameters)
            )
        return units

    def _cid(self, number: int) -> str:
        option = self._problem.options[number]
        return option.unit.cid if option.unit is not None else self._names.new(option.transformation.tid)

    def _channels(
        self, used: list[int], cids: dict[int, str], served: dict[str, _Output]
    ) -> dict[_Output, tuple[str, ...]]:
        """The channels of each output: those of the targets that it serves, or else one of its own."""
        goal_channels = {target.channel for target in self._environment.targets}
        goal_channels |= {target.channel for target in self._problem.targets}
        wanted: dict[_Output, list[str]] = {}
        for target in self._problem.targets:
            wanted.setdefault(served[target.qid], []).append(target.channel)
        found: dict[_Output, tuple[str, ...]] = {}
        for number in used:
            option = self._problem.options[number]
            present = dict(option.unit.outputs) if option.unit is not None else {}
            for port in option.transformation.outputs:
                output = (number, port.name)
                kept = [channel for channel in present.get(port.name, ()) if channel not in goal_channels]
                kept += [channel for channel in present.get(port.name, ()) if channel in wanted.get(output, ())]
                new = [channel for channel in wanted.get(output, ()) if channel not in kept]
                found[output] = tuple(kept + new) or (f"/{cids[number]}/{port.name}",)
        return found

    @staticmethod
    def _subscription(option: Option, port: str, channels: tuple[str, ...]) -> str:
        present = option.unit.subscription(port) if option.unit is not None else None
        return present if present in channels else channels[0]
