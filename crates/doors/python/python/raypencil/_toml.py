"""Scene files from dictionaries: the tables and keys of docs/guide/scene.md."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ._errors import RaypencilError


def value(of: Any, key: str) -> str:
    """A value of a key as TOML."""
    if isinstance(of, np.generic) or (isinstance(of, np.ndarray) and of.ndim == 0):
        of = of.item()
    if isinstance(of, bool):
        return "true" if of else "false"
    if isinstance(of, int):
        return str(of)
    if isinstance(of, float):
        if math.isnan(of):
            return "nan"
        return repr(of) if math.isfinite(of) else ("inf" if of > 0 else "-inf")
    if isinstance(of, os.PathLike):
        of = os.fspath(of)
    if isinstance(of, str):
        # The escapes of JSON are those of TOML, which also wants one for DEL.
        return json.dumps(of, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(of, Mapping):
        return "{ " + ", ".join(f"{name(k, key)} = {value(v, f'{key}.{k}')}" for k, v in of.items()) + " }"
    if isinstance(of, np.ndarray):
        of = of.tolist()
    if isinstance(of, Sequence):
        return "[" + ", ".join(value(one, f"{key}.{at}") for at, one in enumerate(of)) + "]"
    raise RaypencilError(f"`{key}` is of type {type(of).__name__}; expected a number, a text, a list or a dictionary")


def name(of: Any, key: str) -> str:
    """A key, which must be one that needs no quotes."""
    if not isinstance(of, str) or not of or not all(c.isascii() and (c.isalnum() or c in "_-") for c in of):
        raise RaypencilError(f"`{key}`: {of!r} is no key; expected one such as pitch_down_deg")
    return of


def document(tables: Mapping[str, Any]) -> str:
    """The text of a scene file. ``version = 1`` is added."""
    text = "" if "version" in tables else "version = 1\n"
    return text + "".join(f"{name(key, key)} = {value(of, key)}\n" for key, of in tables.items())


def by_keyword(message: str, file: str, tables: Mapping[str, Any], text: str) -> str:
    """A message about the ``document`` of tables, with the keyword in place of its line and column."""
    place = re.match(re.escape(file) + r":(\d+):\d+: ", message)
    if not place:
        return message
    lines = text.splitlines()
    key = lines[min(int(place[1]), len(lines)) - 1].split(" = ")[0]
    return f"keyword {key}: {message[place.end():]}" if key in tables else message[place.end() :]


def settings(of: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """Keys joined by dots, each with its value as TOML: ``camera.pitch_down_deg``, ``beam.0.thickness_mm``."""
    if isinstance(of, Mapping):
        for part, inner in of.items():
            yield from settings(inner, f"{key}.{part}" if key else str(part))
    elif key and isinstance(of, (list, tuple)) and of and all(isinstance(inner, Mapping) for inner in of):
        for at, inner in enumerate(of):
            yield from settings(inner, f"{key}.{at}")
    else:
        # A text needs no quotes there, and has none that could be taken for something else.
        yield key, value(of, key)
