"""Finds wrong rays of a peer on a mesh, and leaves reproducers that need nothing of raypencil."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import terrain
from .._errors import RaypencilError
from .._mesh import Mesh, load_mesh
from . import _snippets
from ._known import peer as peer_of
from ._page import how_rounded
from ._peer import Hits, Peer, Rays, segment_length
from ._question import asked, judged
from ._reduce import Case, Exact, exact, reduced, wrong_hit
from .adapters.node import NODE_FOLDER, NodePeer
from .adapters.rust import RustPeer

#: Seconds that a reproducer in Rust may take: the first one builds the crates.
_BUILDS = 1800

#: What rays aim at, in turns.
_AIMS = ("faces", "edges", "vertices", "grazing", "from far", "of any length")


def hunting_rays(mesh: Mesh, count: int, seed: int) -> tuple[Rays, list[str]]:
    """Rays at faces, edges and vertices, grazing, from far, and of any length; and of each what it is.

    Args:
        mesh: any mesh with faces.
        count: of rays.
        seed: the same seed has the same rays.
    """
    draw = np.random.default_rng(seed)
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    size = float(np.ptp(vertices, axis=0).max()) or 1.0
    kind = np.arange(count) % len(_AIMS)
    corners = vertices[faces[draw.integers(len(faces), size=count)]]
    weights = draw.dirichlet([1, 1, 1], count)
    weights[kind == 1, 2] = 0
    weights[kind == 2] = [1, 0, 0]
    weights /= weights.sum(axis=1, keepdims=True)
    targets = np.einsum("nk,nkx->nx", weights, corners)
    way = draw.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    with np.errstate(all="ignore"):
        normals = np.nan_to_num(normals / np.linalg.norm(normals, axis=1, keepdims=True))
    grazing = kind == 3
    flat = way - (way * normals).sum(axis=1, keepdims=True) * normals
    way[grazing] = (flat + normals * 10.0 ** draw.uniform(-8, -1, (count, 1)))[grazing]
    distance = np.where(kind == 4, 10.0 ** draw.uniform(1, 6, count), draw.uniform(0.5, 3, count)) * size
    length = np.where(kind == 5, 10.0 ** draw.uniform(-6, 6, count), 1.0)
    rays = np.empty((count, 8))
    rays[:, 0:3] = targets - distance[:, None] * way
    rays[:, 3:6] = way * length[:, None]
    rays[:, 6], rays[:, 7] = 0, np.inf
    return rays, [_AIMS[k] for k in kind]


def _list(numbers: object) -> str:
    return repr(np.asarray(numbers).tolist())


def ending(peer: Peer) -> str:
    """How the file of a peer's reproducer ends."""
    return "mjs" if isinstance(peer, NodePeer) else "rs" if isinstance(peer, RustPeer) else "py"


#: Before the line of a reproducer in Rust that names a crate, as Cargo.toml has it.
_NEEDS = "// Cargo.toml: "


def _in_rust(peer: Peer, about: str, case: Case) -> str:
    question = case.question(peer)
    body, more = _snippets.RUST[peer.name]
    needs = [f'{peer.package} = "={peer.version()}"', *more]
    ray = question.rays[0]
    values = [
        f"    let v: Vec<[f64; 3]> = vec!{_list(question.mesh.vertices)};",
        f"    let f: Vec<[u32; 3]> = vec!{_list(question.mesh.faces)};",
        f"    let (o, d): ([f64; 3], [f64; 3]) = ({_list(ray[0:3])}, {_list(ray[3:6])});",
    ]
    lines = [f"// {about}", *(f"{_NEEDS}{need}" for need in needs), "fn main() {", *values, body, '    println!("told: {face} {t}");', "}"]
    return "\n".join(lines) + "\n"


def script(peer: Peer, case: Case, truth: Exact) -> str:
    """A program that asks a peer one ray by the peer's own interface, and prints what it tells and what is exact.

    Raises:
        RaypencilError: there are no lines for this peer.
    """
    about = f"{peer.title} {peer.version()}: one ray, of which the exact answer is {truth}."
    if isinstance(peer, RustPeer) and peer.name in _snippets.RUST:
        return _in_rust(peer, about, case)
    question = case.question(peer)
    ray = question.rays[0]
    is_node = isinstance(peer, NodePeer)
    lines = (_snippets.NODE if is_node else _snippets.PYTHON).get(peer.name)
    if lines is None:
        raise RaypencilError(f"{peer.name}: there are no lines for a reproducer of it")
    given = {"V": question.mesh.vertices, "F": question.mesh.faces, "o": ray[0:3], "d": ray[3:6]}
    if peer.is_segment:
        length = segment_length(np.asarray(question.mesh.vertices), question.rays)
        given |= {"e": ray[0:3] + length[0] * ray[3:6], "T": length[0]}
    if is_node:
        imports = [line for line in lines.splitlines() if line.startswith("import ")]
        rest = [line for line in lines.splitlines() if not line.startswith("import ")]
        values = [f"const {name} = {_list(value)};" for name, value in given.items()]
        return "\n".join([f"// {about}", *imports, *values, *rest, 'console.log("told:", face, t);']) + "\n"
    values = [f"{name} = {_list(value)}" for name, value in given.items()]
    return "\n".join([f"# {about}", "import numpy as np", *values, *lines.splitlines(), 'print("told:", face, t)']) + "\n"


def told_by(peer: Peer, text: str) -> tuple[int, float]:
    """Runs a reproducer, and reads the face and the t that it prints.

    Raises:
        RaypencilError: it does not run, or prints something else.
    """
    kind, built = ending(peer), dict(os.environ)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        file = place / f"ray.{kind}"
        file.write_text(text, encoding="utf-8")
        words = [sys.executable, str(file)]
        if kind == "mjs":
            # Node looks for packages beside the program.
            (place / "node_modules").symlink_to(Path(os.environ.get(NODE_FOLDER, ".")).resolve() / "node_modules")
            words = ["node", str(file)]
        if kind == "rs":
            if shutil.which("cargo") is None:
                raise RaypencilError("there is no `cargo`, which builds reproducers in Rust")
            needs = "\n".join(line.removeprefix(_NEEDS) for line in text.splitlines() if line.startswith(_NEEDS))
            package = '[workspace]\n[package]\nname = "ray"\nedition = "2024"\n[[bin]]\nname = "ray"\npath = "ray.rs"\n[dependencies]\n'
            (place / "Cargo.toml").write_text(f"{package}{needs}\n", encoding="utf-8")
            # The crates are built once for all reproducers.
            built.setdefault("CARGO_TARGET_DIR", str(Path(tempfile.gettempdir(), "raypencil-reproducers")))
            words = ["cargo", "run", "--release", "--quiet"]
        done = subprocess.run(words, capture_output=True, text=True, timeout=_BUILDS if kind == "rs" else 300, cwd=folder, env=built)
    lines = [line for line in done.stdout.splitlines() if line.startswith("told: ")]
    if done.returncode != 0 or len(lines) != 1:
        raise RaypencilError(f"the reproducer does not run: {(done.stderr.strip().splitlines() or ['it prints nothing'])[-1]}")
    _, face, t = lines[0].split()
    return int(face), float(t.replace("Infinity", "inf"))


def reproduces(told: Hits, face: int, t: float) -> bool:
    """Whether a program tells what the adapter was told."""
    if not told.hit[0]:
        return not np.isfinite(t)
    same = bool(np.isclose(t, told.t[0], rtol=1e-5, atol=0))
    return same if told.face is None else same and face == int(told.face[0])


@dataclass(frozen=True, eq=False)
class Found:
    """A wrong ray, and the program that shows it."""

    aim: str
    case: Case
    told: Hits
    exact: Exact
    script: str

    def answer(self) -> str:
        """What the peer tells, in words."""
        if not self.told.hit[0]:
            return "no hit"
        face = "a hit" if self.told.face is None else f"face {self.told.face[0]}"
        return f"{face} at t = {self.told.t[0]:.9g}"

    def issue(self, peer: Peer) -> str:
        """A text to paste into an issue."""
        language = {"mjs": "js", "rs": "rust", "py": "python"}[ending(peer)]
        return (
            f"{peer.title} {peer.version()} tells {self.answer()} for this ray; the exact answer is {self.exact}.\n\n"
            f"```{language}\n{self.script}```\n\n"
            f"The exact answer is by fractions, of the numbers as they stand here. The program {how_rounded(peer)}. No ray that is"
            " moved sideways by up to 16 u S (u: the unit roundoff of that arithmetic; S: the largest coordinate plus the origin's)"
            " has the answer that is told: it is not a matter of rounding.\n"
        )


def hunted(peer: Peer, mesh: Mesh, count: int, seed: int, most: int) -> tuple[int, list[Found]]:
    """Wrong rays of a peer on a mesh: how many of `count`, and up to `most` of them reduced, of different aims first.

    Raises:
        Unavailable: the peer is not installed.
        RaypencilError: a reproducer does not run.
    """
    rays, aims = hunting_rays(mesh, count, seed)
    if peer.is_brute_force:
        rays = rays[: max(60, min(count, 2_000_000 // len(mesh.faces)))]
    question = asked(peer, mesh, rays)
    told = peer.first(question.mesh, question.rays)
    _, wrong = judged(peer, question, told)
    # One of each aim first.
    order = sorted(wrong.tolist(), key=lambda k: ([aims[question.of[j]] for j in wrong if j < k].count(aims[question.of[k]]), k))
    found: list[Found] = []
    for k in order[: 4 * most]:
        if len(found) == most:
            break
        case = Case(np.asarray(question.mesh.vertices), np.asarray(question.mesh.faces, dtype=np.int64), question.rays[k])
        if wrong_hit(peer, case) is None:
            # It is wrong among many rays only.
            continue
        case = reduced(peer, case)
        last = wrong_hit(peer, case)
        assert last is not None
        truth = exact(case.question(peer))
        text = script(peer, case, truth)
        face, t = told_by(peer, text)
        if reproduces(last, face, t):
            found.append(Found(aims[question.of[k]], case, last, truth, text))
    return len(wrong), found


def _meshes(mesh: str | None, terrains: int | None, seed: int) -> Iterator[tuple[str, Mesh]]:
    if mesh is not None:
        yield mesh, load_mesh(mesh)
    for k in range(terrains or 0):
        yield f"terrain {seed + k}", terrain.generate("smooth", seed + k, extent=8)


def hunt(name: str, mesh: str | None, terrains: int | None, seed: int, count: int, most: int, output: Path) -> int:
    """Hunts, prints what it finds, and writes the reproducers that ran. Returns 1 if something is found."""
    peer = peer_of(name)
    version, number, total = peer.version(), 0, 0
    # A card that is missing is told before anything is made.
    peer.device()
    for where, one in _meshes(mesh, terrains, seed):
        wrong, found = hunted(peer, one, count, seed, most - number)
        total += wrong
        print(f"{where}: {wrong} wrong of {count} rays by {peer.title} {version}")
        for case in found:
            number += 1
            file = output / f"{name}-{number}.{ending(peer)}"
            output.mkdir(parents=True, exist_ok=True)
            file.write_text(case.script, encoding="utf-8")
            (output / f"{name}-{number}.md").write_text(case.issue(peer), encoding="utf-8")
            size = f"{len(case.case.faces)} face{'s' if len(case.case.faces) > 1 else ''}"
            print(f"  {file}: {case.aim}, {size}: {case.answer()}; exact: {case.exact}")
        if number == most:
            break
    return 1 if total else 0
