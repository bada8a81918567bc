"""The question as a peer can read it, and its exact answers."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .._cast import cast
from .._errors import RaypencilWarning
from .._judge import WRONG, judge
from .._mesh import Mesh
from ._peer import Hits, Peer, Rays


#: Of a peer that tells no face, so many of the faces next to its hit are tried.
_NEAR = 32

#: The largest coordinate, and the largest end of a ray, that the referee takes.
_LARGEST = 1e30


@contextmanager
def _unwarned() -> Iterator[None]:
    """Hard rays look wrong on purpose."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RaypencilWarning)
        yield


@dataclass(frozen=True, eq=False)
class Question:
    """Mesh and rays, rounded to what a peer reads: what is counted is no fault of its input.

    Attributes:
        mesh, rays: as they are asked, in double precision with the values of the peer's types.
        of: the indices of the rays among those that were given.
    """

    mesh: Mesh
    rays: Rays
    of: NDArray[np.intp]

    @cached_property
    def nearest(self) -> list[frozenset[int]]:
        """The faces at the nearest t of each ray, exactly; none where it misses."""
        if len(self.rays) == 0:
            return []
        with _unwarned():
            found = cast(self.mesh, self.rays, query="all").all
        assert found is not None
        groups = []
        for k in range(len(self.rays)):
            part = found.of(k)
            groups.append(frozenset(found.face[part][found.group[part] == 0].tolist()))
        return groups

    @cached_property
    def t(self) -> NDArray[np.float64]:
        """(n,): the exact t, rounded once; +Inf: no hit."""
        with _unwarned():
            return cast(self.mesh, self.rays).t if len(self.rays) else np.zeros(0)


@dataclass(frozen=True)
class Counts:
    """What became of the rays of a question.

    Attributes:
        rays: how many were asked.
        missed, invented, other: first hits that are none of the nearest ones: none told, one told where there is none,
            another face. Of a peer that tells no face, `other` are ranges that rounding does not excuse.
        wrong: of these, how many are wrong by the rule of `raypencil check`.
        ranges: rays with a right face whose t is wrong by the same rule.
        convention: rays that meet, as the peer has it, a face in whose plane they lie, or one without an area. They are in none of
            the others.
    """

    rays: int = 0
    missed: int = 0
    invented: int = 0
    other: int = 0
    wrong: int = 0
    ranges: int = 0
    convention: int = 0

    @property
    def differing(self) -> int:
        """All first hits that are none of the nearest ones."""
        return self.missed + self.invented + self.other

    def __add__(self, more: Counts) -> Counts:
        return Counts(*(a + b for a, b in zip(self.all, more.all, strict=True)))

    @property
    def all(self) -> tuple[int, ...]:
        """All numbers."""
        return self.rays, self.missed, self.invented, self.other, self.wrong, self.ranges, self.convention


def rounded(array: NDArray[np.float64], arithmetic: str) -> NDArray[np.float64]:
    """Numbers as an arithmetic has them; too large ones become infinite."""
    if arithmetic == "f64":
        return np.array(array, dtype=np.float64)
    with np.errstate(over="ignore"):
        return array.astype(np.float32).astype(np.float64)


def asked(peer: Peer | type[Peer], mesh: Mesh, rays: Rays) -> Question:
    """The question as a peer reads it.

    Rays that start later than at their origin are left out, for no peer takes a t_min of each ray; and those whose numbers its
    type does not have. Where a peer wants directions of length 1, they are made so first, and t is then a length.

    Args:
        peer: whose types decide.
        mesh: any mesh.
        rays: (n, 6) or (n, 8).
    """
    given = np.empty((len(rays), 8))
    given[:, 0:6], given[:, 6], given[:, 7] = rays[:, 0:6], 0.0, np.inf
    if rays.shape[1] == 8:
        given[:, 6:8] = rays[:, 6:8]
    with np.errstate(all="ignore"):
        if peer.is_unit:
            # In two steps: squares of small and of large numbers leave the doubles.
            largest = np.abs(given[:, 3:6]).max(axis=1, keepdims=True)
            parts = given[:, 3:6] / largest
            length = np.sqrt((parts**2).sum(axis=1, keepdims=True))
            given[:, 3:6] = parts / length
            given[:, 7] *= (largest * length)[:, 0]
            # An end that is farther than anything is none.
            given[:, 7] = np.where(given[:, 7] > _LARGEST, np.inf, given[:, 7])
        read = rounded(given, peer.rays_type)
    vertices = rounded(np.asarray(mesh.vertices), peer.mesh_type)
    # As the referee reads them.
    fits = np.isfinite(read[:, 0:6]).all(axis=1) & (np.abs(read[:, 0:3]) <= _LARGEST).all(axis=1) & (read[:, 3:6] != 0).any(axis=1) & (read[:, 6] == 0)
    if not (np.abs(vertices) <= _LARGEST).all():
        return Question(mesh, read[:0], np.zeros(0, dtype=np.intp))
    return Question(Mesh(vertices, mesh.faces), read[fits], np.flatnonzero(fits))


def _normal(mesh: Mesh, face: int) -> list[Fraction]:
    """The normal of a face, as long as twice its area, exactly."""
    a, b, c = ([Fraction(x) for x in corner] for corner in mesh.vertices[mesh.faces[face]].tolist())
    u, v = ([q - p for p, q in zip(a, end, strict=True)] for end in (b, c))
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def has_no_area(mesh: Mesh, face: int) -> bool:
    """Whether the corners of a face lie in a line, exactly."""
    return not any(_normal(mesh, face))


def lies_in_plane(mesh: Mesh, face: int, ray: NDArray[np.float64]) -> bool:
    """Whether a ray lies in the plane of a face, exactly."""
    a, normal = [Fraction(x) for x in mesh.vertices[mesh.faces[face][0]].tolist()], _normal(mesh, face)
    start, way = ([Fraction(x) for x in part] for part in (ray[0:3].tolist(), ray[3:6].tolist()))
    along = sum(n * d for n, d in zip(normal, way, strict=True))
    off = sum(n * (p - q) for n, p, q in zip(normal, a, start, strict=True))
    return along == 0 and off == 0


def _with_a_face(peer: Peer | type[Peer], question: Question, told: Hits, wrong: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Of the hits of a peer that tells no face, those whose t is right on some face, for a ray moved as the rule allows.

    A t alone is compared with that of the faces that the ray itself meets.
    """
    excused = np.zeros(len(wrong), dtype=bool)
    rays = np.flatnonzero(wrong & told.hit)
    if len(rays) == 0:
        return excused
    corners = np.asarray(question.mesh.vertices)[question.mesh.faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    near = []
    for k in rays:
        point = question.rays[k, 0:3] + told.t[k] * question.rays[k, 3:6]
        away = np.maximum(np.maximum(low - point, point - high), 0).max(axis=1)
        near.append(np.argsort(away, kind="stable")[:_NEAR])
    of, face = np.repeat(rays, [len(faces) for faces in near]), np.concatenate(near)
    answers = {"face": face.astype(np.int64), "t": told.t[of]}
    right = judge(question.mesh, question.rays[of], answers, peer.arithmetic, explain=False).classes != WRONG
    excused[of[right]] = True
    return excused


def judged(peer: Peer | type[Peer], question: Question, told: Hits) -> tuple[Counts, NDArray[np.intp]]:
    """Counts a peer's answers, and judges its first hits by the rule of `raypencil check`, at the peer's own arithmetic.

    The counts are followed by the indices of the rays whose first hit is wrong by the rule, among those of the question.

    Args:
        peer: whose arithmetic decides.
        question: what was asked.
        told: what the peer told.
    """
    if len(question.rays) == 0:
        return Counts(), np.zeros(0, dtype=np.intp)
    hit, nearest = told.hit, question.nearest
    is_hit = np.array([bool(faces) for faces in nearest])
    both = judge(question.mesh, question.rays, told.arrays, peer.arithmetic, explain=False).classes == WRONG
    missed, invented = is_hit & ~hit, ~is_hit & hit
    by_convention = np.zeros(len(hit), dtype=bool)
    if told.face is None:
        is_wrong, other = both & ~_with_a_face(peer, question, told, both), is_hit & hit & both
    else:
        other = np.array([h and bool(n) and int(f) not in n for h, f, n in zip(hit, told.face, nearest, strict=True)])
        is_wrong = judge(question.mesh, question.rays, {"face": told.face}, peer.arithmetic, explain=False).classes == WRONG
        for k in np.flatnonzero(invented | other):
            face = int(told.face[k])
            in_plane = peer.meets_in_plane and lies_in_plane(question.mesh, face, question.rays[k])
            by_convention[k] = in_plane or has_no_area(question.mesh, face)
    ranges = both & ~is_wrong & ~(missed | invented | other)
    parts = (missed, invented, other, is_wrong, ranges)
    counts = [len(hit), *(int((one & ~by_convention).sum()) for one in parts), int(by_convention.sum())]
    return Counts(*counts), np.flatnonzero(is_wrong & ~by_convention)
