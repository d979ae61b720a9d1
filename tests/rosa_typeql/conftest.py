"""Fixtures for models in TypeQL: ``load`` reads texts, ``refusal`` says what is wrong with one."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import KnowledgeModel, KnowledgeModelError


@pytest.fixture
def load(tmp_path):
    """Write texts to files, TypeQL unless a suffix is given, and load them together."""

    def load(*texts: str | tuple[str, str]) -> KnowledgeModel:
        paths = []
        for index, text in enumerate(texts):
            suffix, content = text if isinstance(text, tuple) else (".tql", text)
            path = tmp_path / f"m{index}{suffix}"
            path.write_text(content, encoding="utf-8")
            paths.append(path)
        return KnowledgeModel.load(*paths)

    return load


@pytest.fixture
def refusal(load):
    """What is said of a model that cannot be: one line for each problem, without the directory."""

    def refusal(*texts: str | tuple[str, str]) -> str:
        with pytest.raises(KnowledgeModelError) as error:
            load(*texts)
        lines = []
        for problem in error.value.problems:
            where = "" if problem.where is None else f"{Path(problem.where.file).name}:{problem.where.line}: "
            lines.append(f"{where}{problem.what} ({problem.hint})")
        return "\n".join(lines)

    return refusal
