"""What there is to choose from for an action, and what a complete choice looks like."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from rosa_core.model.elements import Estimation


@dataclass(frozen=True, slots=True)
class DesignOption:
    """A design that may solve a function.

    Args:
        name: of the function design.
        components: names of its components.
        priority: the lowest number is preferred, None comes last.
    """

    name: str
    components: tuple[str, ...]
    priority: float | None = None


@dataclass(frozen=True, slots=True)
class ConfigurationOption:
    """A configuration that a component may run with.

    Args:
        name: of the component configuration.
        priority: the lowest number is preferred, None comes last.
    """

    name: str
    priority: float | None = None


Option = TypeVar("Option", DesignOption, ConfigurationOption)


@dataclass(frozen=True)
class Alternatives:
    """Everything that can be chosen for an action.

    Args:
        functions: the options of each function that the action requires. A function without any cannot be provided,
            so that there is no complete configuration.
        components: the options of each component that has configurations; a component that is not here has none.
        estimations: those of all designs, components and configurations that can occur, in order of declaration.

    The order of functions, components and options breaks the last ties: earlier is better.
    """

    functions: Mapping[str, tuple[DesignOption, ...]]
    components: Mapping[str, tuple[ConfigurationOption, ...]] = field(default_factory=dict)
    estimations: tuple[Estimation, ...] = ()

    def keeping(self, designs: Mapping[str, str], configurations: Mapping[str, str]) -> Alternatives:
        """The same with some choices made: these designs and configurations are the only options there.

        Args:
            designs: by function. A name that is no option is ignored: what is not feasible cannot be kept.
            configurations: by component, likewise.
        """
        return Alternatives(
            {function: _kept(options, designs.get(function)) for function, options in self.functions.items()},
            {
                component: _kept(options, configurations.get(component))
                for component, options in self.components.items()
            },
            self.estimations,
        )

    def preferring(self, names: Iterable[str], configurations: Iterable[str]) -> Alternatives:
        """The same with these as the first options, which win ties.

        Args:
            names: of designs.
            configurations: names of configurations.
        """
        first_designs, first_configurations = frozenset(names), frozenset(configurations)
        return Alternatives(
            {function: _first(options, first_designs) for function, options in self.functions.items()},
            {component: _first(options, first_configurations) for component, options in self.components.items()},
            self.estimations,
        )

    def solvable(self) -> Alternatives:
        """Without the functions that have no option."""
        functions = {function: options for function, options in self.functions.items() if options}
        return Alternatives(functions, self.components, self.estimations)


@dataclass(frozen=True)
class CompleteConfiguration:
    """One design for every function of an action, and one configuration for every component that has any.

    Args:
        function_designs: by function.
        component_configurations: by component.
        estimates: by measure that any alternative is expected to affect, in its unit.
        utility: what the weights make of the estimates; 0 without weights.
    """

    function_designs: Mapping[str, str]
    component_configurations: Mapping[str, str]
    estimates: Mapping[str, float]
    utility: float = 0.0


def _kept(options: tuple[Option, ...], name: str | None) -> tuple[Option, ...]:
    return tuple(option for option in options if option.name == name) or options


def _first(options: tuple[Option, ...], names: frozenset[str]) -> tuple[Option, ...]:
    return tuple(sorted(options, key=lambda option: option.name not in names))
