#!/usr/bin/env python3
"""A renderer in 40 lines of numpy: traces the rays of a pack and writes arrays that `raypencil check` reads.

    python reference/numpy_candidate.py PACK OUT [--dtype float64|float32]
"""
import json, sys, tomllib
from pathlib import Path
import numpy as np

pack, out = Path(sys.argv[1]), Path(sys.argv[2])
real = np.dtype(sys.argv[4] if sys.argv[3:4] == ["--dtype"] else "float64").type  # all arithmetic is done in it
scene = tomllib.loads((pack / "scene.toml").read_text())

# terrain.glb: a JSON chunk, then a binary chunk. All primitives share one list of vertices; faces count through them.
blob = (pack / "terrain.glb").read_bytes()
size = int.from_bytes(blob[12:16], "little")
tree, data = json.loads(blob[20:20 + size]), blob[28 + size:]
def read(index, dtype):
    accessor = tree["accessors"][index]
    start = tree["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.frombuffer(data, dtype, accessor["count"] * {"VEC3": 3, "SCALAR": 1}[accessor["type"]], start).reshape(-1, 3)
parts = tree["meshes"][0]["primitives"]
vertices = (read(parts[0]["attributes"]["POSITION"], "<f4")[:, [0, 2, 1]] * [1, -1, 1]).astype(real)  # (gx, -gz, gy)
faces = np.vstack([read(p["indices"], "<u4") for p in parts])
normals = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])

def trace(o, q, reach):
    """Nearest front of each ray at t >= 1 and R <= reach: its t (inf: none) and face."""
    a, b, c = (vertices[faces[:, k]] - o[:, None] for k in range(3))  # corners seen from the ray's origin
    # The same bits with opposite signs in both faces of an edge, and closed: no ray slips through between them.
    inside = [(np.cross(u, v) * q[:, None]).sum(axis=2) <= 0 for u, v in ((a, b), (b, c), (c, a))]
    facing = (normals * q[:, None]).sum(axis=2)
    t = (normals * a).sum(axis=2) / np.where(facing < 0, facing, np.nan)  # backs are not hit
    met = np.all(inside, axis=0) & (t >= 1) & (t * np.linalg.norm(q, axis=1)[:, None] <= reach)
    t = np.where(met, t, np.inf).astype(real)
    return t.min(axis=1), t.argmin(axis=1)  # of equals the lowest index

sensors = {"camera": scene["camera"]} | {f"beam-{k}": beam for k, beam in enumerate(scene.get("beam", []))}
for name, sensor in sensors.items():
    rays = np.load(pack / f"rays-{name}.npy").astype(real)
    o, q = rays.reshape(-1, 6)[:, :3], rays.reshape(-1, 6)[:, 3:]
    pieces = [slice(k, k + 256) for k in range(0, len(q), 256)]  # some rays at a time, with all faces
    t, face = map(np.concatenate, zip(*(trace(o[k], q[k], real(sensor["max_range_m"])) for k in pieces)))
    hit, length, n = np.isfinite(t), np.linalg.norm(q, axis=1), normals[face]
    t, n = np.where(hit, t, real(np.nan)), n / np.linalg.norm(n, axis=1)[:, None] * np.where(hit, real(1), real(np.nan))[:, None]
    maps = {"range.T": np.where(hit, t * length, real(np.inf)), "P": o + t[:, None] * q, "N": n,
            "depth.Z": np.where(hit, t * real(sensor["focal_length_m" if name == "camera" else "grid_distance_m"]), real(np.inf)),
            "face.I": np.where(hit, face, 4294967295).astype("<u4"), "incidence.V": -(n * q).sum(axis=1) / length}
    (out / name).mkdir(parents=True, exist_ok=True)
    for channel, values in maps.items():
        np.save(out / name / f"{channel}.npy", values.reshape(rays.shape[:2] + values.shape[1:]))
