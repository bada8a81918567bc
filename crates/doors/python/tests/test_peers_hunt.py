"""Thresholds in words, hunts and their reproducers, the page, and the command: on a peer that is planted, and on our own."""

from __future__ import annotations

import ctypes
import json
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, ClassVar
from xml.etree import ElementTree

import numpy as np
import pytest

import raypencil
from conftest import ROOT
from raypencil import peers
from raypencil.peers import Counts, Hits, _command, _known, _snippets
from raypencil.peers._figures import laws_svg, speed_svg
from raypencil.peers._hunt import ending, hunted, hunting_rays, reproduces, script, told_by
from raypencil.peers._laws import LAWS, Threshold, bumpy, explained, sentence, share_wrong, thresholds
from raypencil.peers._measure import Measured, Step, installed, machine, measure, of_answers
from raypencil.peers._ours import Referee, Tracer
from raypencil.peers._page import cell, page, paragraph
from raypencil.peers._peer import PROCESSOR, Rays
from raypencil.peers._reduce import Case, Exact, exact, reduced, wrong_hit
from raypencil.peers._worker import work
from raypencil.peers.adapters import _card

#: Möller and Trumbore's test with their threshold, as programs have it that lose small meshes. It stands alone.
TEST = """v = np.array(V, float)
a, b, c = (v[np.array(F)[:, k]] for k in range(3))
p = np.cross(np.array(d), c - a)
det = ((b - a) * p).sum(axis=1)
with np.errstate(all="ignore"):
    u = ((np.array(o) - a) * p).sum(axis=1) / det
    q = np.cross(np.array(o) - a, b - a)
    w, ts = (q @ np.array(d)) / det, ((c - a) * q).sum(axis=1) / det
    is_hit = (np.abs(det) > THRESHOLD) & (u >= 0) & (w >= 0) & (u + w <= 1) & (ts >= 0)
ts = np.where(is_hit, ts, np.inf)
t, face = float(ts.min()), int(ts.argmin()) if is_hit.any() else -1"""


class Planted(Tracer):
    """A peer that takes determinants up to 1e-6 for 0."""

    name, title, package, registry = "planted", "Planted", "planted", "PyPI"
    threshold = "1e-6"

    def version(self) -> str:
        return "1.0"

    def shoot(self, built: Any, rays: Rays) -> Hits:
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        program = compile(TEST.replace("THRESHOLD", self.threshold), "planted", "exec")
        for k, ray in enumerate(rays):
            names: dict[str, Any] = {"np": np, "V": built.vertices, "F": built.faces, "o": ray[0:3], "d": ray[3:6]}
            exec(program, names)
            face[k], t[k] = names["face"], names["t"]
        return Hits(face, t)


@pytest.fixture
def planted(monkeypatch: pytest.MonkeyPatch) -> Planted:
    """The planted peer, known as the others are."""
    monkeypatch.setattr(_known, "_CLASSES", (*_known._CLASSES, Planted))
    monkeypatch.setitem(_snippets.PYTHON, "planted", TEST.replace("THRESHOLD", Planted.threshold))
    return Planted()


def found_in(one: peers.Peer, *names: str) -> list[Threshold]:
    found = []
    for name in names:
        law = LAWS[name]
        found += thresholds(one, law, {value: share_wrong(one, law, value) for value in law.values})
    return found


def test_a_threshold_is_found_and_told_in_words(planted: Planted) -> None:
    found = found_in(planted, "scale", "length")
    # The edges are 1/8 of the mesh's width: the determinant is 1/64 of its square, and the slant of the rays takes 2 %.
    assert [(one.law, one.side) for one in found] == [("scale", "below"), ("length", "below")]
    assert sentence(found) == "It misses every ray on a mesh narrower than 0.0081 and with directions shorter than 6.6e-05."
    assert explained(found) == "All of these are what a test does that takes a determinant below 1e-06 for 0."

    class Coarser(Planted):
        threshold = "1e-4"

    (coarser,) = found_in(Coarser(), "length")
    of_both = explained([coarser, Threshold("scale", "below", 0.08, 1.0, 1.0)])
    assert of_both is not None and "a determinant below 0.0001 for 0" in of_both
    # One number alone, or numbers that do not agree, explain nothing.
    assert explained(found[:1]) is None
    length = Threshold("length", "below", 1e-3, 1.0, 1.0)
    assert explained([found[0], length]) is None
    # A plane's normal has no size.
    angle = Threshold("angle", "below", 1e-3, 1.0, 1.0)
    assert explained([angle, length]) == "Both are what a test does that takes unit normal times direction below 0.001 for 0."
    assert explained([found[0], angle, length]) == (
        "Angle and length are what a test does that takes unit normal times direction below 0.001 for 0."
    )


def test_the_tracer_has_no_threshold() -> None:
    assert found_in(Tracer(), *LAWS) == []


def test_what_is_lost_on_the_other_side_is_told_too() -> None:
    class Short(Referee):
        def shoot(self, built: Any, rays: Rays) -> Hits:
            told = super().shoot(built, rays)
            assert told.face is not None
            is_long = (np.abs(rays[:, 3:6]).max(axis=1) > 1e7) & (np.arange(len(rays)) % 4 > 0)
            return Hits(np.where(is_long & told.hit, told.face ^ 1, told.face), told.t)

    (found,) = found_in(Short(), "length")
    assert (found.law, found.side) == ("length", "above") and 0.9e7 < found.at < 1.1e7
    assert sentence([found]) == "It answers wrongly more than half of all rays with directions longer than 1e+07."


def test_a_hunt_leaves_a_reproducer_that_reproduces(planted: Planted, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # A ball as large as a fist, in kilometres.
    phi = np.linspace(0, 2 * np.pi, 9)[:-1]
    ring = np.stack([np.cos(phi), np.sin(phi), 0 * phi], axis=1)
    vertices = np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]]) * 5e-4
    k = np.arange(8)
    faces = np.concatenate([np.stack([k, (k + 1) % 8, 0 * k + 8], axis=1), np.stack([(k + 1) % 8, k, 0 * k + 9], axis=1)])
    raypencil.Mesh(vertices, faces).save(tmp_path / "ball")
    words = ["hunt", "planted", "--mesh", str(tmp_path / "ball"), "--rays", "36", "--most", "2", "-o", str(tmp_path / "out")]
    assert _command.main(words) == 1
    said = capsys.readouterr().out
    assert "wrong of 36 rays by Planted 1.0" in said and said.count("1 face: no hit; exact: face 0 at t = ") == 2
    text = (tmp_path / "out" / "planted-1.py").read_text()
    assert len(text.splitlines()) <= 20 and "raypencil" not in text
    done = subprocess.run([sys.executable, "-I", str(tmp_path / "out" / "planted-1.py")], capture_output=True, text=True)
    assert done.stdout == "told: -1 inf\n", done.stderr
    issue = (tmp_path / "out" / "planted-1.md").read_text()
    assert issue.startswith("Planted 1.0 tells no hit for this ray; the exact answer is face 0 at t = ") and text in issue
    # Where nothing is wrong, nothing is written.
    assert _command.main(["hunt", "referee", "--terrains", "1", "--rays", "12", "-o", str(tmp_path / "none")]) == 0
    assert not (tmp_path / "none").exists()


def test_a_reproducer_that_tells_otherwise_is_not_left(planted: Planted, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = raypencil.Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) * 1e-4, [[0, 1, 2]])
    wrong, found = hunted(planted, mesh, 24, 1, 1)
    assert wrong > 0 and len(found) == 1
    monkeypatch.setitem(_snippets.PYTHON, "planted", "face, t = 0, 1.5")
    assert hunted(planted, mesh, 24, 1, 1) == (wrong, [])
    monkeypatch.setitem(_snippets.PYTHON, "planted", "face, t = nothing")
    with pytest.raises(raypencil.RaypencilError, match="does not run: .*nothing"):
        hunted(planted, mesh, 24, 1, 1)
    missed, hit = Hits(np.array([-1]), np.array([np.inf])), Hits(np.array([3]), np.array([2.0]))
    assert reproduces(missed, -1, np.inf) and not reproduces(missed, 0, 1.0)
    assert reproduces(hit, 3, 2.0) and not reproduces(hit, 3, 2.1) and not reproduces(hit, 2, 2.0)
    assert reproduces(Hits(None, hit.t), -1, 2.0)


def test_a_wrong_ray_is_reduced_to_one_face_and_short_numbers(planted: Planted) -> None:
    vertices = np.array([[x / 7, y / 7, 0.123456789] for y in range(8) for x in range(8)]) / 300
    faces = np.array([[8 * y + x, 8 * y + x + 1, 8 * y + x + 9] for y in range(7) for x in range(7)])
    case = Case(vertices, faces, np.array([0.0008, 0.0003, 1.1, 0.0, 0.0, -1.3, 0.0, np.inf]))
    assert wrong_hit(planted, case) is not None
    small = reduced(planted, case)
    assert len(small.faces) == 1 and wrong_hit(planted, small) is not None
    # Few binary digits, as fractions show.
    assert max(Fraction(x).numerator.bit_length() for x in [*small.vertices.flat, *small.ray[:6]]) <= 4
    with pytest.raises(raypencil.RaypencilError, match="alone the ray is answered rightly"):
        reduced(planted, Case(vertices * 300, faces, case.ray * [300, 300, 1, 1, 1, 1, 1, 1]))


def test_faces_are_left_out_also_where_none_is_likely() -> None:
    class Crowded(Referee):
        """Sees nothing where there are three faces or more."""

        def shoot(self, built: Any, rays: Rays) -> Hits:
            told = super().shoot(built, rays)
            return told if len(built.faces) < 3 else Hits(np.full(len(rays), -1), np.full(len(rays), np.inf))

    vertices = np.array([[x, y, 0.25 * x] for y in range(6) for x in range(6)], dtype=float)
    faces = np.array([[6 * y + x, 6 * y + x + 1, 6 * y + x + 7] for y in range(5) for x in range(5)])
    case = Case(vertices, faces, np.array([2.7, 3.2, 9.0, 0.0, 0.0, -1.0, 0.0, np.inf]))
    small = reduced(Crowded(), case)
    assert len(small.faces) == 3 and len(small.vertices) <= 9 and small.faces.max() == len(small.vertices) - 1


def test_faces_are_left_out_also_where_each_of_them_moves_all_corners() -> None:
    class Centred(Referee):
        """Moves a mesh to its middle in single precision, and loses the rays that begin at every sixteenth place there."""

        def shoot(self, built: Any, rays: Rays) -> Hits:
            told = super().shoot(built, rays)
            begins = (rays[:, 0:3] - built.vertices.mean(axis=0)).sum(axis=1).astype(np.float32)
            is_lost = begins.view(np.uint32) % 16 == 0
            assert told.face is not None
            return Hits(np.where(is_lost, -1, told.face), np.where(is_lost, np.inf, told.t))

    vertices, faces = bumpy(24)
    mesh = raypencil.Mesh(vertices, faces)
    rays, _ = hunting_rays(mesh, 240, 1)
    _, wrong = peers.judged(Centred(), question := peers.asked(Centred, mesh, rays), Centred().first(mesh, question.rays))
    assert 5 < len(wrong) < 40
    for k in wrong[:5]:
        small = reduced(Centred(), Case(vertices, faces, question.rays[k]))
        assert len(small.faces) <= 2 and wrong_hit(Centred(), small) is not None


def test_the_exact_answer_is_that_of_the_referee() -> None:
    mesh = raypencil.Mesh([[0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 0]], [[0, 1, 2], [3, 2, 1]])
    one = peers.asked(Referee, mesh, np.array([[1.0, 1, 3, 0, 0, -7]]))
    assert exact(one) == Exact((0,), Fraction(3, 7)) and str(exact(one)) == "face 0 at t = 3/7"
    edge = peers.asked(Referee, mesh, np.array([[2.0, 2, 3, 0, 0, -1]]))
    assert str(exact(edge)) == "faces 0 and 1 at t = 3"
    away = peers.asked(Referee, mesh, np.array([[9.0, 9, 3, 0, 0, -1]]))
    assert str(exact(away)) == "no hit"
    # Were they of two minds, that would be told.
    edge.nearest.pop()
    edge.nearest.append(frozenset({0}))
    with pytest.raises(raypencil.RaypencilError, match=r"the referee says \[0\] at 3.0; by fractions it is \(0, 1\) at 3"):
        exact(edge)


def test_rays_of_a_hunt_are_of_all_kinds_and_the_same_again() -> None:
    ground = raypencil.Mesh([[0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 1]], [[0, 1, 2], [3, 2, 1]])
    rays, aims = hunting_rays(ground, 120, 3)
    assert len(set(aims)) == 6 and np.isfinite(rays[:, :6]).all() and (rays[:, 3:6] != 0).any(axis=1).all()
    assert np.array_equal(rays, hunting_rays(ground, 120, 3)[0]) and not np.array_equal(rays, hunting_rays(ground, 120, 4)[0])


def test_a_reproducer_can_be_written_for_each_other_program() -> None:
    # tinybvh is a header of C++ that no package installs.
    lines = {*_snippets.PYTHON, *_snippets.NODE, *_snippets.RUST, "tinybvh", "tinybvh-double"}
    assert [one.name for one in peers.every_peer() if one.registry != "here" and one.name not in lines] == []


def test_a_reproducer_in_rust_names_its_crates(fake_program: Callable[[str], None]) -> None:
    fake_program('echo "bvh 0.13.0"')
    one = peers.peer("bvh")
    case = Case(np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0.5]]), np.array([[0, 1, 2]]), np.array([1, 1, 3, 0, 0, -2.0, 0, np.inf]))
    text = script(one, case, exact(case.question(one)))
    assert text.startswith("// bvh (Rust) 0.13.0: one ray, of which the exact answer is face 0 at t = 23/8.\n")
    assert '// Cargo.toml: bvh = "=0.13.0"\n// Cargo.toml: nalgebra = "0.35"\nfn main() {\n' in text
    assert "let v: Vec<[f64; 3]> = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.5]];" in text
    assert "let f: Vec<[u32; 3]> = vec![[0, 1, 2]];" in text
    # Its directions are 1 long.
    assert "let (o, d): ([f64; 3], [f64; 3]) = ([1.0, 1.0, 3.0], [0.0, 0.0, -1.0]);" in text
    assert text.endswith('println!("told: {face} {t}");\n}\n') and ending(one) == "rs"


@pytest.mark.parametrize("name", ["embree", "libigl", "trimesh", "vtk-static", "mitsuba-llvm", "warp", "three", "jolt"])
def test_the_lines_of_a_reproducer_ask_what_the_adapter_asks(name: str) -> None:
    one = peers.peer(name)
    try:
        one.version()
    except peers.Unavailable as missing:
        pytest.skip(str(missing))
    vertices = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 1], [4, 0, 1], [0, 4, 1.0]])
    for ray in ([1, 1, 3, 0, 0, -2.0], [9, 9, 3, 0, 0, -1]):
        case = Case(vertices, np.array([[0, 1, 2], [3, 4, 5]]), np.array([*ray, 0, np.inf]))
        question = case.question(one)
        face, t = told_by(one, script(one, case, exact(question)))
        assert reproduces(one.first(question.mesh, question.rays), face, t)


class Known(Planted):
    """The planted peer, whose source was read."""

    name, title = "known", "Known"
    causes = ("It takes a determinant below 1e-06 for 0 (`meet`, src/meet.c).",)
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {("scale", "below"): "make directions longer"}


def measured(one: peers.Peer, **families: Counts | str) -> Measured:
    whole: dict[str, Counts | str] = {name: Counts(10) for name in raypencil.testing.hard_rays()}
    shares: dict[str, list[tuple[float, float | None]]] = {"scale": [(1.0, 0.0), (10.0, 0.5), (100.0, None)]}
    found = [Threshold("scale", "below", 0.0081, 1.0, 1.0)] if isinstance(one, Planted) else []
    return Measured(one, "1.0", "one machine", {**whole, **families}, shares, found, 1234.0)


def test_a_paragraph_says_what_is_lost_and_what_to_do() -> None:
    one = measured(Planted(), edges=Counts(10, missed=2, invented=1, other=3, wrong=4, ranges=5, convention=6), tiny="Error: no\nmore")
    assert paragraph(one) == (
        "**Planted** (planted 1.0; reads mesh and rays in double precision; judged as f64). 4 of 170 first hits are wrong: edges 4."
        " Of 830 rays through edges and vertices of a closed mesh 4 are not stopped where they should be. It misses every ray on a"
        " mesh narrower than 0.0081. By its convention 6 rays meet faces without an area. 5 ranges are off by more than rounding. It refuses the mesh of tiny (Error: no). What to do:"
        " scale a small mesh, with its rays, to a width of about 1, and t back; do not count crossings of closed meshes by it."
        " `raypencil-peers ask planted`"
    )
    single = paragraph(measured(Planted(), edges=Counts(10, missed=1, wrong=1)))
    assert "a closed mesh 1 is not stopped where it should be." in single
    assert cell(one.families["edges"]) == "**4** of 6, convention 6" and cell("Error") == "refused" and cell(Counts(9)) == "0"
    assert cell(Counts(9, other=2)) == "0 of 2"
    assert "It answers all rays exactly." in paragraph(measured(Referee()))

    class InPlane(Planted):
        meets_in_plane = True

    assert "By its convention 1 ray meets faces in whose plane the ray lies." in paragraph(measured(InPlane(), edges=Counts(10, convention=1)))
    # What its source says stands for what is concluded from thresholds, and its own remedy for the general one.
    known = paragraph(measured(Known()))
    assert "narrower than 0.0081. It takes a determinant below 1e-06 for 0 (`meet`, src/meet.c). What to do: make directions longer." in known


def test_the_page_has_a_row_and_a_paragraph_for_each() -> None:
    several = [measured(Planted(), edges=Counts(10, missed=2, wrong=2)), measured(Tracer())]
    text = page(several, {"embree": "pip install embreex"})
    assert "| Planted | 1.0 | 180 | 2 | 0 | 0 | **2** | 0 | 0 | 1,200 |" in text and "\n**Planted** (" in text
    assert "* embree: not asked here (pip install embreex)." in text and all(name in text for name in peers.LEFT_OUT)
    assert all(f"| {name} |" in text for name in raypencil.testing.hard_rays())
    # The machine is that of most; the others are named.
    elsewhere = replace(several[0], machine="a card, 16 cores")
    assert "on a machine of one machine," in text and "On another machine" not in text
    told = page([elsewhere, *several], {})
    assert "on a machine of one machine," in told and "On another machine (a card, 16 cores) were asked: Planted." in told
    for drawn in (laws_svg(several), speed_svg(several)):
        assert ElementTree.fromstring(drawn).tag.endswith("svg") and "Planted<" in drawn
    assert 'fill="#cccccc"' in laws_svg(several)


def test_the_page_says_what_the_two_commands_took(tmp_path: Path) -> None:
    quick, slow = (replace(measured(one), seconds=seconds, load=load) for one, seconds, load in ((Planted(), 66.0, 0.5), (Tracer(), 240.0, 4.0)))
    environment, kept = tmp_path / "environment", tmp_path / "kept"
    environment.mkdir()
    kept.mkdir()
    assert installed(kept, environment) == []
    (environment / "installed.tsv").write_text("an empty environment\t4\t26\nPython's packages\t90\t5000\n")
    steps = installed(kept, environment)
    assert steps == [Step("an empty environment", 4, 26), Step("Python's packages", 90, 5000)]
    # What is kept stands for what was made, also where another environment writes the page.
    assert installed(kept, tmp_path / "none") == steps
    told = page([quick, slow], {}, steps)
    assert "| Python's packages | 90 | 5,000 |\n| all | 94 | 5,026 |" in told
    assert "The second takes 5 minutes; the longest of them raypencil's tracer 4 and Planted 1." in told
    assert "one program after the other, beside other work (its load, when each began, was 0.5 to 4)" in told
    again = page([quick, replace(slow, times=3)], {}, steps)
    assert "was 0.5 to 4), up to 3 times in other hours, of which the highest speed stands; threads" in again
    # Where nobody noted the time of one, nothing is said of all.
    some = page([quick, measured(Tracer())], {})
    assert "The second takes" not in some and "not all in the same hour" in some and "installed.tsv" not in some


def test_the_page_of_the_docs_has_the_words_of_the_adapters_of_what_is_kept() -> None:
    folders = [ROOT / "reference" / "peers" / name for name in ("kept", "card")]
    names = [one.name for one in peers.every_peer()]
    assert sorted(file.stem for folder in folders for file in folder.glob("*.json")) == sorted(names)
    several, missing = measure(names, folders[0], lambda line: pytest.fail(line), folders[1])
    if missing:
        pytest.skip(f"the questions are others than those of the page: {missing}")
    assert page(several, {}, installed(folders[0], ROOT)) == (ROOT / "docs" / "peers.md").read_text(encoding="utf-8")


def test_a_process_that_dies_is_followed_by_another() -> None:
    done = work("tracer", [{"family": "duplicates"}, {"nonsense": True}, {"family": "needles"}])
    assert done[0]["answer"][:2] == [100, 0] and done[2]["answer"][0] == 160
    assert done[1] == {"refused": "its process ended with code 1"}
    assert "did not answer in 0.01 s" in work("tracer", [{"family": "needles"}], patience=0.01)[0]["refused"]


def test_what_a_peer_refuses_is_kept() -> None:
    answers: list[dict[str, Any]] = [{"refused": "Error: flat"}] * (len(raypencil.testing.hard_rays()) + len(LAWS) + 1)
    one = of_answers(Tracer(), "1.0", "one machine", answers)
    assert one.total == Counts() and set(one.refused.values()) == {"Error: flat"} and one.speed is None
    assert all(share is None for shares in one.shares.values() for _, share in shares)


def test_the_command(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert _command.main(["list"]) == 0
    told = capsys.readouterr().out
    assert all(f"{one.name} " in told for one in peers.every_peer()) and "Not asked:" in told
    assert _command.main(["ask", "embre"]) == 2 and "no peer `embre`" in capsys.readouterr().err
    assert _command.main(["hunt", "tracer", "--mesh", "none.stl"]) == 2 and "none.stl" in capsys.readouterr().err
    kept = tmp_path / "kept"
    assert _command.main(["table", "tracer", "--kept", str(kept), "-o", str(tmp_path / "peers.md")]) == 0
    text = (tmp_path / "peers.md").read_text()
    assert "| raypencil's tracer |" in text and (tmp_path / "figures" / "peers-laws.svg").is_file()
    # What is kept is not asked again, and the page has the same bytes.
    assert measure(["tracer"], kept, lambda line: pytest.fail(line))[0][0].total.wrong == 0
    assert _command.main(["table", "tracer", "--kept", str(kept)]) == 0 and text in capsys.readouterr().out
    # What another machine kept says so, and is not asked here.
    answers = json.loads((kept / "tracer.json").read_text())
    assert answers["machine"] == machine()
    other = tmp_path / "other"
    other.mkdir()
    (other / "tracer.json").write_text(json.dumps({**answers, "machine": "a card, 16 cores"}))
    assert _command.main(["table", "tracer", "--elsewhere", str(other)]) == 0
    assert "on a machine of a card, 16 cores," in capsys.readouterr().out
    assert f"on a machine of {machine()}," in text and "On another machine" not in text
    assert _command.main(["table", "tracer", "--elsewhere", str(tmp_path / "none")]) == 2 and "none` is no folder" in capsys.readouterr().err
    # A speed that is asked again is kept where it is higher, and only then.
    slow = {**answers, "answers": [*answers["answers"][:-1], {"answer": {"rays": 1, "seconds": 9.0, "faces": 8192}}]}
    for given, is_kept in ((slow, False), ({**slow, "answers": [*slow["answers"][:-1], {"answer": {"rays": 10**12, "seconds": 1.0}}]}, True)):
        (kept / "tracer.json").write_text(json.dumps(given))
        assert _command.main(["table", "tracer", "--kept", str(kept), "--time-again"]) == 0
        now = json.loads((kept / "tracer.json").read_text())
        assert (now["answers"] == given["answers"]) is is_kept and now["answers"][:-1] == answers["answers"][:-1] and now["times"] == 2
    assert _command.main(["table", "tracer", "--time-again"]) == 2 and "needs `--kept DIR`" in capsys.readouterr().err
    # Answers to other questions are refused.
    (kept / "tracer.json").write_text('{"jobs": [], "version": "", "machine": "", "answers": []}')
    assert _command.main(["table", "tracer", "--kept", str(kept)]) == 2


def test_a_card_that_is_not_there_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    class Driver:
        def __init__(self, cards: int) -> None:
            self.cards = cards

        def cuInit(self, flags: int) -> int:
            return 0

        def cuDeviceGet(self, into: Any, number: int) -> int:
            return 0 if number < self.cards else 101

        def cuDeviceGetName(self, name: Any, size: int, device: Any) -> int:
            name.value = b"a card"
            return 0

    def missing(name: str) -> None:
        raise OSError(name)

    for library, words in ((missing, "no driver of one here"), (lambda name: Driver(0), "its driver finds none here")):
        monkeypatch.setattr(ctypes, "CDLL", library)
        _card.card.cache_clear()
        with pytest.raises(peers.Unavailable, match=words):
            peers.peer("warp-cuda").device()
    monkeypatch.setattr(ctypes, "CDLL", lambda name: Driver(1))
    assert peers.peer("mitsuba-cuda").device() == "a card" and machine("a card").startswith("a card, ")
    _card.card.cache_clear()
    assert peers.peer("tracer").device() == PROCESSOR and PROCESSOR not in machine()


def test_what_is_lost_between_two_values_is_told_so() -> None:
    class Middling(Tracer):
        def shoot(self, built: Any, rays: Rays) -> Hits:
            told = super().shoot(built, rays)
            length = np.linalg.norm(rays[:, 3:6], axis=1)
            is_lost = (length > 1e7) & (length < 1e16)
            assert told.face is not None
            return Hits(np.where(is_lost, -1, told.face), np.where(is_lost, np.inf, told.t))

    (found,) = found_in(Middling(), "length")
    assert found.to is not None and 0.9e7 < found.at < 1.1e7 and 0.9e16 < found.to < 1.1e16
    assert sentence([found]) == "It misses every ray with directions 1e+07 to 1e+16 long."
    assert explained([found, found]) is None
