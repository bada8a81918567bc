"""How a peer's answers change with one number: the mesh's size, the distance, the angle, the faces' shape, the direction's length."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .._mesh import Mesh
from ._peer import Peer, Rays
from ._question import asked, judged

_WIDE = 8


@dataclass(frozen=True)
class Law:
    """One number that is swept.

    Attributes:
        name: as the tables have it.
        axis: what the number is.
        values: what is asked, in order.
        ask: mesh and rays for a value. Every ray meets the inside of one face, far from its edges.
        below, above: the words for rays beyond a threshold, with `{}` for it.
        between: those for rays between two of them.
    """

    name: str
    axis: str
    values: tuple[float, ...]
    ask: Callable[[float], tuple[Mesh, Rays]]
    below: str
    above: str
    between: str


@dataclass(frozen=True)
class Threshold:
    """A value beyond which half of the rays or more are wrong.

    Attributes:
        law: the law's name.
        side: whether the rays beyond are those at smaller or at larger values.
        at: the value, by bisection.
        share: of the rays at the next value that was asked how many are wrong, 0 to 1.
        missed: and how many of the wrong ones are misses, 0 to 1.
        to: the value beyond which most rays are right again; ``None``: they are wrong up to the last value that was asked.
    """

    law: str
    side: Literal["below", "above"]
    at: float
    share: float
    missed: float
    to: float | None = None


def bumpy(count: int, height: float = 0.02) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A ground from -0.5 to 0.5 of 2 count^2 faces, with bumps: vertices and faces."""
    ends = np.linspace(-0.5, 0.5, count + 1)
    x, y = (part.ravel() for part in np.meshgrid(ends, ends))
    # Bumps without a random generator, whose numbers may change with its version.
    z = height * (np.sin(13 * x + 5 * y) + np.cos(11 * y - 7 * x)) if height else np.zeros_like(x)
    # In sixteenths of a millionth, so that single precision has them too.
    vertices = np.round(np.stack([x, y, z], axis=1) * 2**20) / 2**20
    first = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    one = np.stack([first, first + 1, first + count + 2], axis=1)
    two = np.stack([first, first + count + 2, first + count + 1], axis=1)
    return vertices, np.stack([one, two], axis=1).reshape(-1, 3)


def _targets(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """A place inside of each fourth face and a neighbour of it, in turns: to prove that an answer is wrong takes long."""
    faces = faces[(np.arange(len(faces)) % 8 < 2)]
    return np.asarray(np.einsum("k,fkx->fx", np.array([0.4, 0.35, 0.25]), vertices[faces]))


def _down(targets: NDArray[np.float64]) -> NDArray[np.float64]:
    """Directions nearly down, 1 long, each its own."""
    number = np.arange(len(targets))
    way = np.stack([0.2 * np.sin(number), 0.2 * np.cos(2 * number), -np.ones(len(targets))], axis=1)
    return np.asarray(way / np.linalg.norm(way, axis=1, keepdims=True))


def _rays(origins: NDArray[np.float64], directions: NDArray[np.float64]) -> Rays:
    ends = np.broadcast_to([0.0, np.inf], (len(origins), 2))
    return np.concatenate([origins, directions, ends], axis=1)


def _of_scale(scale: float) -> tuple[Mesh, Rays]:
    vertices, faces = bumpy(_WIDE)
    targets = _targets(vertices, faces)
    way = _down(targets)
    return Mesh(vertices * scale, faces), _rays((targets - way) * scale, way)


def _of_distance(distance: float) -> tuple[Mesh, Rays]:
    vertices, faces = bumpy(_WIDE)
    targets = _targets(vertices, faces)
    way = _down(targets)
    return Mesh(vertices, faces), _rays(targets - distance * way, way)


def _solid(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Mesh:
    """A flat mesh, with a face aside and below that no ray meets: some peers refuse a mesh without a volume."""
    aside = np.array([[2, 0, -1], [2.125, 0, -1], [2, 0.125, -1.25]])
    return Mesh(np.concatenate([vertices, aside]), np.concatenate([faces, len(vertices) + np.array([[0, 1, 2]])]))


def _of_angle(angle: float) -> tuple[Mesh, Rays]:
    vertices, faces = bumpy(_WIDE, height=0.0)
    targets = _targets(vertices, faces)
    turn = np.arange(len(targets)) * 0.7
    way = np.stack([np.cos(turn) * np.cos(angle), np.sin(turn) * np.cos(angle), np.full(len(turn), -np.sin(angle))], axis=1)
    # The height is that of the direction, so that the ray meets the floor at t = 1 whatever its rounding.
    return _solid(vertices, faces), _rays(targets - way, way)


def _of_aspect(aspect: float) -> tuple[Mesh, Rays]:
    k = np.arange(33)
    left, right = (np.stack([np.full(33, x), k / aspect, np.zeros(33)], axis=1) for x in (0.0, 1.0))
    vertices = np.concatenate([left, right])
    one = np.stack([k[:-1], k[:-1] + 33, k[1:] + 33], axis=1)
    two = np.stack([k[:-1], k[1:] + 33, k[1:]], axis=1)
    faces = np.concatenate([one, two])
    targets = _targets(vertices, faces)
    way = np.broadcast_to([0.0, 0.0, -1.0], targets.shape)
    return _solid(vertices, faces), _rays(targets - way, way)


def _of_length(length: float) -> tuple[Mesh, Rays]:
    vertices, faces = bumpy(_WIDE)
    targets = _targets(vertices, faces)
    way = _down(targets)
    return Mesh(vertices, faces), _rays(targets - way, way * length)


def _decades(first: int, last: int, step: int = 1) -> tuple[float, ...]:
    return tuple(float(f"1e{k}") for k in range(first, last + 1, step))


#: All laws. The meshes are 1 wide, in 128 faces or fewer, and rays begin 1 away, but for what a law changes.
LAWS: dict[str, Law] = {
    law.name: law
    for law in (
        Law(
            "scale", "width of the mesh", _decades(-9, 9), _of_scale,
            "on a mesh narrower than {}", "on a mesh wider than {}", "on a mesh {} to {} wide",
        ),
        Law(
            "distance", "distance from origin to surface, in widths of the mesh", _decades(-9, 9), _of_distance,
            "from nearer to the surface than {} of the mesh's width", "from farther away than {} widths of the mesh",
            "from {} to {} widths of the mesh away",
        ),
        Law(
            "angle", "angle between ray and surface, in radians", _decades(-12, 0), _of_angle,
            "at less than {} radians to the surface", "at more than {} radians to the surface",
            "at {} to {} radians to the surface",
        ),
        Law(
            "aspect", "length over width of the faces", _decades(0, 9), _of_aspect,
            "on faces less than {} times as long as wide", "on faces more than {} times as long as wide",
            "on faces {} to {} times as long as wide",
        ),
        Law(
            "length", "length of the direction", _decades(-30, 30, 3), _of_length,
            "with directions shorter than {}", "with directions longer than {}", "with directions {} to {} long",
        ),
    )
}  # fmt: skip


def share_wrong(peer: Peer, law: Law, value: float) -> tuple[float, float] | None:
    """At one value: the share of wrong rays, by the rule of `raypencil check`, and the share of these that are misses.

    ``None`` where the peer's types do not have the question.
    """
    question = asked(peer, *law.ask(value))
    # A mesh that rounding flattens has no right answer to lose.
    if len(question.rays) == 0 or not any(question.nearest):
        return None
    told = peer.first(question.mesh, question.rays)
    _, wrong = judged(peer, question, told)
    return len(wrong) / len(question.rays), float((~told.hit[wrong]).mean()) if len(wrong) else 0.0


def thresholds(peer: Peer, law: Law, shares: dict[float, tuple[float, float] | None]) -> list[Threshold]:
    """Where half of a law's rays become wrong: once for each side, by ten halvings between two values that were asked.

    Args:
        peer: is asked again, between the values.
        law: one of :data:`LAWS`.
        shares: of each value of the law, by :func:`share_wrong`.
    """
    asked_values = [value for value in law.values if shares.get(value) is not None]

    def is_lost(value: float) -> bool:
        share = shares.get(value) or share_wrong(peer, law, value)
        return share is not None and share[0] >= 0.5

    if not asked_values:
        return []
    # The easy middle: the value nearest to 1 that is answered rightly.
    fine = [value for value in asked_values if not is_lost(value)]
    if not fine:
        return []
    middle = min(fine, key=lambda value: abs(np.log10(value)))
    def border(right: float, lost: float) -> float:
        """The lost value nearest to a right one, by halving their ratio ten times."""
        inner, outer = np.log10(right), np.log10(lost)
        for _ in range(10):
            half = (inner + outer) / 2
            inner, outer = (inner, half) if is_lost(10**half) else (half, outer)
        return float(10**outer)

    found = []
    sides: tuple[Literal["below", "above"], ...] = ("below", "above")
    for side in sides:
        outward = [v for v in sorted(asked_values, reverse=side == "below") if v != middle and (v < middle) == (side == "below")]
        first = next((k for k, value in enumerate(outward) if is_lost(value)), None)
        if first is None:
            continue
        at = border(outward[first - 1] if first else middle, outward[first])
        again = next((k for k in range(first, len(outward)) if not is_lost(outward[k])), None)
        to = None if again is None else border(outward[again], outward[again - 1])
        share, missed = shares[outward[first]] or (0.0, 0.0)
        found.append(Threshold(law.name, side, at, share, missed, to))
    return found


def number(value: float) -> str:
    """Two digits: `2.4e-05`, `0.012`."""
    return f"{value:.2g}"


def parts(one: Threshold) -> tuple[str, str]:
    """A threshold in words, without the peer's name: `misses every ray`, and `on a mesh narrower than 0.01`."""
    law = LAWS[one.law]
    rays = "every ray" if one.share > 0.99 else "nearly every ray" if one.share > 0.9 else "more than half of all rays"
    if one.to is None:
        words = (law.below if one.side == "below" else law.above).format(number(one.at))
    else:
        words = law.between.format(*map(number, sorted((one.at, one.to))))
    return f"{'misses' if one.missed > 0.5 else 'answers wrongly'} {rays}", words


def sentence(found: Sequence[Threshold]) -> str:
    """Thresholds as one sentence: what the page says of a peer."""
    told: dict[str, list[str]] = {}
    for what, words in map(parts, found):
        told.setdefault(what, []).append(words)
    return f"It {listed([f'{what} {listed(words)}' for what, words in told.items()])}."


def listed(words: Sequence[str]) -> str:
    """`one`, `one and two`, `one, two and three`."""
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1]


def explained(found: Sequence[Threshold]) -> str | None:
    """One threshold of a test of triangles that explains several that were found, in a sentence, if they agree on one.

    Möller and Trumbore's test divides by a determinant: the product of two edges, the direction's length and the sine of the
    angle. The edges are 1/8 long where the mesh is 1 wide. A test of planes divides by the product of unit normal and direction,
    in which the mesh's size has no part.
    """
    at = {one.law: one.at for one in found if one.side == "below" and one.to is None}
    edge = 1 / _WIDE
    scale = (at["scale"] * edge) ** 2 if "scale" in at else None
    others = [at[name] for name in ("angle", "length") if name in at]
    if scale is not None and others and _agree([scale, *(other * edge**2 for other in others)]):
        return f"All of these are what a test does that takes a determinant below {_digit(scale)} for 0."
    if len(others) == 2 and _agree(others):
        what = "Angle and length" if len(at) > 2 else "Both"
        return f"{what} are what a test does that takes unit normal times direction below {_digit(others[0])} for 0."
    return None


def _agree(values: Sequence[float]) -> bool:
    return max(values) < 1.3 * min(values)


def _digit(value: float) -> str:
    return f"{float(f'{value:.1g}'):g}"
