"""``rosa new``: the smallest robot package that runs and passes its test."""

from __future__ import annotations

import importlib.util
import keyword
import re
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from rosa_core import InputError
from rosa_core.errors import Location, Problem, unwritable

_TEMPLATES = "templates/new_robot"
_PACKAGE_FOLDER, _TESTS_FOLDER = "package", "tests"


def new_robot(name: str, folder: Path) -> list[Path]:
    """Write a robot package of one's own.

    Args:
        name: of the package and of its scenario.
        folder: in which a folder of that name is made.

    Returns:
        the files that were written, model first.

    Raises:
        InputError: if the name cannot be that of a package, or there is something of that name already. Nothing is
            written then.
    """
    check_name(name)
    project = folder / name
    if project.exists():
        hint = "choose another name, or another place with --out"
        raise InputError(Problem("there is something of that name already", Location(str(project)), hint))
    files = _render(name)
    try:
        for path, text in files.items():
            file = project / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise unwritable(project, error, "name a folder that can be written with --out") from None
    return [project / path for path in files]


def check_name(name: str) -> None:
    """Make sure that a package can have that name.

    Raises:
        InputError: if it is no lower-case identifier, or a module has it already.
    """
    if not _is_name(name):
        other = re.sub(r"\W+", "_", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name)).strip("_").lower()
        hint = f"such as '{other}'" if _is_name(other) else "such as 'my_robot'"
        what = f"'{name}' cannot be the name of a robot's package"
        raise InputError(Problem(what, hint=f"write small letters, digits and underscores, {hint}"))
    if name == _TESTS_FOLDER or importlib.util.find_spec(name) is not None:
        raise InputError(Problem(f"there is a Python module '{name}' already", hint="choose another name"))


def _is_name(text: str) -> bool:
    return re.fullmatch(r"[a-z][a-z0-9_]{0,63}", text) is not None and not keyword.iskeyword(text)


def _render(name: str) -> dict[Path, str]:
    """The texts of the files by their paths in the project."""
    # The files are source text, not HTML.
    templates = Environment(
        loader=PackageLoader("rosa_cli", _TEMPLATES),
        undefined=StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701
    )
    found = sorted(template for template in templates.list_templates() if template.endswith(".j2"))
    return {_path(template, name): templates.get_template(template).render(name=name) for template in found}


def _path(template: str, name: str) -> Path:
    path = Path(template.removesuffix(".j2"))
    if path.parts[0] == _PACKAGE_FOLDER:
        return Path(name, *path.parts[1:])
    return path.with_name(path.name.replace("robot", name)) if path.parts[0] == _TESTS_FOLDER else path


def print_new_robot(name: str, out: Path) -> None:
    """Write the package, and print what there is and what can be done with it."""
    files = new_robot(name, out)
    project = out / name
    print(f"{project}: a robot that runs")
    for file in files:
        print(f"  {file.relative_to(project)}")
    print(f"\nnext: pip install -e {project}, then rosa run {name}; {project / 'README.md'} says what is where")
