"""Any rays on any mesh, answered exactly."""

from __future__ import annotations

import math
import warnings as python_warnings
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _raypencil
from ._cast_result import VALUES, CastResult, decided_counts
from ._errors import RaypencilError, RaypencilWarning
from ._mesh import Caster, as_mesh, is_tracer, number_of_threads
from ._progress import Progress, stages

Query = Literal["first", "any", "all"]

#: Rays that are put together and answered at a time: their numbers take 19 MB.
RAYS_AT_A_TIME = 1 << 17

_ALL_VALUES = (1 << len(VALUES)) - 1

#: Types and last dimensions of arrays with a value for each ray.
_TYPES: dict[str, tuple[Any, _arrays.Shape]] = {
    "face": (np.uint32, ()),
    "side": (np.int8, ()),
    "ties": (np.uint32, ()),
    "t": (np.float64, ()),
    "range": (np.float64, ()),
    "cos_incidence": (np.float64, ()),
    "point": (np.float64, (3,)),
    "normal": (np.float64, (3,)),
    "barycentric": (np.float64, (3,)),
    "any": (np.uint8, ()),
    "margin.face": (np.float64, (2,)),
    "margin.surface": (np.float64, (2,)),
    "across": (np.float64, (2, 3)),
}


def cast(
    mesh: Any,
    origins: ArrayLike,
    directions: ArrayLike | None = None,
    *,
    t_min: ArrayLike | None = None,
    t_max: ArrayLike | None = None,
    t_blind: ArrayLike | None = None,
    query: Query | tuple[Query, ...] = "first",
    values: Iterable[str] | None = None,
    with_: Caster = "referee",
    fronts_only: bool = False,
    margins: bool = False,
    out: Mapping[str, NDArray[Any]] | None = None,
    threads: int | None = None,
    progress: Progress = False,
) -> CastResult:
    """Answers rays on a mesh: exactly, or by the tracer in float64.

    The ray is exactly the set of points o + t d with t_min <= t <= t_max. Nothing is tolerated and nothing nearly missed;
    every number is the double nearest to the exact value.

    A :class:`Mesh` keeps its tree, so that the first call builds it and later ones only ask; of other meshes each call builds one.

    Args:
        mesh: a :class:`Mesh`, a :class:`Scene` (its terrain, in the scene frame), ``(vertices, faces)``, or anything with
            ``vertices`` and ``faces``, such as a ``trimesh.Trimesh``; also a triangle mesh of Open3D.
        origins: (..., 3), in the mesh's unit. Without ``directions``: the rays together, (..., 6), (..., 8) or
            (..., 9). Tensors of other packages are taken by DLPack, without a copy.
        directions: (..., 3), not 0; their length counts.
        t_min, t_max: a number or (...), in lengths of the direction. Default: 0, and no end.
        t_blind: the shortest range of a sensor, as a t: a number or (...). A ray whose nearest hit is before it is too near, and
            nothing behind that hit is seen. Default: 0.
        query: the first hit is asked for, unless ``values`` is empty. ``"any"`` asks besides whether anything is hit, ``"all"``
            for all hits in exact order; a tuple asks for both.
        values: which values of first hits are formed: names of ``face``, ``side``, ``ties``, ``t``, ``range``, ``cos_incidence``,
            ``point``, ``normal``, ``barycentric``. ``face`` always comes along. ``None``: all, or those of ``out``; ``()``: none.
        with_: ``"referee"`` is exact. ``"tracer"`` is 1.2 to 3.2 times as fast (docs/evidence/speed.md), rounds, and knows no ties, no
            margins and no crossings.
        fronts_only: rays pass through the backs of faces.
        margins: how far each ray may be moved sideways before its answer changes.
        out: arrays into which answers are written, by the names in :attr:`CastResult.arrays`: of the type and the shape that they
            would have, in any memory order. The result has them as read-only views. An error of the arguments is raised before
            anything is written.
        threads: how many threads answer; ``None``: all. The answers are the same.
        progress: ``True``: a line by tqdm, if that is installed. A function is called with the name of each stage.

    Returns:
        Arrays of the rays' own shape.

    Warns:
        RaypencilWarning: several rays and none hits (is the mesh in millimetres?), most first hits are backs, or all hits are
            asked for of an open mesh. The sentences stand in ``warnings`` of the result too.

    Raises:
        RaypencilError: shapes that do not fit, and the first ray that is none: a number that is not finite or beyond 1e30, a
            direction of 0, a t_min below 0, a t_max below t_min, a t_blind below 0 or beyond t_max.
    """
    rays = _arrays.RayParts(origins, directions, t_min, t_max, t_blind)
    asked = Asked(query, values, with_, fronts_only, margins, threads, out)
    result = asked.of(as_mesh(mesh)._core, rays, progress, out)
    for sentence in result.warnings:
        python_warnings.warn(sentence, RaypencilWarning, stacklevel=2)
    return result


def cast_chunks(
    mesh: Any,
    origins: ArrayLike,
    directions: ArrayLike | None = None,
    *,
    t_min: ArrayLike | None = None,
    t_max: ArrayLike | None = None,
    t_blind: ArrayLike | None = None,
    query: Query | tuple[Query, ...] = "first",
    values: Iterable[str] | None = None,
    with_: Caster = "referee",
    fronts_only: bool = False,
    margins: bool = False,
    threads: int | None = None,
    size: int = 1 << 20,
) -> Iterator[tuple[slice, CastResult]]:
    """:func:`cast`, a piece at a time, for more rays than memory holds answers of: nothing is kept of a piece that was given.

    Pieces are rows of the first axis of the rays. Origins and directions may be arrays on disk (``numpy.memmap``). A piece of the
    result has its ``warnings``, of which Python is not warned.

    Args:
        mesh: as in :func:`cast`; its tree is built once, when the first piece is taken.
        origins, directions, t_min, t_max, t_blind: as in :func:`cast`, for at least one axis of rays.
        query, values, with_, fronts_only, margins, threads: as in :func:`cast`.
        size: most rays of a piece; at least one row.

    Returns:
        For each piece a slice of the first axis, and the answers of these rays.

    Raises:
        RaypencilError: as :func:`cast`. A ray that is none is found when its piece is taken.
    """
    rays = _arrays.RayParts(origins, directions, t_min, t_max, t_blind)
    if isinstance(size, bool) or not isinstance(size, (int, np.integer)) or size < 1:
        raise RaypencilError(f"size is {size!r}; expected 1 or more rays")
    if not rays.shape:
        raise RaypencilError("one ray has no pieces; expected rays of one axis or more")
    asked, core = Asked(query, values, with_, fronts_only, margins, threads), as_mesh(mesh)._core

    def pieces() -> Iterator[tuple[slice, CastResult]]:
        row = math.prod(rays.shape[1:])
        rows = max(1, int(size) // max(1, row))
        for start in range(0, rays.shape[0], rows):
            part = slice(start, min(start + rows, rays.shape[0]))
            shape = (part.stop - start, *rays.shape[1:])
            yield part, asked.of_block(core, rays.block((part,)), shape, start * row)

    return pieces()


class Asked:
    """What is asked of rays, checked."""

    __slots__ = ("all", "any", "by_tracer", "fronts_only", "margins", "threads", "values")

    def __init__(
        self,
        query: Query | tuple[Query, ...] = "first",
        values: Iterable[str] | None = None,
        with_: Caster = "referee",
        fronts_only: bool = False,
        margins: bool = False,
        threads: int | None = None,
        out: Mapping[str, NDArray[Any]] | None = None,
    ) -> None:
        self.by_tracer = is_tracer(with_)
        asked = (query,) if isinstance(query, str) else tuple(query)
        for one in asked:
            if one not in ("first", "any", "all"):
                raise RaypencilError(f'query is {one!r}; expected "first", "any" or "all"')
        self.any, self.all, self.margins = "any" in asked, "all" in asked, bool(margins)
        self.fronts_only, self.threads = fronts_only, number_of_threads(threads)
        if self.by_tracer and margins:
            raise RaypencilError('with_="tracer" knows no margins; expected with_="referee"')
        if values is None and out is not None:
            values = [name for name in out if name in VALUES]
        #: The bits of the values.
        self.values = _ALL_VALUES if values is None else bits_of(values)
        if self.values == 0 and not (self.any or self.all or self.margins):
            raise RaypencilError('values is empty, and nothing else is asked; expected a value, query="any" or query="all"')

    def of(
        self,
        core: _raypencil.MeshCore,
        rays: _arrays.RayParts,
        progress: Progress = False,
        out: Mapping[str, NDArray[Any]] | None = None,
    ) -> CastResult:
        """The answers to all rays."""
        shape = rays.shape
        count = math.prod(shape)
        arrays = None if out is None else self._targets(rays, out)
        if count == 0 or out is None and count <= RAYS_AT_A_TIME:
            if progress is False:
                return self.of_block(core, rays.whole(), shape)
            with stages(progress) as on_stage:
                return self.of_block(core, rays.whole(), shape, on_stage=on_stage)
        if out is not None and count > RAYS_AT_A_TIME:
            # A ray that is none is found before anything is written.
            for index, start, _ in _arrays.blocks(shape, RAYS_AT_A_TIME):
                _raypencil.check_rays(rays.block(index), start)
        return self._in_blocks(core, rays, self._targets(rays, {}) if arrays is None else arrays, progress)

    def of_block(
        self,
        core: _raypencil.MeshCore,
        rays: NDArray[np.float64],
        shape: _arrays.Shape,
        first: int = 0,
        on_stage: Any = None,
    ) -> CastResult:
        """The answers to rays (n, 9) of this shape; in messages the first one has the index ``first``."""
        arrays, _, decided, warnings = _raypencil.cast(
            core, rays, shape, first, self.values, self.by_tracer, self.fronts_only, self.any, self.all, self.margins,
            self.threads, True, on_stage,
        )  # fmt: skip
        return CastResult._of_engine(arrays, shape, warnings, decided)

    def _names(self) -> list[str]:
        """The arrays with a value for each ray that are answered."""
        names = [name for bit, name in enumerate(VALUES) if self.values >> bit & 1]
        return names + ["any"] * self.any + ["margin.face", "margin.surface", "across"] * self.margins

    def _targets(self, rays: _arrays.RayParts, given: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
        """The arrays into which answers are written: those that are given, and new ones."""
        names, shape = self._names(), rays.shape
        for name in given:
            if name not in names:
                raise RaypencilError(f"out: {name!r} is none of the answers; expected some of {', '.join(names)}")
        arrays = {}
        for name in names:
            kind, last = _TYPES[name]
            if name not in given:
                arrays[name] = np.empty(shape + last, dtype=kind)
                continue
            array = given[name]
            if not isinstance(array, np.ndarray):
                raise RaypencilError(f"out: {name} is of type {type(array).__name__}; expected an array of NumPy")
            if array.shape != shape + last or array.dtype != np.dtype(kind):
                has, wants = f"{array.dtype} {array.shape}", f"{np.dtype(kind)} {shape + last}"
                raise RaypencilError(f"out: {name} is {has}; expected {wants}")
            if not array.flags.writeable:
                raise RaypencilError(f"out: {name} is read-only; expected an array that can be written to")
            if rays.overlaps(array):
                raise RaypencilError(f"out: {name} lies in the memory of the rays; expected an array of its own")
            for other in given:
                if other < name and np.may_share_memory(given[other], array):
                    raise RaypencilError(f"out: {name} and {other} lie in the same memory; expected two arrays")
            arrays[name] = array
        return arrays

    def _in_blocks(
        self, core: _raypencil.MeshCore, rays: _arrays.RayParts, arrays: dict[str, NDArray[Any]], progress: Progress
    ) -> CastResult:
        """Writes the answers a block at a time: only one block of rays is put together at once."""
        count = math.prod(rays.shape)
        counts, decided = np.zeros(3, dtype=np.int64), np.zeros(3, dtype=np.int64)
        of_all: list[dict[str, NDArray[Any]]] = []
        is_decided = False
        with stages(progress) as on_stage:
            for index, start, _ in _arrays.blocks(rays.shape, RAYS_AT_A_TIME):
                if on_stage is not None and start:
                    on_stage(f"rays: {start} of {count}")
                block = rays.block(index)
                flat, seen, by, _ = _raypencil.cast(
                    core, block, (len(block),), start, self.values, self.by_tracer, self.fronts_only, self.any, self.all,
                    self.margins, self.threads, False, on_stage if start == 0 else None,
                )  # fmt: skip
                counts += seen
                if by is not None:
                    is_decided = True
                    decided += by
                for name, array in arrays.items():
                    part = array[index] if index else array
                    last = array.shape[len(rays.shape) :]
                    # A single cell is a number, no view.
                    array[index if index else ...] = flat[name].reshape(part.shape[: part.ndim - len(last)] + last)
                if self.all:
                    of_all.append({name: array for name, array in flat.items() if name.startswith("all.")})
        # Only where nothing is hit the rays are asked again.
        is_all_missed = not counts[:2].any() and (self.values or self.any or self.all) and count > 1
        whole = rays.whole() if is_all_missed else np.zeros((0, 9))
        hits, near, backs = (int(one) for one in counts)
        warnings = _raypencil.cast_warnings(core, whole, self.fronts_only, self.all, (hits, near, backs))
        results = {name: array.view() for name, array in arrays.items()}
        of_decided = tuple(int(one) for one in decided) if is_decided else None
        return CastResult(results | _joined(of_all), rays.shape, tuple(warnings), decided_counts(of_decided))


def bits_of(values: Iterable[str]) -> int:
    """Names of values as the bits of the engine. Where any is asked for, the face is."""
    names = (values,) if isinstance(values, str) else tuple(values)
    bits = 0
    for name in names:
        if name not in VALUES:
            raise RaypencilError(f"values: there is no {name!r}; expected some of {', '.join(VALUES)}")
        bits |= 1 << VALUES.index(name)
    return bits | 1 if bits else 0


def _joined(parts: list[dict[str, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    """All hits of blocks of rays that follow each other."""
    if not parts:
        return {}
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0] if name != "all.start"}
    starts, before = [np.zeros(1, dtype=np.uint64)], 0
    for part in parts:
        starts.append(part["all.start"][1:] + np.uint64(before))
        before += int(part["all.start"][-1])
    return {"all.start": np.concatenate(starts), **joined}


def answered(
    mesh: Any,
    rays: _arrays.RayParts,
    query: Query | tuple[Query, ...] = "first",
    with_: Caster = "referee",
    values: Iterable[str] | None = None,
) -> CastResult:
    """The answers of :func:`cast` to rays, without a warning."""
    return Asked(query, values, with_).of(as_mesh(mesh)._core, rays)
