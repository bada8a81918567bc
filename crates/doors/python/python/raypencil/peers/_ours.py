"""raypencil's own tracer and referee, asked and judged as the others are."""

from __future__ import annotations

import warnings
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from .._cast import cast
from .._errors import RaypencilWarning
from .._judge import Arithmetic
from .._mesh import Mesh
from .._raypencil import __version__
from ._peer import Built, Hits, Peer, Rays, hits


class Tracer(Peer):
    """`cast(..., with_="tracer")`."""

    name, title, package, registry = "tracer", "raypencil's tracer", "raypencil", "here"
    arithmetic: ClassVar[Arithmetic] = "f64"
    mesh_type: ClassVar[Arithmetic] = "f64"
    rays_type: ClassVar[Arithmetic] = "f64"
    caster: Literal["tracer", "referee"] = "tracer"

    def version(self) -> str:
        return __version__

    def build(self, mesh: Mesh) -> Built:
        return mesh

    def shoot(self, built: Built, rays: Rays) -> Hits:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RaypencilWarning)
            told = cast(built, rays, with_=self.caster)
        return hits(told.face.astype(np.int32).astype(np.int64), told.t, rays, is_hit=told.hit)

    def any(self, mesh: Mesh, rays: Rays) -> NDArray[np.bool_] | None:
        told = cast(mesh, rays, query="any").any
        assert told is not None
        return told.astype(bool)


class Referee(Tracer):
    """`cast`, which is exact: here for what it costs in time."""

    name, title = "referee", "raypencil's referee"
    caster = "referee"
