"""Drives of the rover, frame by frame."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _raypencil
from ._errors import RaypencilError, optional
from ._progress import Progress, bar_of
from ._scene import Pose, as_scene


@dataclass(frozen=True, eq=False)
class ElevationMap:
    """The paper's local terrain map after a frame. Row 0 has the smallest y, column 0 the smallest x."""

    #: (points, points) float64: global z, metres; NaN where nothing is known.
    elevation: NDArray[np.float64]
    #: (points, points) uint8: 0 unknown, 1 proximity sensor, 2 extrapolated, 3 measured.
    source: NDArray[np.uint8]
    #: Global x of column 0, metres.
    west: float
    #: Global y of row 0, metres.
    south: float
    #: Metres.
    spacing: float

    @property
    def x(self) -> NDArray[np.float64]:
        """Global x of each column, metres."""
        return np.asarray(self.west + self.spacing * np.arange(self.elevation.shape[1]), dtype=np.float64)

    @property
    def y(self) -> NDArray[np.float64]:
        """Global y of each row, metres."""
        return np.asarray(self.south + self.spacing * np.arange(self.elevation.shape[0]), dtype=np.float64)

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` over ``y`` and ``x``. Raises ImportError without xarray."""
        xarray = optional("xarray", "to_xarray()")
        sources = {"flag_values": [0, 1, 2, 3], "flag_meanings": "unknown proximity extrapolated measured"}
        dataset = xarray.Dataset(
            {
                "elevation": (("y", "x"), self.elevation, {"units": "m", "long_name": "global z"}),
                "source": (("y", "x"), self.source, sources),
            },
            {"y": self.y, "x": self.x},
            attrs={"source": f"raypencil {_raypencil.__version__}", "frame": "global"},
        )
        for name in ("x", "y"):
            dataset[name].attrs["units"] = "m"
        return dataset

    def _repr_png_(self) -> bytes:
        # North is on top of a picture.
        return _raypencil.picture(np.ascontiguousarray(self.elevation[::-1]), 640, False)


@dataclass(frozen=True, eq=False)
class Sectors:
    """An obstacle map: where each sector ends, from right to left."""

    #: (n, 4) float64: global direction (radians, from the x axis to the left), radius (m), global x and y (m).
    ends: NDArray[np.float64]
    #: ``obstacle``, ``unknown`` or ``visibility``.
    labels: list[str]


@dataclass(frozen=True, eq=False)
class Vectors:
    """A navigator map: vectors along the ends of the sectors."""

    #: (n, 4) float64: global x, y of the start, and of the end, metres.
    ends: NDArray[np.float64]
    #: ``obstacle``, ``unknown`` or ``visibility``.
    labels: list[str]


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame of a drive: what the rover was given, and what it made of it. Arrays are those of a recording
    (docs/formats/recording.md)."""

    index: int
    #: Seconds since the first frame.
    time: float
    #: Commanded way since the start, metres.
    driven: float
    #: ``global_from_vehicle``: the truth, and what the vehicle believes after the frame.
    true_pose: Pose
    believed_pose: Pose
    #: Why there is a vertical scan in this frame: ``start``, ``distance``, ``inconsistency``; ``None``: no scan.
    scan: str | None
    #: Columns of the image in which the beams could not be told apart.
    columns_left_out: int
    #: Digital images (rows, columns) by the lit beam: ``beam0``, ``beam1``, or ``all``. uint16; int32 with
    #: ``subtract_unlit``; float64 in W/m with ``eq1``. Those of a scan are left out.
    images: dict[str, NDArray[Any]]
    #: (n, 5) float64: frame, step of the scan (-1: none), beam, column, row of each edge (px from the upper border).
    stripes: NDArray[np.float64]
    #: (m, 11) float64: the same five, and the point in the vehicle frame and in the global frame, metres.
    points: NDArray[np.float64]
    map: ElevationMap
    #: In frames that make an obstacle map, else ``None``.
    sectors: Sectors | None
    vectors: Vectors | None


def _frame(flat: dict[str, Any]) -> Frame:
    _arrays.frozen(flat)
    sectors, vectors = flat["sectors"], flat["vectors"]
    return Frame(
        **{
            **flat,
            "true_pose": Pose(**flat["true_pose"]),
            "believed_pose": Pose(**flat["believed_pose"]),
            "map": ElevationMap(**flat["map"]),
            "sectors": None if sectors is None else Sectors(**sectors),
            "vectors": None if vectors is None else Vectors(**vectors),
        }
    )


class Drive(Iterator[Frame]):
    """A drive that goes on as its frames are taken: ``for frame in drive(...)``.

    It runs at most a few exposures ahead. One that is not taken to its end is given up by :meth:`close`, by leaving a
    ``with`` block, or when nothing refers to it any more.
    """

    def __init__(self, core: _raypencil.DriveCore, progress: Progress) -> None:
        self._core = core
        self._is_done = False
        self._hears = progress if callable(progress) else None
        self._bar = bar_of(progress, unit="frame", desc="drive")

    @property
    def planned(self) -> int:
        """Number of frames of the route: more than are driven if it leads off the ground. 0 before the first frame."""
        return self._core.planned

    def __next__(self) -> Frame:
        if self._is_done:
            raise StopIteration
        try:
            flat = self._core.next()
        except BaseException:
            self.close()
            raise
        if flat is None:
            self._finish()
            raise StopIteration
        frame = _frame(flat)
        if self._bar is not None:
            self._bar.total = self.planned
            self._bar.update(1)
        if self._hears is not None:
            self._hears(f"frame {frame.index + 1} of {self.planned}")
        return frame

    def run(self) -> Drive:
        """Takes all frames that are left, and keeps none."""
        for _ in self:
            pass
        return self

    def _finish(self) -> None:
        self._is_done = True
        if self._bar is not None:
            self._bar.close()

    def close(self) -> None:
        """Gives the drive up."""
        self._core.close()
        self._finish()

    def __enter__(self) -> Drive:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _ended(self) -> tuple[bool, str, str]:
        ended = self._core.summary()
        if ended is None:
            raise RaypencilError("the drive has not ended; expected all of its frames to be taken: drive.run()")
        return ended

    @property
    def passes(self) -> bool:
        """Whether both renderers' drives are identical, or there is only one. After the last frame."""
        return self._ended()[0]

    @property
    def text(self) -> str:
        """The screen of the command. After the last frame."""
        return self._ended()[1]

    @property
    def summary(self) -> dict[str, Any]:
        """The command's ``summary.json`` (docs/formats/drive.schema.json). After the last frame."""
        document: dict[str, Any] = json.loads(self._ended()[2])
        return document

    def __repr__(self) -> str:
        ended = self._core.summary()
        return f"<raypencil.Drive: {'ended' if ended else 'going on'}>"


def drive(
    scene: Any,
    to: Sequence[float] | Sequence[Sequence[float]] | None = None,
    *,
    to_global: bool = False,
    with_: str | Sequence[str] | None = None,
    as_printed: bool = False,
    rules: Mapping[str, str] | None = None,
    switches: Mapping[str, str] | None = None,
    images: bool = True,
    record: Sequence[str] = (),
    output: str | os.PathLike[str] | None = None,
    stripes: ArrayLike | str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Progress = False,
) -> Drive:
    """Drives the rover over a scene: an iterator over frames.

    Args:
        scene: a :class:`Scene`, or a name or path of one.
        to: waypoints, metres ahead of the vehicle and to its left: ``(3, 0)``, or ``[(3, 0), (3, 2)]``. Default: the route of
            the scene file, or of the built-in ground.
        to_global: the waypoints are global.
        with_: a renderer; or two in lockstep: ``("scanline", "tracer")``. Default: scanline, as printed scanline-paper.
        as_printed: drive by the paper's own rules.
        rules: rules of the maps: ``{"gap": "paper"}``.
        switches: of the scanline renderer.
        images: keep the images of each frame.
        record: with ``output``: ``images``, ``png``, ``npy``, ``points``, ``poses``, ``maps``, ``mcap``, ``all``.
        output: the folder of the command ``drive``. It is complete when the last frame was taken.
        stripes: stripes in place of the rover's own extraction: a folder with ``stripes.npy``, such as a recording; or an array
            (n, 5) of frame, step of a scan (-1: none), beam, column and row, as :attr:`Frame.stripes` of all frames together.
        force: replace what ``output`` has of another command, or of something else; without it that is an error.
        progress: ``True``: a bar by tqdm, if that is installed. A function is called after each frame.

    Raises:
        RaypencilError: no route, a start or a route off the ground, a wrong name. Here, or with the first frame.
    """
    if record and output is None:
        raise RaypencilError("record needs output: the folder to record into")
    points: list[tuple[float, float]] = []
    if to is not None:
        wrong = RaypencilError(f"to is {to!r}; expected waypoints of two numbers, such as [(3, 0), (3, 2)]")
        try:
            array = np.asarray(to, dtype=np.float64)
        except (TypeError, ValueError):
            # A text, or places of different lengths.
            raise wrong from None
        if array.ndim == 1:
            array = array[np.newaxis]
        if array.ndim != 2 or array.shape[1] != 2 or not np.isfinite(array).all():
            raise wrong
        points = [(float(x), float(y)) for x, y in array]
    if with_ is None:
        with_ = "scanline-paper" if as_printed else "scanline"
    names = [with_] if isinstance(with_, str) else list(with_)
    folder = None if output is None else os.fspath(output)
    core = as_scene(scene)._core

    def begun(of_stripes: tuple[str, bool] | None) -> Drive:
        made = _raypencil.DriveCore(
            core, points, to_global, as_printed, list((rules or {}).items()), list(record), names,
            list((switches or {}).items()), images, folder, of_stripes, force, None,
        )  # fmt: skip
        return Drive(made, progress)

    if stripes is None:
        return begun(None)
    if isinstance(stripes, (str, os.PathLike)):
        given = os.fspath(stripes)
        if folder is not None and Path(given).resolve().is_relative_to(Path(folder).resolve()):
            raise RaypencilError(f"stripes: {given} lies in the output {folder}; expected another output")
        return begun((given, True))
    rows = np.asarray(stripes, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != 5:
        raise RaypencilError(f"stripes have the shape {rows.shape}; expected (n, 5): frame, step, beam, column, row")
    # They are read before the drive begins.
    with tempfile.TemporaryDirectory() as beside:
        np.save(Path(beside, "stripes.npy"), np.ascontiguousarray(rows))
        return begun((beside, False))
