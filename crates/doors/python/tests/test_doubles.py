"""No function of the package says once more what another one says."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import raypencil

SOURCES = sorted(Path(raypencil.__file__).parent.glob("*.py"))

#: Parameters that two functions may have in common: tuned. `assert_answers` hands six to `check`, and `cast` six to what answers
#: rays that are formed.
MAX_COMMON_PARAMETERS = 6

#: Functions that ask the same by design, and so have more parameters in common: of a piece what is asked of all rays at once, and
#: what checks both.
SAME_QUESTION = {("cast", "cast_chunks"), ("cast", "__init__")}

#: Lines that two functions may have in common, one after the other: tuned.
MAX_COMMON_LINES = 3

class Function(NamedTuple):
    """What may be a double of something in a function."""

    name: str
    parameters: set[str]
    #: Each line with those after it, without docstring, comments and blanks, in the layout of the parser.
    runs: set[tuple[str, ...]]


def functions(text: str) -> Iterator[Function]:
    """All functions and methods; of those with overloads the last one, which does the work."""
    module = ast.parse(text)
    classes = [node for node in module.body if isinstance(node, ast.ClassDef)]
    for node in [*module.body, *(node for of in classes for node in of.body)]:
        if isinstance(node, ast.FunctionDef) and [ast.unparse(by) for by in node.decorator_list] != ["overload"]:
            arguments = {argument.arg for argument in [*node.args.args, *node.args.kwonlyargs]}
            body = node.body[1:] if ast.get_docstring(node) is not None else node.body
            lines = [line.strip() for statement in body for line in ast.unparse(statement).splitlines()]
            ends = range(MAX_COMMON_LINES + 1, len(lines) + 1)
            runs = {tuple(lines[end - MAX_COMMON_LINES - 1 : end]) for end in ends}
            yield Function(node.name, arguments - {"self", "cls"}, runs)


def doubles(texts: list[str]) -> list[str]:
    told = []
    for one, other in combinations([function for text in texts for function in functions(text)], 2):
        common = one.parameters & other.parameters
        if len(common) > MAX_COMMON_PARAMETERS and (one.name, other.name) not in SAME_QUESTION:
            told.append(f"{one.name} and {other.name} have {len(common)} parameters in common: {sorted(common)}")
        if same := one.runs & other.runs:
            told.append(f"{one.name} and {other.name} have lines in common: {min(same)}")
    return told


def test_no_two_functions_say_the_same() -> None:
    texts = [path.read_text(encoding="utf-8") for path in SOURCES]
    assert sum(1 for text in texts for _ in functions(text)) > 100
    assert doubles(texts) == []
    # Whom this excuses needs it.
    parameters = {function.name: function.parameters for text in texts for function in functions(text) if "query" in function.parameters}
    for one, other in SAME_QUESTION:
        assert len(parameters[one] & parameters[other]) > MAX_COMMON_PARAMETERS, (one, other)


def test_doubles_are_found() -> None:
    listed = ", ".join("abcdefg")
    assert doubles([f"def one({listed}): pass", f"def other(self, x, *, {listed}): pass"]) == [
        "one and other have 7 parameters in common: ['a', 'b', 'c', 'd', 'e', 'f', 'g']"
    ]
    body = "".join(f"    x = {number}\n" for number in range(4))
    deeper = body.replace("    x", "        x")
    found = doubles([f'def one():\n    "Says."\n{body}', f"class Of:\n  def other():\n    if y:\n{deeper}"])
    assert len(found) == 1 and found[0].startswith("one and other have lines in common")
    # Overloads have the parameters of their function.
    assert doubles([f"@overload\ndef one({listed}): ...\n@overload\ndef one({listed}): ...\ndef one({listed}): ..."]) == []
