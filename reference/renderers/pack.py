"""What a pack asks: sensors, triangles and rays, read from its own files (docs/guide/for-implementers.md)."""

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

NO_HIT = 4294967295


class PackError(Exception):
    """A pack that cannot be read: which file, and what is wrong with it."""


@dataclass
class Part:
    """Triangles of one reflectivity: `faces` of the mesh from number `first` on."""

    first: int
    faces: np.ndarray
    reflectivity: float


@dataclass
class Pose:
    """Where a sensor stands: `rotation` turns its axes (x right, y down, z forward) into the scene's."""

    position: np.ndarray
    rotation: np.ndarray


@dataclass
class Pack:
    """A pack. `rays` has (rows, columns, 6) by sensor; of `beams` and `camera` see docs/guide/scene.md, resolved scenes."""

    folder: Path
    scene: dict
    vertices: np.ndarray
    parts: list[Part]
    rays: dict[str, np.ndarray]

    @property
    def camera(self) -> dict:
        return self.scene["camera"]

    @property
    def beams(self) -> list[dict]:
        return self.scene.get("beam", [])

    @property
    def attenuation(self) -> float:
        """Of the air, in 1/m."""
        return self.scene["atmosphere"]["attenuation_per_m"]

    @property
    def faces(self) -> np.ndarray:
        """Corners of all faces, in the order of `face.I`."""
        return np.vstack([part.faces for part in self.parts])

    def sensors(self) -> dict[str, dict]:
        return {"camera": self.camera} | {f"beam-{k}": beam for k, beam in enumerate(self.beams)}

    def answer(self, sensor: str, channel: str) -> np.ndarray | None:
        """What the pack says is right; nothing in a blind one."""
        path = self.folder / sensor / f"{channel}.npy"
        return np.load(path) if path.exists() else None


def pose(sensor: dict) -> Pose:
    """The pose of a sensor; its quaternion need not be a unit."""
    (held,) = (value for key, value in sensor.items() if key.startswith("scene_from_"))
    x, y, z, w = held["quaternion_xyzw"]
    rotation = np.array([
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]) / (x * x + y * y + z * z + w * w)
    return Pose(np.array(held["position_m"]), rotation)


def read(folder: Path) -> Pack:
    """Reads a pack; PackError tells what is amiss."""
    for name in ("manifest.json", "scene.toml", "terrain.glb"):
        if not (folder / name).is_file():
            raise PackError(f"{folder / name}: no such file; expected a pack, as `raypencil pack` writes it")
    try:
        scene = tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8"))
        vertices, parts = read_terrain(folder / "terrain.glb")
        pack = Pack(folder, scene, vertices, parts, {})
        for sensor in pack.sensors():
            pack.rays[sensor] = np.load(folder / f"rays-{sensor}.npy")
    except (ValueError, KeyError, IndexError, TypeError, OSError) as error:
        # `raypencil check` says what is wrong with a pack; here it is enough that it is none.
        raise PackError(f"{folder}: not a pack as it was written ({type(error).__name__}: {error})") from error
    return pack


def read_terrain(path: Path) -> tuple[np.ndarray, list[Part]]:
    """Vertices as f32 in the scene's axes (exact: an exchange of axes and a sign), and parts by material."""
    blob = path.read_bytes()
    if blob[:4] != b"glTF":
        raise PackError(f"{path}: not a GLB file")
    size = int.from_bytes(blob[12:16], "little")
    tree, data = json.loads(blob[20:20 + size]), blob[28 + size:]

    def accessor(index: int, dtype: str) -> np.ndarray:
        held = tree["accessors"][index]
        start = tree["bufferViews"][held["bufferView"]].get("byteOffset", 0) + held.get("byteOffset", 0)
        count = held["count"] * {"VEC3": 3, "SCALAR": 1}[held["type"]]
        return np.frombuffer(data, dtype, count, start).reshape(-1, 3)

    primitives = tree["meshes"][0]["primitives"]
    gltf = accessor(primitives[0]["attributes"]["POSITION"], "<f4")
    vertices = np.ascontiguousarray(np.stack([gltf[:, 0], -gltf[:, 2], gltf[:, 1]], axis=1))
    parts, first = [], 0
    for primitive in primitives:
        faces = accessor(primitive["indices"], "<u4").astype(np.int32)
        material = tree["materials"][primitive["material"]]
        parts.append(Part(first, faces, material["extras"]["reflectivity"]))
        first += len(faces)
    return vertices, parts
