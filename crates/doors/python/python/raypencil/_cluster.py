"""Work in shards: here, or on a Dask cluster."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ._errors import RaypencilError, optional
from ._progress import Progress, bar_of, stages

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


def made_apart(make: Callable[[str], object]) -> Files:
    """What ``make`` writes into a folder of its own, as a worker does."""
    with tempfile.TemporaryDirectory() as folder:
        make(folder)
        return files_below(folder)


@dataclass(frozen=True)
class Work:
    """Work that can be made in shards."""

    #: ``campaign`` or ``sweep``.
    name: str
    #: What it consists of, in the plural, and how many of them there are.
    units: str
    count: int
    #: Of a shard on a cluster, if the number of shards is not given: some seconds of work.
    of_a_shard: int
    #: ``make(index, shards, folder, on_stage)`` makes a shard here.
    make: Callable[[int, int, str, Callable[[str], object] | None], object]
    #: ``has(index, shards, folder)``: whether a shard is there.
    has: Callable[[int, int, str], bool]
    #: ``task(shards, index)`` makes it anywhere; it can be pickled.
    task: Callable[[int, int], Files]


def run_shards(
    work: Work, shards: int | None, folder: str, client: Any, retries: int, progress: Progress
) -> None:
    """Makes all shards of some work: here, or those that are not there yet on a cluster."""
    if shards is None:
        shards = 1 if client is None else -(-work.count // work.of_a_shard)
    if not 1 <= shards <= work.count:
        raise RaypencilError(f"shards is {shards}; expected 1 to {work.count}, the {work.units}")
    if client is None:
        with stages(progress) as on_stage:
            for index in range(shards):
                work.make(index, shards, folder, on_stage)
        return
    os.makedirs(folder, exist_ok=True)
    missing = [index for index in range(shards) if not work.has(index, shards, folder)]
    _on_cluster(client, work.name, missing, partial(work.task, shards), folder, retries, progress)


def _on_cluster(
    client: Any,
    name: str,
    wanted: list[int],
    task: Callable[[int], Files],
    folder: str,
    retries: int,
    progress: Progress,
) -> None:
    """Makes shards on a cluster; the files of each are stored as soon as it is done.

    A worker that is lost loses the shard that it makes: the scheduler gives it to another one. What was stored stays,
    so that a run that is broken off, by whatever, goes on where it was.
    """
    as_completed = optional("distributed", "client=", "dask").as_completed
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
