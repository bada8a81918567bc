"""The code of the pages runs as it is pasted, block after block."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import ROOT

PAGES = ["docs/guide/python.md", "crates/doors/python/README.md"]


def blocks(page: str) -> list[str]:
    text = (ROOT / page).read_text(encoding="utf-8")
    # Blank lines keep the numbers of lines in messages.
    found = re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S)
    return ["\n" * text[: block.start(1)].count("\n") + block.group(1) for block in found]


@pytest.mark.parametrize("page", PAGES)
def test_the_code_of_a_page_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for package in ("xarray", "pandas", "trimesh", "rtree"):
        pytest.importorskip(package)
    # Files that the page reads are those of the repository; those that it writes stay here.
    (tmp_path / "data").symlink_to(ROOT / "data")
    monkeypatch.chdir(tmp_path)
    scope: dict[str, object] = {"__name__": "page"}
    found = blocks(page)
    assert found
    for block in found:
        exec(compile(block, page, "exec"), scope)


def test_the_page_begins_with_ten_lines() -> None:
    first = blocks(PAGES[0])[0].strip().splitlines()
    assert len(first) <= 10


def page() -> str:
    return (ROOT / PAGES[0]).read_text(encoding="utf-8")


def missing(names: list[str], text: str) -> list[str]:
    """The names that are in no code of the page, neither in a block nor between backticks."""
    code = "\n".join(re.findall(r"^```.*?^```$", text, re.M | re.S))
    code += "\n".join(re.findall(r"`[^`\n]+`", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)))
    return [name for name in names if not re.search(rf"\b{name}\b", code)]


def test_each_public_name_is_on_the_page() -> None:
    import raypencil

    assert missing(raypencil.__all__, page()) == []


@pytest.mark.parametrize("name", ["read", "AllHits", "RaypencilWarning", "__version__"])
def test_a_name_that_the_page_lacks_is_found(name: str) -> None:
    text = re.sub(rf"\b{name}\b", "it", page())
    # A word of a sentence is no name.
    assert missing(["cast", name], f"{text}\nThis is {name}.") == [name]
