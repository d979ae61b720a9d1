"""What other packages plug into the knowledge base: found by name, and imported when it is first needed.

The knowledge base has two ports for which it imports nothing above itself:

- a *model reader* for a suffix of file names (:class:`rosa_core.formats.ModelReader`);
- a *query language* (:class:`rosa_core.kb.query_port.QueryLanguage`).

TypeQL answers at both. The package ``rosa_typeql`` has a module ``rosa_typeql.plugin`` with two functions:
``read_typeql(path, builder)`` is the reader of ``.tql`` files, and ``prepare_query(text)`` the query language of
``KnowledgeBase.query``. Without that package everything else works, and asking for either says what is missing.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

from rosa_core.errors import InputError, Problem


class MissingPluginError(InputError):
    """Something was asked for that a package which is not installed would provide."""


@dataclass(frozen=True, slots=True)
class Plugin:
    """Something that a module provides, known by name.

    Args:
        module: the module's full name.
        attribute: what it is called there.
        purpose: what it is needed for, in words that follow "needs".

    Example:
        >>> Plugin("math", "sqrt", "roots").load()(9.0)
        3.0
    """

    module: str
    attribute: str
    purpose: str

    def load(self) -> Any:
        """The object itself; its module is imported if that has not happened yet.

        Raises:
            MissingPluginError: if there is no such package.
        """
        package = self.module.partition(".")[0]
        try:
            return getattr(import_module(self.module), self.attribute)
        except ModuleNotFoundError as error:
            if error.name != package:
                raise
            hint = f"install {package}, or add its folder to the Python path"
            problem = Problem(f"{self.purpose} needs the package {package}, which is not installed", hint=hint)
            raise MissingPluginError(problem) from None
