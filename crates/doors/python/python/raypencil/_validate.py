"""Renderers against each other, and recordings against each other."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from . import _raypencil
from ._errors import RaypencilError
from ._judge import Arithmetic
from ._progress import Progress, stages
from ._render import RenderResult
from ._scene import as_scene


class Outcome:
    """Whether something passes, in words and as a document.

    Attributes:
        passes: what the command's exit code says. The outcome itself is true if it passes.
        text: the command's screen.
        summary: the command's JSON.
    """

    def __init__(self, passes: bool, text: str, document: str) -> None:
        self.passes = passes
        self.text = text
        self.summary: dict[str, Any] = json.loads(document)

    def __bool__(self) -> bool:
        return self.passes

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class ValidationResult(Outcome):
    """A scene rendered by several renderers, compared ray by ray."""

    def __init__(self, core: _raypencil.ValidationCore, scene_sha256: str, flux_unit: str) -> None:
        super().__init__(core.passes, core.text(), core.json())
        self._core: _raypencil.ValidationCore | None = core
        self._renders: dict[str, RenderResult] = {}
        self._about = (scene_sha256, flux_unit)

    @property
    def counts(self) -> dict[str, int]:
        """Numbers of rays: ``compared``, and of these ``agree``, ``tie``, ``rounding``, ``undecided``, ``defects``; those
        that are left made an error of the paper. ``judged``: the referee ruled on them."""
        keys = ("compared", "agree", "tie", "rounding", "undecided", "defects", "not_compared", "judged")
        return {key: self.summary[key] for key in keys}

    @property
    def renders(self) -> dict[str, RenderResult]:
        """Each renderer's maps, by its name."""
        if self._core is not None:
            for index, name in enumerate(self._core.renderers):
                if name not in self._renders:
                    self._renders[name] = RenderResult(self._core.maps(index), name, *self._about)
        return self._renders

    def report(self) -> str:
        """The page of ``report.html``, which asks for no other file."""
        if self._core is None:
            raise RaypencilError("the report is not pickled; expected a validation of this process")
        return self._core.report()

    def __repr__(self) -> str:
        return f"<raypencil.ValidationResult: {self.summary['verdict']}, {self.counts['compared']} rays compared>"

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_renders": self.renders, "_core": None}


def validate(
    scene: Any,
    with_: Sequence[str] = ("scanline", "tracer"),
    *,
    judge: Literal["sample", "all"] = "sample",
    switches: Mapping[str, str] | None = None,
    candidates: Sequence[str | os.PathLike[str]] = (),
    channels: Mapping[str, str] | None = None,
    scale: float | None = None,
    allow_empty: bool = False,
    output: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Progress = False,
) -> ValidationResult:
    """Renders a scene by two or more renderers and compares every ray. The referee rules on each that differs.

    Args:
        scene: a :class:`Scene`, or a name or path of one.
        with_: names of renderers, as for :func:`render`.
        judge: of the rays that agree the referee rules on ``"sample"``, one in 64, or on ``"all"``.
        switches: of the scanline renderer: ``{"facing": "paper"}``.
        candidates: folders with other programs' answers to this scene, to be checked besides.
        channels, scale: of the candidates' files, as for :func:`check`.
        allow_empty: whether a scene in which nothing is hit may pass.
        output: a folder for the report and the files of the command ``validate``.
        force: replace what ``output`` has of another command, or of something else; without it that is an error.
        progress: see :func:`cast`.

    Raises:
        RaypencilError: fewer than two renderers, one that is not there, a candidate that cannot be read.
    """
    if judge not in ("sample", "all"):
        raise RaypencilError(f'judge is {judge!r}; expected "sample" or "all"')
    if isinstance(with_, str):
        with_ = with_.split(",")
    scene = as_scene(scene)
    folder = None if output is None else os.fspath(output)
    folders = [os.fspath(candidate) for candidate in candidates]
    of_switches = list((switches or {}).items())
    with stages(progress) as on_stage:
        core = _raypencil.validate(
            scene._core, list(with_), of_switches, judge == "all", folders, list((channels or {}).items()), scale,
            allow_empty, folder, force, on_stage,
        )
    return ValidationResult(core, scene.sha256, scene.flux_unit)


class DiffResult(Outcome):
    """Two recordings, channel by channel."""

    @property
    def channels(self) -> list[dict[str, Any]]:
        """One for each channel: docs/guide/diff.md has the keys."""
        return list(self.summary["channels"])

    def __repr__(self) -> str:
        return f"<raypencil.DiffResult: {self.summary['verdict']}, {len(self.channels)} channels>"


def diff(
    a: str | os.PathLike[str],
    b: str | os.PathLike[str],
    *,
    channels: Mapping[str, str] | None = None,
    scale: float | None = None,
    fail: float = 0.0,
    fail_relative: float = 0.0,
    fail_ulp: float = 0.0,
    fail_percent: float = 0.0,
    hard_fail: float | None = None,
    shared_only: bool = False,
    scene: Any = None,
    arithmetic: Arithmetic | None = None,
    output: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Progress = False,
) -> DiffResult:
    """Compares two recordings: files or folders of EXR, NPY, NPZ, Zarr, PFM, PNG or TIFF, of any program.

    A cell passes if ``fail``, ``fail_relative`` or ``fail_ulp`` allows its difference.

    Args:
        a, b: the files or folders.
        channels, scale: as for :func:`check`; they concern each side that has such a channel.
        fail: an absolute difference that is allowed, in the channel's unit.
        fail_relative: one relative to the larger of both numbers.
        fail_ulp: one in units in the last place of the file with the lower precision.
        fail_percent: percent of a channel's cells that may fail.
        hard_fail: what no cell may differ by more than, whatever the others allow.
        shared_only: ignore channels that one side has alone.
        scene: a :class:`Scene`, or a name or path of one. The referee then rules on each cell that differs by more than is
            allowed, and a channel fails only if a side is wrong.
        arithmetic: with ``scene``, the arithmetic in which both were computed. Default: for each as its ``candidate.json``
            says, else ``"f64"``.
        output: a folder for the report.
        force: replace what ``output`` has of another command, or of something else; without it that is an error.
        progress: see :func:`cast`.

    Raises:
        RaypencilError: files that cannot be read, nothing in common, two sizes of one channel, a threshold below 0.
    """
    limits = {"fail": fail, "fail_relative": fail_relative, "fail_ulp": fail_ulp, "hard_fail": hard_fail}
    for name, limit in limits.items():
        if limit is not None and not 0 <= limit < float("inf"):
            raise RaypencilError(f"{name} is {limit}; expected a number of at least 0, such as 1e-6")
    if not 0 <= fail_percent <= 100:
        raise RaypencilError(f"fail_percent is {fail_percent}; expected a percentage from 0 to 100")
    core = None if scene is None else as_scene(scene)._core
    folder = None if output is None else os.fspath(output)
    with stages(progress) as on_stage:
        passes, text, document = _raypencil.diff(
            os.fspath(a), os.fspath(b), list((channels or {}).items()), scale, fail, fail_relative, fail_ulp,
            fail_percent, hard_fail, shared_only, core, arithmetic, folder, force, on_stage,
        )
    return DiffResult(passes, text, document)
