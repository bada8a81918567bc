"""Arguments that have another name than they had."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import NamedTuple, ParamSpec, TypeVar

from ._errors import RaypencilError

P = ParamSpec("P")
T = TypeVar("T")


class Renamed(NamedTuple):
    """An argument by both of its names."""

    old: str
    new: str
    #: The new name says the opposite: ``bench=False`` is ``no_bench=True``.
    is_opposite: bool = False


def renamed(*names: Renamed) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Lets a function take arguments by their old names too. Each is warned of with its new name."""

    def of_function(function: Callable[P, T]) -> Callable[P, T]:
        @functools.wraps(function)
        def with_old_names(*arguments: P.args, **named: P.kwargs) -> T:
            for old, new, is_opposite in names:
                if old not in named:
                    continue
                if new in named:
                    raise RaypencilError(f"{old} and {new} are given; expected {new} alone, of which {old} is the old name")
                value = named.pop(old)
                named[new] = not value if is_opposite else value
                how = f"{new}, with the opposite value" if is_opposite else new
                # The line that is shown is the caller's.
                warnings.warn(f"{function.__name__}: {old} is now {how}", DeprecationWarning, stacklevel=2)
            return function(*arguments, **named)

        return with_old_names

    return of_function
