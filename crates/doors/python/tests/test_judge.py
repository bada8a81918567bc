"""Somebody's answers against the truth: what is right passes, each kind of wrong is called so, and told why."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DATA, Command, random_rays, same_bits
from numpy.typing import NDArray

import raypencil
from raypencil import Mesh, RaypencilError, cast, judge

RAYS = random_rays(400, seed=3)


def exact(cube: Mesh) -> dict[str, NDArray[Any]]:
    """The exact answers, to be changed."""
    return {name: np.array(array) for name, array in cast(cube, RAYS).arrays.items() if name != "ties"}


def test_the_truth_is_right(cube: Mesh) -> None:
    judged = judge(cube, RAYS, exact(cube))
    assert judged and judged.passes and judged.why is None and len(judged.wrong) == 0
    assert judged.counts == {"same": 400, "ties": 0, "rounding": 0, "wrong": 0}
    assert judged.classes.dtype == np.uint8 and judged.classes.shape == (400,) and np.isnan(judged.moved).all()
    assert judge(cube, RAYS, cast(cube, RAYS)).passes and "All 400 rays agree" in judged.text


@pytest.mark.parametrize("parts", [["face"], ["t"], ["range"], ["face", "point"], ["t", "normal", "barycentric"]])
def test_any_part_of_the_truth_is_right(cube: Mesh, parts: list[str]) -> None:
    truth = exact(cube)
    assert judge(cube, RAYS.reshape(40, 10, 8), {name: truth[name] for name in parts}).passes


def test_the_tracer_is_judged_as_by_the_command(cube: Mesh, command: Command, tmp_path: Path) -> None:
    np.save(tmp_path / "rays.npy", RAYS.reshape(80, 5, 8))
    command("cast", DATA / "rays/cube.obj", "rays.npy", "--with", "tracer", "-o", "out")
    rays = RAYS.reshape(80, 5, 8)
    judged = judge(cube, rays, cast(cube, rays, with_="tracer"))
    assert same_bits(judged.classes, np.load(tmp_path / "out/tracer.verdict.npy"))
    assert same_bits(judged.moved, np.load(tmp_path / "out/tracer.moved.npy"))


def test_wrong_rays_are_found_where_they_are(cube: Mesh) -> None:
    answers = exact(cube)
    hits, misses = (np.flatnonzero(cast(cube, RAYS).hit == is_hit) for is_hit in (True, False))
    answers["face"][hits[3]] = (answers["face"][hits[3]] + 6) % 12
    answers["face"][hits[5]], answers["t"][hits[5]] = 4294967295, np.inf
    answers["face"][misses[2]] = 0
    answers["t"][hits[8]] *= 1 + 1e-9
    judged = judge(cube, RAYS, answers)
    assert not judged and judged.wrong.tolist() == sorted([hits[3], hits[5], hits[8], misses[2]])
    assert judged.counts["wrong"] == 4 and "4 of 400 rays are wrong" in judged.text
    # What only misses is found as well, where faces alone are stated.
    faces = np.where(np.arange(400) == hits[5], -1, cast(cube, RAYS).face.astype(int))
    assert judge(cube, RAYS, {"face": faces}).wrong.tolist() == [hits[5]]


def test_rounding_is_excused_with_a_witness(cube: Mesh) -> None:
    # A ray an ulp beside the diagonal of the top: the other of its two faces is right for a ray that is moved.
    beside = np.array([[0.25, np.nextafter(0.25, 1), 3.0, 0, 0, -1.0]])
    truth = cast(cube, beside)
    assert truth.ties.tolist() == [1]
    other = 21 - truth.face.astype(int)
    judged = judge(cube, beside, {"face": other})
    assert judged.classes.tolist() == [raypencil._judge.ROUNDING] and judged.passes
    assert 0 < np.abs(judged.moved).max() < 1e-14


def test_single_precision_has_to_be_declared(cube: Mesh) -> None:
    # Numbers of single precision in an array of double precision: nothing says that storing rounded them.
    t = cast(cube, RAYS).t.astype(np.float32).astype(np.float64)
    assert not judge(cube, RAYS, {"t": t}).passes and judge(cube, RAYS, {"t": t}, "f32").passes
    assert judge(cube, RAYS, {"t": t}).why == '100.0000 % agree if arithmetic is of single precision: declare arithmetic="f32"'


def test_exact_answers_in_fewer_digits_are_right(cube: Mesh) -> None:
    truth = exact(cube)
    for kind in (np.float32, np.float16):
        stored = {name: a if a.dtype.kind != "f" else a.astype(kind) for name, a in truth.items()}
        assert judge(cube, RAYS, stored).passes
        # A unit of the last place is not excused.
        hits = np.flatnonzero(np.isfinite(truth["t"]))
        t = stored["t"].copy()
        t[hits] += np.spacing(t[hits])
        judged = judge(cube, RAYS, {"face": truth["face"], "t": t})
        assert judged.wrong.tolist() == hits.tolist()
    # A declared miss is met as the array rounds it.
    t = np.where(np.isfinite(truth["t"]), truth["t"], 0.1).astype(np.float32)
    assert judge(cube, RAYS, {"t": t}, miss=0.1).passes and not judge(cube, RAYS, {"t": t}, miss=0.2, explain=False).passes


@pytest.mark.parametrize(
    ("words", "change"),
    [
        ("face indices are 1 too large", lambda a: {"face": a["face"].astype(np.int64) + 1}),
        ("t holds the range", lambda a: {"t": a["range"]}),
        ("normals point inward", lambda a: {"face": a["face"], "normal": -a["normal"]}),
        ("y and z of points and normals are swapped", lambda a: {"t": a["t"], "point": a["point"][..., [0, 2, 1]]}),
        ("barycentric weights are in the order", lambda a: {"t": a["t"], "barycentric": a["barycentric"][..., [1, 2, 0]]}),
        ("lengths are in thousandths", lambda a: {"range": 1000 * a["range"]}),
    ],
)
def test_a_mistake_is_told(cube: Mesh, words: str, change: Any) -> None:
    # Rays that hit, so that no miss becomes face 0.
    rays = RAYS[cast(cube, RAYS).hit]
    answers = change(cast(cube, rays).arrays)
    judged = judge(cube, rays, answers)
    assert not judged.passes and judged.why is not None and words in judged.why
    assert f"Why: {judged.why}" in str(judged) and judge(cube, rays, answers, explain=False).why is None


def test_a_mistake_that_breaks_right_rays_is_no_reason(cube: Mesh) -> None:
    exact_t, hits = exact(cube)["t"], np.flatnonzero(cast(cube, RAYS).hit)
    for changed, is_told in ((hits, True), (hits[::2], False)):
        t = exact_t.copy()
        t[changed] *= 2
        judged = judge(cube, RAYS, {"t": t})
        assert judged.wrong.tolist() == changed.tolist()
        # Where every other hit is right, a factor would make it wrong.
        assert ("2 times" in (judged.why or "")) == is_told and (judged.why is None) != is_told


def test_a_mistake_of_the_question_is_told(cube: Mesh) -> None:
    endless = cast(cube, RAYS[:, 0:3], RAYS[:, 3:6], t_min=RAYS[:, 6])
    assert judge(cube, RAYS, endless).why == "100.0000 % agree if t_max is ignored"
    truth = cast(cube, RAYS)
    zeros = judge(cube, RAYS, {"t": np.where(truth.hit, truth.t, 0)})
    assert zeros.why == "100.0000 % agree if 0 means no hit: declare miss=0"


def test_too_near_is_told_from_a_miss(cube: Mesh) -> None:
    # Half of the rays are those of a sensor that is blind up to the middle of what they meet.
    plain = cast(cube, RAYS)
    blind = np.where(plain.hit & (np.arange(len(RAYS)) % 2 == 0), np.nextafter(plain.t, np.inf) + 1e-3, 0)
    rays = np.concatenate([RAYS, np.minimum(blind, RAYS[:, 7])[:, None]], axis=1)
    truth = cast(cube, rays)
    near = int(truth.too_near.sum())
    assert near > 20 and not (truth.too_near & truth.hit).any()
    assert judge(cube, rays, truth).passes and judge(cube, rays, {"range": truth.range, "hit": truth.hit}).passes
    assert judge(cube, rays, {"face": truth.face}).passes
    missed = judge(cube, rays, {"t": np.where(truth.too_near, np.inf, truth.t)})
    assert len(missed.wrong) == near and missed.why is not None and "is not told from a miss" in missed.why
    assert "exactly what is hit is too near" in missed.text and "t_blind: " in missed.text
    measured = judge(cube, rays, plain)
    assert len(measured.wrong) == near and measured.why is not None and "shortest range is ignored" in measured.why
    swapped = {"t": np.where(np.isposinf(truth.t), -np.inf, truth.t)}
    assert "too near; exactly it is no hit" in judge(cube, rays, swapped).text
    assert judge(cube, RAYS, {"t": np.where(plain.hit, plain.t, -np.inf)}, miss=-np.inf).passes


def test_a_miss_can_be_declared(cube: Mesh) -> None:
    truth = cast(cube, RAYS)
    assert judge(cube, RAYS, {"t": np.where(truth.hit, truth.t, 0)}, miss=0).passes
    seven = {"t": np.where(truth.hit, truth.t, 7), "hit": truth.hit}
    assert judge(cube, RAYS, seven, miss=7).passes
    judged = judge(cube, RAYS, seven)
    assert judged.wrong.tolist() == np.flatnonzero(~truth.hit).tolist()
    assert judged.why == "100.0000 % agree if 7 means no hit: declare miss=7"
    # A distance that is the number, of a ray that hits by its face, its truth value or its other distance.
    ray = int(np.flatnonzero(truth.hit & (truth.t != truth.range))[0])
    for number, own, other in ((truth.t[ray], "t", "range"), (truth.range[ray], "range", "t")):
        filled = {name: np.where(truth.hit, truth.arrays[name], number) for name in ("t", "range")}
        for beside in ({"face": truth.face}, {"hit": truth.hit}, {other: filled[other]}):
            assert judge(cube, RAYS, {own: filled[own]} | beside, miss=number).passes
        assert judge(cube, RAYS, {own: filled[own]}, miss=number).wrong.tolist() == [ray]
        assert judge(cube, RAYS, filled | {"face": truth.face}).why == f"100.0000 % agree if {number} means no hit: declare miss={number}"
    # A face whose number is declared, where a distance says that the ray hits.
    assert judge(cube, RAYS, {"t": np.where(truth.hit, truth.t, 0), "face": np.where(truth.hit, truth.face, 0)}, miss=0).passes
    # All other values of rays that miss.
    filled = {name: np.where(np.isfinite(a), a, 0) for name, a in truth.arrays.items() if name not in ("face", "side", "ties")}
    assert judge(cube, RAYS, filled, miss=0).passes and not judge(cube, RAYS, filled, explain=False).passes
    assert judge(cube, RAYS, {"face": np.where(truth.hit, truth.face.astype(float), np.nan)}).passes


@pytest.mark.parametrize("name", ["t", "range", "side", "point", "normal", "barycentric", "cos_incidence", "hit"])
def test_answers_that_disagree_with_themselves_are_wrong(cube: Mesh, name: str) -> None:
    answers = exact(cube) | {"hit": cast(cube, RAYS).hit.copy()}
    miss, hit = np.flatnonzero(~answers["hit"])[4], np.flatnonzero(answers["hit"])[4]
    answers[name][miss] = 0.5 if answers[name].dtype.kind == "f" else 1
    judged = judge(cube, RAYS, answers, explain=False)
    assert judged.wrong.tolist() == [miss]
    assert f"face says that nothing is hit, and {name} is " in judged.text
    if name in ("t", "range", "hit"):
        answers = exact(cube) | {"hit": cast(cube, RAYS).hit.copy()}
        answers[name][hit] = False if name == "hit" else np.inf
        assert f"face says that something is hit, and {name} is " in judge(cube, RAYS, answers, explain=False).text


def test_fronts_only_is_another_question(cube: Mesh) -> None:
    answers = cast(cube, RAYS, fronts_only=True)
    assert judge(cube, RAYS, answers, fronts_only=True).passes and not judge(cube, RAYS, answers).passes


@pytest.mark.parametrize(
    ("answers", "words"),
    [
        ({}, "expected face, t, range or hit"),
        ({"point": np.zeros((400, 3))}, "expected face, t, range or hit"),
        ({"T": np.zeros(400)}, "there is no `T`; expected some of face"),
        ({"t": np.zeros(399)}, r"t has the shape \(399,\); expected \(400,\)"),
        ({"t": np.zeros(400), "point": np.zeros((400, 2))}, r"point has the shape \(400, 2\); expected \(400, 3\)"),
        ({"face": np.full(400, 0.5)}, "face: cell 0 is 0.5; expected 0 or a larger whole number"),
        ({"face": np.full(400, -2)}, "face: cell 0 is -2"),
        # 4294967295 is none, and what is beyond it is no face either.
        ({"face": np.full(400, 4294967296)}, "face: cell 0 is 4294967296; expected 0 or a larger whole number"),
        ({"t": np.zeros(400, dtype=complex)}, "t is of type complex128"),
        ({"hit": np.full(400, np.nan)}, "hit: cell 0 is nan; expected 1 where the ray hits, 0 where it does not"),
        ({"hit": np.full(400, 2)}, "hit: cell 0 is 2; expected 1 where"),
        ({"hit": np.full(400, "no")}, "hit is of type <U2; expected truth values"),
        (3, "answers are of type int"),
    ],
)
def test_what_is_wrong_is_named(cube: Mesh, answers: Any, words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        judge(cube, RAYS, answers)


def test_an_unknown_arithmetic_is_refused(cube: Mesh) -> None:
    with pytest.raises(RaypencilError, match="arithmetic is \"f16\""):
        judge(cube, RAYS, exact(cube), "f16")  # type: ignore[arg-type]


def test_rays_may_be_a_tuple(cube: Mesh) -> None:
    rays = (RAYS[:, 0:3], RAYS[:, 3:6], RAYS[:, 6], RAYS[:, 7])
    assert judge(cube, rays, exact(cube)).passes
    assert not judge(cube, rays[:2], exact(cube), explain=False).passes


def test_many_rays_are_judged_as_one(cube: Mesh) -> None:
    # More than are judged at a time: their places count through.
    rays = np.tile(RAYS, (200, 1))
    answers = {"t": np.array(cast(cube, rays).t)}
    first, last = np.flatnonzero(cast(cube, rays).hit)[[0, -1]]
    answers["t"][first] += 0.25
    answers["t"][last] = np.nextafter(answers["t"][last], 9)
    judged = judge(cube, rays, answers, explain=False)
    assert judged.wrong.tolist() == [first] and judged.summary["values"][0]["worst"]["ray"] == last
    assert judged.summary["values"][0]["compared"] == cast(cube, rays).hit.sum() - 1
    answers["t"][last] += 0.25
    assert judge(cube, rays, answers, explain=False).wrong.tolist() == [first, last]


def test_judgements_can_be_pickled(cube: Mesh) -> None:
    pytest.importorskip("xarray")
    judged = pickle.loads(pickle.dumps(judge(cube, RAYS, exact(cube))))
    assert judged.passes and not judged.classes.flags.writeable
    dataset = judged.to_xarray()
    assert dataset.classes.attrs["flag_meanings"] == "same tie rounding wrong" and dataset.moved.shape == (400, 2)


def test_hits_alone_are_tests_of_occlusion(cube: raypencil.Mesh) -> None:
    hit = cast(cube, RAYS).hit
    judged = judge(cube, RAYS, {"hit": hit})
    assert judged.passes and judged.counts["same"] == 400 and 0 < hit.sum() < 400
    other = hit.copy()
    other[[3, 77]] ^= True
    wrong = judge(cube, RAYS, {"hit": other})
    assert wrong.wrong.tolist() == [3, 77] and wrong.why is None
    assert any(word in wrong.text for word in ("a hit; exactly nothing is hit", "no hit; exactly it is face"))
    assert judge(cube, RAYS, {"hit": hit.astype(np.float32)}).passes and judge(cube, RAYS, {"hit": ~hit}).why is None
    assert judge(cube, RAYS, {"hit": np.zeros(400, bool)}).why == "every ray is a miss: nothing at all is hit"
    # Beside an edge by less than float32 rounds.
    beside = ([-1.0000001, 0.3, 5.0], [0.0, 0.0, -1.0])
    assert judge(cube, beside, {"hit": np.array(True)}, "f32").counts["rounding"] == 1
    assert judge(cube, beside, {"hit": np.array(True)}).counts["wrong"] == 1
    with pytest.raises(RaypencilError, match="expected face, t, range or hit"):
        judge(cube, RAYS, {"side": np.ones(400)})


def test_a_program_that_culls_backs_is_not_told_that_it_hits_nothing(cube: Mesh) -> None:
    # More rays into the sky than are tried come first, then some upon the cube, and last some from inside it.
    sky, upon, inside = np.tile([5.0, 5.0, 9.0, 0.0, 0.0, 1.0], (3000, 1)), random_rays(300)[:, :6], np.zeros((40, 6))
    middle = np.mean(np.asarray(cube.bounds), axis=0)
    inside[:, :3], inside[:, 3:] = middle, np.random.default_rng(3).normal(size=(40, 3))
    rays = np.concatenate([sky, upon, inside])
    culled = cast(cube, rays, fronts_only=True)
    judged = judge(cube, rays, {"face": culled.face.astype(np.int64), "t": culled.t})
    assert len(judged.wrong) >= 40 and culled.hit.sum() > 50
    assert judged.why is not None and "nothing at all is hit" not in judged.why
    # A program that does hit nothing is told so.
    nothing = judge(cube, rays, {"hit": np.zeros(len(rays), bool), "t": np.full(len(rays), np.inf)})
    assert nothing.why == "every ray is a miss: nothing at all is hit"


def test_rays_in_a_file_are_not_widened_as_a_whole(cube: Mesh, tmp_path: Path) -> None:
    rays = random_rays(50)[:, :6].astype(np.float32)
    np.save(tmp_path / "rays.npy", rays)
    mapped = np.load(tmp_path / "rays.npy", mmap_mode="r")
    assert np.shares_memory(raypencil._arrays.RayParts(mapped, None).parts[0], mapped)
    assert same_bits(cast(cube, mapped).t, cast(cube, rays.astype(np.float64)).t)
