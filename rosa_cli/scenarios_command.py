"""``rosa scenarios``: what can be run, and what can be set."""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from rosa_cli.output import plain_table
from rosa_simulation.scenario import find_scenario, scenario_names


def list_scenarios() -> None:
    """Print the installed scenarios with a line on each."""
    for name in scenario_names():
        scenario = find_scenario(name)
        print(f"{name:18}{scenario.description} (managers: {', '.join(scenario.managers)})")


def describe_scenario(name: str) -> None:
    """Print what one of them can be run with, and its parameters.

    Raises:
        InputError: if there is no such scenario.
    """
    scenario = find_scenario(name)
    print(f"{scenario.name}: {scenario.description}")
    print(f"managers: {', '.join(scenario.managers)}")
    print(f"task layers: {', '.join(scenario.task_layers)}")
    if not scenario.parameters:
        return
    print("\nparameters, for --set NAME=VALUE and experiment files:")
    table = plain_table("name", "default", "what it is")
    for parameter, about in scenario.parameters.items():
        table.add_row(Text(parameter), Text(_shown(about.default)), Text(about.description))
    Console(highlight=False).print(table)


def _shown(default: object) -> str:
    if default is None:
        return "-"
    if isinstance(default, bool):
        return "true" if default else "false"
    if isinstance(default, list | tuple):
        return f"[{', '.join(map(_shown, default))}]"
    if isinstance(default, str) and set(default) & set(",:[]{}#"):
        return f'"{default}"'
    return f"{default:g}" if isinstance(default, float) else str(default)
