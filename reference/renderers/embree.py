"""Embree, through embreex: the range and face of every ray of a pack, and whether the camera sees what a pencil hits.

All arithmetic is Embree's own, in single precision; here are only the rules of the contract that are not a ray
tracer's: rays go through backs and meet nothing before t = 1, and a point is seen if nothing lies between it and the
image plane.
"""

from importlib.metadata import version
from pathlib import Path

import numpy as np
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

from . import maps
from .pack import NO_HIT, Pack, pose

# A point that was computed in single precision is off by some units in the last place of its coordinates; what is met
# on the way to it no nearer to it than this, as a part of 1 + |P|, is the point itself. (Tuned: 32 units.)
SAME_POINT = 32 * 2.0**-24


class Ground:
    """The triangles of a pack in Embree."""

    def __init__(self, pack: Pack):
        self.scene = rtcore_scene.EmbreeScene(robust=True)
        self.vertices, self.faces = pack.vertices, pack.faces
        TriangleMesh(self.scene, self.vertices, self.faces)
        corners = self.vertices.astype(float)[self.faces]
        self.normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    def first(self, origin: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The first face of any side along each ray: its t (inf: none) and number (-1: none)."""
        said = self.scene.run(origin.astype(np.float32), direction.astype(np.float32), output=1)
        face = said["primID"]
        return np.where(face >= 0, said["tfar"].astype(float), np.inf), face

    def first_front(self, origin: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The first front at t >= 1 along each ray. After a back, or a face before t = 1, the ray goes on."""
        t, face = self.first(origin, direction)
        while True:
            is_front = (self.normals[face] * direction).sum(axis=1) < 0
            (passed,) = np.nonzero((face >= 0) & ~(is_front & (t >= 1)))
            if len(passed) == 0:
                return t, face
            start = np.nextafter(t[passed].astype(np.float32), np.float32(np.inf)).astype(float)
            start = start * (1 + 2.0**-22)
            further, face[passed] = self.first(origin[passed] + start[:, None] * direction[passed], direction[passed])
            t[passed] = start + further


def render(pack: Pack, out: Path) -> dict:
    """Writes the maps of every sensor; returns what made them."""
    ground = Ground(pack)
    for name, sensor in pack.sensors().items():
        rays = pack.rays[name].reshape(-1, 6)
        origin, direction = rays[:, :3], rays[:, 3:]
        t, face = ground.first_front(origin, direction)
        reach = t * np.linalg.norm(direction, axis=1)
        is_hit = (face >= 0) & (reach <= sensor["max_range_m"])
        channels = {
            "range.T": np.where(is_hit, reach, np.inf),
            "face.I": np.where(is_hit, face, NO_HIT).astype("<u4"),
        }
        if name != "camera":
            point = origin + np.where(is_hit, t, 0)[:, None] * direction
            channels["visible.V"] = seen(pack, ground, point, face, is_hit).astype("u1")
        shape = pack.rays[name].shape[:2]
        maps.write(out, name, {key: values.reshape(shape) for key, values in channels.items()})
    return {"program": "Embree 4", "versions": {"embreex": version("embreex"), "numpy": np.__version__}}


def seen(pack: Pack, ground: Ground, point: np.ndarray, face: np.ndarray, is_hit: np.ndarray) -> np.ndarray:
    """Whether the camera sees each point: the first thing met from the image plane on is the point's own face."""
    camera = pack.camera
    stand = pose(camera)
    x, y, depth = ((point - stand.position) @ stand.rotation).T
    focal, pitch, principal = camera["focal_length_m"], camera["pixel_pitch_m"], camera["principal_point_px"]
    with np.errstate(divide="ignore", invalid="ignore"):
        column = principal[0] + focal * x / (depth * pitch[0])
        row = principal[1] + focal * y / (depth * pitch[1])
        lands = (column >= 0) & (column < camera["width_px"]) & (row >= 0) & (row < camera["height_px"])
        crossing = stand.position + (point - stand.position) * (focal / depth)[:, None]
    faces_camera = (ground.normals[face] * (stand.position - point)).sum(axis=1) > 0
    candidate = is_hit & (depth > focal) & lands & faces_camera
    result = np.zeros(len(point), bool)
    way = (point - crossing)[candidate]
    t, met = ground.first(crossing[candidate], way)
    short = (1 - t) * np.linalg.norm(way, axis=1)  # how far before the point it is
    near = SAME_POINT * (1 + np.linalg.norm(point[candidate], axis=1))
    result[candidate] = (met < 0) | (met == face[candidate]) | (short <= near)
    return result
