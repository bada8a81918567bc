"""The stub of the compiled module says what the module has: `mypy` believes it."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from raypencil import _raypencil

STUB = Path(_raypencil.__file__).with_name("_raypencil.pyi")

#: Py_TPFLAGS_BASETYPE.
CAN_HAVE_SUBCLASSES = 1 << 10

#: What each item is: `attribute`, `class`, `final class`, or a line with the parameters of a function.
Items = dict[str, str]


def line(parameters: inspect.Signature) -> str:
    """The parameters with their order, kinds and defaults; without types, which the compiled module does not have."""
    plain = [
        parameter.replace(annotation=inspect.Parameter.empty)
        for name, parameter in parameters.parameters.items()
        if name not in ("self", "cls")
    ]
    return str(inspect.Signature(plain))


def of_module(module: ModuleType) -> Iterator[tuple[str, str]]:
    """All that the compiled module has. PyO3 gives each function a signature; one without it fails here."""
    every_module_has = vars(ModuleType("any")).keys() | {"__file__", "__all__"}
    for name, item in vars(module).items():
        if isinstance(item, type):
            yield name, "class" if item.__flags__ & CAN_HAVE_SUBCLASSES else "final class"
            yield from ((f"{name}.{of}", what) for of, what in of_class(item))
        elif callable(item):
            yield name, line(inspect.signature(item))
        elif name not in every_module_has:
            yield name, "attribute"


def of_class(item: type) -> Iterator[tuple[str, str]]:
    # A class that Python cannot make has no signature of its own.
    if getattr(item, "__text_signature__", None) is not None:
        yield "__new__", line(inspect.signature(item))
    for name, member in vars(item).items():
        if name in ("__new__", "__doc__", "__module__"):
            continue
        yield name, "attribute" if inspect.isdatadescriptor(member) else line(inspect.signature(member))


def of_stub(text: str) -> Iterator[tuple[str, str]]:
    """All that the stub has. Names of types, which begin with one underscore, are its own."""
    yield from of_nodes(ast.parse(text).body)


def of_nodes(nodes: list[ast.stmt], of: str = "") -> Iterator[tuple[str, str]]:
    for node in nodes:
        match node:
            case ast.ClassDef(name=name, body=body, decorator_list=decorators):
                yield name, " ".join([*map(ast.unparse, decorators), "class"])
                yield from of_nodes(body, f"{name}.")
            case ast.FunctionDef(name=name, decorator_list=[ast.Name(id="property")]):
                yield f"{of}{name}", "attribute"
            case ast.FunctionDef(name=name, decorator_list=[]):
                # Types would have to be imported.
                scope: dict[str, Any] = {}
                exec(compile(ast.Module([without_types(node)], []), str(STUB), "exec"), scope)
                yield f"{of}{name}", line(inspect.signature(scope[name]))
            case ast.AnnAssign(target=ast.Name(id=name)):
                yield f"{of}{name}", "attribute"
            case ast.Assign(targets=[ast.Name(id=name)]) if name.startswith("_") and not name.startswith("__"):
                pass
            case ast.Import() | ast.ImportFrom() | ast.Expr(value=ast.Constant()):
                pass
            case _:
                raise AssertionError(f"{STUB.name}, line {node.lineno}: {ast.unparse(node)}")


def without_types(function: ast.FunctionDef) -> ast.FunctionDef:
    function.returns = None
    for node in ast.walk(function.args):
        if isinstance(node, ast.arg):
            node.annotation = None
    return function


def differences(module: Items, stub: Items) -> list[str]:
    told = []
    for name in sorted(module.keys() | stub.keys()):
        has, says = module.get(name, "nothing"), stub.get(name, "nothing")
        if has != says:
            told.append(f"{name}: the module has {has}, the stub says {says}")
    return told


def test_the_stub_says_what_the_module_has() -> None:
    module, stub = dict(of_module(_raypencil)), dict(of_stub(STUB.read_text(encoding="utf-8")))
    assert differences(module, stub) == []
    # All kinds are there, so that none is skipped.
    assert module["__version__"] == "attribute" and module["MeshCore"] == "final class"
    assert module["MeshCore.vertices"] == "attribute" and module["MeshCore.__new__"] == "(vertices, faces)"
    assert module["cast"].startswith("(mesh, rays, ") and "ValidationCore.__new__" not in module


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("def command(arguments", "def order(arguments", ["command: the module has (arguments), the stub says nothing",
                                                          "order: the module has nothing, the stub says (arguments)"]),
        ("max_side: int, light", "light: bool, max_side", ["picture: the module has (map, max_side, light), the stub says (map, light, max_side)"]),
        ("def load_mesh(path: _Path, on_stage: _OnStage = None)", "def load_mesh(path: _Path, on_stage: _OnStage)",
         ["load_mesh: the module has (path, on_stage=None), the stub says (path, on_stage)"]),
        ("scene: SceneCore | None = None,\n    arithmetic: str | None = None", "scene: SceneCore | None = None,\n    arithmetic: str = 'f32'",
         ["diff"]),
        ("    @property\n    def planned", "    def planned", ["DriveCore.planned: the module has attribute, the stub says ()"]),
        ("class ValidationCore:\n", "class ValidationCore:\n    def __new__(cls) -> ValidationCore: ...\n",
         ["ValidationCore.__new__: the module has nothing, the stub says ()"]),
        ("    def close(self) -> None: ...\n", "", ["DriveCore.close: the module has (), the stub says nothing"]),
        ("class SweepCore", "class Sweep", ["Sweep: the module has nothing, the stub says final class"]),
        ("@final\nclass DriveCore", "class DriveCore", ["DriveCore: the module has final class, the stub says class"]),
        ("__version__: str", "", ["__version__: the module has attribute, the stub says nothing"]),
    ],
)  # fmt: skip
def test_a_stub_that_says_something_else_is_found(old: str, new: str, told: list[str]) -> None:
    text = STUB.read_text(encoding="utf-8")
    assert text.count(old) == 1
    found = differences(dict(of_module(_raypencil)), dict(of_stub(text.replace(old, new))))
    assert all(any(one.startswith(words) for one in found) for words in told), found
