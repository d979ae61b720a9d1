"""What managing systems over system modes know of a robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rosa_simulation.system_modes.situation import Situation


@dataclass(frozen=True, slots=True)
class FunctionDesign:
    """A way to solve a function, and the system mode that realises it.

    Attributes:
        function: the function, which is a system of system modes.
        mode: the mode that the function is put into.
        performance: how good a design it is; the higher the better.
        requires: the least value of each measured quality with which the design works.
        components: the hardware without which it does not work.
    """

    function: str
    mode: str
    performance: float
    requires: Mapping[str, float] = field(default_factory=dict)
    components: frozenset[str] = frozenset()


def _no_conditions(_: Situation) -> Mapping[str, Callable[..., Any]]:
    return {}


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeControl:
    """The system modes of a robot, and what its managing systems over system modes need besides.

    Attributes:
        modes_file: the modes of the robot's functions, in the format of the ROS 2 package ``system_modes``.
        unused_mode: the mode of a function that no action needs.
        tree_file: the managing tree, in which mission and adaptation are one; None: the robot has none.
        conditions: gives what the managing tree asks of a situation, by the names of its leaves.
        functions: the functions that become objectives of metacontrol when an action is performed.
        designs: the function designs that metacontrol chooses from.
        varied: the function whose mode the manager ``random`` changes while an action is performed.
        adaptation_period: s between two adaptations of the manager ``random``.
    """

    modes_file: Path
    unused_mode: str
    tree_file: Path | None = None
    conditions: Callable[[Situation], Mapping[str, Callable[..., Any]]] = _no_conditions
    functions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    designs: tuple[FunctionDesign, ...] = ()
    varied: Mapping[str, str] = field(default_factory=dict)
    adaptation_period: float = 30.0
