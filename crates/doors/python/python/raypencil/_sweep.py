"""Sweeps: one scene with many settings, and a table."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Literal

from . import _raypencil, _toml
from ._cluster import Files, Work, made_apart, run_shards, store
from ._errors import RaypencilError, optional
from ._progress import Progress
from ._scene import Scene
from ._validate import Outcome

#: Runs of a shard on a cluster, if their number is not given.
RUNS_OF_A_SHARD = 4


class SweepResult(Outcome):
    """The table of a sweep.

    Attributes:
        columns: a list for each column, by its name: ``run``, the parameters, the results; ``None`` where a run has no such
            value. docs/guide/sweep.md says what they mean, and their units.
        folder: where ``table.csv``, ``table.parquet`` and the charts stand.
    """

    def __init__(self, passes: bool, text: str, document: str, columns: dict[str, list[Any]], folder: str) -> None:
        super().__init__(passes, text, document)
        self.columns = columns
        self.folder = folder

    def __len__(self) -> int:
        return len(self.columns["run"])

    def to_pandas(self) -> Any:
        """The table as a ``pandas.DataFrame``, indexed by run."""
        pandas = optional("pandas", "to_pandas()")
        return pandas.DataFrame(self.columns).set_index("run")

    def __repr__(self) -> str:
        return f"<raypencil.SweepResult: {len(self)} runs, {len(self.columns)} columns>"

    def _repr_html_(self) -> str:
        try:
            return str(self.to_pandas()._repr_html_())
        except RaypencilError:
            return super()._repr_html_()


def _part(arguments: tuple[Any, ...], count: int, index: int) -> Files:
    """A part, made by a worker in a folder of its own."""
    core = _raypencil.SweepCore(*arguments)
    files = made_apart(lambda folder: core.part(index, count, folder))
    return {name: content for name, content in files.items() if name != "sweep.json"}


def _value(value: Any, key: str) -> str:
    """A value of a key as TOML; a text stands as it is, as on the command line."""
    return value if isinstance(value, str) else _toml.value(value, key)


def _values(values: Any, key: str) -> list[str]:
    """The values of a key."""
    several = values if isinstance(values, Iterable) and not isinstance(values, str | Mapping) else [values]
    return [_value(value, key) for value in several]


def _source(scene: Any, folder: str) -> tuple[str, list[tuple[str, str]]]:
    """Name or path of a scene, and its settings. One without a file is to have one in ``folder``."""
    if not isinstance(scene, Scene):
        return os.fspath(scene), []
    source = scene._source
    if scene._is_text:
        source = os.path.join(folder, f"{scene._name}.toml")
    return source, list(scene._settings)


def sweep(
    scene: str | os.PathLike[str] | Scene,
    settings: Mapping[str, Any] | None = None,
    *,
    runs: Iterable[Mapping[str, Any]] | Any = None,
    do: Literal["validate", "render", "drive"] = "validate",
    with_: Sequence[str] | str | None = None,
    as_printed: bool = False,
    charts: Sequence[str] = (),
    output: str | os.PathLike[str],
    force: bool = False,
    shards: int | None = None,
    client: Any = None,
    retries: int = 3,
    progress: Progress = False,
) -> SweepResult:
    """Runs a scene with many settings: one table of parameters and results.

    Args:
        scene: a name or path of a scene, or a :class:`Scene`. One that was made from a text is written into ``output``.
        settings: keys of a scene file with their values, in the file's units: ``{"beam.0.pitch_down_deg": range(20, 36, 5)}``.
            Of several keys every combination is run; the first changes slowest. A value that is itself a list needs another
            list around it.
        runs: mappings from keys to values, one for each run, or a DataFrame with a column for each key. Each is combined with
            every combination of ``settings``.
        do: what is done with each scene: two renderers compared, one rendered, or a drive.
        with_: the renderers; scanline and tracer to validate, else scanline, as printed scanline-paper.
        as_printed: with ``do="drive"``: as the paper prints it.
        charts: ``"RESULT,KEY"`` or ``"RESULT,KEY,KEY"``: charts to draw beside those of the main results.
        output: a folder for records, table and charts. A sweep that was broken off there goes on.
        force: begin in a folder that has results of another command, or another sweep; without it they are an error.
        shards, client, retries, progress: as for :func:`campaign`.

    Returns:
        The table; byte for byte the same for any number of shards and workers.

    Raises:
        RaypencilError: a key that is none, a renderer that is not there, a file that cannot be read or written.
    """
    axes: list[tuple[list[str], list[list[str]]]] = []
    for key, values in (settings or {}).items():
        axes.append(([key], [[value] for value in _values(values, key)]))
    if runs is not None:
        axes.append(_rows(runs))
    if with_ is None:
        of_one = "scanline-paper" if as_printed else "scanline"
        with_ = ["scanline", "tracer"] if do == "validate" else [of_one]
    names = with_.split(",") if isinstance(with_, str) else list(with_)
    folder = os.fspath(output)
    source, of_scene = _source(scene, folder)
    # The text of a scene that no file has: a file of it is written beside the records.
    text = scene._source if isinstance(scene, Scene) and scene._is_text else None
    swept = {key for keys, _ in axes for key in keys}
    # Of two settings of one key the last holds.
    axes = [([key], [[value]]) for key, value in dict(of_scene).items() if key not in swept] + axes
    if text is not None or Path(source).exists():
        source = os.path.abspath(source)
    shared = _raypencil.SharedCore(folder, force, (source, do))
    try:
        if text is not None:
            store({os.path.basename(source): text.encode()}, folder)
        return _swept((source, axes, do, names, as_printed), folder, charts, (shards, client, retries, progress))
    finally:
        shared.release()


def _swept(arguments: tuple[Any, ...], folder: str, charts: Sequence[str], how: tuple[Any, ...]) -> SweepResult:
    """Makes the runs that are missing in the folder, in shards, and joins them."""
    shards, client, retries, progress = how
    core = _raypencil.SweepCore(*arguments)
    task = partial(_part, arguments)
    work = Work("sweep", "runs", core.runs, RUNS_OF_A_SHARD, core.part, core.has_part, task)
    run_shards(work, shards, folder, client, retries, progress)
    return SweepResult(*core.finish([folder], list(charts), folder), folder)


def _rows(runs: Any) -> tuple[list[str], list[list[str]]]:
    """Runs as keys and rows. What a run leaves out is the scene's own."""
    if hasattr(runs, "to_dict"):
        runs = runs.to_dict("records")
    listed = [dict(run) for run in runs]
    if not listed:
        raise RaypencilError("runs is empty; expected at least one mapping from keys to values")
    keys = list(dict.fromkeys(key for run in listed for key in run))
    return keys, [["" if _is_missing(run.get(key)) else _value(run[key], key) for key in keys] for run in listed]


def _is_missing(value: Any) -> bool:
    """Whether a run leaves a key as it is in the scene; a DataFrame says so by NaN."""
    return value is None or (isinstance(value, float) and value != value)
