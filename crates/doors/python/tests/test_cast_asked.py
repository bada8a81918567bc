"""What is asked of rays, and where the answers go: values, given arrays, pieces, threads, indices, notebooks."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from conftest import random_rays, same_bits

import raypencil
from raypencil import Mesh, RaypencilError, _arrays, _cast, cast, cast_chunks
from raypencil._cast_result import VALUES


@pytest.mark.parametrize("with_", ["referee", "tracer"])
def test_a_value_is_the_same_whatever_is_asked_beside_it(cube: Mesh, with_: Any) -> None:
    rays = random_rays(300)
    every = cast(cube, rays, with_=with_)
    assert tuple(every.arrays) == VALUES
    for name in VALUES:
        some = cast(cube, rays, values=(name,), with_=with_)
        assert set(some.arrays) == {name, "face"}
        assert same_bits(some.arrays[name], every.arrays[name]) and same_bits(some.face, every.face)
        # Of one ray, too, which another path answers.
        for k in (0, 1, 2):
            assert same_bits(cast(cube, rays[k], values=name, with_=with_).arrays[name], every.arrays[name][k, ...])


def test_a_value_that_was_not_asked_for_is_refused_by_name(cube: Mesh) -> None:
    answers = cast(cube, random_rays(20), values=("t",))
    assert answers.hit.any() and not answers.too_near.any()
    with pytest.raises(RaypencilError, match=r"point was not asked for \(values: face, t\); expected values="):
        _ = answers.point
    with pytest.raises(RaypencilError, match="values: there is no 'depth'; expected some of face, side"):
        cast(cube, random_rays(2), values=("t", "depth"))
    with pytest.raises(RaypencilError, match="values is empty, and nothing else is asked"):
        cast(cube, random_rays(2), values=())


def test_without_values_no_first_hit_is_asked(cube: Mesh) -> None:
    rays = random_rays(200)
    every = cast(cube, rays, query=("any", "all"))
    for with_ in ("referee", "tracer"):
        only = cast(cube, rays, values=(), query="any", with_=with_)
        assert list(only.arrays) == ["any"] and only.any is not None and every.any is not None
        assert same_bits(only.any, every.any) and 0 < only.any.sum() < 200
    assert repr(only) == "<raypencil.CastResult: 200 rays, shape (200,)>"
    alone = cast(cube, rays, values=(), query="all").all
    assert alone is not None and every.all is not None and same_bits(alone.t, every.all.t)
    with pytest.warns(raypencil.RaypencilWarning, match="none of the 2 rays hits"):
        cast(cube, [[9, 9, 9], [9, 9, 8]], [0, 0, 1], values=(), query="any")


def test_the_tracer_answers_any_and_all(cube: Mesh) -> None:
    rays = random_rays(300)
    exact, traced = (cast(cube, rays, query=("any", "all"), with_=with_) for with_ in ("referee", "tracer"))
    assert exact.any is not None and traced.any is not None and same_bits(exact.any, traced.any)
    theirs, ours = exact.all, traced.all
    assert theirs is not None and ours is not None and ours.crossing is None and theirs.crossing is not None
    # In general position rays meet faces one by one.
    assert same_bits(theirs.start, ours.start) and same_bits(theirs.face, ours.face) and same_bits(theirs.side, ours.side)
    assert np.allclose(theirs.t, ours.t, rtol=1e-12) and len(ours.t) > 100
    both = cast(cube, [0, 0, 3], [0, 0, -1], query="all", with_="tracer").all
    assert both is not None and both.group.tolist() == [0, 0, 1, 1]


def test_a_mesh_keeps_its_trees(cube: Mesh) -> None:
    mesh = Mesh(cube.vertices, cube.faces)
    assert list(mesh.trees) == [] and repr(mesh) == "<raypencil.Mesh: 8 vertices, 12 faces>"
    said: list[str] = []
    first = cast(mesh, [0.25, 0.5, 3], [0, 0, -2], progress=said.append)
    assert said == ["building a tree of 12 faces", "casting 1 rays"] and list(mesh.trees) == ["referee"]
    said.clear()
    again = cast(mesh, [0.25, 0.5, 3], [0, 0, -2], progress=said.append)
    assert said == ["casting 1 rays"] and all(same_bits(first.arrays[name], again.arrays[name]) for name in VALUES)
    raypencil.judge(mesh, [[0.25, 0.5, 3, 0, 0, -2]], {"t": [1.0]}, progress=said.append)
    assert not any("building" in stage for stage in said)
    assert mesh.build("tracer", threads=1) is mesh and list(mesh.trees) == ["referee", "tracer"]
    assert "tree of referee and tracer" in repr(mesh) and not pickle.loads(pickle.dumps(mesh)).trees
    with pytest.raises(RaypencilError, match="with_ is 'embree'"):
        mesh.build("embree")  # type: ignore[arg-type]


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2", 5000])
def test_a_number_of_threads_that_is_none_is_refused(cube: Mesh, threads: Any) -> None:
    with pytest.raises(RaypencilError, match="threads is .*; expected 1 to 1024"):
        cast(cube, random_rays(2), threads=threads)


def test_the_answers_do_not_depend_on_the_threads() -> None:
    mesh = raypencil.terrain.generate("smooth", 1, extent=8)
    rays = np.zeros((3000, 6))
    rays[:, 0:2], rays[:, 2], rays[:, 3:6] = np.random.default_rng(0).uniform(-4, 4, (3000, 2)), 5, [0.1, 0.2, -1]
    expected = cast(mesh, rays)
    for threads in (1, 3):
        fresh = Mesh(mesh.vertices, mesh.faces)
        answers = cast(fresh, rays, threads=threads)
        assert all(same_bits(answers.arrays[name], expected.arrays[name]) for name in VALUES)


def given_arrays(shape: tuple[int, ...]) -> dict[str, np.ndarray]:
    """Arrays in any memory order, with something in them."""
    wide = np.full((*shape, 6), 7.0)
    return {
        "t": np.asfortranarray(np.full(shape, 7.0)),
        "point": wide[..., ::2],
        "face": np.full(shape, 7, dtype=np.uint32),
        "any": np.full(shape, 7, dtype=np.uint8),
    }


@pytest.mark.parametrize("at_a_time", [1 << 18, 7])
def test_rays_of_single_precision_are_widened_a_block_at_a_time(cube: Mesh, monkeypatch: pytest.MonkeyPatch, at_a_time: int) -> None:
    monkeypatch.setattr(_cast, "RAYS_AT_A_TIME", at_a_time)
    rays = random_rays(60).astype(np.float32)
    rays[:, 7] = np.inf
    expected = cast(cube, rays.astype(np.float64))
    assert expected.hit.any()
    strided = np.zeros((60, 24), np.float32)
    strided[:, ::3] = rays
    for given in (rays, np.asfortranarray(rays), strided[:, ::3]):
        answers = cast(cube, given)
        for name, array in expected.arrays.items():
            assert same_bits(answers.arrays[name], array), name
        # Nothing is copied before.
        assert np.shares_memory(_arrays.RayParts(given, None).parts[0], given)
    # An array of single precision is no place for answers either, if the rays lie there.
    own = np.zeros((4, 6), np.float32)
    own[:, 5] = -1.0
    with pytest.raises(RaypencilError, match="lies in the memory of the rays"):
        cast(cube, own, values=("t",), out={"t": own.reshape(-1).view(np.float64)[:4]})
    with pytest.raises(RaypencilError, match=r"\(4, 5\)"):
        cast(cube, own[:, :5])
    with pytest.raises(RaypencilError, match="rays\\[2\\]"):
        own[2, 0] = np.nan
        cast(cube, own)


@pytest.mark.parametrize("at_a_time", [1 << 18, 7, 45])
def test_answers_are_written_into_given_arrays(cube: Mesh, monkeypatch: pytest.MonkeyPatch, at_a_time: int) -> None:
    monkeypatch.setattr(_cast, "RAYS_AT_A_TIME", at_a_time)
    # Some see the cube before their shortest range.
    rays = np.concatenate([random_rays(240), np.zeros((240, 1))], axis=1).reshape(6, 20, 2, 9)
    rays[::2, ..., 8] = np.minimum(1.5, rays[::2, ..., 7])
    with monkeypatch.context() as whole:
        whole.setattr(_cast, "RAYS_AT_A_TIME", 1 << 18)
        expected = cast(cube, rays, query=("any", "all"), margins=True)
        fronts = cast(cube, rays, fronts_only=True)
    assert expected.too_near.any() and not same_bits(fronts.t, expected.t)
    assert same_bits(cast(cube, rays, fronts_only=True, out={"t": np.empty(rays.shape[:-1])}).t, fronts.t)
    out = given_arrays(rays.shape[:-1])
    answers = cast(cube, rays, query="any", out=out)
    assert set(answers.arrays) == set(out)
    for name, array in out.items():
        assert np.array_equal(array, expected.arrays[name], equal_nan=True), name
        assert array.flags.writeable and not answers.arrays[name].flags.writeable
        assert np.shares_memory(array, answers.arrays[name])
    # Values beside those that are given are new arrays; blocks of rays give what all at once do.
    more = cast(cube, rays, query=("any", "all"), margins=True, values=VALUES, out={"range": np.empty(rays.shape[:-1])})
    assert sorted(more.arrays) == sorted(expected.arrays)
    for name, array in more.arrays.items():
        assert same_bits(np.ascontiguousarray(array), expected.arrays[name]), name
    one = np.empty(())
    cast(cube, [0.25, 0.5, 3], [0, 0, -2], out={"t": one})
    assert one == 1.0


def test_arrays_that_do_not_fit_are_refused_and_stay_as_they_are(cube: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    rays = random_rays(20)
    frozen = np.empty(20)
    frozen.flags.writeable = False
    pair = np.empty((20, 3))
    wrong: list[tuple[Any, str]] = [
        ({"depth": np.empty(20)}, "out: 'depth' is none of the answers; expected some of face"),
        ({"any": np.empty(20, dtype=np.uint8)}, "out: 'any' is none of the answers"),
        ({"t": np.empty(19)}, r"out: t is float64 \(19,\); expected float64 \(20,\)"),
        ({"t": np.empty(20, dtype=np.float32)}, r"out: t is float32 \(20,\); expected float64 \(20,\)"),
        ({"point": np.empty(20)}, r"expected float64 \(20, 3\)"),
        ({"t": [0.0] * 20}, "out: t is of type list"),
        ({"t": frozen}, "out: t is read-only"),
        ({"t": rays[:, 3]}, "out: t lies in the memory of the rays"),
        ({"t": pair[:, 0], "range": pair[:, 0]}, "lie in the same memory"),
    ]
    for out, words in wrong:
        with pytest.raises(RaypencilError, match=words):
            cast(cube, rays, out=out, values=VALUES)
    # The last ray is none: nothing was written of those before it.
    monkeypatch.setattr(_cast, "RAYS_AT_A_TIME", 4)
    rays[17, 3:6] = 0
    for shape in [(20,), (2, 10)]:
        t = np.full(shape, 7.0)
        with pytest.raises(RaypencilError, match=r"rays\[17\].direction"):
            cast(cube, rays.reshape((*shape, 8)), out={"t": t})
        assert (t == 7).all()


def test_blocks_warn_as_all_rays_at_once_do(cube: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    away = np.tile([[0.5, 0.5, 5000.0]], (20, 1))
    inside = np.zeros((20, 3))
    for mesh, origins, options in [
        (cube, away, {"t_max": 10}),
        (cube, inside, {}),
        (Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), inside + [0.2, 0.2, 1], {"query": "all"}),
    ]:
        with pytest.warns(raypencil.RaypencilWarning):
            expected = cast(mesh, origins, [0.1, 0, -1], **options)  # type: ignore[arg-type]
        with pytest.warns(raypencil.RaypencilWarning), monkeypatch.context() as small:
            small.setattr(_cast, "RAYS_AT_A_TIME", 6)
            assert cast(mesh, origins, [0.1, 0, -1], **options).warnings == expected.warnings != ()  # type: ignore[arg-type]


def test_pieces_together_are_the_whole(cube: Mesh) -> None:
    rays = random_rays(120).reshape(30, 4, 8)
    expected = cast(cube, rays, query=("any", "all"))
    pieces = list(cast_chunks(cube, rays, size=18, query=("any", "all")))
    assert [part for part, _ in pieces[:2]] == [slice(0, 4), slice(4, 8)] and len(pieces) == 8
    assert pieces[-1][0] == slice(28, 30) and pieces[-1][1].shape == (2, 4)
    for part, answers in pieces:
        assert all(same_bits(answers.arrays[name], expected.arrays[name][part]) for name in (*VALUES, "any"))
        whole, own = expected.all, answers.all
        assert whole is not None and own is not None
        some = slice(int(whole.start[part.start * 4]), int(whole.start[part.stop * 4]))
        assert same_bits(own.t, whole.t[some])
    # The index of a wrong ray is that among all of them.
    rays[9, 1, 3:6] = 0
    with pytest.raises(RaypencilError, match=r"rays\[37\].direction"):
        list(cast_chunks(cube, rays, size=18))
    with pytest.raises(RaypencilError, match="size is 0; expected 1 or more"):
        cast_chunks(cube, rays, size=0)
    with pytest.raises(RaypencilError, match="one ray has no pieces"):
        cast_chunks(cube, [0, 0, 3], [0, 0, -1])


def test_pieces_of_an_array_on_disk_are_read_as_they_are_taken(cube: Mesh, tmp_path: Any) -> None:
    np.save(tmp_path / "rays.npy", random_rays(50))
    on_disk = np.load(tmp_path / "rays.npy", mmap_mode="r")
    found = np.concatenate([answers.t for _, answers in cast_chunks(cube, on_disk, size=7, values=("t",))])
    assert same_bits(found, cast(cube, on_disk).t)


@pytest.mark.parametrize("index", [3, -1, slice(2, 9, 3), (slice(None), 1), (4, 2), (..., 0), [5, 0, 5], (slice(None), None)])
def test_an_index_gives_the_answers_of_these_rays(cube: Mesh, index: Any) -> None:
    rays = random_rays(60).reshape(20, 3, 8)
    answers = cast(cube, rays, query=("any", "all"), margins=True)
    some = answers[index]
    wanted = rays[(*index, slice(None))] if isinstance(index, tuple) else rays[index]
    expected = cast(cube, wanted, query=("any", "all"), margins=True)
    assert some.shape == expected.shape and sorted(some.arrays) == sorted(expected.arrays)
    for name, array in expected.arrays.items():
        assert same_bits(some.arrays[name], array), name


def test_truth_values_choose_rays_and_there_is_no_ray_beyond_the_last(cube: Mesh) -> None:
    answers = cast(cube, random_rays(60), query="all")
    hits = answers[answers.hit]
    assert hits.hit.all() and len(hits) == answers.hit.sum() > 0 and same_bits(hits.t, answers.t[answers.hit])
    missed = answers[~answers.hit].all
    assert missed is not None and missed.start[-1] == len(missed.t)
    with pytest.raises(IndexError):
        answers[60]


def test_a_notebook_shows_arrays_and_a_picture(cube: Mesh) -> None:
    shown = cast(cube, random_rays(12).reshape(4, 3, 8))._repr_html_()
    assert "of 12 rays hit, shape (4, 3)" in shown and "data:image/png;base64," in shown
    assert "<td>cos_incidence</td><td>float64 (4, 3)</td>" in shown
    plain = cast(cube, random_rays(5), values=("side",), query="all")._repr_html_()
    assert "img" not in plain and "<td>all_t</td>" in plain and "<td>point</td>" not in plain


def test_a_result_says_which_arithmetic_decided(cube: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    anywhere = random_rays(300)
    through_edges = np.concatenate([anywhere, np.tile([0.0, 0, 5, 0, 0, -1, 0, np.inf], (20, 1))])
    told = cast(cube, through_edges).decided
    assert told is not None and list(told) == ["filter", "intervals", "exact"]
    assert told["filter"] >= 290 and told["exact"] >= 20 and sum(told.values()) == 320
    # The same in pieces, whatever values are asked for, and after a pickle.
    monkeypatch.setattr(_cast, "RAYS_AT_A_TIME", 64)
    pieces = cast(cube, through_edges, values="face")
    assert pieces.decided == told == pickle.loads(pickle.dumps(pieces)).decided
    # Where no first hit is asked for, and by the tracer, nothing is decided so.
    assert cast(cube, anywhere, values=(), query="any").decided is None
    assert cast(cube, anywhere, with_="tracer").decided is None and pieces[:3].decided is None
