"""Answers to rays."""

from __future__ import annotations

import base64
import html
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _raypencil
from ._errors import RaypencilError, optional

#: The values of a first hit, by the bits of the engine.
VALUES = ("face", "side", "ties", "t", "range", "cos_incidence", "point", "normal", "barycentric")

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
    ``start`` (uint64) has one more than there are rays. The tracer groups hits at the same double, and does not know crossings:
    ``crossing`` is ``None``.
    """

    start: NDArray[np.uint64]
    face: NDArray[np.uint32]
    side: NDArray[np.int8]
    t: NDArray[np.float64]
    group: NDArray[np.uint32]
    crossing: NDArray[np.int32] | None

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


def rays_and_places(hits: AllHits) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """The ray of each hit, and whether the hit is the first of its group."""
    start = hits.start.astype(np.int64)
    index_ray = np.repeat(np.arange(len(start) - 1), start[1:] - start[:-1])
    begins = np.ones(len(index_ray), dtype=bool)
    begins[1:] = (index_ray[1:] != index_ray[:-1]) | (hits.group[1:] != hits.group[:-1])
    return index_ray, begins


def decided_counts(decided: tuple[int, ...] | None) -> dict[str, int] | None:
    """The counts of the engine by their names."""
    return None if decided is None else dict(zip(("filter", "intervals", "exact"), decided, strict=True))


class CastResult:
    """Answers to rays: arrays of the rays' own shape, read-only.

    ``arrays`` has all of them by the names of the command's files (docs/guide/cast.md), and each is an attribute, with ``_``
    for ``.``: ``face``, ``side``, ``ties``, ``t``, ``range``, ``cos_incidence`` of shape (...), ``point``, ``normal``,
    ``barycentric`` of shape (..., 3); ``any`` and ``all``, ``margin_face``, ``margin_surface`` (..., 2) and ``across``
    (..., 2, 3) if they were asked for, else ``None``. A value that was not among those of ``values`` raises RaypencilError.

    ``result[index]`` has the answers of some rays: the index is one of NumPy for an array of the rays' shape.
    """

    __slots__ = ("arrays", "decided", "shape", "warnings")

    def __init__(
        self,
        arrays: dict[str, NDArray[Any]],
        shape: _arrays.Shape,
        warnings: tuple[str, ...] = (),
        decided: dict[str, int] | None = None,
    ) -> None:
        #: The arrays by the names of the command's files.
        self.arrays = arrays
        #: Shape of the rays.
        self.shape = shape
        #: What looks wrong in the rays and their mesh: no ray hits, most hits are backs, the mesh is open where crossings are asked.
        self.warnings = warnings
        #: Of how many rays each arithmetic decided the first hit: ``filter`` (plain float64 with a proven bound), ``intervals``,
        #: ``exact``. ``None`` if no first hit was asked for, from the tracer, and of some of the rays of a result.
        self.decided = decided
        _arrays.frozen(arrays)

    @classmethod
    def _of_engine(
        cls,
        arrays: dict[str, NDArray[Any]],
        shape: _arrays.Shape,
        warnings: list[str],
        decided: tuple[int, ...] | None,
    ) -> CastResult:
        """The same of arrays that are read-only already."""
        result = cls.__new__(cls)
        result.arrays, result.shape, result.warnings = arrays, shape, tuple(warnings)
        result.decided = decided_counts(decided)
        return result

    def _value(self, name: str) -> NDArray[Any]:
        try:
            return self.arrays[name]
        except KeyError:
            has = ", ".join(name for name in self.arrays if name in VALUES) or "none"
            raise RaypencilError(f"{name} was not asked for (values: {has}); expected values=(..., {name!r})") from None

    @property
    def hit(self) -> NDArray[np.bool_]:
        """Whether each ray hits something that is not too near: it has a face and a range."""
        return np.asarray(self.face != _arrays.NO_FACE)

    @property
    def too_near(self) -> NDArray[np.bool_]:
        """Whether the nearest surface stands before the shortest range of the ray's sensor (``t_blind``)."""
        return np.asarray(np.isneginf(self.arrays["range"] if "t" not in self.arrays and "range" in self.arrays else self.t))

    @property
    def face(self) -> NDArray[np.uint32]:
        """The first face that is hit, of several at the same t the lowest; 4294967295: none, or too near."""
        return self._value("face")

    @property
    def side(self) -> NDArray[np.int8]:
        """1 front, -1 back, 0 no hit."""
        return self._value("side")

    @property
    def ties(self) -> NDArray[np.uint32]:
        """Number of faces at exactly this t; 0: no hit. The tracer does not know of ties, and says 1."""
        return self._value("ties")

    @property
    def t(self) -> NDArray[np.float64]:
        """The ray's parameter: the point is o + t d. +Inf: no hit, -Inf: too near."""
        return self._value("t")

    @property
    def range(self) -> NDArray[np.float64]:
        """Distance along the ray, t |d|, in the mesh's unit. +Inf: no hit, -Inf: too near."""
        return self._value("range")

    @property
    def cos_incidence(self) -> NDArray[np.float64]:
        """Cosine of the angle between normal and reversed ray: negative where a back is met, NaN: no hit."""
        return self._value("cos_incidence")

    @property
    def point(self) -> NDArray[np.float64]:
        """(..., 3): the point, in the mesh's unit. NaN: no hit."""
        return self._value("point")

    @property
    def normal(self) -> NDArray[np.float64]:
        """(..., 3): the unit normal to the front of the face. NaN: no hit."""
        return self._value("normal")

    @property
    def barycentric(self) -> NDArray[np.float64]:
        """(..., 3): the weights of the face's three corners. NaN: no hit."""
        return self._value("barycentric")

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
        return AllHits(**{name: self.arrays.get(f"all.{name}") for name in names})  # type: ignore[arg-type]

    def __getitem__(self, index: Any) -> CastResult:
        """The answers of the rays at an index of their shape.

        Args:
            index: one of NumPy: whole numbers, slices, arrays of either or of truth values.

        Raises:
            IndexError: there is no such ray.
        """
        chosen = np.arange(len(self)).reshape(self.shape)[index]
        flat, shape = np.ravel(chosen), np.shape(chosen)
        arrays = {}
        for name, array in self.arrays.items():
            if not name.startswith("all."):
                last = array.shape[len(self.shape) :]
                arrays[name] = array.reshape((len(self), *last))[flat].reshape(shape + last)
        if "all.start" in self.arrays:
            start = self.arrays["all.start"].astype(np.int64)
            counts = start[flat + 1] - start[flat]
            begins = np.concatenate([[0], np.cumsum(counts)])
            entries = np.arange(begins[-1]) + np.repeat(start[flat] - begins[:-1], counts)
            for name, array in self.arrays.items():
                if name.startswith("all."):
                    arrays[name] = begins.astype(np.uint64) if name == "all.start" else array[entries]
        return CastResult(arrays, shape)

    def __len__(self) -> int:
        return int(np.prod(self.shape, dtype=np.int64))

    def __repr__(self) -> str:
        return f"<raypencil.CastResult: {self._counts()}, shape {self.shape}>"

    def _counts(self) -> str:
        if "face" not in self.arrays:
            return f"{len(self)} rays"
        near = int(self.too_near.sum()) if {"t", "range"} & set(self.arrays) else 0
        of_near = f", {near} too near" if near else ""
        return f"{int(self.hit.sum())} of {len(self)} rays hit{of_near}"

    def _repr_html_(self) -> str:
        """A table of the arrays for notebooks, and the ranges as a picture for rays of two dimensions."""
        rows = []
        for name, array in self.arrays.items():
            unit, meaning = _MEANINGS.get(name, ("", "of all hits: see AllHits"))
            known = array[np.isfinite(array)] if array.dtype.kind == "f" else array[:0]
            span = f"{known.min():.6g} to {known.max():.6g}" if known.size else ""
            cells = [name.replace(".", "_", 1), f"{array.dtype} {array.shape}", span, unit, meaning]
            rows.append("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>")
        head = "".join(f"<th>{title}</th>" for title in ("array", "type and shape", "finite values", "unit", "meaning"))
        picture = self._repr_png_()
        shown = f'<img alt="ranges" src="data:image/png;base64,{base64.b64encode(picture).decode()}">' if picture else ""
        warnings = "".join(f"<p>{html.escape(sentence)}</p>" for sentence in self.warnings)
        counts = f"<p>{html.escape(self._counts())}, shape {self.shape}</p>"
        return f"<div>{counts}{warnings}{shown}<table><tr>{head}</tr>{''.join(rows)}</table></div>"

    def __getstate__(self) -> dict[str, Any]:
        return {"arrays": self.arrays, "shape": self.shape, "warnings": self.warnings, "decided": self.decided}

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Arrays of a pickle may be written to.
        self.__init__(**state)  # type: ignore[misc]

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
        if len(self.shape) != 2 or 0 in self.shape or "range" not in self.arrays:
            return None
        return _raypencil.picture(np.ascontiguousarray(self.range), 640, False)
