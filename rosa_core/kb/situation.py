"""A situation: raw facts to suppose, in order to ask what would follow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Situation:
    """Facts as they might be. Nothing is planned or checked for sense: statuses just follow from the rules.

    ``selected_designs`` and ``selected_configurations`` are kept apart since names are unique only within a kind.
    """

    measurements: Mapping[str, float] = field(default_factory=dict)
    failed_components: tuple[str, ...] = ()
    required_actions: tuple[str, ...] = ()
    selected_designs: tuple[str, ...] = ()
    selected_configurations: tuple[str, ...] = ()
    active_components: tuple[str, ...] = ()
