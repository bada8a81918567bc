"""Whether an adapter mixes anything up, on a cube whose answers follow by hand."""

from __future__ import annotations

import numpy as np

from .._mesh import Mesh
from ._peer import Peer, Rays
from ._question import asked

#: Corners of the cube from -1 to 1, counted in binary: x, y, z.
_CORNERS = np.array([[2.0 * (k >> 2 & 1) - 1, 2.0 * (k >> 1 & 1) - 1, 2.0 * (k & 1) - 1] for k in range(8)])

#: Two faces for each side, wound counter-clockwise from outside.
_FACES = np.array(
    [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]
)  # fmt: skip


def _rays() -> tuple[Rays, list[int], list[float], list[str]]:
    """Rays, their faces (-1: a miss), their ts, and what each of them is there for."""
    rays, faces, ts, what = [], [], [], []

    def add(origin: object, direction: object, end: float, face: int, t: float, why: str) -> None:
        rays.append([*np.asarray(origin).tolist(), *np.asarray(direction).tolist(), 0.0, end])
        faces.append(face)
        ts.append(t)
        what.append(why)

    for k, corners in enumerate(_CORNERS[_FACES]):
        # No two weights are the same, so that corners that change places show.
        point = np.array([0.5, 0.3125, 0.1875]) @ corners
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0]) / 4
        length = [0.5, 1.0, 4.0][k % 3]
        last = ", which is numbered last" if k == 11 else ""
        add(point + 2 * normal, -length * normal, np.inf, k, 2 / length, f"face {k}{last}, by a direction {length:g} long")
        add(point - normal / 2, length * normal, np.inf, k, 0.5 / length, f"face {k}{last}, from inside: its back")
        add(point + 2 * normal, -length * normal, 1 / length, -1, np.inf, f"a ray that ends before face {k}")
        add(point + 2 * normal, length * normal, np.inf, -1, np.inf, f"a ray away from face {k}: it is behind the origin")
    add([3, 4, 5], [1, -2, 0.5], np.inf, -1, np.inf, "a ray beside the cube")
    return np.array(rays), faces, ts, what


def mixed_up(peer: Peer) -> list[str]:
    """What an adapter answers otherwise than it follows by hand, in a sentence each; none: it mixes nothing up.

    Every face of a cube from outside and from inside, by directions of three lengths; rays that end before, and rays that miss.

    Raises:
        Unavailable: the peer is not installed.
    """
    rays, faces, ts, what = _rays()
    question = asked(peer, Mesh(_CORNERS, _FACES), rays)
    told = peer.first(question.mesh, question.rays)
    wrong = []
    # Where directions were made 1 long, t is a length.
    scale = np.linalg.norm(rays[:, 3:6], axis=1) if peer.is_unit else np.ones(len(rays))
    if told.t.shape != (len(rays),):
        return [f"there are ts of the shape {told.t.shape}; expected ({len(rays)},)"]
    for k, (face, t) in enumerate(zip(faces, ts, strict=True)):
        if bool(told.hit[k]) != (face >= 0):
            wrong.append(f"{what[k]}: {'a hit' if told.hit[k] else 'no hit'}; expected {'a hit' if face >= 0 else 'none'}")
        elif face >= 0 and told.face is not None and told.face[k] != face:
            wrong.append(f"{what[k]}: face {told.face[k]}; expected {face}")
        elif face >= 0 and abs(told.t[k] / (t * scale[k]) - 1) > 1e-5:
            wrong.append(f"{what[k]}: t is {told.t[k]:g}; expected {t * scale[k]:g}")
    is_hit = np.array(faces) >= 0
    # Not all calls for any hit take a ray's end.
    endless = np.isinf(rays[:, 7])
    if (any_hit := peer.any(question.mesh, question.rays)) is not None:
        differing = np.flatnonzero((any_hit != is_hit) & endless)
        wrong += [f"{what[k]}: any hit is {bool(any_hit[k])}; expected {bool(is_hit[k])}" for k in differing]
    if (every := peer.all(question.mesh, question.rays)) is not None:
        for k in np.flatnonzero(endless & is_hit).tolist():
            if not every[k] or every[k][0][0] != faces[k]:
                wrong.append(f"{what[k]}: of all hits the first is {every[k][:1]}; expected face {faces[k]}")
    return wrong
