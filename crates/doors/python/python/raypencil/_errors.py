"""The exceptions of this package. Their messages are those of the command ``raypencil``."""

from __future__ import annotations


class RaypencilError(ValueError):
    """Something is refused: the message names the file or the argument, what was found and what was expected."""


class RaypencilFileError(RaypencilError, OSError):
    """A file or a folder cannot be read or written."""


class RaypencilFileNotFoundError(RaypencilFileError, FileNotFoundError):
    """A file or a folder is not there."""


class RaypencilWarning(UserWarning):
    """Something looks wrong in what was given. The answers are right for it all the same."""


def missing_extra(package: str, extra: str | None = None) -> ImportError:
    """The error for a package that is optional and not installed."""
    return ImportError(f"this needs {package}: pip install raypencil[{extra or package}]")
