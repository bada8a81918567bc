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


def test_each_public_name_is_on_the_page() -> None:
    import raypencil

    text = (ROOT / PAGES[0]).read_text(encoding="utf-8")
    missing = [name for name in raypencil.__all__ if not re.search(rf"\b{name}\b", text) and not name.startswith("__")]
    # Parts of results are found by their docstrings.
    assert set(missing) <= {"AllHits", "Beam", "Camera", "Pose", "RaySet", "Sectors", "Vectors", "ElevationMap"}
