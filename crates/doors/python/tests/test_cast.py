"""Rays: the command's files bit for bit, and answers that follow by hand."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DATA, Command, random_rays, same_bits

import raypencil
from raypencil import Mesh, RaypencilError, cast

#: Without the names of all hits, which have no value for each ray.
FIRST = ["face", "side", "ties", "t", "range", "cos_incidence", "point", "normal", "barycentric"]


@pytest.mark.parametrize("flags", [(), ("--any", "--all", "--margins"), ("--fronts-only", "--all")])
def test_every_array_is_the_commands_file(cube: Mesh, command: Command, tmp_path: Path, flags: tuple[str, ...]) -> None:
    # 60 x 5 rays: an axis that is transposed shows.
    rays = random_rays(300).reshape(60, 5, 8)
    np.save(tmp_path / "rays.npy", rays)
    command("cast", DATA / "rays/cube.obj", "rays.npy", *flags, "-o", "out")
    query: Any = tuple(name for name in ("any", "all") if f"--{name}" in flags)
    answers = cast(
        cube, rays, query=query or "first", margins="--margins" in flags, fronts_only="--fronts-only" in flags
    )
    files = {path.stem: np.load(path) for path in (tmp_path / "out").glob("*.npy")}
    assert sorted(files) == sorted(answers.arrays)
    for name, file in files.items():
        assert same_bits(answers.arrays[name], file), name
    assert 0 < answers.hit.sum() < 300 and answers.shape == (60, 5)


def test_the_tracer_is_the_commands_tracer(cube: Mesh, command: Command, tmp_path: Path) -> None:
    rays = random_rays(200)
    np.save(tmp_path / "rays.npy", rays)
    command("cast", DATA / "rays/cube.obj", "rays.npy", "--with", "tracer", "-o", "out")
    answers = cast(cube, rays, with_="tracer")
    assert same_bits(answers.face, np.load(tmp_path / "out/tracer.face.npy"))
    assert list(answers.arrays) == FIRST and (answers.ties[answers.hit] == 1).all()


def test_origins_and_directions_are_the_rays_in_two_parts(cube: Mesh) -> None:
    rays = random_rays(40).reshape(8, 5, 8)
    together = cast(cube, rays)
    apart = cast(cube, rays[..., 0:3], rays[..., 3:6], t_min=rays[..., 6], t_max=rays[..., 7])
    without_ends = cast(cube, rays[..., 0:6])
    assert all(same_bits(together.arrays[name], apart.arrays[name]) for name in FIRST)
    assert same_bits(cast(cube, rays[..., 0:3], rays[..., 3:6]).t, without_ends.t)
    # The ends matter.
    assert (without_ends.hit != together.hit).any()


def test_one_ray_by_hand(cube: Mesh) -> None:
    # From z = 3 down by 2 for each t: the top at z = 1 is met at t = 1, 2 from the origin.
    answers = cast(cube, [0.25, 0.5, 3], [0, 0, -2], query=("any", "all"), margins=True)
    assert answers.shape == () and answers.t.shape == () and answers.point.shape == (3,)
    assert (float(answers.t), float(answers.range), int(answers.side), int(answers.ties)) == (1.0, 2.0, 1, 1)
    assert answers.point.tolist() == [0.25, 0.5, 1.0] and answers.normal.tolist() == [0, 0, 1]
    assert float(answers.cos_incidence) == 1.0 and answers.any is not None and int(answers.any) == 1
    # The bottom at z = -1 is left at t = 2.
    assert answers.all is not None and answers.all.t.tolist() == [1.0, 2.0]
    assert answers.all.crossing is not None and answers.all.crossing.tolist() == [1, -1] and answers.all.side.tolist() == [1, -1]
    # The diagonal x = y of the top is 0.25 / sqrt(2) away, and the sides x = 1 and y = 1 are 0.75 and 0.5.
    assert answers.margin_surface is not None and answers.margin_surface.shape == (2,)
    assert answers.margin_surface[0] <= 0.5 <= answers.margin_surface[1] * (1 + 1e-12)
    assert answers.across is not None and answers.across.shape == (2, 3)


def test_the_ends_of_a_ray_belong_to_it(cube: Mesh) -> None:
    def hits(**ends: float) -> bool:
        return bool(cast(cube, [0.25, 0.5, 3], [0, 0, -2], **ends).hit)  # type: ignore[arg-type]

    below = float(np.nextafter(1.0, 0.0))
    assert hits(t_max=1.0) and not hits(t_max=below)
    # After the top the bottom is met at t = 2.
    assert hits(t_min=2.0) and not hits(t_min=2.0 + 1e-15, t_max=9.0)


def test_what_is_before_the_shortest_range_is_too_near(cube: Mesh) -> None:
    # The top at z = 1 is met at t = 1, the bottom at t = 2, by a ray down by 2 for each t; the last ray misses.
    origins = np.array([[0.25, 0.5, 3], [0.25, 0.5, 3], [9, 9, 3]])
    blind = [1.5, 1.0, 1.5]
    answers = cast(cube, origins, [0, 0, -2], t_blind=blind, query=("any", "all"), margins=True)
    assert answers.too_near.tolist() == [True, False, False] and answers.hit.tolist() == [False, True, False]
    assert answers.t.tolist() == [-np.inf, 1.0, np.inf] and answers.range.tolist() == [-np.inf, 2.0, np.inf]
    assert answers.face[0] == answers.face[2] == 4294967295 and np.isnan(answers.point[0]).all()
    assert "1 of 3 rays hit, 1 too near" in repr(answers)
    # Where the ray meets the mesh is another question; a start of the ray is another ray.
    assert answers.any is not None and answers.any.tolist() == [1, 1, 0]
    assert answers.all is not None and answers.all.t[answers.all.of(0)].tolist() == [1.0, 2.0]
    assert cast(cube, origins[0], [0, 0, -2], t_min=1.5).t == 2.0
    rays = np.array([[*origin, 0, 0, -2, 0, np.inf, t] for origin, t in zip(origins, blind, strict=True)])
    assert same_bits(cast(cube, rays).t, answers.t) and same_bits(cast(cube, rays, with_="tracer").t, answers.t)


def test_a_ray_through_the_diagonal_ties(cube: Mesh) -> None:
    answers = cast(cube, [[0, 0, 3]], [[0, 0, -1]])
    assert answers.ties.tolist() == [2] and answers.face.tolist() == [10]


def test_rays_are_broadcast(cube: Mesh) -> None:
    directions = np.stack(np.broadcast_arrays(np.linspace(-0.3, 0.3, 5), np.linspace(-0.2, 0.2, 4)[:, None], -1.0), axis=-1)
    answers = cast(cube, [0.01, 0.02, 3.0], directions, t_max=np.array([[9.0], [9.0], [9.0], [0.5]]))
    assert answers.shape == (4, 5) and answers.point.shape == (4, 5, 3)
    assert answers.hit[:3].all() and not answers.hit[3].any()
    # Column by column the point moves in x, row by row in y.
    assert (np.diff(answers.point[:3, :, 0], axis=1) > 0).all() and (np.diff(answers.point[:3, :, 1], axis=0) > 0).all()


def test_strides_and_types_do_not_matter(cube: Mesh) -> None:
    rays = random_rays(30)
    expected = cast(cube, rays)
    wide = np.zeros((60, 16))
    wide[::2, ::2] = rays
    frozen = rays.copy()
    frozen.flags.writeable = False
    sames: list[Any] = [wide[::2, ::2], np.asfortranarray(rays), rays.astype(">f8"), rays[::-1][::-1], rays.tolist(), frozen]
    for same in sames:
        answers = cast(cube, same)
        assert all(same_bits(expected.arrays[name], answers.arrays[name]) for name in FIRST)
    # float32 is another question.
    single = cast(cube, rays.astype(np.float32))
    assert same_bits(single.t, cast(cube, rays.astype(np.float32).astype(float)).t)


def test_no_rays_are_no_answers(cube: Mesh) -> None:
    for shape in [(0, 8), (3, 0, 6)]:
        answers = cast(cube, np.zeros(shape), query=("any", "all"), margins=True)
        assert answers.shape == shape[:-1] and answers.point.shape == (*shape[:-1], 3)
        assert answers.all is not None and answers.all.start.tolist() == [0]
    assert cast(cube, np.zeros((0, 3)), np.zeros((0, 3)), with_="tracer").t.shape == (0,)


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        (([[0, 0, 0]], [[0, 0, 0]]), {}, r"rays\[0\].direction is .*not all 0"),
        (([[0, 0, 0], [0, np.nan, 0]], [0, 0, 1]), {}, r"rays\[1\].origin is .*NaN.*three finite numbers"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"t_min": -1}, r"rays\[0\].t_min is -1: expected 0 to 1e30"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"t_min": 2, "t_max": 1}, r"rays\[0\].t_max is 1"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"t_max": np.nan}, r"t_max is NaN"),
        (([0, 0], [0, 0, 1]), {}, r"origins has the shape \(2,\); expected \(\.\.\., 3\)"),
        ((np.zeros((4, 3)), np.ones((5, 3))), {}, r"shapes do not fit: origins \(4,\), directions \(5,\)"),
        ((np.zeros((4, 7)),), {}, r"rays have the shape \(4, 7\); expected \(\.\.\., 6\), \(\.\.\., 8\) or \(\.\.\., 9\)"),
        ((np.ones((4, 8)),), {"t_min": 0}, r"t_min and t_max are given twice: rays of 8 numbers have them"),
        ((np.ones((4, 9)),), {"t_blind": 0}, r"t_blind is given twice"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"t_blind": -1}, r"rays\[0\].t_blind is -1: expected 0 to 1e30"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"t_blind": [0, 1], "t_min": [0, 1, 2]}, r"shapes do not fit: .*t_blind \(2,\)"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"query": "last"}, r"query is 'last'"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"with_": "embree"}, r"with_ is 'embree'"),
        (([[0, 0, 0]], [[0, 0, 1]]), {"with_": "tracer", "margins": True}, r"knows no margins; expected with_=\"referee\""),
        (([[0, 0, 0j]], [[0, 0, 1]]), {}, r"origins is of type complex128"),
    ],
)
def test_what_is_wrong_is_named(cube: Mesh, arguments: tuple[object, ...], options: dict[str, object], words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        cast(cube, *arguments, **options)  # type: ignore[arg-type]


def test_what_is_no_mesh_is_refused() -> None:
    with pytest.raises(RaypencilError, match="mesh is of type str"):
        cast("cube.obj", [0, 0, 0], [0, 0, 1])


def test_answers_may_not_be_written_and_can_be_pickled(cube: Mesh) -> None:
    answers = cast(cube, random_rays(20), query=("any", "all"), margins=True)
    for one in (answers, pickle.loads(pickle.dumps(answers))):
        assert sorted(one.arrays) == sorted(answers.arrays)
        for name, array in one.arrays.items():
            assert not array.flags.writeable and same_bits(array, answers.arrays[name])


def test_all_hits_of_a_ray_are_found_by_its_index(cube: Mesh) -> None:
    answers = cast(cube, np.array([[9, 9, 9], [0.25, 0.5, 3]]), [0, 0, -2], query="all")
    hits = answers.all
    assert hits is not None and answers.any is None and hits.start.tolist() == [0, 0, 2]
    assert hits.t[hits.of(0)].tolist() == [] and hits.t[hits.of(1)].tolist() == [1.0, 2.0]
    with pytest.raises(IndexError, match="expected 0 to 1"):
        hits.of(2)


def test_xarray_has_dimensions_units_and_meanings(cube: Mesh) -> None:
    pytest.importorskip("xarray")
    answers = cast(cube, random_rays(12).reshape(4, 3, 8), query=("any", "all"), margins=True)
    dataset = answers.to_xarray()
    assert dict(dataset.sizes) == {"row": 4, "column": 3, "xyz": 3, "corner": 3, "bound": 2, "vector": 2}
    assert dataset.point.dims == ("row", "column", "xyz") and dataset.xyz.values.tolist() == ["x", "y", "z"]
    assert dataset.range.attrs["units"] == "unit of the mesh" and dataset.t.attrs["units"] == "length of the direction"
    assert dataset.margin_face.sel(bound="lo").shape == (4, 3) and "all_t" not in dataset
    assert np.array_equal(dataset.t.values, answers.t)
    assert cast(cube, random_rays(5)).to_xarray().t.dims == ("ray",)


def test_pandas_has_a_row_for_each_ray(cube: Mesh) -> None:
    pytest.importorskip("pandas")
    answers = cast(cube, random_rays(12).reshape(4, 3, 8))
    table = answers.to_pandas()
    assert len(table) == 12 and np.array_equal(table["t"], answers.t.ravel())
    assert np.array_equal(table["point.y"], answers.point[..., 1].ravel(), equal_nan=True)


def test_answers_of_two_dimensions_have_a_picture(cube: Mesh) -> None:
    picture = cast(cube, random_rays(12).reshape(4, 3, 8))._repr_png_()
    assert picture is not None and picture.startswith(b"\x89PNG") and picture[16:24] == b"\0\0\0\x03\0\0\0\x04"
    assert cast(cube, random_rays(12))._repr_png_() is None


def test_a_scenes_terrain_is_a_mesh(small: raypencil.Scene) -> None:
    # The camera is 1.5 m above level ground at x = 0.3.
    assert cast(small, [0.3, 0, 1.5], [0, 0, -1]).range == 1.5


def test_what_looks_wrong_is_warned_of(cube: Mesh) -> None:
    # Rays in metres inside a cube of 8 m in millimetres: they end long before it.
    inside = [[0.5, 0.5, 0.0], [0.25, 0.5, 0.0]]
    room = Mesh(cube.vertices * 4000.0, cube.faces)
    with pytest.warns(raypencil.RaypencilWarning, match=r"none of the 2 rays hits .*--scale 0\.001\)\? 2 of 2 would hit"):
        answers = cast(room, inside, [0, 0, -1], t_max=10)
    assert not answers.hit.any() and len(answers.warnings) == 1
    assert pickle.loads(pickle.dumps(answers)).warnings == answers.warnings
    # An open mesh is none for crossings, and is one for first hits.
    square = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.warns(raypencil.RaypencilWarning, match="3 open edges"):
        cast(square, [0.25, 0.25, 1], [0, 0, -1], query="all")
    assert cast(square, [0.25, 0.25, 1], [0, 0, -1]).warnings == ()
    # A miss of one ray is its answer.
    assert cast(square, [2, 2, 1], [0, 0, -1]).warnings == ()
