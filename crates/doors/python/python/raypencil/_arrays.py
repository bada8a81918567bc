"""Arrays as the engine takes them: checked here, so that a message names the argument."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import RaypencilError

#: What stands for no face in an array of faces.
NO_FACE = 4294967295

#: The type of most arrays, which need no look.
_F64 = np.dtype(np.float64)

#: Rays that are copied before Ctrl-C is heard again.
_RAYS_AT_A_TIME = 1 << 17

Shape = tuple[int, ...]

#: Rays as (n, 9), and their own shape.
Rays = tuple[NDArray[np.float64], Shape]


def array(name: str, values: Any) -> NDArray[Any]:
    """Values as an array; tensors of other packages by DLPack, without a copy."""
    if isinstance(values, np.ndarray):
        return values
    if hasattr(values, "__dlpack__") and not isinstance(values, np.generic):
        try:
            return np.from_dlpack(values)
        except (BufferError, RuntimeError, TypeError, ValueError) as error:
            kind = f"{type(values).__module__}.{type(values).__name__}"
            expected = "one in the memory of the processor without a gradient, such as tensor.detach().cpu()"
            raise RaypencilError(f"{name} is a {kind} that is no array here ({error}); expected {expected}") from None
    return np.asarray(values)


def reals(name: str, values: Any) -> NDArray[np.float64]:
    """Numbers of any real type as float64, without a copy where they are so already."""
    if type(values) is np.ndarray and values.dtype is _F64 and values.flags.c_contiguous:
        return values
    numbers = array(name, values)
    if numbers.dtype.kind not in "fiub" and numbers.size:
        raise RaypencilError(f"{name} is of type {numbers.dtype}; expected real numbers")
    return np.ascontiguousarray(numbers, dtype=np.float64).reshape(numbers.shape)


def numbers_of_rays(name: str, values: Any) -> NDArray[Any]:
    """The same, but numbers of single precision stay so: a block of rays is widened when it is put together, which is exact."""
    if type(values) in (np.ndarray, np.memmap) and values.dtype == np.float32:
        return np.asarray(values)
    return reals(name, values)


def vectors(name: str, values: Any) -> NDArray[np.float64]:
    """Vectors of three numbers: (..., 3)."""
    return of_three(name, reals(name, values))


def of_three(name: str, numbers: NDArray[Any]) -> NDArray[Any]:
    """The same array, of vectors (..., 3)."""
    if numbers.ndim == 0 or numbers.shape[-1] != 3:
        raise RaypencilError(f"{name} has the shape {numbers.shape}; expected (..., 3)")
    return numbers


class RayParts:
    """Rays as they were given: parts that are broadcast against each other, and put together where they are needed."""

    __slots__ = ("parts", "shape")

    def __init__(
        self,
        origins: Any,
        directions: Any | None,
        t_min: Any | None = None,
        t_max: Any | None = None,
        t_blind: Any | None = None,
    ) -> None:
        if directions is None:
            together = numbers_of_rays("rays", origins)
            if together.ndim == 0 or together.shape[-1] not in (6, 8, 9):
                raise RaypencilError(f"rays have the shape {together.shape}; expected (..., 6), (..., 8) or (..., 9)")
            origin, direction = together[..., 0:3], together[..., 3:6]
            if together.shape[-1] >= 8:
                if t_min is not None or t_max is not None:
                    raise RaypencilError(f"t_min and t_max are given twice: rays of {together.shape[-1]} numbers have them")
                t_min, t_max = together[..., 6], together[..., 7]
            if together.shape[-1] == 9:
                if t_blind is not None:
                    raise RaypencilError("t_blind is given twice: rays of 9 numbers have it")
                t_blind = together[..., 8]
        else:
            origin = of_three("origins", numbers_of_rays("origins", origins))
            direction = of_three("directions", numbers_of_rays("directions", directions))
        #: Origins and directions (..., 3), then t_min, t_max and t_blind: an array or a number.
        self.parts: tuple[Any, ...] = (
            origin,
            direction,
            0.0 if t_min is None else numbers_of_rays("t_min", t_min),
            np.inf if t_max is None else numbers_of_rays("t_max", t_max),
            0.0 if t_blind is None else numbers_of_rays("t_blind", t_blind),
        )
        #: The shape of the rays.
        self.shape: Shape = origin.shape[:-1]
        if direction.shape != origin.shape or t_min is not None or t_max is not None or t_blind is not None:
            self.shape = self._broadcast()

    def _broadcast(self) -> Shape:
        names = ("origins", "directions", "t_min", "t_max", "t_blind")
        shapes = {name: np.shape(of) for name, of in zip(names, self.parts, strict=True)}
        shapes["origins"], shapes["directions"] = shapes["origins"][:-1], shapes["directions"][:-1]
        if isinstance(self.parts[4], float):
            del shapes["t_blind"]
        try:
            shape = np.broadcast_shapes(*shapes.values())
        except ValueError:
            given = ", ".join(f"{name} {of}" for name, of in shapes.items())
            raise RaypencilError(f"shapes do not fit: {given}; expected shapes that can be broadcast") from None
        return tuple(int(side) for side in shape)

    def whole(self) -> NDArray[np.float64]:
        """All rays, (n, 9)."""
        made = np.empty((math.prod(self.shape), 9))
        # One copy of millions of rays takes a second on a busy machine, and Ctrl-C is heard between two copies only.
        for index, start, stop in blocks(self.shape, _RAYS_AT_A_TIME):
            made[start:stop] = self.block(index)
        return made

    def block(self, index: tuple[Any, ...]) -> NDArray[np.float64]:
        """The rays at an index of slices and whole numbers, (k, 9)."""
        origin, direction, *ends = self.parts
        cut: list[Any] = [np.broadcast_to(of, (*self.shape, 3))[index] for of in (origin, direction)]
        cut += [np.broadcast_to(of, self.shape)[index] if isinstance(of, np.ndarray) else of for of in ends]
        made = np.empty((*cut[0].shape[:-1], 9))
        made[..., 0:3], made[..., 3:6], made[..., 6], made[..., 7], made[..., 8] = cut
        return made.reshape(-1, 9)

    def overlaps(self, other: NDArray[Any]) -> bool:
        """Whether an array lies in memory where the rays do."""
        return any(np.may_share_memory(of, other) for of in self.parts if isinstance(of, np.ndarray))


def blocks(shape: Shape, size: int) -> Iterator[tuple[tuple[Any, ...], int, int]]:
    """Parts of an array of this shape with at most ``size`` cells each: an index, and where its cells begin and end in C order."""
    if not shape:
        yield (), 0, 1
        return
    row = math.prod(shape[1:])
    if row <= size:
        rows = max(1, size // max(1, row))
        for start in range(0, shape[0], rows):
            stop = min(start + rows, shape[0])
            yield (slice(start, stop),), start * row, stop * row
        return
    for at in range(shape[0]):
        for index, start, stop in blocks(shape[1:], size):
            yield (at, *index), at * row + start, at * row + stop


def rays(
    origins: Any,
    directions: Any | None,
    t_min: Any | None = None,
    t_max: Any | None = None,
    t_blind: Any | None = None,
) -> Rays:
    """Rays as (n, 9) with their own shape.

    Origins and directions are (..., 3) each, or, without directions, (..., 6), (..., 8) or (..., 9) together. Everything is
    broadcast against everything else.
    """
    parts = RayParts(origins, directions, t_min, t_max, t_blind)
    return parts.whole(), parts.shape


def given_rays(values: Any) -> Rays:
    """Rays in one argument: an array (..., 6), (..., 8) or (..., 9), or a tuple of the arguments of :func:`rays`."""
    if isinstance(values, tuple):
        if not 2 <= len(values) <= 5:
            raise RaypencilError(f"rays are {len(values)} arrays; expected origins, directions, t_min, t_max, t_blind")
        return rays(*values)
    return rays(values, None)


def dimensions(shape: Shape) -> tuple[str, ...]:
    """The names of the dimensions of rays, for xarray."""
    return {1: ("ray",), 2: ("row", "column")}.get(len(shape)) or tuple(f"axis_{axis}" for axis in range(len(shape)))


def faces(name: str, values: Any) -> NDArray[np.uint32]:
    """Vertex indices: (m, 3), whole numbers of any integer type."""
    indices = array(name, values)
    if indices.size == 0:
        return np.zeros((0, 3), dtype=np.uint32)
    if indices.ndim != 2 or indices.shape[1] != 3:
        raise RaypencilError(f"{name} has the shape {indices.shape}; expected (m, 3)")
    if indices.dtype.kind not in "iu":
        raise RaypencilError(f"{name} is of type {indices.dtype}; expected integers")
    if indices.dtype.kind == "i" and (indices < 0).any() or int(indices.max()) > NO_FACE:
        row = int(np.argmax(((indices < 0) | (indices > NO_FACE)).any(axis=1)))
        raise RaypencilError(f"{name}[{row}] is {indices[row].tolist()}; expected three vertex indices")
    return np.ascontiguousarray(indices, dtype=np.uint32)


def hit_faces(
    name: str, values: ArrayLike, miss: float | None, says_hit: NDArray[np.bool_] | None = None
) -> NDArray[np.int64]:
    """Face indices of hits, flat, -1 where nothing is hit: -1, 4294967295, what is not finite, and ``miss``.

    ``miss`` is a face of rays that hit by other arrays, ``says_hit``.
    """
    numbers = np.asarray(values).ravel()
    if numbers.dtype.kind not in "fiub":
        raise RaypencilError(f"{name} is of type {numbers.dtype}; expected face indices")
    is_miss = (numbers == -1) | (numbers == NO_FACE)
    if numbers.dtype.kind == "f":
        is_miss |= ~np.isfinite(numbers)
    if miss is not None:
        is_miss |= (numbers == miss) & (True if says_hit is None else ~says_hit)
    with np.errstate(invalid="ignore"):
        is_wrong = ~is_miss & ((numbers < 0) | (numbers > NO_FACE) | (numbers != np.floor(numbers)))
    if is_wrong.any():
        cell = int(np.argmax(is_wrong))
        expected = f"0 or a larger whole number; -1 or {NO_FACE} for no hit"
        raise RaypencilError(f"{name}: cell {cell} is {numbers[cell]}; expected {expected}")
    indices = np.where(is_miss, 0, numbers).astype(np.int64)
    indices[is_miss] = -1
    return indices


def frozen(values: Any) -> Any:
    """The arrays of a dictionary, or of a dictionary of them, made read-only."""
    if isinstance(values, np.ndarray):
        values.flags.writeable = False
    elif isinstance(values, Mapping):
        for value in values.values():
            frozen(value)
    return values
