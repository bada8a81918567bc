"""A wrong ray on a large mesh as one on a few faces with short numbers, and its exact answer as fractions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from .._errors import RaypencilError
from .._mesh import Mesh
from ._peer import Hits, Peer, Rays
from ._question import Question, asked, judged

#: How often a peer is asked at most while faces are left out, and while numbers are made shorter.
_TRIES = 400


@dataclass(frozen=True, eq=False)
class Case:
    """One ray on a mesh. Arrays are as the peer reads them."""

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    ray: Rays

    def question(self, peer: Peer) -> Question:
        """The question of one ray."""
        return asked(peer, Mesh(self.vertices, self.faces), self.ray[None])


def wrong_hit(peer: Peer, case: Case) -> Hits | None:
    """What a peer tells for a case, if it is wrong by the rule of `raypencil check`."""
    try:
        question = case.question(peer)
        if len(question.rays) == 0:
            return None
        told = peer.first(question.mesh, question.rays)
        _, wrong = judged(peer, question, told)
    except Exception:  # A peer that refuses a mesh, or that the referee refuses, shows nothing.
        return None
    return told if len(wrong) else None


def _with_faces(case: Case, keep: NDArray[np.intp]) -> Case:
    """A case with some of its faces, and only their corners."""
    used, faces = np.unique(case.faces[keep], return_inverse=True)
    return Case(case.vertices[used], faces.reshape(-1, 3).astype(np.int64), case.ray)


def _fewer_faces(is_wrong: Callable[[Case], bool], case: Case, likely: set[int]) -> Case:
    """Leaves faces out, ever smaller parts of them, as long as the answer stays wrong."""
    few = np.array(sorted(likely), dtype=np.intp)
    if len(few) and is_wrong(_with_faces(case, few)):
        case = _with_faces(case, few)
    size, tries = max(1, len(case.faces) // 2), 0
    while tries < _TRIES:
        start = 0
        while start < len(case.faces) and tries < _TRIES:
            keep = np.concatenate([np.arange(start), np.arange(min(start + size, len(case.faces)), len(case.faces))])
            tries += 1
            if len(keep) and is_wrong(smaller := _with_faces(case, keep)):
                case = smaller
            else:
                start += size
        if size == 1:
            break
        size = max(1, size // 2)
    return case


def _shorter(value: float) -> Iterator[float]:
    """Numbers close to one, of ever more binary digits: short ones are exact in every type, and as fractions."""
    mantissa, power = np.frexp(value)
    for bits in range(1, 21):
        short = float(np.ldexp(np.round(mantissa * 2**bits), power - bits))
        if short == value:
            return
        yield short


def _on_a_grid(is_wrong: Callable[[Case], bool], case: Case, question: Question) -> Case:
    """Moves all corners and both ends of the ray to a grid, as coarse a one as leaves the answer wrong.

    What meets edges and vertices stays on them more often so than number by number.
    """
    t = question.t[0] if np.isfinite(question.t[0]) else 1.0
    target = case.ray[0:3] + t * case.ray[3:6]
    size = float(max(np.abs(case.vertices).max(), np.abs(case.ray[0:3]).max()))
    for power in range(1, 21):
        step = 2.0 ** (np.ceil(np.log2(size)) - power) if size > 0 else 1.0
        start, end = (np.round(point / step) * step for point in (case.ray[0:3], target))
        ray = np.concatenate([start, end - start, [0, np.inf]])
        tried = Case(np.round(case.vertices / step) * step, case.faces, ray)
        if is_wrong(tried):
            return tried
    return case


def _shorter_numbers(is_wrong: Callable[[Case], bool], case: Case) -> Case:
    """Makes numbers shorter, one at a time, as long as the answer stays wrong."""
    tries = 0
    for which in ("ray", "vertices"):
        size = 6 if which == "ray" else case.vertices.size
        for k in range(size):
            array = case.ray if which == "ray" else case.vertices
            for short in _shorter(float(array.flat[k])):
                if (tries := tries + 1) > 2 * _TRIES:
                    return case
                new = array.copy()
                new.flat[k] = short
                tried = Case(case.vertices, case.faces, new) if which == "ray" else Case(new, case.faces, case.ray)
                if is_wrong(tried):
                    case = tried
                    break
    return case


def reduced(peer: Peer, case: Case) -> Case:
    """The fewest faces and the shortest numbers that were found at which a peer is still wrong.

    Raises:
        RaypencilError: it is not wrong at this case alone.
    """
    told = wrong_hit(peer, case)
    if told is None:
        raise RaypencilError(f"{peer.name}: alone the ray is answered rightly")
    likely = set(case.question(peer).nearest[0])
    likely |= set() if told.face is None or told.face[0] < 0 else {int(told.face[0])}

    def is_wrong(one: Case) -> bool:
        return wrong_hit(peer, one) is not None

    small = _fewer_faces(is_wrong, case, likely)
    return _shorter_numbers(is_wrong, _on_a_grid(is_wrong, small, small.question(peer)))


@dataclass(frozen=True)
class Exact:
    """The exact answer: the nearest faces and t, or none."""

    faces: tuple[int, ...]
    t: Fraction | None

    def __str__(self) -> str:
        if self.t is None:
            return "no hit"
        which = " and ".join(map(str, self.faces))
        return f"face{'s' if len(self.faces) > 1 else ''} {which} at t = {self.t}"


Vector = list[Fraction]


def _cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _dot(a: Vector, b: Vector) -> Fraction:
    return sum((p * q for p, q in zip(a, b, strict=True)), Fraction(0))


def _minus(a: Vector, b: Vector) -> Vector:
    return [p - q for p, q in zip(a, b, strict=True)]


def exact(question: Question) -> Exact:
    """The answer to the only ray of a question, by fractions, every face tried; it is compared with the referee's.

    Raises:
        RaypencilError: the referee says otherwise.
    """
    ray = question.rays[0]
    start, way = ([Fraction(x) for x in part] for part in (ray[0:3].tolist(), ray[3:6].tolist()))
    end = None if np.isinf(ray[7]) else Fraction(float(ray[7]))
    found: list[tuple[Fraction, int]] = []
    for number, corners in enumerate(question.mesh.faces.tolist()):
        a, b, c = ([Fraction(x) for x in question.mesh.vertices[k].tolist()] for k in corners)
        normal = _cross(_minus(b, a), _minus(c, a))
        along = _dot(normal, way)
        if along == 0:
            continue
        # The ray passes inside where it has all edges on one side.
        p, q, r = (_minus(corner, start) for corner in (a, b, c))
        sides = [_dot(_cross(u, v), way) for u, v in ((p, q), (q, r), (r, p))]
        t = _dot(normal, p) / along
        if (min(sides) >= 0 or max(sides) <= 0) and t >= 0 and (end is None or t <= end):
            found.append((t, number))
    first = min((t for t, _ in found), default=None)
    faces = tuple(number for t, number in found if t == first)
    if set(faces) != set(question.nearest[0]) or (first is not None and float(first) != question.t[0]):
        raise RaypencilError(f"the referee says {sorted(question.nearest[0])} at {question.t[0]}; by fractions it is {faces} at {first}")
    return Exact(faces, first)
