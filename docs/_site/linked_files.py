"""Hook of MkDocs: what pages link to outside ``docs/`` (models, missions, code) becomes part of the site.

On disk such a link is ``../suave/models/suave.yaml``, which readers of the repository can follow; on the site it is
``source/suave/models/suave.yaml``. A folder becomes a page that lists its files.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from mkdocs.structure.files import File, Files

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[2]
_OUTSIDE = re.compile(r"\]\(\.\./([^)#\s]+)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add every file that a page links to."""
    linked = {ROOT / link for page in files.documentation_pages() for link in _OUTSIDE.findall(page.content_string)}
    linked.add(ROOT / "benchmarks" / "README.md")
    contents: dict[Path, str] = {}
    for path in sorted(linked):
        for file in _files_in(path) if path.is_dir() else [path]:
            contents[file] = _content(file)
        if path.is_dir():
            contents[path / "index.md"] = _listing(path)
    for path, content in contents.items():
        files.append(File.generated(config, f"source/{path.relative_to(ROOT).as_posix()}", content=content))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Let links lead to the files that were added."""
    if page.file.src_uri.startswith("source/"):
        return markdown

    def inside(link: re.Match[str]) -> str:
        target = link[1].rstrip("/")
        return f"](source/{target}/index.md" if (ROOT / target).is_dir() else f"](source/{target}"

    return _OUTSIDE.sub(inside, markdown)


def _content(file: Path) -> str:
    text = file.read_text(encoding="utf-8")
    return text.replace("](../docs/", "](../../") if file.suffix == ".md" else text


def _files_in(folder: Path) -> list[Path]:
    return sorted(file for file in folder.iterdir() if file.is_file() and file.suffix != ".pyc")


def _listing(folder: Path) -> str:
    lines = "\n".join(f"- [{file.name}]({file.name})" for file in _files_in(folder))
    return f"# {folder.relative_to(ROOT).as_posix()}\n\n{lines}\n"
