"""Maps of one renderer."""

from __future__ import annotations

import base64
import os
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _raypencil
from ._errors import RaypencilError, optional
from ._progress import Progress, stages
from ._scene import as_scene

#: Unit and meaning of each map.
_MEANINGS = {
    "range": ("m", "distance along the ray, not depth; infinite: no hit"),
    "depth": ("m", "distance along the sensor's normal axis; infinite: no hit"),
    "point": ("m", "hit point, scene frame"),
    "normal": ("1", "unit normal of the face, outward, scene frame"),
    "face": ("1", "index of the face; 4294967295: none"),
    "cos_incidence": ("1", "cosine of the angle between the reversed ray and the normal"),
    "visible": ("1", "whether the camera sees the hit"),
    "pixel": ("1", "column and row of the camera's pixel in which the hit lands; 4294967295: none"),
    "view_depth": ("m", "depth of the hit in the camera; infinite: no hit"),
    "cos_off_axis": ("1", "cosine of the angle between the camera's axis and the ray to the hit"),
    "cos_view": ("1", "cosine of the angle between the normal and the direction to the camera"),
    "flux": ("W", "flux that arrives at the camera"),
}

#: Maps whose cells are vectors, with the names of their parts.
_PARTS = {"point": ("xyz", ["x", "y", "z"]), "normal": ("xyz", ["x", "y", "z"]), "pixel": ("ij", ["i", "j"])}

#: Channels of the command's files.
_CHANNELS = {
    "range": "range.T",
    "depth": "depth.Z",
    "point": "P",
    "normal": "N",
    "face": "face.I",
    "cos_incidence": "incidence.V",
    "visible": "visible.V",
    "view_depth": "view.Z",
    "cos_off_axis": "offAxis.V",
    "cos_view": "emission.V",
}


class RenderResult(Mapping[str, Mapping[str, NDArray[Any]]]):
    """Maps of each sensor: ``result["camera"]["range"]``, ``result["beam-0"]["point"]``. Read-only.

    Arrays are (rows, columns), and row 0 is the top one; ``point`` and ``normal`` have 3 numbers in each cell, ``pixel`` has
    column and row. Numbers are the computed doubles; the command's files have them rounded to single precision.

    ========================== ============================================================== ==================
    of each sensor             meaning, unit                                                  no hit
    ========================== ============================================================== ==================
    ``range``, ``depth``       float64: along the ray, along the axis, m                      infinite
    ``point``, ``normal``      float64 (..., 3): scene frame, m; unit vector                  NaN
    ``face``                   uint32                                                         4294967295
    ``cos_incidence``          float64                                                        NaN
    of a beam
    ``visible``                bool: whether the camera sees the hit                          False
    ``pixel``                  uint32 (..., 2): column, row of the camera's pixel             4294967295
    ``view_depth``             float64: depth in the camera, m                                infinite
    ``cos_off_axis``,          float64: phi and theta of the paper's equations                NaN
    ``cos_view``
    ``flux``                   float64: what arrives in the pixel, W (W/m by equation 1)      0
    of the camera
    ``flux``                   float64 (beams, rows, columns): W (W/m) per pixel              0
    ========================== ============================================================== ==================
    """

    def __init__(self, sensors: dict[str, dict[str, NDArray[Any]]], renderer: str, scene: str, flux_unit: str) -> None:
        self._sensors = _arrays.frozen(sensors)
        #: Name of the renderer.
        self.renderer = renderer
        #: SHA-256 of the scene.
        self.scene_sha256 = scene
        #: ``W`` or ``W/m``.
        self.flux_unit = flux_unit

    def __getitem__(self, sensor: str) -> Mapping[str, NDArray[Any]]:
        found: Mapping[str, NDArray[Any]] = self._sensors[sensor]
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(self._sensors)

    def __len__(self) -> int:
        return len(self._sensors)

    @property
    def camera(self) -> Mapping[str, NDArray[Any]]:
        """The camera's maps."""
        return self["camera"]

    @property
    def beams(self) -> list[Mapping[str, NDArray[Any]]]:
        """The beams' maps."""
        return [maps for sensor, maps in self.items() if sensor.startswith("beam-")]

    @property
    def arrays(self) -> dict[str, NDArray[Any]]:
        """The maps by the channels of a recording (docs/formats/files.md), as :func:`check` takes them."""
        channels: dict[str, NDArray[Any]] = {}
        for sensor, maps in self.items():
            for name, array in maps.items():
                if name == "pixel":
                    channels[f"{sensor}/pixel.I"], channels[f"{sensor}/pixel.J"] = array[..., 0], array[..., 1]
                elif name == "flux" and sensor == "camera":
                    channels.update({f"camera/flux.beam{beam}": image for beam, image in enumerate(array)})
                elif name == "flux":
                    channels[f"{sensor}/flux.V"] = array
                else:
                    channels[f"{sensor}/{_CHANNELS[name]}"] = array
        return channels

    def to_xarray(self, sensor: str = "camera") -> Any:
        """An ``xarray.Dataset`` of one sensor's maps, with the coordinates ``row`` and ``column``, units and meanings.

        Args:
            sensor: ``camera``, ``beam-0``, ...

        Raises:
            RaypencilError: a sensor that is not there.
            ImportError: xarray is not installed: ``pip install raypencil[xarray]``.
        """
        xarray = optional("xarray", "to_xarray()")
        if sensor not in self:
            raise RaypencilError(f"sensor is {sensor!r}; expected one of {', '.join(self)}")
        variables, coordinates = {}, dict[str, Any]()
        rows, columns = self[sensor]["range"].shape if "range" in self[sensor] else (0, 0)
        for name, array in self[sensor].items():
            unit, meaning = _MEANINGS[name]
            dimensions: tuple[str, ...] = ("row", "column")
            if name in _PARTS:
                last, parts = _PARTS[name]
                dimensions, coordinates[last] = (*dimensions, last), parts
            if name == "flux":
                unit = self.flux_unit
                if array.ndim == 3:
                    dimensions, coordinates["beam"] = ("beam", *dimensions), list(range(len(array)))
            rows, columns = array.shape[dimensions.index("row")], array.shape[dimensions.index("column")]
            variables[name] = (dimensions, array, {"units": unit, "long_name": meaning})
        dataset = xarray.Dataset(
            variables,
            {**coordinates, "row": np.arange(rows), "column": np.arange(columns)},
            attrs={
                "renderer": self.renderer,
                "sensor": sensor,
                "scene_sha256": self.scene_sha256,
                "source": f"raypencil {_raypencil.__version__}",
            },
        )
        dataset["row"].attrs["long_name"] = "row; 0 is the top one"
        return dataset

    def picture(self, sensor: str = "camera", name: str = "range") -> bytes:
        """A map of numbers as PNG. Cells without a hit are grey.

        Args:
            sensor: ``camera``, ``beam-0``, ...
            name: of the map. The camera's ``flux`` is the sum over all beams.

        Raises:
            KeyError: a sensor or a map that is not there.
            RaypencilError: a map with several numbers in each cell.
        """
        array = self[sensor][name]
        if name == "flux" and array.ndim == 3:
            array = array.sum(axis=0)
        if array.ndim != 2:
            raise RaypencilError(f"{name} has {array.shape[-1]} numbers in each cell; expected a map of one")
        return _raypencil.picture(np.ascontiguousarray(array, dtype=np.float64), 640, name == "flux")

    def __repr__(self) -> str:
        sizes = ", ".join(f"{sensor} {' x '.join(map(str, maps['range'].shape[::-1]))}" for sensor, maps in self.items())
        return f"<raypencil.RenderResult by {self.renderer}: {sizes}>"

    def _repr_html_(self) -> str:
        parts = []
        for sensor in self:
            data = base64.b64encode(self.picture(sensor)).decode()
            picture = f'<img alt="ranges of {sensor}" style="max-width:100%" src="data:image/png;base64,{data}">'
            parts.append(f"<figure><figcaption>{sensor}, range by {self.renderer}</figcaption>{picture}</figure>")
        return "".join(parts)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        # Arrays of a pickle may be written to.
        _arrays.frozen(self._sensors)


def render(
    scene: Any,
    with_: str = "scanline",
    *,
    switches: Mapping[str, str] | None = None,
    jitter: int | None = None,
    output: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Progress = False,
) -> RenderResult:
    """Renders a scene: everything about every ray of the camera and the beams.

    Args:
        scene: a :class:`Scene`, or a name or path of one.
        with_: ``scanline``, ``scanline-paper``, ``tracer`` or ``referee`` (exact).
        switches: of the scanline renderer: ``{"facing": "paper"}``.
        jitter: a seed: one random ray in each pencil, not the central one. ``tracer`` and ``referee`` can do it.
        output: a folder for the files of the command ``render``.
        force: replace what ``output`` has of another command, or of something else; without it that is an error.
        progress: see :func:`cast`.

    Sets of rays (``[[rays]]``) are answered by ``cast(scene, scene.ray_sets[name].rays)``.

    Raises:
        RaypencilError: a renderer that is not there, or that cannot do what is asked.
    """
    scene = as_scene(scene)
    folder = None if output is None else os.fspath(output)
    with stages(progress) as on_stage:
        sensors = _raypencil.render(scene._core, with_, list((switches or {}).items()), jitter, folder, force, on_stage)
    return RenderResult(sensors, with_, scene.sha256, scene.flux_unit)
