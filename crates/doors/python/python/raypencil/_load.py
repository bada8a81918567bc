"""What a path or a name stands for."""

from __future__ import annotations

import os

from ._mesh import BUILTIN_NAMES, Mesh, load_mesh
from ._progress import Progress
from ._scene import Scene

_SCENE_ENDINGS = (".toml", ".tif", ".tiff")


def load(source: str | os.PathLike[str], *, progress: Progress = False) -> Mesh | Scene:
    """Loads what a path or a name stands for.

    A built-in name (``pyramids``, ``facets``), a scene file (``.toml``) and an elevation model (``.tif``) are a
    :class:`Scene`. Everything else is a :class:`Mesh`: ``.glb``, ``.gltf``, ``.stl``, ``.obj``, ``.ply``, or a folder with
    ``vertices.npy`` and ``faces.npy``. For a scene with the default rig on a ``.glb``, write ``Scene("ground.glb")``.

    Args:
        source: the path or the name.
        progress: see :func:`cast`.

    Raises:
        RaypencilError: as :class:`Scene` and :func:`load_mesh`.
    """
    path = os.fspath(source)
    if path in BUILTIN_NAMES or path.lower().endswith(_SCENE_ENDINGS):
        return Scene(path, progress=progress)
    return load_mesh(path, progress=progress)
