"""The exceptions of this package. Their messages are those of the command ``raypencil``."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class RaypencilError(ValueError):
    """Something is refused: the message names the file or the argument, what was found and what was expected."""


class RaypencilFileError(RaypencilError, OSError):
    """A file or a folder cannot be read or written."""


class RaypencilFileNotFoundError(RaypencilFileError, FileNotFoundError):
    """A file or a folder is not there."""


class RaypencilWarning(UserWarning):
    """Something looks wrong in what was given. The answers are right for it all the same."""


class MissingExtraError(RaypencilError, ImportError):
    """A package that is optional is not installed."""


def optional(package: str, what: str, extra: str | None = None) -> Any:
    """A package that ``what`` needs and nothing else does."""
    try:
        return import_module(package)
    except ImportError:
        raise MissingExtraError(f"{what} needs {package}: pip install raypencil[{extra or package}]") from None
