"""The drop-in for trimesh: the same where trimesh is right, and right where it is not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from raypencil import RaypencilError
from raypencil.trimesh import RayMeshIntersector

trimesh = pytest.importorskip("trimesh")
pytest.importorskip("rtree")

MESHES = {"cube": lambda: trimesh.creation.box(), "sphere": lambda: trimesh.creation.icosphere(subdivisions=2)}


@pytest.fixture(params=MESHES)
def mesh(request: pytest.FixtureRequest) -> Any:
    return MESHES[request.param]()


def rays(count: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """Rays in general position, where trimesh is right; half of them miss."""
    draw = np.random.default_rng(4)
    origins = draw.uniform(-3, 3, (count, 3))
    return origins, draw.uniform(-0.9, 0.9, (count, 3)) - origins


def both(mesh: Any) -> tuple[Any, RayMeshIntersector]:
    return trimesh.ray.ray_triangle.RayMeshIntersector(mesh), RayMeshIntersector(mesh)


def in_order(*arrays: np.ndarray) -> tuple[np.ndarray, ...]:
    """By ray, and then by face."""
    order = np.lexsort((arrays[1], arrays[0]))
    return tuple(array[order] for array in arrays)


def test_first_and_any_are_those_of_trimesh(mesh: Any) -> None:
    theirs, ours = both(mesh)
    first = ours.intersects_first(*rays())
    assert np.array_equal(first, theirs.intersects_first(*rays())) and first.dtype == np.int64 and (first == -1).any()
    hit = ours.intersects_any(*rays())
    assert np.array_equal(hit, theirs.intersects_any(*rays())) and hit.dtype == bool and 20 < hit.sum() < 180
    assert np.array_equal(RayMeshIntersector(mesh, with_="tracer").intersects_first(*rays()), first)


def test_ids_are_those_of_trimesh(mesh: Any) -> None:
    theirs, ours = both(mesh)
    for multiple in (True, False):
        tri, ray = ours.intersects_id(*rays(), multiple_hits=multiple)
        tri_theirs, ray_theirs = theirs.intersects_id(*rays(), multiple_hits=multiple)
        assert tri.dtype == ray.dtype == np.int64
        assert np.array_equal(in_order(ray, tri), in_order(ray_theirs, tri_theirs))
        tri, ray, place = ours.intersects_id(*rays(), return_locations=True, multiple_hits=multiple)
        expected = theirs.intersects_id(*rays(), return_locations=True, multiple_hits=multiple)
        ours_in_order, theirs_in_order = in_order(ray, tri, place), in_order(expected[1], expected[0], expected[2])
        assert np.array_equal(ours_in_order[:2], theirs_in_order[:2])
        assert np.allclose(ours_in_order[2], theirs_in_order[2], rtol=0, atol=1e-9)


def test_locations_are_those_of_trimesh(mesh: Any) -> None:
    theirs, ours = both(mesh)
    place, ray, tri = ours.intersects_location(*rays())
    expected = theirs.intersects_location(*rays())
    assert place.shape == (len(ray), 3) and tri.shape == ray.shape
    a, b = in_order(ray, tri, place), in_order(expected[1], expected[2], expected[0])
    assert np.array_equal(a[:2], b[:2]) and np.allclose(a[2], b[2], rtol=0, atol=1e-9)
    # Of each ray in order from its origin.
    origin = rays()[0]
    distance = np.linalg.norm(place - origin[ray], axis=1)
    assert ((np.diff(distance) >= 0) | (np.diff(ray) > 0)).all()


def test_points_inside_are_those_of_trimesh(mesh: Any) -> None:
    theirs, ours = both(mesh)
    points = np.random.default_rng(1).uniform(-1.2, 1.2, (400, 3))
    inside = ours.contains_points(points)
    assert np.array_equal(inside, theirs.contains_points(points)) and 10 < inside.sum() < 390
    # Turned inside out it encloses the same points.
    turned = trimesh.Trimesh(mesh.vertices, mesh.faces[:, ::-1], process=False)
    assert np.array_equal(RayMeshIntersector(turned).contains_points(points), inside)


def test_an_edge_is_one_place_and_two_triangles() -> None:
    _, ours = both(trimesh.creation.box())
    # Down the middle of the box: through the diagonals of its top and its bottom.
    down = ([[0.0, 0.0, 3.0]], [[0.0, 0.0, -1.0]])
    tri, ray = ours.intersects_id(*down)
    assert ray.tolist() == [0, 0, 0, 0] and len(set(tri.tolist())) == 4
    place, ray, _ = ours.intersects_location(*down)
    assert place.tolist() == [[0, 0, 0.5], [0, 0, -0.5]] and ray.tolist() == [0, 0]
    # From the middle such a ray leaves once, wherever it goes.
    assert ours.contains_points([[0.0, 0.0, 0.0], [0.0, 0.0, 0.6]]).tolist() == [True, False]


def test_what_trimesh_loses_is_found() -> None:
    # A millionth the size: trimesh has a threshold that does not shrink with the mesh.
    small = trimesh.creation.box(extents=[1e-6] * 3)
    theirs, ours = both(small)
    question = ([[2e-7, 1e-7, 3e-6]], [[0.0, 0.0, -1e-6]])
    assert ours.intersects_any(*question).all()
    place, _, _ = ours.intersects_location(*question)
    assert np.allclose(place[:, 2], [5e-7, -5e-7])


def test_a_mesh_that_moves_is_followed() -> None:
    box = trimesh.creation.box()
    box.ray = ours = RayMeshIntersector(box)
    down = ([[0.1, 0.2, 3.0]], [[0.0, 0.0, -1.0]])
    assert box.ray.intersects_location(*down)[0][0, 2] == 0.5
    box.apply_translation([0, 0, 1])
    assert ours.intersects_location(*down)[0][0, 2] == 1.5


def test_no_rays(mesh: Any) -> None:
    ours = RayMeshIntersector(mesh)
    none: np.ndarray = np.zeros((0, 3))
    assert ours.intersects_first(none, none).shape == (0,) and ours.intersects_any([], []).shape == (0,)
    place, ray, tri = ours.intersects_location(none, none)
    assert place.shape == (0, 3) and ray.shape == tri.shape == (0,) and ours.contains_points(none).shape == (0,)
    with pytest.raises(RaypencilError, match=r"expected \(m, 3\) twice"):
        ours.intersects_any([[0, 0, 0]], [[0, 0, 1], [0, 0, 1]])
    with pytest.raises(RaypencilError, match=r"points have the shape"):
        ours.contains_points([0, 0, 0])
