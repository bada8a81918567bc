"""The drop-in for Open3D: the same where Open3D is right, and right where it is not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from raypencil import Mesh, RaypencilError, RaypencilWarning
from raypencil.open3d import RaycastingScene


def tetrahedron(at: float) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float32)
    return corners + np.float32(at), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=np.uint32)


def two() -> RaycastingScene:
    """A tetrahedron at the origin, and one at (2, 2, 2)."""
    scene = RaycastingScene()
    assert (scene.add_triangles(*tetrahedron(0)), scene.add_triangles(Mesh(*tetrahedron(2)))) == (0, 1)
    return scene


def rays(count: int = 400) -> np.ndarray:
    """Rays in general position, in single precision."""
    draw = np.random.default_rng(4)
    origins = draw.uniform(-3, 5, (count, 3))
    targets = draw.uniform(0.05, 0.45, (count, 3)) + 2 * draw.integers(0, 2, (count, 1))
    return np.concatenate([origins, targets - origins], axis=1).astype(np.float32)


def test_first_hits_by_hand() -> None:
    along: Any = [[[0.25, 0.25, -1, 0, 0, 2], [2.25, 2.5, 1, 0, 0, 1]], [[9, 9, 9, 0, 0, 1], [0.1, 0.2, 5, 0, 0, -1]]]
    told = two().cast_rays(along)
    assert told["t_hit"].dtype == np.float64 and told["geometry_ids"].dtype == told["primitive_ids"].dtype == np.uint32
    assert told["t_hit"].tolist()[0] == [0.5, 1.0] and told["t_hit"][1, 0] == np.inf
    assert told["geometry_ids"].tolist() == [[0, 1], [4294967295, 0]] and RaycastingScene.INVALID_ID == 4294967295
    assert told["primitive_ids"].tolist() == [[0, 0], [4294967295, 3]]
    # Face 0 is (0, 2, 1): at (x, y) the weight of its second corner is y, and of its third x.
    assert told["primitive_uvs"].tolist()[0] == [[0.25, 0.25], [0.5, 0.25]] and told["primitive_uvs"][1, 0].tolist() == [0, 0]
    assert told["primitive_normals"].tolist()[0] == [[0, 0, -1], [0, 0, -1]] and told["primitive_normals"].shape == (2, 2, 3)


def test_all_hits_are_listed_by_ray_and_in_order() -> None:
    # Through both bodies, then past both, then through the edge x = 0, y = 0 of the first.
    along: Any = [[0.2, 0.2, -1, 0, 0, 1], [9, 9, 9, 1, 0, 0], [-1, -1, 0.25, 1, 1, 0]]
    told = two().list_intersections(along)
    assert told["ray_splits"].tolist() == [0, 2, 2, 5] and told["ray_ids"].tolist() == [0, 0, 2, 2, 2]
    assert np.allclose(told["t_hit"], [1, 1.6, 1, 1, 1.375]) and told["primitive_ids"].tolist() == [0, 3, 1, 2, 3]
    assert np.allclose(told["primitive_uvs"][0], [0.2, 0.2]) and told["geometry_ids"].tolist() == [0] * 5
    # The edge is one place.
    assert two().count_intersections(along).tolist() == [2, 0, 2]


def test_occlusions_have_ends_that_belong_to_the_rays() -> None:
    scene, down = two(), [[0.25, 0.25, -1, 0, 0, 1]]
    assert scene.test_occlusions(down).tolist() == [True]
    assert [bool(scene.test_occlusions(down, tfar=far)[0]) for far in (0.5, 1.0)] == [False, True]
    assert [bool(scene.test_occlusions(down, tnear=near)[0]) for near in (1.5, 1.6)] == [True, False]


def test_occupancy_is_counted_through_edges_and_corners() -> None:
    scene = RaycastingScene()
    # A lattice of corners, so that points lie in planes of edges.
    steps = np.linspace(-1.5, 1.5, 7)
    points = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    scene.add_triangles(corners, faces)
    inside, outside = (np.abs(points) < 1).all(axis=-1), (np.abs(points) > 1).any(axis=-1)
    told = scene.compute_occupancy(points, nsamples=3)
    assert told.dtype == np.float32 and told.shape == (7, 7, 7)
    assert (told[inside] == 1).all() and (told[outside] == 0).all() and inside.sum() == 27


def test_an_open_mesh_is_told() -> None:
    scene = RaycastingScene(nthreads=1)
    vertices, faces = tetrahedron(0)
    scene.add_triangles(vertices, faces[1:])
    with pytest.warns(RaypencilWarning, match="the meshes have 3 open edges: they have an inside only where they are closed"):
        scene.compute_occupancy([[0.1, 0.1, 0.1]])


def test_what_is_wrong_is_named() -> None:
    with pytest.raises(RaypencilError, match=r"rays have the shape \(2, 8\); expected \(\.\.\., 6\)"):
        two().cast_rays(np.ones((2, 8)))
    with pytest.raises(RaypencilError, match=r"query_points has the shape \(2,\); expected \(\.\.\., 3\)"):
        two().compute_occupancy([1, 2])
    with pytest.raises(RaypencilError, match="threads is -1"):
        two().cast_rays(rays(2), nthreads=-1)
    # A scene of nothing is hit by nothing.
    assert RaycastingScene().count_intersections(rays(3)).tolist() == [0, 0, 0]


def test_where_open3d_is_right_it_says_the_same() -> None:
    o3d: Any = pytest.importorskip("open3d")
    theirs, ours = o3d.t.geometry.RaycastingScene(), two()
    for at in (0, 2):
        theirs.add_triangles(*tetrahedron(at))
    # Next to edges it is in single precision.
    found = ours.list_intersections(rays())
    u, v = found["primitive_uvs"].T
    near = np.unique(found["ray_ids"][np.minimum(np.minimum(u, v), 1 - u - v) < 1e-4])
    some = np.delete(rays(), near, axis=0)
    assert 0 < len(near) < 20
    tensor = o3d.core.Tensor(some)
    first, expected = ours.cast_rays(some), {name: of.numpy() for name, of in theirs.cast_rays(tensor).items()}
    assert set(first) == set(expected)
    for name, of in expected.items():
        assert first[name].shape == of.shape
        assert np.allclose(first[name], of, rtol=1e-4, atol=1e-4), name
    assert np.isfinite(expected["t_hit"]).sum() > 300
    assert np.array_equal(ours.test_occlusions(some, tfar=0.9), theirs.test_occlusions(tensor, tfar=0.9).numpy())
    assert np.array_equal(ours.count_intersections(some), theirs.count_intersections(tensor).numpy())
    listed, expected = ours.list_intersections(some), {name: of.numpy() for name, of in theirs.list_intersections(tensor).items()}
    assert set(listed) == set(expected) and np.array_equal(listed["ray_splits"], expected["ray_splits"])
    # Open3D lists the hits of a ray in no order.
    order = np.lexsort((expected["t_hit"], expected["ray_ids"]))
    for name, of in expected.items():
        if name != "ray_splits":
            assert np.allclose(listed[name], of[order], rtol=1e-4, atol=1e-4), name
    points = np.random.default_rng(5).uniform(-1, 3.5, (500, 3)).astype(np.float32)
    assert np.array_equal(ours.compute_occupancy(points), theirs.compute_occupancy(o3d.core.Tensor(points)).numpy())
