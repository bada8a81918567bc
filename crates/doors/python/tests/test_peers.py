"""Adapters of other programs: each mixes nothing up; what does is red. Those that are not installed are skipped."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import raypencil
from raypencil import RaypencilError, peers
from raypencil.peers import Hits, Peer, Unavailable
from raypencil.peers._closed_forms import mixed_up
from raypencil.peers._laws import LAWS
from raypencil.peers._ours import Referee, Tracer
from raypencil.peers._peer import Rays

NAMES = [one.name for one in peers.every_peer()]


@pytest.mark.parametrize("name", NAMES)
def test_an_adapter_mixes_nothing_up(name: str) -> None:
    one = peers.peer(name)
    try:
        one.version()
        # A card may be missing where the package is there.
        one.device()
        wrong = mixed_up(one)
    except Unavailable as missing:
        pytest.skip(f"{one.title}: {missing}")
    assert wrong == []


def test_each_has_names_of_its_own_and_says_what_it_reads() -> None:
    assert len(set(NAMES)) == len(NAMES) and len({one.title for one in peers.every_peer()}) == len(NAMES)
    for one in peers.every_peer():
        assert {one.arithmetic, one.mesh_type, one.rays_type} <= {"f32", "f64"} and one.package
        assert all(sentence.endswith(".") for sentence in (*one.conventions, *one.causes)), one.name
        # A cause says where it is found, and a remedy is against a threshold that there is.
        assert all(re.search(r"`.+` \(|\(`.+\)", sentence) for sentence in one.causes), one.name
        assert all(law in LAWS and side in ("below", "above") for law, side in one.remedies), one.name
    assert list(peers.LEFT_OUT) == sorted(peers.LEFT_OUT, key=str.lower)
    with pytest.raises(RaypencilError, match="no peer `embre`; expected one of embree, "):
        peers.peer("embre")


def test_mujoco_takes_a_mesh_in_a_plane() -> None:
    one = peers.peer("mujoco")
    try:
        one.version()
    except Unavailable as missing:
        pytest.skip(str(missing))
    flat = raypencil.Mesh([[0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 0]], [[0, 1, 2], [3, 2, 1]])
    told = one.first(flat, np.array([[1, 1, 3, 0, 0, -2, 0, np.inf]]))
    assert told.t.tolist() == [1.5]


def test_a_program_of_rust_that_does_not_answer_is_told(fake_program: Callable[[str], None], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAYPENCIL_PEERS_RUST", "/nowhere/program")
    with pytest.raises(Unavailable, match="there is no program `/nowhere/program`: cargo install --path reference/peers/rust"):
        peers.peer("parry").version()
    fake_program('echo "parry 0.31.1"; echo "bvh 0.13.0"')
    assert peers.peer("parry").version() == "0.31.1" and peers.peer("bvh").version() == "0.13.0"
    with pytest.raises(Unavailable, match="does not know tinybvh: cargo install"):
        peers.peer("tinybvh").version()
    fake_program('echo "raypencil-peers-rust: faces: there is no vertex 7" >&2; exit 2')
    with pytest.raises(Unavailable, match=r"versions` does not answer \(raypencil-peers-rust: faces"):
        peers.peer("parry").version()
    mesh = raypencil.Mesh([[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    ray = np.array([[1, 1, 3, 0, 0, -2, 0, np.inf]])
    with pytest.raises(RaypencilError, match="^parry: raypencil-peers-rust: faces: there is no vertex 7$"):
        peers.peer("parry").first(mesh, ray)


Change = Callable[[raypencil.Mesh, Hits], Hits]


def changed(change: Change) -> Peer:
    """The referee, with a mistake in its adapter."""

    class Planted(Referee):
        def first(self, mesh: raypencil.Mesh, rays: Rays) -> Hits:
            told = super().first(mesh, rays)
            return change(mesh, told)

    return Planted()


def faces_of(told: Hits) -> NDArray[np.int64]:
    assert told.face is not None
    return told.face


def culled(mesh: raypencil.Mesh, told: Hits) -> Hits:
    # Backs are met where t is half a unit away.
    is_back = told.hit & np.isin(told.t, [1.0, 0.5, 0.125]) & ~np.isin(told.t, [2.0, 4.0])
    return Hits(np.where(is_back, -1, faces_of(told)), np.where(is_back, np.inf, told.t))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda mesh, told: Hits(np.where(told.hit, faces_of(told) + 1, -1), told.t), "face 12; expected 11"),
        (lambda mesh, told: Hits(np.where(told.hit, 11 - faces_of(told), -1), told.t), "face 11; expected 0"),
        (lambda mesh, told: Hits(np.where(told.hit, faces_of(told) ^ 1, -1), told.t), "face 1; expected 0"),
        (lambda mesh, told: Hits(told.face, np.where(told.hit, 2.0, np.inf)), "t is 2; expected 4"),
        (lambda mesh, told: Hits(np.maximum(faces_of(told), 0), np.where(told.hit, told.t, 9.0)), "a hit; expected none"),
        (lambda mesh, told: Hits(faces_of(told)[:1], told.t[:1]), r"shape \(1,\)"),
        (culled, "its back: no hit; expected a hit"),
    ],
    ids=["off by one", "reversed", "pairs swapped", "t not scaled", "misses told as hits", "too few", "backs culled"],
)
def test_a_mistake_in_an_adapter_is_red(change: Change, words: str) -> None:
    assert mixed_up(changed(lambda mesh, told: told)) == []
    told = "\n".join(mixed_up(changed(change)))
    assert re.search(words, told), told


def test_ends_of_rays_and_all_hits_are_looked_at() -> None:
    class Endless(Referee):
        def shoot(self, built: object, rays: Rays) -> Hits:
            endless = rays.copy()
            endless[:, 7] = np.inf
            return super().shoot(built, endless)

    assert any("ends before" in sentence for sentence in mixed_up(Endless()))

    class Backwards(Tracer):
        def all(self, mesh: raypencil.Mesh, rays: Rays) -> list[list[tuple[int, float]]]:
            return [[(0, 1.0)] for _ in rays]

    assert any("of all hits" in sentence for sentence in mixed_up(Backwards()))


def test_a_question_is_what_the_peer_reads() -> None:
    class Single(Referee):
        mesh_type = rays_type = "f32"

    class Unit(Referee):
        is_unit = True

    mesh = raypencil.Mesh([[0, 0, 0.1], [4, 0, 0.1], [0, 4, 0.1]], [[0, 1, 2]])
    rays = np.array(
        [
            [1, 1, 3, 0, 0, -2.1, 0, 5],
            [1, 1, 3, 0, 0, -2, 1, 5],  # has a t_min
            [1, 1, 3, 0, 0, -1e60, 0, 5],  # too long for f32
            [1, 1, 3, 0, 0, -1e-60, 0, 5],  # too short for it
        ]
    )
    single = peers.asked(Single, mesh, rays)
    assert single.of.tolist() == [0] and single.rays[0, 5] == np.float32(-2.1) and single.mesh.vertices[0, 2] == np.float32(0.1)
    unit = peers.asked(Unit, mesh, rays)
    assert unit.of.tolist() == [0, 2, 3] and unit.rays[:, 3:6].tolist() == [[0, 0, -1]] * 3
    # The end of a ray is a length then.
    assert unit.rays[:, 7].tolist() == [10.5, np.inf, 5e-60] and unit.t.tolist() == [2.9, 2.9, np.inf]
    assert unit.nearest == [{0}, {0}, set()]


def test_what_a_peer_answers_is_counted() -> None:
    mesh = raypencil.Mesh([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 1], [4, 0, 1], [0, 4, 1]], [[0, 1, 2], [3, 4, 5]])
    rays = np.array([[1, 1, 3, 0, 0, -1.0], [1, 1.5, 3, 0, 0, -1], [9, 9, 3, 0, 0, -1], [2, 2, 3, 0, 0, -1], [-1, 1, 0, 1, 0, 0]])
    question = peers.asked(Referee, mesh, rays)
    right = Referee().first(mesh, question.rays)
    counts, wrong = peers.judged(Referee, question, right)
    assert counts == peers.Counts(5) and wrong.tolist() == []
    # Missed; another face; invented; right for a ray beside it, which misses; a face in whose plane the ray lies.
    told = Hits(np.array([-1, 0, 1, -1, 0]), np.array([np.inf, 3, 2, np.inf, 1]))
    counts, wrong = peers.judged(Referee, question, told)
    assert counts == peers.Counts(5, missed=2, invented=2, other=1, wrong=4) and wrong.tolist() == [0, 1, 2, 4]

    class InPlane(Referee):
        meets_in_plane = True

    counts, wrong = peers.judged(InPlane, question, told)
    assert counts == peers.Counts(5, missed=2, invented=1, other=1, wrong=3, convention=1) and wrong.tolist() == [0, 1, 2]
    # A face to which a ray is parallel, but in whose plane it is not, is none by convention.
    beside = peers.asked(InPlane, mesh, np.array([[-1, 1, 0.5, 1, 0, 0]]))
    assert peers.judged(InPlane, beside, Hits(np.array([0]), np.array([1.0])))[0] == peers.Counts(1, invented=1, wrong=1)
    # A face without an area is met by no ray, and to count it is a choice; of two rays only one is told such a face.
    line = raypencil.Mesh([[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 4, 0]], [[0, 1, 2], [0, 1, 3]])
    thin = peers.asked(Referee, line, np.array([[1.0, 0, 1.5, -1, 0, 0], [1, 5, 0.5, -1, 0, 0]]))
    told_thin = peers.judged(Referee, thin, Hits(np.array([0, 1]), np.array([1.0, 1.0])))
    assert told_thin[0] == peers.Counts(2, invented=1, wrong=1, convention=1) and told_thin[1].tolist() == [1]
    late = Hits(right.face, np.where(right.hit, right.t + 0.25, np.inf))
    assert peers.judged(Referee, question, late)[0] == peers.Counts(5, ranges=3)
    # Without faces it is t that is judged.
    assert peers.judged(Referee, question, Hits(None, late.t))[0] == peers.Counts(5, other=3, wrong=3)
    assert peers.judged(Referee, question, Hits(None, right.t))[0] == peers.Counts(5)
    assert (counts + counts).rays == 10 and counts.differing == 4


def test_a_hit_without_a_face_is_excused_as_one_with_it() -> None:
    class Single(Referee):
        arithmetic = "f32"

    # A floor, and a wall that the ray passes by a billionth, all but along it: moved by its rounding it meets the wall anywhere.
    off, lean = 2.0**-30, 2.0**-24
    corners = np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0], [off, -1, 1], [off, 1, 1], [off + lean, 0, 2]])
    mesh = raypencil.Mesh(corners, [[0, 1, 2], [3, 4, 5]])
    question = peers.asked(Single, mesh, np.array([[x, 0, 3, 0, 0, -1] for x in (0.0, 0, 4, 0)]))
    assert question.nearest == [{0}] * 4 and question.t.tolist() == [3] * 4
    ts = np.array([3, 1.5, 2.5, np.inf])
    with_faces = peers.judged(Single, question, Hits(np.array([0, 1, 1, -1]), ts))
    without = peers.judged(Single, question, Hits(None, ts))
    # On the floor; on the wall; where there is nothing; a miss.
    assert with_faces[1].tolist() == [2, 3] and without[1].tolist() == [2, 3]
    assert without[0] == peers.Counts(4, missed=1, other=2, wrong=2)


def test_the_end_of_a_ray_belongs_to_it() -> None:
    from raypencil.peers._peer import hits

    rays = np.array([[0.0, 0, 0, 0, 0, 1, 0, 2]] * 3)
    told = hits([4, 5, 6], [2.0, np.nextafter(2.0, 3), 1.0], rays)
    assert told.hit.tolist() == [True, False, True] and told.t.tolist() == [2, np.inf, 1]
    assert told.face is not None and told.face.tolist() == [4, -1, 6]
