"""Whatever a file contains, it is either a tree or one InputError."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from py_trees.behaviour import Behaviour

from rosa_core import InputError
from task_layer.bt import load_tree, load_trees
from task_layer.bt.scripting import ScriptError, compile_script
from task_layer.bt.xml.outline import read_outline
from task_layer.bt.xml.version_3 import upgrade
from tests.task_layer.bt_xml.random_trees import LEAVES, mission

_SEASONING = (
    b"<", b">", b'"', b"'", b"&", b"/", b"{", b"}", b"\0", b"\xff", b"&#0;", b"&lt;", b"]]>", b"<![CDATA[", b"<!--",
    b"<?xml version='1.1'?>", b"<SubTree ID='Main'/>", b"ID=''", b'name=""', b"{=}", b"9" * 400, b"_skipIf='('",
    b"1e999", b"<include path='mission.xml'/>", b"<include path='\0'/>", b"xmlns:a='b' ", b"a:", b"<TreeNodesModel>",
    b"SubTree",
)  # fmt: skip
"""What is put in somewhere."""


def loads(path: Path) -> bool:
    """Whether a file is a tree; if it is not, the error must be a good one."""
    try:
        root = load_tree(path, LEAVES)
    except InputError as error:
        problems = error.problems
    else:
        assert isinstance(root, Behaviour)
        return True
    assert problems
    assert all(len(str(problem)) < 1000 and problem.where is not None for problem in problems)
    return False


def mutated(random: Random, text: bytes) -> bytes:
    """A file with some bytes cut out, copied elsewhere, or replaced."""
    for _ in range(random.randint(1, 4)):
        start = random.randrange(len(text) + 1)
        end = min(len(text), start + random.choice((0, 1, 1, 5, 30)))
        other = random.randrange(len(text) + 1)
        put = random.choice((b"", random.choice(_SEASONING), text[other : other + random.choice((1, 10, 60))]))
        text = text[:start] + put + text[end:]
    return text


@pytest.mark.parametrize("seed", range(10))
def test_damaged_missions(seed: int, tmp_path: Path) -> None:
    random = Random(seed)
    path = tmp_path / "mission.xml"
    whole = mission(random).encode()
    path.write_bytes(whole)
    assert loads(path)
    loaded = 0
    for _ in range(40):
        path.write_bytes(mutated(random, whole))
        loaded += loads(path)
    assert loaded < 40


@pytest.mark.parametrize("seed", range(5))
def test_damaged_projects(seed: int, tmp_path: Path) -> None:
    """Whatever is wrong with the files of a folder, it is a warning, an error, or a tree that is shown or converted."""
    random = Random(seed)
    whole = mission(random).encode()
    old = whole.replace(b' BTCPP_format="4"', b"").replace(b"<SequenceWithMemory", b"<SequenceStar")
    for number in range(20):
        folder = tmp_path / str(number)
        folder.mkdir()
        for name in ("a", "b"):
            (folder / f"{name}.xml").write_bytes(mutated(random, random.choice((whole, old))))
        with suppress(InputError):
            project = load_trees(folder, LEAVES, nodes=random.choice(([], [folder / "a.xml"])))
            for tree in project.ids:
                assert all(len(str(warning)) < 1500 for warning in project.warnings(tree))
                with suppress(InputError):
                    project.build(tree)
        with suppress(InputError):
            read_outline([folder / "a.xml", folder / "b.xml"], "Main")
        with suppress(InputError):
            upgrade(folder / "a.xml", folder / "new.xml")


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.one_of(st.binary(max_size=300), st.lists(st.sampled_from(_SEASONING), max_size=20).map(b" ".join)))
def test_any_bytes(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "mission.xml"
    path.write_bytes(data)
    assert not loads(path)


@settings(max_examples=300, deadline=None)
@given(st.text(st.sampled_from("ab1.0x'\"+-*/&|^!~<>=:;?() {}@_é\\\n"), max_size=40))
def test_any_script(text: str) -> None:
    with suppress(ScriptError):
        compile_script(text)


@pytest.mark.parametrize(
    "bomb",
    [
        '<!DOCTYPE lolz [<!ENTITY a "aaaaaaaaaa">'
        + "".join(f'<!ENTITY {new} "{f"&{old};" * 10}">' for old, new in zip("abcdefgh", "bcdefghi", strict=True))
        + ']><root BTCPP_format="4">&i;</root>',
        '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><root>&x;</root>',
        '<!DOCTYPE r [<!ENTITY % x SYSTEM "http://127.0.0.1:9/"> %x;]><root/>',
        '<?xml version="1.0" encoding="no-such-encoding"?><root/>',
        '<?xml version="1.0" encoding="utf-16"?><root/>',
        "<root>" + "<a>" * 100_000,
        "<" + "a" * 1_000_000,
        "<root " + " ".join(f'a{n}="1"' for n in range(100_000)) + "/>",
        "<root>" + "<!-- -->" * 100_000,
    ],
    ids=["entities", "external", "parameter", "encoding", "utf-16", "depth", "name", "attributes", "comments"],
)
def test_bombs(bomb: str, tmp_path: Path) -> None:
    path = tmp_path / "mission.xml"
    path.write_text(bomb, encoding="utf-8")
    assert not loads(path)


def test_what_is_no_file(tmp_path: Path) -> None:
    assert not loads(tmp_path)
    assert not loads(tmp_path / "missing.xml")
    assert not loads(tmp_path / "nul\0.xml")
    assert not loads(tmp_path / "nul\0" / "mission.xml")
    (tmp_path / "loop.xml").symlink_to(tmp_path / "loop.xml")
    assert not loads(tmp_path / "loop.xml")
