"""Knowledge models as commands are given them: files, and scenarios by name."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rosa_core import InputError, KnowledgeModel
from rosa_core.errors import Problem
from rosa_core.paths import is_file


def load_given_model(given: Iterable[Path]) -> KnowledgeModel:
    """The model of files and of scenarios.

    Args:
        given: files; what is none and has the name of an installed scenario stands for that scenario's own files.

    Raises:
        InputError: if a model cannot be used.
    """
    return KnowledgeModel.load(*(file for path in given for file in _files(path)))


def _files(path: Path) -> tuple[Path, ...]:
    if path.suffix or is_file(path):
        return (path,)
    from rosa_simulation.scenario import find_scenario, scenario_names

    if str(path) not in scenario_names():
        return (path,)
    files = find_scenario(str(path)).models()
    if not files:
        raise InputError(Problem(f"the scenario '{path}' has no knowledge model to show", hint="give its files"))
    return files
