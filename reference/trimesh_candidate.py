#!/usr/bin/env python3
"""trimesh's ray tracer on the rays of a pack: ranges and faces that `raypencil check` reads.

    python reference/trimesh_candidate.py PACK OUT
    raypencil campaign --terrains 50 --candidate-command 'python reference/trimesh_candidate.py {pack} {out}' -o out/hunt

trimesh (trimesh.ray.ray_triangle, double precision) finds all hits of a ray on both sides of the faces. Which of them counts
is decided here, as the pack's rules say: the nearest front at t >= 1, at most at the sensor's range, and of equally near
ones the lowest face.
"""
import json
import sys
import tomllib
from pathlib import Path

import numpy as np
import trimesh
from trimesh.ray.ray_triangle import RayMeshIntersector

PIECE = 4096  # rays at a time

pack, out = Path(sys.argv[1]), Path(sys.argv[2])
scene = tomllib.loads((pack / "scene.toml").read_text())

# terrain.glb: a JSON chunk, then a binary chunk. All primitives share one list of vertices; faces count through them.
blob = (pack / "terrain.glb").read_bytes()
size = int.from_bytes(blob[12:16], "little")
tree, data = json.loads(blob[20 : 20 + size]), blob[28 + size :]


def read(index, dtype):
    accessor = tree["accessors"][index]
    start = tree["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
    count = accessor["count"] * {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
    return np.frombuffer(data, dtype, count, start).reshape(-1, 3)


parts = tree["meshes"][0]["primitives"]
vertices = read(parts[0]["attributes"]["POSITION"], "<f4")[:, [0, 2, 1]].astype(float) * [1, -1, 1]
faces = np.vstack([read(part["indices"], "<u4") for part in parts]).astype(np.int64)
# Neither welded nor cleaned: faces keep their numbers.
mesh = trimesh.Trimesh(vertices, faces, process=False, validate=False)
corners = vertices[faces]
normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
tracer = RayMeshIntersector(mesh)


def nearest_fronts(origins, directions, reach):
    """Nearest front of each ray at t >= 1 within reach: its t (inf: none) and face."""
    t, face = np.full(len(origins), np.inf), np.full(len(origins), 4294967295, dtype=np.uint32)
    found, ray, points = tracer.intersects_id(origins, directions, multiple_hits=True, return_locations=True)
    if len(found) == 0:
        return t, face
    along = np.einsum("ij,ij->i", points - origins[ray], directions[ray])
    along /= np.einsum("ij,ij->i", directions[ray], directions[ray])
    length = np.linalg.norm(directions[ray], axis=1)
    is_front = np.einsum("ij,ij->i", normals[found], directions[ray]) < 0
    counts = is_front & (along >= 1) & (along * length <= reach)
    # The farthest and highest first, so that the nearest and lowest stays.
    order = np.lexsort((found[counts], along[counts]))[::-1]
    t[ray[counts][order]], face[ray[counts][order]] = along[counts][order], found[counts][order]
    return t, face


sensors = {"camera": scene["camera"]} | {f"beam-{k}": beam for k, beam in enumerate(scene.get("beam", []))}
for name, sensor in sensors.items():
    rays = np.load(pack / f"rays-{name}.npy")
    origins, directions = rays.reshape(-1, 6)[:, :3], rays.reshape(-1, 6)[:, 3:]
    pieces = [slice(k, k + PIECE) for k in range(0, len(origins), PIECE)]
    answers = [nearest_fronts(origins[k], directions[k], sensor["max_range_m"]) for k in pieces]
    t, face = (np.concatenate(column) for column in zip(*answers))
    (out / name).mkdir(parents=True, exist_ok=True)
    with np.errstate(invalid="ignore"):
        ranges = np.where(np.isfinite(t), t * np.linalg.norm(directions, axis=1), np.inf)
    np.save(out / name / "range.T.npy", ranges.reshape(rays.shape[:2]))
    np.save(out / name / "face.I.npy", face.reshape(rays.shape[:2]))
scene_of = json.loads((pack / "manifest.json").read_text())["scene"]
program = {"format": 1, "program": f"trimesh {trimesh.__version__}", "arithmetic": "f64", "scene": scene_of}
(out / "candidate.json").write_text(json.dumps(program))
