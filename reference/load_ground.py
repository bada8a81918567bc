#!/usr/bin/env python3
"""A glTF loader in 50 lines of numpy: reads the ground of an input pack and writes the triangles for `raypencil check`.

    python reference/load_ground.py PACK OUT
"""
import json, sys
from pathlib import Path
import numpy as np

pack, out = Path(sys.argv[1]), Path(sys.argv[2])
blob = (pack / "ground.glb").read_bytes()
size = int.from_bytes(blob[12:16], "little")
tree, data = json.loads(blob[20:20 + size]), blob[28 + size:]

def read(index):
    """The elements of an accessor: vertices (count, 3), or indices (count)."""
    accessor = tree["accessors"][index]
    view = tree["bufferViews"][accessor["bufferView"]]
    dtype = np.dtype({5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}[accessor["componentType"]])
    width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", width * dtype.itemsize)
    cells = np.ndarray((accessor["count"], width), dtype, data, start, (stride, dtype.itemsize))
    return cells[:, 0] if width == 1 else cells

def local(node):
    """A node's transform to its parent's axes."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T  # stored column by column
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    turn = np.array([[w*w + x*x - y*y - z*z, 2 * (x*y - w*z), 2 * (x*z + w*y)],
                     [2 * (x*y + w*z), w*w - x*x + y*y - z*z, 2 * (y*z - w*x)],
                     [2 * (x*z - w*y), 2 * (y*z + w*x), w*w - x*x - y*y + z*z]])
    matrix = np.eye(4)
    matrix[:3, :3] = turn * node.get("scale", (1, 1, 1))  # scaled first, then turned
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix

def corners(mode, indices):
    """The triangles of a primitive as rows of indices (glTF 2.0, 3.7.2.1)."""
    n = len(indices)
    if mode == 4:
        return indices.reshape(-1, 3)
    if mode == 5:
        return np.array([[indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]] for i in range(n - 2)])
    if mode == 6:
        return np.array([[indices[i + 1], indices[i + 2], indices[0]] for i in range(n - 2)])
    return np.empty((0, 3), int)  # points and lines

triangles, reflectivities = [], []
def draw(index, parent):
    node = tree["nodes"][index]
    matrix = parent @ local(node)
    for primitive in tree["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
        points = read(primitive["attributes"]["POSITION"])
        points = (points @ matrix[:3, :3].T + matrix[:3, 3])[:, [0, 2, 1]] * [1, -1, 1]  # y up becomes z up
        indices = read(primitive["indices"]) if "indices" in primitive else np.arange(len(points))
        faces = corners(primitive.get("mode", 4), indices)
        if np.linalg.det(matrix[:3, :3]) < 0:
            faces = faces[:, [0, 2, 1]]  # a mirror turns the outside in
        triangles.append(points[faces].reshape(-1, 9))
        material = tree["materials"][primitive["material"]] if "material" in primitive else {}
        colour = material.get("pbrMetallicRoughness", {}).get("baseColorFactor")
        grey = 0.25 if colour is None else np.dot(colour[:3], (0.2126, 0.7152, 0.0722))
        reflectivities.extend([material.get("extras", {}).get("reflectivity", grey)] * len(faces))
    for child in node.get("children", []):
        draw(child, matrix)

for root in tree["scenes"][tree["scene"]]["nodes"]:
    draw(root, np.eye(4))
out.mkdir(parents=True, exist_ok=True)
np.save(out / "triangles.npy", np.vstack(triangles))
np.save(out / "reflectivity.npy", np.array(reflectivities)[:, None])
