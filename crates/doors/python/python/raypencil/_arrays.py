"""Arrays as the engine takes them: checked here, so that a message names the argument."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import RaypencilError

#: What stands for no face in an array of faces.
NO_FACE = 4294967295

Shape = tuple[int, ...]

#: Rays as (n, 9), and their own shape.
Rays = tuple[NDArray[np.float64], Shape]


def reals(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Numbers of any real type as float64, without a copy where they are so already."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiub" and array.size:
        raise RaypencilError(f"{name} is of type {array.dtype}; expected real numbers")
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def vectors(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Vectors of three numbers: (..., 3)."""
    array = reals(name, values)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise RaypencilError(f"{name} has the shape {array.shape}; expected (..., 3)")
    return array


def rays(
    origins: ArrayLike,
    directions: ArrayLike | None,
    t_min: ArrayLike | None = None,
    t_max: ArrayLike | None = None,
    t_blind: ArrayLike | None = None,
) -> Rays:
    """Rays as (n, 9) with their own shape.

    Origins and directions are (..., 3) each, or, without directions, (..., 6), (..., 8) or (..., 9) together. Everything is
    broadcast against everything else.
    """
    if directions is None:
        together = reals("rays", origins)
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
        origin, direction = vectors("origins", origins), vectors("directions", directions)
    low = reals("t_min", 0.0 if t_min is None else t_min)
    high = reals("t_max", np.inf if t_max is None else t_max)
    blind = reals("t_blind", 0.0 if t_blind is None else t_blind)
    parts = {"origins": origin.shape[:-1], "directions": direction.shape[:-1], "t_min": low.shape, "t_max": high.shape}
    if t_blind is not None:
        parts["t_blind"] = blind.shape
    try:
        shape = np.broadcast_shapes(*parts.values())
    except ValueError:
        given = ", ".join(f"{name} {of}" for name, of in parts.items())
        raise RaypencilError(f"shapes do not fit: {given}; expected shapes that can be broadcast") from None
    made = np.empty((*shape, 9))
    made[..., 0:3], made[..., 3:6], made[..., 6], made[..., 7], made[..., 8] = origin, direction, low, high, blind
    return made.reshape(-1, 9), tuple(int(side) for side in shape)


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


def faces(name: str, values: ArrayLike) -> NDArray[np.uint32]:
    """Vertex indices: (m, 3), whole numbers of any integer type."""
    array = np.asarray(values)
    if array.size == 0:
        return np.zeros((0, 3), dtype=np.uint32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise RaypencilError(f"{name} has the shape {array.shape}; expected (m, 3)")
    if array.dtype.kind not in "iu":
        raise RaypencilError(f"{name} is of type {array.dtype}; expected integers")
    if array.dtype.kind == "i" and (array < 0).any() or int(array.max()) > NO_FACE:
        row = int(np.argmax(((array < 0) | (array > NO_FACE)).any(axis=1)))
        raise RaypencilError(f"{name}[{row}] is {array[row].tolist()}; expected three vertex indices")
    return np.ascontiguousarray(array, dtype=np.uint32)


def hit_faces(name: str, values: ArrayLike, miss: float | None) -> NDArray[np.int64]:
    """Face indices of hits, flat, -1 where nothing is hit: -1, 4294967295, ``miss`` and what is not finite."""
    numbers = np.asarray(values).ravel()
    if numbers.dtype.kind not in "fiub":
        raise RaypencilError(f"{name} is of type {numbers.dtype}; expected face indices")
    is_miss = (numbers == -1) | (numbers == NO_FACE)
    if numbers.dtype.kind == "f":
        is_miss |= ~np.isfinite(numbers)
    if miss is not None:
        is_miss |= numbers == miss
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
