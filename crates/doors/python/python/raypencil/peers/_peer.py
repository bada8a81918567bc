"""What every peer has: one shape, so that all of them are asked and judged by the same rule."""

from __future__ import annotations

import importlib
import time
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as version_of
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .._errors import RaypencilError
from .._judge import Arithmetic
from .._mesh import Mesh

Rays = NDArray[np.float64]
Built = Any

#: What most peers compute on.
PROCESSOR = "processor"


class Unavailable(ImportError):
    """A peer that is not installed: the message says what would install it."""


@dataclass(frozen=True, eq=False)
class Hits:
    """First hits, one for each ray.

    Attributes:
        face: int64, the face's index as the mesh numbers it; -1: no hit. ``None`` where the peer tells no face.
        t: float64, in lengths of the ray's direction; +Inf: no hit.
    """

    face: NDArray[np.int64] | None
    t: NDArray[np.float64]

    @property
    def hit(self) -> NDArray[np.bool_]:
        """Whether each ray hits something."""
        return np.isfinite(self.t) if self.face is None else self.face >= 0

    @property
    def arrays(self) -> dict[str, NDArray[Any]]:
        """As :func:`raypencil.judge` takes them."""
        return {"t": self.t} if self.face is None else {"face": self.face, "t": self.t}


def hits(face: Any, t: Any, rays: Rays, *, is_hit: Any = None) -> Hits:
    """Answers as a peer gives them, with all misses told in one way. A hit beyond the ray's end is none.

    Args:
        face: ``None`` where the peer tells none.
        t: in lengths of the direction.
        rays: (n, 8).
        is_hit: truth values, where the peer tells misses by themselves.
    """
    told = np.asarray(t, dtype=np.float64).reshape(len(rays))
    of_faces = None if face is None else np.asarray(face, dtype=np.int64).reshape(len(rays))
    kept = np.isfinite(told) & (told <= rays[:, 7])
    if of_faces is not None:
        kept &= of_faces >= 0
    if is_hit is not None:
        kept &= np.asarray(is_hit, dtype=bool).reshape(len(rays))
    return Hits(None if of_faces is None else np.where(kept, of_faces, -1), np.where(kept, told, np.inf))


def need(module: str, package: str) -> Any:
    """A module of a peer.

    Raises:
        Unavailable: it is not installed, or something under it is not.
    """
    try:
        return importlib.import_module(module)
    except (ImportError, OSError) as error:
        raise Unavailable(f"{module} cannot be imported ({error}): pip install {package}") from None


class Peer:
    """Another program that answers rays. An adapter is a class with these names.

    What a peer reads decides the question: :func:`raypencil.peers.asked` rounds mesh and rays to it first.
    """

    #: As `raypencil-peers ask` takes it.
    name: ClassVar[str]
    #: As people call it.
    title: ClassVar[str]
    #: The package that brings it, and the registry that has the package.
    package: ClassVar[str]
    registry: ClassVar[str] = "PyPI"
    #: In which arithmetic it decides.
    arithmetic: ClassVar[Arithmetic]
    #: In which types it takes the mesh and the rays.
    mesh_type: ClassVar[Arithmetic]
    rays_type: ClassVar[Arithmetic]
    #: Whether it wants directions of length 1. Then the question has such directions.
    is_unit: ClassVar[bool] = False
    #: Whether it takes segments. A ray without an end becomes one that leaves the mesh's box behind.
    is_segment: ClassVar[bool] = False
    #: Whether a face is met by rays that lie in its plane, as only some have it. Such answers are counted apart.
    meets_in_plane: ClassVar[bool] = False
    #: What it has otherwise than others, a sentence each.
    conventions: ClassVar[tuple[str, ...]] = ()
    #: Why it loses what it loses, as its source has it: a sentence each, with the function and the file.
    causes: ClassVar[tuple[str, ...]] = ()
    #: What a user should do that no threshold says, each a clause.
    advice: ClassVar[tuple[str, ...]] = ()
    #: What helps against a threshold of this peer, by the law and the side, where it is not what helps in general.
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {}
    #: Whether it asks each face without a tree: then it is not asked on large meshes.
    is_brute_force: ClassVar[bool] = False

    def version(self) -> str:
        """The version of its package.

        Raises:
            Unavailable: it is not installed.
        """
        try:
            return version_of(self.package)
        except PackageNotFoundError:
            raise Unavailable(f"{self.package} is not installed: pip install {self.package}") from None

    def device(self) -> str:
        """What it computes on, in words.

        Raises:
            Unavailable: this machine has none.
        """
        return PROCESSOR

    def build(self, mesh: Mesh) -> Built:
        """What it makes of a mesh before it is asked.

        Args:
            mesh: as it reads it.
        """
        raise NotImplementedError

    def shoot(self, built: Built, rays: Rays) -> Hits:
        """The first hits on what a mesh was made into.

        Args:
            built: of :meth:`build`.
            rays: (n, 8), with t_min 0.
        """
        raise NotImplementedError

    def timed(self, built: Built, rays: Rays) -> tuple[Hits, float]:
        """The first hits, and the seconds that they took.

        Args:
            built: of :meth:`build`.
            rays: (n, 8), with t_min 0.
        """
        start = time.perf_counter()
        told = self.shoot(built, rays)
        return told, time.perf_counter() - start

    def first(self, mesh: Mesh, rays: Rays) -> Hits:
        """The first hits.

        Args:
            mesh: as it is; :func:`raypencil.peers.asked` rounds it.
            rays: (n, 8), with t_min 0.
        """
        if len(rays) == 0:
            return Hits(np.zeros(0, dtype=np.int64), np.zeros(0))
        return self.shoot(self.build(mesh), rays)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        """Whether each ray hits anything, by the peer's own call for it; ``None`` where it has none.

        Args:
            mesh: as it reads it.
            rays: (n, 8), with t_min 0.
        """
        return None

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        """All hits of each ray, face and t in order of t, by the peer's own call for it; ``None`` where it has none.

        Args:
            mesh: as it reads it.
            rays: (n, 8), with t_min 0.
        """
        return None


def single(array: NDArray[Any]) -> NDArray[np.float32]:
    """In single precision, contiguous."""
    return np.ascontiguousarray(array, dtype=np.float32)


def segment_length(vertices: NDArray[np.float64], rays: Rays) -> NDArray[np.float64]:
    """(n,): the t at which the segment of each ray ends: its own end, or twice as far as the mesh's farthest corner.

    It is a power of two where the ray has no end, so that t d is exact.
    """
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    reach = np.maximum(np.abs(rays[:, 0:3] - low), np.abs(rays[:, 0:3] - high)).max(axis=1) * 2
    longest = np.abs(rays[:, 3:6]).max(axis=1)
    with np.errstate(all="ignore"):
        power = np.exp2(np.ceil(np.log2(np.maximum(reach, np.finfo(float).tiny)) - np.log2(longest)) + 1)
    return np.where(np.isfinite(rays[:, 7]), rays[:, 7], np.clip(power, 2.0**-900, 2.0**900))


def unknown(name: str, known: list[str]) -> RaypencilError:
    """The error for a name that no peer has."""
    return RaypencilError(f"there is no peer `{name}`; expected one of {', '.join(known)}")
