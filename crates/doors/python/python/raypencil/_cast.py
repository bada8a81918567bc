"""Any rays on any mesh, answered exactly."""

from __future__ import annotations

import warnings as python_warnings
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _raypencil
from ._errors import RaypencilError, RaypencilWarning, optional
from ._mesh import as_mesh
from ._progress import Progress, stages

Query = Literal["first", "any", "all"]
Caster = Literal["referee", "tracer"]

#: Unit, and what it is, of each array that has a value for each ray.
_MEANINGS = {
    "face": ("1", "index of the first face that is hit; 4294967295: none, or too near"),
    "side": ("1", "side of the face: 1 front, -1 back, 0 no hit"),
    "ties": ("1", "number of faces at exactly this t"),
    "t": ("length of the direction", "parameter of the ray at the hit; +Inf: no hit, -Inf: too near"),
    "range": ("unit of the mesh", "distance along the ray; +Inf: no hit, -Inf: too near"),
    "cos_incidence": ("1", "cosine of the angle between normal and reversed ray; negative: back"),
    "point": ("unit of the mesh", "hit point"),
    "normal": ("1", "unit normal to the front of the face"),
    "barycentric": ("1", "weights of the face's corners"),
    "any": ("1", "whether anything is hit"),
    "margin.face": ("unit of the mesh", "least sideways displacement that changes the set of nearest faces"),
    "margin.surface": ("unit of the mesh", "least sideways displacement that changes the surface"),
    "across": ("1", "the two vectors along which the ray is moved sideways"),
}

_LAST = {
    "point": ("xyz",),
    "normal": ("xyz",),
    "barycentric": ("corner",),
    "margin.face": ("bound",),
    "margin.surface": ("bound",),
    "across": ("vector", "xyz"),
}

_COORDINATES = {
    "xyz": ["x", "y", "z"],
    "corner": ["a", "b", "c"],
    "bound": ["lo", "hi"],
    "vector": ["u", "v"],
}


@dataclass(frozen=True, eq=False)
class AllHits:
    """All hits of all rays, in exact order: those of ray k (in C order) are entries ``start[k]`` to ``start[k + 1] - 1``.

    ``face`` (uint32), ``side`` (int8), ``t`` (float64), ``group`` (uint32: hits of one ray at exactly the same t are one
    group) and ``crossing`` (int32: how often the surface is crossed inward in the hit's group) have an entry for each hit;
    ``start`` (uint64) has one more than there are rays.
    """

    start: NDArray[np.uint64]
    face: NDArray[np.uint32]
    side: NDArray[np.int8]
    t: NDArray[np.float64]
    group: NDArray[np.uint32]
    crossing: NDArray[np.int32]

    def of(self, ray: int) -> slice:
        """The entries of one ray: ``all.t[all.of(3)]``.

        Args:
            ray: its index in C order, from 0.

        Raises:
            IndexError: there is no such ray.
        """
        if not 0 <= ray < len(self.start) - 1:
            raise IndexError(f"ray {ray}; expected 0 to {len(self.start) - 2}")
        return slice(int(self.start[ray]), int(self.start[ray + 1]))


class CastResult:
    """Answers to rays: arrays of the rays' own shape, read-only.

    ``arrays`` has all of them by the names of the command's files (docs/guide/cast.md), and each is an attribute, with ``_``
    for ``.``: ``face``, ``side``, ``ties``, ``t``, ``range``, ``cos_incidence`` of shape (...), ``point``, ``normal``,
    ``barycentric`` of shape (..., 3); ``any`` and ``all``, ``margin_face``, ``margin_surface`` (..., 2) and ``across``
    (..., 2, 3) if they were asked for, else ``None``.
    """

    __slots__ = ("arrays", "shape", "warnings")

    def __init__(
        self, arrays: dict[str, NDArray[Any]], shape: _arrays.Shape, warnings: tuple[str, ...] = ()
    ) -> None:
        #: The arrays by the names of the command's files.
        self.arrays = arrays
        #: Shape of the rays.
        self.shape = shape
        #: What looks wrong in the rays and their mesh: no ray hits, most hits are backs, the mesh is open where crossings are asked.
        self.warnings = warnings
        _arrays.frozen(arrays)

    @property
    def hit(self) -> NDArray[np.bool_]:
        """Whether each ray hits something that is not too near: it has a face and a range."""
        return np.asarray(self.face != _arrays.NO_FACE)

    @property
    def too_near(self) -> NDArray[np.bool_]:
        """Whether the nearest surface stands before the shortest range of the ray's sensor (``t_blind``)."""
        return np.asarray(np.isneginf(self.t))

    @property
    def face(self) -> NDArray[np.uint32]:
        """The first face that is hit, of several at the same t the lowest; 4294967295: none, or too near."""
        return self.arrays["face"]

    @property
    def side(self) -> NDArray[np.int8]:
        """1 front, -1 back, 0 no hit."""
        return self.arrays["side"]

    @property
    def ties(self) -> NDArray[np.uint32]:
        """Number of faces at exactly this t; 0: no hit. The tracer does not know of ties, and says 1."""
        return self.arrays["ties"]

    @property
    def t(self) -> NDArray[np.float64]:
        """The ray's parameter: the point is o + t d. +Inf: no hit, -Inf: too near."""
        return self.arrays["t"]

    @property
    def range(self) -> NDArray[np.float64]:
        """Distance along the ray, t |d|, in the mesh's unit. +Inf: no hit, -Inf: too near."""
        return self.arrays["range"]

    @property
    def cos_incidence(self) -> NDArray[np.float64]:
        """Cosine of the angle between normal and reversed ray: negative where a back is met, NaN: no hit."""
        return self.arrays["cos_incidence"]

    @property
    def point(self) -> NDArray[np.float64]:
        """(..., 3): the point, in the mesh's unit. NaN: no hit."""
        return self.arrays["point"]

    @property
    def normal(self) -> NDArray[np.float64]:
        """(..., 3): the unit normal to the front of the face. NaN: no hit."""
        return self.arrays["normal"]

    @property
    def barycentric(self) -> NDArray[np.float64]:
        """(..., 3): the weights of the face's three corners. NaN: no hit."""
        return self.arrays["barycentric"]

    @property
    def any(self) -> NDArray[np.uint8] | None:
        """Whether anything is hit, too near or not, 0 or 1; ``None`` if it was not asked."""
        return self.arrays.get("any")

    @property
    def margin_face(self) -> NDArray[np.float64] | None:
        """(..., 2): lo and hi of the least displacement that changes the set of nearest faces, in the mesh's unit."""
        return self.arrays.get("margin.face")

    @property
    def margin_surface(self) -> NDArray[np.float64] | None:
        """(..., 2): lo and hi of the least displacement that changes the surface, in the mesh's unit."""
        return self.arrays.get("margin.surface")

    @property
    def across(self) -> NDArray[np.float64] | None:
        """(..., 2, 3): the two vectors along which the ray is moved."""
        return self.arrays.get("across")

    @property
    def all(self) -> AllHits | None:
        """All hits, also what is too near and what is behind it; ``None`` if they were not asked for."""
        if "all.start" not in self.arrays:
            return None
        names = ("start", "face", "side", "t", "group", "crossing")
        return AllHits(**{name: self.arrays[f"all.{name}"] for name in names})

    def __len__(self) -> int:
        return int(np.prod(self.shape, dtype=np.int64))

    def __repr__(self) -> str:
        near = int(self.too_near.sum())
        of_near = f", {near} too near" if near else ""
        return f"<raypencil.CastResult: {int(self.hit.sum())} of {len(self)} rays hit{of_near}, shape {self.shape}>"

    def __getstate__(self) -> dict[str, Any]:
        return {"arrays": self.arrays, "shape": self.shape, "warnings": self.warnings}

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Arrays of a pickle may be written to.
        self.__init__(state["arrays"], state["shape"], state["warnings"])  # type: ignore[misc]

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` with a dimension ``ray`` (or ``row`` and ``column``, or ``axis_0``, ...), units and meanings.

        All hits, which have no value for each ray, are left out.

        Raises:
            ImportError: xarray is not installed: ``pip install raypencil[xarray]``.
        """
        xarray = optional("xarray", "to_xarray()")
        dimensions = _arrays.dimensions(self.shape)
        variables = {}
        used: set[str] = set()
        for name, array in self.arrays.items():
            if name not in _MEANINGS:
                continue
            unit, meaning = _MEANINGS[name]
            last = _LAST.get(name, ())
            used.update(last)
            attributes = {"units": unit, "long_name": meaning}
            variables[name.replace(".", "_")] = (dimensions + last, array, attributes)
        coordinates = {name: _COORDINATES[name] for name in _COORDINATES if name in used}
        return xarray.Dataset(variables, coordinates, attrs={"source": f"raypencil {_raypencil.__version__}"})

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame`` with a row for each ray, in C order; vectors have a column for each part.

        Raises:
            ImportError: pandas is not installed: ``pip install raypencil[pandas]``.
        """
        pandas = optional("pandas", "to_pandas()")
        columns = {}
        for name, array in self.arrays.items():
            if name not in _MEANINGS:
                continue
            last = _LAST.get(name, ())
            if not last:
                columns[name] = array.reshape(len(self))
            elif len(last) == 1:
                flat = array.reshape(len(self), -1)
                columns.update({f"{name}.{part}": flat[:, at] for at, part in enumerate(_COORDINATES[last[0]])})
        return pandas.DataFrame(columns)

    def _repr_png_(self) -> bytes | None:
        """The ranges as a picture, for rays of two dimensions."""
        if len(self.shape) != 2 or 0 in self.shape:
            return None
        return _raypencil.picture(np.ascontiguousarray(self.range), 640, False)


def cast(
    mesh: Any,
    origins: ArrayLike,
    directions: ArrayLike | None = None,
    *,
    t_min: ArrayLike | None = None,
    t_max: ArrayLike | None = None,
    t_blind: ArrayLike | None = None,
    query: Query | tuple[Query, ...] = "first",
    with_: Caster = "referee",
    fronts_only: bool = False,
    margins: bool = False,
    progress: Progress = False,
) -> CastResult:
    """Answers rays on a mesh: exactly, or by the tracer in float64.

    The ray is exactly the set of points o + t d with t_min <= t <= t_max. Nothing is tolerated and nothing nearly missed;
    every number is the double nearest to the exact value.

    Args:
        mesh: a :class:`Mesh`, a :class:`Scene` (its terrain, in the scene frame), or anything with ``vertices`` and
            ``faces``, such as a ``trimesh.Trimesh``.
        origins: (..., 3), in the mesh's unit. Without ``directions``: the rays together, (..., 6), (..., 8) or
            (..., 9).
        directions: (..., 3), not 0; their length counts.
        t_min, t_max: a number or (...), in lengths of the direction. Default: 0, and no end.
        t_blind: the shortest range of a sensor, as a t: a number or (...). A ray whose nearest hit is before it is too near, and
            nothing behind that hit is seen. Default: 0.
        query: the first hit is always asked for. ``"any"`` asks besides whether anything is hit, ``"all"`` for all hits in
            exact order; a tuple asks for both.
        with_: ``"referee"`` is exact. ``"tracer"`` is about a hundred times as fast, rounds, and knows no ties.
        fronts_only: rays pass through the backs of faces.
        margins: how far each ray may be moved sideways before its answer changes.
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
    rays = _arrays.rays(origins, directions, t_min, t_max, t_blind)
    result = answered(mesh, rays, query, with_, fronts_only, margins, progress)
    for sentence in result.warnings:
        python_warnings.warn(sentence, RaypencilWarning, stacklevel=2)
    return result


def answered(
    mesh: Any,
    rays: _arrays.Rays,
    query: Query | tuple[Query, ...] = "first",
    with_: Caster = "referee",
    fronts_only: bool = False,
    margins: bool = False,
    progress: Progress = False,
) -> CastResult:
    """The answers of :func:`cast` to rays that are formed already, without a warning."""
    if with_ not in ("referee", "tracer"):
        raise RaypencilError(f'with_ is {with_!r}; expected "referee" or "tracer"')
    asked = (query,) if isinstance(query, str) else tuple(query)
    for one in asked:
        if one not in ("first", "any", "all"):
            raise RaypencilError(f'query is {one!r}; expected "first", "any" or "all"')
    by_tracer = with_ == "tracer"
    if by_tracer and (set(asked) != {"first"} or margins):
        raise RaypencilError('with_="tracer" answers query="first" alone, without margins')
    flat_rays, shape = rays
    core = as_mesh(mesh)._core
    with stages(progress) as on_stage:
        flat, warnings = _raypencil.cast(
            core, flat_rays, by_tracer, fronts_only, "any" in asked, "all" in asked, margins, on_stage
        )
    arrays = {
        name: array if name.startswith("all.") else array.reshape(shape + array.shape[1:])
        for name, array in flat.items()
    }
    return CastResult(arrays, shape, tuple(warnings))
