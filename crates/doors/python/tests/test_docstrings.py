"""The docstrings say what the signatures are: each argument, in order; exceptions and references that there are."""

from __future__ import annotations

import builtins
import importlib
import inspect
import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import pytest

import raypencil
import raypencil.peers

DROP_INS = [importlib.import_module(f"raypencil.{name}") for name in ("open3d", "trimesh")]
MODULES = [raypencil, raypencil.terrain, raypencil.testing, *DROP_INS, raypencil.peers]

#: Classes that people make; all others are made by functions.
MADE_BY_PEOPLE = {"Mesh", "Scene", "RayMeshIntersector", "RaycastingScene"}


def public() -> Iterator[tuple[str, Any]]:
    """All public functions, classes, and methods and properties of classes."""
    for module in MODULES:
        names: list[str] = module.__all__
        for name in names:
            item = getattr(module, name)
            if isinstance(item, type):
                yield name, item
                yield from ((f"{name}.{of}", member) for of, member in members(item))
            elif callable(item):
                yield name, item


def members(item: type) -> Iterator[tuple[str, Any]]:
    """Methods and properties of a class that are written here."""
    found: dict[str, Any] = {}
    for base in reversed(item.__mro__):
        if base.__module__.startswith("raypencil"):
            found |= {name: of for name, of in vars(base).items() if not name.startswith("_")}
    for name, member in found.items():
        if isinstance(member, property | classmethod | staticmethod) or inspect.isfunction(member):
            yield name, member


PUBLIC = dict(public())


def sections(text: str) -> dict[str, list[str]]:
    """The sections of a docstring, each with the names of its entries: `a, b: ...` has two."""
    found: dict[str, list[str]] = {}
    of = None
    for line in text.splitlines():
        if heading := re.fullmatch(r"(\w+):", line):
            of = found.setdefault(heading[1], [])
        elif not line.startswith(" "):
            of = None if line else of
        elif of is not None and (entry := re.match(r" {4}(\w+(?:, \w+)*):(?: |$)", line)):
            of += entry[1].split(", ")
    return found


def parameters(function: Callable[..., Any]) -> list[str]:
    return [name for name in inspect.signature(function).parameters if name != "self"]


def wrong_arguments(name: str, item: Any, text: str) -> list[str]:
    """What a docstring says of its arguments that is not so."""
    told = sections(text).get("Args")
    if isinstance(item, property) or (isinstance(item, type) and item.__name__ not in MADE_BY_PEOPLE):
        has: list[str] = []
    else:
        has = parameters(vars(item)["__init__"] if isinstance(item, type) else getattr(item, "__func__", item))
    return [] if (told or []) == has else [f"{name} has the arguments {has}, and documents {told or []}"]


def names_of_exceptions(text: str) -> list[str]:
    found = sections(text)
    return [*found.get("Raises", []), *found.get("Warns", []), *re.findall(r"\b[Rr]aises (\w+)", text)]


def unknown_names(module: ModuleType, text: str) -> list[str]:
    """Exceptions and references to what is not there."""
    wrong = []
    for name in names_of_exceptions(text):
        exception = next((found for of in (*MODULES, builtins) if (found := getattr(of, name, None)) is not None), None)
        if not (isinstance(exception, type) and issubclass(exception, Exception)):
            wrong.append(name)
    for path in re.findall(r":\w+:`([\w.]+)`", text):
        if not is_there(path, module):
            wrong.append(path)
    return wrong


def is_there(path: str, module: ModuleType) -> bool:
    """Whether a reference leads somewhere: from the package, the module, or a class of the module."""
    classes = [item for item in vars(module).values() if isinstance(item, type) and item.__module__ == module.__name__]
    for start in (raypencil, module, *classes):
        item: Any = start
        for part in path.removeprefix("raypencil.").split("."):
            # Attributes of objects are known by their annotations or by what makes them.
            item = getattr(item, part, None) or (isinstance(item, type) and part in attributes(item)) or None
        if item is not None:
            return True
    return False


def attributes(item: type) -> set[str]:
    """The public attributes that objects get from their class's own annotations and ``__init__``."""
    made = re.findall(r"^ +self\.(\w+)(?:: .*)? = ", inspect.getsource(item), re.M) if "__init__" in vars(item) else []
    return {name for name in (*inspect.get_annotations(item), *made) if not name.startswith("_")}


def own_doc(item: Any) -> str:
    # Not that of a base class, and not the one that a dataclass makes of its fields.
    text = inspect.cleandoc(item.__doc__ or "")
    return "" if isinstance(item, type) and text.startswith(f"{item.__name__}(") else text


def module_of(item: Any) -> ModuleType:
    function = item.fget if isinstance(item, property) else item
    return importlib.import_module(getattr(function, "__func__", function).__module__)


@pytest.mark.parametrize("name", PUBLIC)
def test_a_docstring_is_that_of_its_signature(name: str) -> None:
    item = PUBLIC[name]
    text = own_doc(item)
    assert text, f"{name} has no docstring"
    assert wrong_arguments(name, item, text) == []
    assert unknown_names(module_of(item), text) == []


@pytest.mark.parametrize("name", [name for name, item in PUBLIC.items() if "Attributes" in sections(own_doc(item))])
def test_attributes_that_are_documented_are_those_of_the_class(name: str) -> None:
    item = PUBLIC[name]
    assert set(sections(own_doc(item))["Attributes"]) == attributes(item)


def test_all_kinds_are_looked_at() -> None:
    for name in ("cast", "generate", "Mesh", "Scene.replace", "CastResult.t", "RayMeshIntersector.intersects_any"):
        assert name in PUBLIC
    assert sections(own_doc(raypencil.cast))["Args"][3:5] == ["t_min", "t_max"]
    assert names_of_exceptions(own_doc(raypencil.cast)) == ["RaypencilError", "RaypencilWarning"]


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("cast", "    margins: how far", "    margin: how far"),
        ("cast", "    t_min, t_max: a", "    t_max, t_min: a"),
        ("cast", "    fronts_only: rays pass through the backs of faces.\n", ""),
        ("check", "    verify: of", "    thoroughly: really\n    verify: of"),
        ("Mesh", "    faces: (m, 3)", "    face: (m, 3)"),
        ("RenderResult.picture", "    sensor: ", "    sensors: "),
        ("diff", "    a, b: the", "    a: the"),
    ],
)
def test_arguments_that_are_documented_wrongly_are_found(name: str, old: str, new: str) -> None:
    item = PUBLIC[name]
    text = own_doc(item)
    assert text.count(old) == 1 and wrong_arguments(name, item, text.replace(old, new))


@pytest.mark.parametrize(
    ("name", "old", "new", "told"),
    [
        ("cast", "    RaypencilError: ", "    RayPencilError: ", "RayPencilError"),
        ("cast", "    RaypencilWarning: ", "    Mesh: ", "Mesh"),
        ("ElevationMap.to_xarray", "Raises ImportError", "Raises NoImportError", "NoImportError"),
        ("judge", ":attr:`Judgement.why`", ":attr:`Judgement.because`", "Judgement.because"),
        ("Scene", ":meth:`replace`", ":meth:`change`", "change"),
    ],
)
def test_names_that_there_are_not_are_found(name: str, old: str, new: str, told: str) -> None:
    item = PUBLIC[name]
    text = own_doc(item)
    assert old in text and unknown_names(module_of(item), text.replace(old, new)) == [told]
