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

#: On this many faces or fewer other rays at the same point are tried too: the more, the fewer faces there are.
_FEW, _MOST_RAYS = 256, 512


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


def _beside_edges(case: Case, point: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The start of each edge, three for each face, and the place on it next to a point: (3 faces, 3) each."""
    starts, ends = (case.vertices[np.roll(case.faces, k, axis=1)].reshape(-1, 3) for k in (0, 1))
    along = ends - starts
    with np.errstate(all="ignore"):
        part = np.nan_to_num(np.clip(((point - starts) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1))
    return starts, starts + part[:, None] * along


def _aims(case: Case, point: NDArray[np.float64]) -> NDArray[np.float64]:
    """A point, and the corner and the edge next to it, which a ray may have met before they were rounded to the peer's types: (n, 3)."""
    found = [near[np.abs(near - point).max(axis=1).argmin()] for near in _beside_edges(case, point)]
    size = float(np.ptp(case.vertices, axis=0).max())
    return np.stack([point, *(one for one in found if np.abs(one - point).max() < 1e-6 * size)])


def _beside(case: Case, point: NDArray[np.float64]) -> Rays:
    """Rays like that of a case, to the same point or what is next to it, from about there and the same way off: (n, 8)."""
    aims = _aims(case, point)
    way = point - case.ray[0:3]
    distance = float(np.linalg.norm(way))
    count = min(_MOST_RAYS, 64 * _FEW // len(case.faces))
    draw = np.random.default_rng(count)
    # From hardly moved to from anywhere on that side.
    moved = way + distance * np.geomspace(1e-9, 1, count)[:, None] * draw.normal(size=(count, 3))
    rays, ends = np.repeat(case.ray[None], count, axis=0), aims[np.arange(count) % len(aims)]
    rays[:, 0:3] = ends - distance * moved / np.linalg.norm(moved, axis=1, keepdims=True)
    scale = np.linalg.norm(case.ray[3:6]) / distance if distance > 0 else 0.0
    rays[:, 3:6] = (ends - rays[:, 0:3]) * scale
    return rays


def _shown(peer: Peer, case: Case, point: NDArray[np.float64]) -> Case | None:
    """A case at which a peer is wrong: this one, or one with another ray at the same point; ``None``: neither is found.

    Some programs move a mesh to its middle, or sort its faces: with one face less they round otherwise, and this ray is answered
    rightly, but one beside it wrongly.
    """
    if wrong_hit(peer, case) is not None:
        return case
    if len(case.faces) > _FEW:
        return None
    try:
        question = asked(peer, Mesh(case.vertices, case.faces), _beside(case, point))
        _, wrong = judged(peer, question, peer.first(question.mesh, question.rays))
    except Exception:  # As for one ray.
        return None
    others = (Case(case.vertices, case.faces, question.rays[k]) for k in wrong.tolist())
    return next((other for other in others if wrong_hit(peer, other) is not None), None)


def _rings(case: Case, likely: set[int]) -> Iterator[NDArray[np.intp]]:
    """The likely faces, those with their neighbours, and so on: faces that share corners, by place."""
    _, corners = np.unique(case.vertices, axis=0, return_inverse=True)
    places = corners.reshape(-1)[case.faces]
    ring: NDArray[np.bool_] = np.isin(np.arange(len(places)), list(likely))
    while 0 < (count := int(ring.sum())) <= _FEW and count < len(places):
        yield np.flatnonzero(ring)
        wider = np.asarray(np.isin(places, places[ring]).any(axis=1))
        if wider.sum() == count:
            return
        ring = wider


def _fewer_faces(shown: Callable[[Case], Case | None], case: Case, likely: set[int]) -> Case:
    """Leaves faces out, ever smaller parts of them, as long as the answer stays wrong."""
    for ring in _rings(case, likely):
        if (smaller := shown(_with_faces(case, ring))) is not None:
            case = smaller
            break
    size, tries = max(1, len(case.faces) // 2), 0
    while tries < _TRIES:
        start = 0
        while start < len(case.faces) and tries < _TRIES:
            keep = np.concatenate([np.arange(start), np.arange(min(start + size, len(case.faces)), len(case.faces))])
            tries += 1
            if len(keep) and (smaller := shown(_with_faces(case, keep))) is not None:
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
    question = case.question(peer)
    likely = set(question.nearest[0])
    likely |= set() if told.face is None or told.face[0] < 0 else {int(told.face[0])}
    # Where the answers part: at the nearer one.
    point = question.rays[0, 0:3] + min(question.t[0], told.t[0]) * question.rays[0, 3:6]
    if told.face is None and told.t[0] < question.t[0]:
        likely.add(int(np.abs(_beside_edges(case, point)[1] - point).max(axis=1).argmin() // 3))

    def is_wrong(one: Case) -> bool:
        return wrong_hit(peer, one) is not None

    def shown(one: Case) -> Case | None:
        return _shown(peer, one, point)

    small = _fewer_faces(shown, case, likely)
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
