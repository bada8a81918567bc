"""The drop-in for trimesh: the same where trimesh is right, and right where it is not."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

import raypencil
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


def test_arguments_and_copies_are_those_of_trimesh() -> None:
    box = trimesh.creation.box()
    theirs = pytest.importorskip("trimesh.ray.ray_pyembree", exc_type=ImportError).RayMeshIntersector
    question = ([[0.1, 0.2, 3.0]], [[0.0, 0.0, -1.0]])
    for made in (
        RayMeshIntersector(geometry=box, scale_to_box=False),
        RayMeshIntersector(box, False),
        RayMeshIntersector(box, scale_to_box=True),
    ):
        assert made.mesh is box is theirs(geometry=box, scale_to_box=True).mesh
        assert made.intersects_any(*question).all()
    with pytest.raises(RaypencilError, match="no mesh is given"):
        RayMeshIntersector()
    with pytest.raises(RaypencilError, match="two meshes are given"):
        RayMeshIntersector(box, geometry=box)


def test_a_copy_has_a_mesh_of_its_own_and_the_same_caster() -> None:
    box = trimesh.creation.box()
    box.ray = RayMeshIntersector(box, with_="tracer")
    down = ([[0.1, 0.2, 3.0]], [[0.0, 0.0, -1.0]])
    assert copy.copy(box.ray).mesh is box
    for copied in (box.ray.copy(), copy.deepcopy(box.ray)):
        assert copied.mesh is not box and copied.mesh.ray is copied and copied._with == "tracer"
        copied.mesh.apply_translation([0, 0, 1])
        place, _, _ = copied.intersects_location(*down)
        assert place[0, 2] == 1.5 and box.ray.intersects_location(*down)[0][0, 2] == 0.5
    ours = raypencil.Mesh(box.vertices, box.faces)
    assert copy.deepcopy(RayMeshIntersector(ours)).mesh is ours


# What trimesh's own tests of rays ask (`test_ray`, `test_ray_upstream`), which its package does not bring along: with our rays.


def ours_on(mesh: Any) -> Any:
    mesh.ray = RayMeshIntersector(mesh)
    return mesh


def test_suite_every_vertex_is_hit_from_within() -> None:
    for mesh in (trimesh.creation.box(), trimesh.creation.icosphere(subdivisions=2), trimesh.creation.cylinder(1.0, 2.0)):
        ray = ours_on(mesh).ray
        inside = np.zeros_like(mesh.vertices)
        place, index, _ = ray.intersects_location(inside, mesh.vertices)
        # Each once, at the vertex itself up to rounding.
        assert np.array_equal(index, np.arange(len(mesh.vertices)))
        assert np.allclose(place, mesh.vertices, rtol=0, atol=1e-14)
        tri, index, _ = ray.intersects_id(inside, mesh.vertices, return_locations=True, multiple_hits=False)
        assert all(vertex in mesh.faces[face] for face, vertex in zip(tri, index, strict=True))


def test_suite_every_edge_is_hit_once() -> None:
    mesh = ours_on(trimesh.creation.icosphere(subdivisions=2))
    middles = mesh.vertices[mesh.edges_unique].mean(axis=1)
    outward = middles / np.linalg.norm(middles, axis=1)[:, np.newaxis]
    hit = mesh.ray.intersects_any(3 * outward, -outward)
    first = mesh.ray.intersects_first(3 * outward, -outward)
    assert hit.all() and (first >= 0).all()
    place, index, _ = mesh.ray.intersects_location(3 * outward, -outward)
    assert (np.bincount(index, minlength=len(outward)) == 2).all()
    nearest = place[np.searchsorted(index, np.arange(len(outward)))]
    assert np.linalg.norm(nearest - middles, axis=1).max() < 1e-12


def test_suite_a_grid_over_a_box() -> None:
    box = ours_on(trimesh.creation.box())
    x, y = (axis.ravel() for axis in np.meshgrid(*(np.linspace(-0.75, 0.75, 13),) * 2))
    origins = np.column_stack([x, y, np.full(x.shape, 2.0)])
    directions = np.tile([0.0, 0.0, -1.0], (len(origins), 1))
    within = (np.abs(origins[:, :2]) <= 0.5).all(axis=1)
    # The border of the box belongs to it.
    assert np.array_equal(box.ray.intersects_any(origins, directions), within)
    place, index, _ = box.ray.intersects_location(origins, directions)
    strictly = (np.abs(origins[:, :2]) < 0.5).all(axis=1)
    counts = np.bincount(index, minlength=len(origins))
    assert (counts[strictly] == 2).all() and (counts[~within] == 0).all()
    assert set(np.abs(place[np.isin(index, np.flatnonzero(strictly)), 2])) == {0.5}
    # From behind nothing is hit.
    assert not box.ray.intersects_any(origins, -directions).any()


def test_suite_multiple_hits_begin_with_the_first() -> None:
    mesh = ours_on(trimesh.util.concatenate([trimesh.creation.icosphere(radius=radius) for radius in (1.0, 2.0, 3.0)]))
    origins, directions = rays()
    origins = 4 * origins / np.linalg.norm(origins, axis=1)[:, np.newaxis]
    directions = 0.3 * directions - origins
    tri, index, place = mesh.ray.intersects_id(origins, directions, return_locations=True, multiple_hits=True)
    first, of_ray, nearest = mesh.ray.intersects_id(origins, directions, return_locations=True, multiple_hits=False)
    begins = np.unique(index, return_index=True)[1]
    assert np.array_equal(index[begins], of_ray) and np.array_equal(tri[begins], first)
    assert np.array_equal(place[begins], nearest) and np.bincount(index).max() == 6


def test_an_edge_is_crossed_once_by_the_ray_of_a_point() -> None:
    # A point's ray runs along (0.41, 0.29, 0.87): from the origin exactly through the middle of the first edge, which two faces share,
    # and out through the inside of a face.
    corners = np.array([[0.82, 0, 0.87], [0, 0.58, 0.87], [2, 2, 2], [0.5, 0.1, 3.2]])
    faces = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    ours = RayMeshIntersector(raypencil.Mesh(corners, faces))
    met = raypencil.cast((corners, faces), [0.0, 0, 0], [0.41, 0.29, 0.87], query="all").all
    assert met is not None and met.t[:2].tolist() == [1, 1] and len(met.t) == 3
    assert ours.contains_points([[0, 0, 0], corners.mean(axis=0), [3, 3, 3]]).tolist() == [False, True, False]


def test_suite_contains_follows_a_mesh_that_moves() -> None:
    box = ours_on(trimesh.creation.box(extents=[2, 2, 2]))
    points = np.random.default_rng(3).uniform(-3, 3, (500, 3))
    for shift in ([0, 0, 0], [1, -0.5, 0.25], [1e6, 0, 0]):
        box.apply_translation(shift)
        expected = (np.abs(points - box.center_mass.round(9)) < 1).all(axis=1)
        assert np.array_equal(box.contains(points), expected)
    assert box.contains([[1e6 + 1.0, -0.5, 0.25]]).tolist() == [True]
    for count in (0, 1, 7):
        assert box.contains(points[:count]).shape == (count,)
