"""The examples of docs/btcpp_semantics.md print what the page says."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path
from typing import Any

PAGE = Path(__file__).resolve().parents[2] / "docs" / "btcpp_semantics.md"


def test_every_example_prints_what_the_page_says() -> None:
    blocks = re.findall(r"```(python|text)\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    namespace: dict[str, Any] = {}
    printed, examples = "", 0
    for language, block in blocks:
        if language == "text":
            assert printed == block
            printed, examples = "", examples + 1
            continue
        assert printed == ""
        with contextlib.redirect_stdout(io.StringIO()) as output:
            exec(block, namespace)
        printed = output.getvalue()
    assert printed == ""
    assert examples == 8
