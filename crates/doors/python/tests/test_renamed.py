"""Arguments by their old names."""

from __future__ import annotations

import inspect
import warnings
from typing import Any

import pytest
from conftest import SMALL

from raypencil import RaypencilError, Scene, _raypencil, pack
from raypencil._renamed import Renamed, renamed


@renamed(Renamed("colour", "color"), Renamed("loud", "quiet", is_opposite=True))
def paint(what: str, *, color: str = "red", quiet: bool = False) -> str:
    """Paints."""
    return f"{what} {color} {quiet}"


def test_an_old_name_works_and_is_warned_of_where_it_stands() -> None:
    old: dict[str, Any] = {"colour": "blue", "loud": False}
    with pytest.warns(DeprecationWarning) as caught:
        assert paint("it", **old) == "it blue True"
    assert [str(one.message) for one in caught] == [
        "paint: colour is now color",
        "paint: loud is now quiet, with the opposite value",
    ]
    assert {one.filename for one in caught} == {__file__}


def test_a_new_name_is_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert paint("it", color="blue", quiet=True) == "it blue True"
    assert list(inspect.signature(paint).parameters) == ["what", "color", "quiet"]
    assert (paint.__name__, paint.__doc__) == ("paint", "Paints.")


def test_both_names_are_refused() -> None:
    both: dict[str, Any] = {"colour": "blue", "color": "red"}
    with pytest.raises(RaypencilError, match="colour and color are given; expected color alone, of which colour is the old"):
        paint("it", **both)
    other: dict[str, Any] = {"shape": "round"}
    with pytest.raises(TypeError, match="shape"):
        paint("it", **other)


def test_a_pack_takes_its_old_names(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[Any, ...]] = []
    monkeypatch.setattr(_raypencil, "pack_scene", lambda *arguments: asked.append(arguments[1:]))
    scene = Scene(SMALL, name="small")
    for bench in (True, False):
        old: dict[str, Any] = {"bench": bench, "version": "2.1"}
        with pytest.warns(DeprecationWarning) as caught:
            pack(scene, "out", **old)
        assert [str(one.message) for one in caught] == [
            "pack: version is now pack_version",
            "pack: bench is now no_bench, with the opposite value",
        ]
        pack(scene, "out", no_bench=not bench, pack_version="2.1")
    assert asked == [("out", True, "2.1", None, False, None)] * 2 + [("out", False, "2.1", None, False, None)] * 2
