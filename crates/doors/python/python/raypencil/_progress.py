"""Progress, if somebody asks for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

#: ``True``: a line by tqdm, if it is installed. A function: called with the name of each stage.
Progress = bool | Callable[[str], object]


@contextmanager
def stages(progress: Progress) -> Iterator[Callable[[str], object] | None]:
    """What is called with the name of each stage of the work."""
    if callable(progress):
        yield progress
        return
    bar = bar_of(progress, bar_format="{desc} [{elapsed}]")
    if bar is None:
        yield None
        return
    with bar:
        yield bar.set_description_str


def bar_of(progress: Progress, **options: Any) -> Any:
    """A bar of tqdm; ``None`` if none is asked for, or if there is no tqdm."""
    if progress is not True:
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(**options)
