"""Somebody's answers to rays against the exact ones."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _raypencil
from ._errors import RaypencilError, optional
from ._mesh import as_mesh
from ._progress import Progress, stages

Arithmetic = Literal["f64", "f32"]

#: Numbers in :attr:`Judgement.classes`.
SAME, TIE, ROUNDING, WRONG = 0, 1, 2, 3

_SCALARS = ("t", "range", "side", "cos_incidence")
_VECTORS = ("point", "normal", "barycentric")
#: Names of arrays that answers to rays may have.
KNOWN = ("face", *_SCALARS, *_VECTORS, "hit")

#: Wrong rays, and as many others, on which mistakes are tried.
_TRIED = 1000

#: Rays that are said to hit something and are tried beside these.
_FEW = 50


class Judgement:
    """What became of each ray.

    Attributes:
        classes: uint8, the rays' shape: 0 the same, 1 the same at a tie, 2 rounding (right for a ray that is moved sideways
            by no more than rounding may), 3 wrong.
        moved: float64, (..., 2): the displacement that excuses a ray, along the vectors ``across``; NaN for the others.
        passes: whether no ray is wrong, and some ray meets something.
        headline: the verdict in one line.
        why: the mistake that explains the wrong rays, in words; ``None`` if none does.
        summary: the counts and the worst values, as the command's JSON.
    """

    def __init__(self, flat: Mapping[str, Any], shape: _arrays.Shape, why: str | None) -> None:
        self.classes: NDArray[np.uint8] = flat["verdict"].reshape(shape)
        self.moved: NDArray[np.float64] = flat["moved"].reshape((*shape, 2))
        self.passes: bool = flat["passes"]
        self.headline: str = flat["headline"]
        self.why = why
        self.summary: dict[str, Any] = json.loads(flat["json"])
        self._text: str = flat["text"]
        _arrays.frozen((self.classes)), _arrays.frozen(self.moved)

    @property
    def counts(self) -> dict[str, int]:
        """Numbers of rays: ``same`` (``ties`` among them), ``rounding``, ``wrong``."""
        return dict(self.summary["counts"])

    @property
    def wrong(self) -> NDArray[np.intp]:
        """The indices of the wrong rays, in C order: ``np.unravel_index(wrong, classes.shape)`` has their places."""
        return np.flatnonzero(self.classes == WRONG)

    @property
    def text(self) -> str:
        """All of it in lines."""
        return self._text + (f"  Why: {self.why}.\n" if self.why else "")

    def __bool__(self) -> bool:
        return self.passes

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<raypencil.Judgement: {self.headline}>"

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        # Arrays of a pickle may be written to.
        _arrays.frozen(self.classes), _arrays.frozen(self.moved)

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` of ``classes`` and ``moved``. Raises ImportError without xarray."""
        xarray = optional("xarray", "to_xarray()")
        dimensions = _arrays.dimensions(self.classes.shape)
        of_classes = {"flag_values": [0, 1, 2, 3], "flag_meanings": "same tie rounding wrong", "units": "1"}
        of_moved = {"units": "unit of the mesh", "long_name": "displacement that excuses the ray"}
        return xarray.Dataset(
            {"classes": (dimensions, self.classes, of_classes), "moved": ((*dimensions, "vector"), self.moved, of_moved)},
            {"vector": ["u", "v"]},
            attrs={"source": f"raypencil {_raypencil.__version__}", "verdict": self.headline},
        )


def answers_of(answers: Any) -> Mapping[str, Any]:
    """Answers by the names of their arrays."""
    # A render is a mapping of its own, whose names are not those of files.
    arrays = getattr(answers, "arrays", answers)
    if not isinstance(arrays, Mapping):
        raise RaypencilError(f"answers are of type {type(answers).__name__}; expected a dictionary of arrays")
    return arrays


def _half_units(array: NDArray[Any], parts: int) -> NDArray[np.float64] | None:
    """How far storing may have moved the parts of each value: half a unit in the last place of the largest.

    ``None``: numbers of double precision and whole numbers are what was computed.
    """
    if array.dtype.kind != "f" or array.dtype.itemsize >= 8:
        return None
    sizes = np.where(np.isfinite(array), np.abs(array), 0)
    units = np.where(np.isfinite(array), np.spacing(sizes), 0).astype(np.float64)
    return np.ascontiguousarray(0.5 * units.reshape(-1, parts).max(axis=1))


class _Stated:
    """The arrays as the engine takes them: flat, with misses told; beside them how far storing may have moved each, and their types."""

    def __init__(self) -> None:
        self.arrays: dict[str, Any] = {}
        self.errors: dict[str, NDArray[np.float64]] = {}
        self.types: dict[str, np.dtype[Any]] = {}


def _stated(answers: Mapping[str, Any], shape: _arrays.Shape, miss: float | None, is_own: bool) -> _Stated:
    """The answers, checked."""
    count = int(np.prod(shape, dtype=np.int64))
    unknown = [name for name in answers if name not in KNOWN]
    if unknown and not is_own:
        raise RaypencilError(f"answers: there is no `{unknown[0]}`; expected some of {', '.join(KNOWN)}")
    if not {"face", "t", "range", "hit"} & set(answers):
        raise RaypencilError("answers: expected face, t, range or hit; without one of them it is not said which rays hit")

    def shaped(name: str, last: _arrays.Shape) -> Any:
        array = np.asarray(answers[name])
        if array.shape not in (shape + last, (count, *last)):
            raise RaypencilError(f"answers: {name} has the shape {array.shape}; expected {shape + last}")
        return array

    told = _Stated()
    stated = told.arrays
    means_miss: dict[str, NDArray[np.bool_]] = {}
    for name in (*_SCALARS, *_VECTORS):
        if name not in answers:
            continue
        parts = 3 if name in _VECTORS else 1
        array = _arrays.array(f"answers: {name}", shaped(name, (3,) if name in _VECTORS else ()))
        numbers = _arrays.reals(f"answers: {name}", array).reshape(count, parts)
        error = _half_units(array, parts)
        if error is not None:
            told.errors[name], told.types[name] = error, array.dtype
        is_miss = np.zeros(count, dtype=bool)
        if miss is not None:
            allowed = 0 if error is None else error[:, None]
            with np.errstate(invalid="ignore"):
                is_miss = ((numbers == miss) | (np.abs(numbers - miss) <= allowed)).all(axis=1)
        means_miss[name] = is_miss
        stated[name] = numbers if name in _VECTORS else numbers.reshape(count)
    if "hit" in answers:
        stated["hit"] = _hits_of("answers: hit", shaped("hit", ()).reshape(count))
    # Which rays hit by anything but a face: by their truth value, a distance, or without distances a point.
    hits = np.zeros(count, dtype=bool)
    distances: list[str] = [name for name in ("t", "range") if name in stated]
    for name in distances or ["point"] * ("point" in stated):
        hits |= np.isfinite(stated[name].reshape(count, -1)).all(axis=1) & ~means_miss[name]
    if "hit" in stated:
        hits |= stated["hit"]
    if "face" in answers:
        # Where these say that the ray hits, the number is a face.
        stated["face"] = _arrays.hit_faces("answers: face", shaped("face", ()).reshape(count), miss, hits)
        hits = stated["face"] >= 0
    for name in distances:
        # -Inf is no miss: it says that what is hit is too near.
        is_miss = means_miss[name] & ~hits
        stated[name] = np.where(np.isnan(stated[name]) | is_miss, np.inf, stated[name])
    # Other values of a ray that misses by its own words may be `miss`, too.
    misses = ~_hits(told)
    for name in {"side", "cos_incidence", *_VECTORS} & set(stated):
        is_none = misses & means_miss[name]
        none = 0.0 if name == "side" else np.nan
        stated[name] = np.where(is_none[:, None] if name in _VECTORS else is_none, none, stated[name])
    return told


def _hits_of(name: str, values: NDArray[Any]) -> NDArray[np.bool_]:
    """Truth values, of any type: 0 and 1."""
    if values.dtype.kind not in "fiub":
        raise RaypencilError(f"{name} is of type {values.dtype}; expected truth values")
    is_wrong = (values != 0) & (values != 1)
    if is_wrong.any():
        cell = int(np.argmax(is_wrong))
        raise RaypencilError(f"{name}: cell {cell} is {values[cell]}; expected 1 where the ray hits, 0 where it does not")
    return values.astype(bool)


def _drawn(which: NDArray[np.bool_], most: int = _TRIED) -> NDArray[np.intp]:
    """Some of these rays, drawn alike each time: the first ones are often of one kind, such as sky."""
    found = np.flatnonzero(which)
    return found if len(found) <= most else np.sort(np.random.default_rng(1).choice(found, most, replace=False))


def _hits(stated: _Stated) -> NDArray[np.bool_]:
    """Which rays are said to hit something: a sample without one would look like a program that hits nothing."""
    if "face" in stated.arrays:
        return np.asarray(stated.arrays["face"] >= 0)
    of = stated.arrays.get("t", stated.arrays.get("range"))
    return np.asarray(np.isfinite(of) if of is not None else stated.arrays["hit"])


def _explained(
    core: _raypencil.MeshCore,
    rays: NDArray[np.float64],
    stated: _Stated,
    classes: NDArray[np.uint8],
    arithmetic: str,
    fronts_only: bool,
) -> str | None:
    """The mistake that explains the wrong rays, tried on some of them and on some others."""
    some = np.concatenate([_drawn(classes == WRONG), _drawn(classes != WRONG), _drawn(_hits(stated), _FEW)])
    with tempfile.TemporaryDirectory() as folder:
        pack, candidate = Path(folder, "pack"), Path(folder, "answers")
        candidate.mkdir()
        _raypencil.pack_rays(core, np.ascontiguousarray(rays[some]), [len(some)], pack, fronts_only)
        for name, array in stated.arrays.items():
            np.save(candidate / f"{name}.npy", array[some].astype(stated.types.get(name, array.dtype)))
        why = _raypencil.check(pack, candidate, [], None, arithmetic)["why"]
    return None if why is None else said(why)


def said(why: str) -> str:
    """A mistake in the words of this package: its arguments are no options of a command."""
    return why.replace("--arithmetic f32", 'arithmetic="f32"').replace("--miss ", "miss=").replace(".npy", "")


def judge(
    mesh: Any,
    rays: Any,
    answers: Any,
    arithmetic: Arithmetic = "f64",
    *,
    fronts_only: bool = False,
    miss: float | None = None,
    name: str = "answers",
    explain: bool = True,
    progress: Progress = False,
) -> Judgement:
    """Compares one's own first hits with the exact ones, ray by ray.

    Args:
        mesh: as in :func:`cast`.
        rays: (..., 6), (..., 8) or (..., 9), or a tuple of origins, directions, and if wanted t_min, t_max, t_blind.
        answers: a dictionary with some of ``face``, ``t``, ``range``, ``side``, ``point``, ``normal``, ``barycentric``,
            ``cos_incidence``, as :class:`CastResult` has them, in any type; or a :class:`CastResult`. One of ``face``, ``t``,
            ``range`` and ``hit`` must be there: ``hit`` alone is a test of occlusion, which says whether anything is hit and not
            what. A ray misses where the face is -1 or 4294967295, where t or range is +Inf or NaN,
            where either is ``miss`` and neither face nor hit says otherwise, and where ``hit`` (truth values) says so; all must
            say the same, and no other value of such a ray may be a number but ``miss``. Where t and range are -Inf, what is hit
            is too near for the ray's sensor.
        arithmetic: the arithmetic that they were computed in. The type of each array is taken into account beside it: half a
            unit in its last place.
        fronts_only: whether only fronts of faces were to be hit.
        miss: a number that means no hit, rounded as each array holds it.
        name: a name for the messages.
        explain: where rays are wrong, look for the mistake that explains them (:attr:`Judgement.why`).
        progress: see :func:`cast`.

    Raises:
        RaypencilError: as :func:`cast`; arrays of another shape; answers that do not say which rays hit.
    """
    of_rays, shape = _arrays.given_rays(rays)
    stated = _stated(answers_of(answers), shape, miss, is_own=not isinstance(answers, Mapping))
    core = as_mesh(mesh)._core
    with stages(progress) as on_stage:
        flat = _raypencil.judge(
            core, of_rays, name, arithmetic, fronts_only, **stated.arrays, stored=stated.errors, on_stage=on_stage
        )
        why = None
        if explain and (flat["verdict"] == WRONG).any():
            if on_stage is not None:
                on_stage("looking for a mistake that explains the wrong rays")
            why = _explained(core, of_rays, stated, flat["verdict"], arithmetic, fronts_only)
    return Judgement(flat, shape, why)
