"""Work in shards: here, or on a Dask cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from ._errors import RaypencilError
from ._progress import Progress, bar_of

#: The files that a shard leaves: their paths below its folder, and their bytes.
Files = dict[str, bytes]


def files_below(folder: str | os.PathLike[str]) -> Files:
    """All files below a folder."""
    root = Path(folder)
    return {str(path.relative_to(root)): path.read_bytes() for path in sorted(root.rglob("*")) if path.is_file()}


def store(files: Files, folder: str | os.PathLike[str]) -> None:
    """Writes files below a folder, each beside its place and then renamed."""
    for name, content in files.items():
        path = Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        beside = path.with_name(f".{path.name}.part")
        beside.write_bytes(content)
        beside.replace(path)


def run_shards(
    client: Any,
    name: str,
    shards: Iterable[int],
    task: Callable[[int], Files],
    folder: str | os.PathLike[str],
    retries: int,
    progress: Progress,
) -> None:
    """Makes shards on a cluster; the files of each are stored as soon as it is done.

    A worker that is lost loses the shard that it makes: the scheduler gives it to another one. What was stored stays,
    so that a run that is broken off, by whatever, goes on where it was.
    """
    try:
        from distributed import as_completed
    except ImportError as error:
        raise RaypencilError("client= needs Dask: pip install raypencil[dask]") from error
    wanted = list(shards)
    # `pure=False`: a shard of an earlier run, which the scheduler may remember, is no answer to this one.
    futures = [
        client.submit(task, index, key=f"{name}-shard-{index}-{os.urandom(6).hex()}", retries=retries, pure=False)
        for index in wanted
    ]
    bar = bar_of(progress, total=len(futures), unit="shard", desc=name)
    try:
        for done, (future, files) in enumerate(as_completed(futures, with_results=True), 1):
            store(files, folder)
            # Its memory on the cluster is free again.
            future.release()
            if bar is not None:
                bar.update()
            elif callable(progress):
                progress(f"{done} of {len(futures)} shards")
    except BaseException:
        client.cancel(futures)
        raise
    finally:
        if bar is not None:
            bar.close()
