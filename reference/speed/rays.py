"""Times any rays by raypencil, Embree, Open3D and Warp, asked from Python in turns, and writes docs/evidence/speed.md.

    rays.py [--mesh FILE]... [--faces N ...] [--rays N] [--rounds N] [-o FILE]

Needs the package `raypencil`, and asks embreex, open3d and warp-lang where they are installed. Times are those of the
processor, of one thread, so that other work beside it changes them little. `just speed-rays` does all this.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import raypencil
from tables import number, processor, table

HERE = Path(__file__).resolve().parent
VALUES = ("range", "point", "normal", "barycentric", "cos_incidence")

#: Calls with one ray that are timed together.
ONE_BY_ONE = 500


def seconds(call: Callable[[], Any]) -> float:
    start = time.process_time()
    call()
    return time.process_time() - start


class Ours:
    """raypencil's referee or tracer, one thread."""

    def __init__(self, mesh: raypencil.Mesh, with_: str) -> None:
        self.title = "exact" if with_ == "referee" else "`tracer`"
        self.with_, self.kept = with_, mesh.build(with_)

    def build(self) -> Any:
        fresh = raypencil.Mesh(self.kept.vertices, self.kept.faces)
        return lambda: fresh.build(self.with_, threads=1)

    def ask(self, rays: np.ndarray, values: tuple[str, ...] | None, query: str = "first") -> Callable[[], Any]:
        return lambda: raypencil.cast(self.kept, rays, values=values, query=query, with_=self.with_, threads=1)

    def first(self, rays: np.ndarray) -> Callable[[], Any]:
        return self.ask(rays, ("face", "t"))

    def any(self, rays: np.ndarray) -> Callable[[], Any]:
        return self.ask(rays, (), "any")


class Embree:
    title = "Embree, robust"

    def __init__(self, mesh: raypencil.Mesh) -> None:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        vertices, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.int32)

        def built() -> Any:
            scene = EmbreeScene(robust=True)
            # Its tree is made when it is first asked.
            kept = TriangleMesh(scene, vertices, faces)
            scene.run(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))
            return scene, kept

        self.built, self.scene = built, built()

    def build(self) -> Any:
        return self.built

    def first(self, rays: np.ndarray) -> Callable[[], Any]:
        origins, directions = (np.ascontiguousarray(rays[:, at], np.float32) for at in (slice(0, 3), slice(3, 6)))
        return lambda: self.scene[0].run(origins, directions, output=1)

    def any(self, rays: np.ndarray) -> Callable[[], Any]:
        origins, directions = (np.ascontiguousarray(rays[:, at], np.float32) for at in (slice(0, 3), slice(3, 6)))
        return lambda: self.scene[0].run(origins, directions, query="OCCLUDED")


class Open3D:
    title = "Open3D"

    def __init__(self, mesh: raypencil.Mesh) -> None:
        import open3d as o3d

        self.o3d, vertices, faces = o3d, mesh.vertices.astype(np.float32), np.array(mesh.faces)

        def built() -> Any:
            scene = o3d.t.geometry.RaycastingScene(nthreads=1)
            scene.add_triangles(vertices, faces)
            scene.cast_rays(o3d.core.Tensor(np.ones((1, 6), np.float32)))
            return scene

        self.built, self.scene = built, built()

    def build(self) -> Any:
        return self.built

    def tensor(self, rays: np.ndarray) -> Any:
        return self.o3d.core.Tensor(np.ascontiguousarray(rays[:, :6], np.float32))

    def first(self, rays: np.ndarray) -> Callable[[], Any]:
        tensor = self.tensor(rays)
        return lambda: self.scene.cast_rays(tensor, nthreads=1)

    def any(self, rays: np.ndarray) -> Callable[[], Any]:
        tensor = self.tensor(rays)
        return lambda: self.scene.test_occlusions(tensor, nthreads=1)

    def all(self, rays: np.ndarray) -> Callable[[], Any]:
        tensor = self.tensor(rays)
        return lambda: self.scene.list_intersections(tensor, nthreads=1)


class Warp:
    title = "Warp, processor"

    def __init__(self, mesh: raypencil.Mesh) -> None:
        import warp as wp
        from raypencil.peers.adapters._warp_kernel import first as kernel

        wp.config.quiet = True
        self.wp, self.kernel = wp, kernel
        points = wp.array(mesh.vertices.astype(np.float32), dtype=wp.vec3, device="cpu")
        corners = wp.array(mesh.faces.astype(np.int32).ravel(), dtype=wp.int32, device="cpu")
        self.built = lambda: wp.Mesh(points=points, indices=corners)
        self.mesh = self.built()

    def build(self) -> Any:
        return self.built

    def first(self, rays: np.ndarray) -> Callable[[], Any]:
        wp, count = self.wp, len(rays)
        parts = [wp.array(np.ascontiguousarray(rays[:, a:b], np.float32), dtype=wp.vec3, device="cpu") for a, b in ((0, 3), (3, 6))]
        ends = wp.full(count, float(np.finfo(np.float32).max), dtype=wp.float32, device="cpu")
        face = wp.full(count, -1, dtype=wp.int32, device="cpu")
        t = wp.zeros(count, dtype=wp.float32, device="cpu")
        inputs = [self.mesh.id, *parts, ends, face, t]
        return lambda: wp.launch(self.kernel, dim=count, inputs=inputs, device="cpu")


def generated(faces: int) -> raypencil.Mesh:
    """A square of 8 m with bumps of all sizes, and rocks that stand out of it."""
    side = int(np.sqrt(faces / 2)) + 1
    draw = np.random.default_rng(side)
    steps = np.linspace(0, 8, side)
    x, y = np.meshgrid(steps, steps, indexing="ij")
    z = np.zeros_like(x)
    for k in range(24):
        long = 8 * 0.75**k
        (a, b), phase = draw.normal(size=2) / long, draw.uniform(0, 2 * np.pi)
        z += 0.05 * long**0.8 * np.sin(2 * np.pi * (a * x + b * y) + phase) / 4
    for _ in range(200):
        at, radius = draw.uniform(0, 8, 2), 0.05 + draw.exponential(0.08)
        square = ((x - at[0]) ** 2 + (y - at[1]) ** 2) / radius**2
        z = np.maximum(z, z + radius * np.sqrt(np.clip(1 - square, 0, None)))
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    quads = [[corner, corner + side, corner + side + 1], [corner, corner + side + 1, corner + 1]]
    indices = np.concatenate([np.stack(of, axis=-1) for of in quads])
    return raypencil.Mesh(np.stack([x, y, z], axis=-1).reshape(-1, 3), indices)


def camera_rays(mesh: raypencil.Mesh, count: int) -> np.ndarray:
    """A camera above a corner's quarter of the ground, which looks to its middle, row by row."""
    (low, high), up, sides = frame(mesh)
    side = int(np.sqrt(count))
    eye = 0.5 * (low + high)
    eye[sides[0]] = low[sides[0]] + 0.25 * (high - low)[sides[0]]
    eye[up] = high[up] + 0.1 * (high - low)[sides].max()
    ahead = 0.5 * (low + high) - eye
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, np.eye(3)[up])
    right /= np.linalg.norm(right)
    above = np.cross(right, ahead)
    v, u = np.meshgrid(*(np.linspace(-0.4, 0.4, side),) * 2, indexing="ij")
    directions = ahead + u.reshape(-1, 1) * right - v.reshape(-1, 1) * above
    return as_stored(np.broadcast_to(eye, directions.shape), directions)


def random_rays(mesh: raypencil.Mesh, count: int) -> np.ndarray:
    """From anywhere above the ground down to anywhere: no two share anything."""
    (low, high), up, _ = frame(mesh)
    share = np.random.default_rng(1).random((2, count, 3))
    share[0, :, up] = 1 + 0.5 * share[0, :, up]
    share[1, :, up] *= 0.5
    origins, targets = low + (high - low) * share
    return as_stored(origins, targets - origins)


def frame(mesh: raypencil.Mesh) -> tuple[Any, int, list[int]]:
    bounds = mesh.bounds
    assert bounds is not None
    up = int(np.argmin(bounds[1] - bounds[0]))
    return bounds, up, [axis for axis in range(3) if axis != up]


def as_stored(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The same numbers for all: those of single precision."""
    return np.concatenate([origins, directions], axis=1).astype(np.float32).astype(np.float64)


class Times:
    """Seconds of each row in each column, one for each round."""

    def __init__(self) -> None:
        self.of: dict[tuple[str, str], list[float]] = {}

    def add(self, row: str, column: str, time: float) -> None:
        self.of.setdefault((row, column), []).append(time)

    def median(self, row: str, column: str) -> float | None:
        times = self.of.get((row, column))
        return median(times) if times else None

    def ratio(self, row: str, other: str, column: str) -> float | None:
        """The median over the rounds, each a pair."""
        ours, theirs = self.of.get((row, column)), self.of.get((other, column))
        return median(a / b for a, b in zip(ours, theirs, strict=True)) if ours and theirs else None


def installed(mesh: raypencil.Mesh) -> list[Any]:
    found: list[Any] = [Ours(mesh, "referee"), Ours(mesh, "tracer")]
    for other in (Embree, Open3D, Warp):
        try:
            found.append(other(mesh))
        except ImportError as error:
            print(f"{other.title} is not asked: {error}", file=sys.stderr)
    return found


def measure(name: str, mesh: raypencil.Mesh, count: int, rounds: int, times: Times, costs: Times) -> None:
    programs = installed(mesh)
    exact = programs[0]
    kinds = {"camera": camera_rays(mesh, count), "random": random_rays(mesh, count)}
    tenth = kinds["random"][: max(1, count // 10)]
    one = kinds["random"][:1, 0:3], kinds["random"][:1, 3:6]
    for k in range(rounds):
        print(f"{name}: round {k + 1} of {rounds}", file=sys.stderr)
        for program in programs:
            times.add(f"tree, {program.title}", name, seconds(program.build()))
        for kind, rays in kinds.items():
            for program in programs:
                times.add(f"first, {program.title}", f"{name}, {kind}", 1e6 * seconds(program.first(rays)) / len(rays))
            for program in programs:
                if hasattr(program, "any"):
                    times.add(f"any, {program.title}", f"{name}, {kind}", 1e6 * seconds(program.any(rays)) / len(rays))
        first = seconds(exact.first(tenth))
        times.add("all, exact", name, seconds(exact.ask(tenth, (), "all")) / first)
        for program in programs[2:]:
            if hasattr(program, "all"):
                times.add(f"all, {program.title}", name, seconds(program.all(tenth)) / seconds(program.first(tenth)))
        rays = kinds["random"]
        for value in ("t", *VALUES):
            faces = seconds(exact.ask(rays, ("face",)))
            costs.add(value, name, 1e6 * (seconds(exact.ask(rays, (value,))) - faces) / len(rays))
        some = tenth[:1000]
        costs.add("margins", name, len(some) / seconds(lambda: raypencil.cast(mesh, some, values=(), margins=True, threads=1)))
        for what, values in (("one, every value", None), ("one, face and t", ("face", "t"))):

            def calls(values: Any = values) -> None:
                for _ in range(ONE_BY_ONE):
                    raypencil.cast(mesh, *one, values=values)

            costs.add(what, name, 1e6 * seconds(calls) / ONE_BY_ONE)


def memory_of(status: str) -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith(status))


def grown(program: str, folder: Path) -> None:
    """Prints by how many bytes this process grows, at its peak, from a mesh and rays in memory to a tree, and to the answers."""
    vertices, faces, rays = (np.load(folder / f"{name}.npy") for name in ("vertices", "faces", "rays"))
    first = vertices[:3], np.array([[0, 1, 2]], np.uint32)
    ask: Callable[[Any, Any], Callable[[Any], Any]]
    if program == "Open3D":
        import open3d as o3d

        rays = o3d.core.Tensor(rays)

        def ask(vertices: Any, faces: Any) -> Callable[[Any], Any]:
            scene = o3d.t.geometry.RaycastingScene(nthreads=1)
            scene.add_triangles(vertices, faces)
            return lambda rays: scene.cast_rays(rays, nthreads=1)
    else:
        with_, _, asked = program.partition(": ")

        def ask(vertices: Any, faces: Any) -> Callable[[Any], Any]:
            mesh = raypencil.Mesh(vertices, faces)
            return lambda rays: raypencil.cast(mesh, rays, values=asked.split(", "), with_=with_, threads=1)

    # What the library itself takes is there before.
    ask(*first)(rays[:1])
    Path("/proc/self/clear_refs").write_text("5")
    before = memory_of("VmRSS:")
    answer = ask(vertices, faces)
    answer(rays[:1])
    tree = memory_of("VmHWM:") - before
    answers = answer(rays)
    print(tree, memory_of("VmHWM:") - before)
    del answers


#: Programs whose memory is told, and how they are called. Open3D has no choice of arrays: face, t, normal and two weights, in f32.
GROWING = {
    "exact, face and t": "referee: face, t",
    "exact, face, t, normal, weights": "referee: face, t, normal, barycentric",
    "`tracer`, face and t": "tracer: face, t",
    "Open3D": "Open3D",
}

#: Rays of which the memory is measured.
MANY = 1_000_000


def memory(name: str, mesh: raypencil.Mesh, sizes: dict[tuple[str, str], list[float]]) -> None:
    """Megabytes of each program for its tree, and with a million answers, each in a process of its own."""
    print(f"{name}: memory", file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        of = {"vertices": mesh.vertices.astype(np.float32), "faces": mesh.faces, "rays": random_rays(mesh, MANY).astype(np.float32)}
        for what, array in of.items():
            np.save(Path(folder) / f"{what}.npy", array)
        for title, program in GROWING.items():
            told = subprocess.run([sys.executable, __file__, "--grown", program, folder], capture_output=True, text=True, check=False)
            if told.returncode:
                print(f"{title}: memory is not told: {told.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
                continue
            sizes[title, name] = [int(size) / 1e6 for size in told.stdout.split()]


def page(given: argparse.Namespace, grounds: dict[str, int], times: Times, costs: Times, sizes: dict[tuple[str, str], list[float]]) -> str:
    columns = [f"{name}, {kind}" for name in grounds for kind in ("camera", "random")]
    titles = [title for title in ("exact", "`tracer`", "Embree, robust", "Open3D", "Warp, processor")]

    def absolute(what: str, of: list[str]) -> list[list[str]]:
        rows = [[title, *(number(times.median(f"{what}, {title}", column)) for column in of)] for title in titles]
        return [row for row in rows if set(row[1:]) != {"-"}]

    def ratios(what: str, of: list[str]) -> list[list[str]]:
        other = f"{what}, Embree, robust"
        cells = [[title, *(number(times.ratio(f"{what}, {title}", other, column)) for column in of)] for title in titles]
        return [row for row in cells if set(row[1:]) != {"-"} and row[0] != "Embree, robust"]

    shares = [times.ratio("first, exact", "first, `tracer`", column) for column in columns]
    known = [share for share in shares if share is not None]
    names = list(grounds)
    speeds = f"{min(known):.1f} to {max(known):.1f}" if known else "-"
    parts = [
        "# The speed of any rays",
        "<!-- stands on\nmade_by = \"just speed-rays\"\nmeasured = \"times of one machine, of raypencil and of other people's programs\"\n-->",
        f"`just speed-rays` measures this page from Python ([rays.py](../../reference/speed/rays.py)): {processor()}, one thread, medians of "
        f"{given.rounds} rounds of {given.rays:,} rays, in which the programs take turns. Times are those of the processor, not of a clock. "
        + ("Other work ran beside, which makes all of them longer. " if os.getloadavg()[0] > 1.5 * (os.cpu_count() or 1) else "")
        + "The others compute in single precision, and get vertices and rays that are numbers of it. The trees are there already. "
        "*Camera* rays share their origin, row by row; *random* rays share nothing. The grounds have "
        + ", ".join(f"{faces:,} faces ({name})" for name, faces in grounds.items())
        + ".",
        f"**The tracer is {speeds} times as fast as the exact answers**, face and t alone.",
        "## First hits: face and t",
        "Microseconds a ray:",
        table(["", *columns], absolute("first", columns)),
        "Times as long as Embree, robust (the median of the ratios of all rounds; the goal is 1.5 for exact answers, 1 for the tracer):",
        table(["", *columns], ratios("first", columns)),
        "## Whether anything is hit",
        "Microseconds a ray:",
        table(["", *columns], absolute("any", columns)),
        "Times as long as Embree, robust (the goal is 1.2 for exact answers):",
        table(["", *columns], ratios("any", columns)),
        "## Trees",
        "Seconds, one thread:",
        table(["", *names], absolute("tree", names)),
        "## All hits",
        "Times as long as the same program's first hits (the goal is 3):",
        table(["", *names], absolute("all", names)),
        "## Values, margins, single rays",
        "What a correctly rounded value costs beside the face, microseconds a ray (the goal is 0.4 a quantity):",
        table(["", *names], [[f"`{value}`", *(number(costs.median(value, name)) for name in names)] for value in ("t", *VALUES)]),
        "Margins a second, and microseconds of a call with one ray on a kept tree (the goal is 20):",
        table(
            ["", *names],
            [
                [title, *(number(costs.median(row, name)) for name in names)]
                for title, row in (("margins a second", "margins"), ("one ray, face and t", "one, face and t"), ("one ray, every value", "one, every value"))
            ],
        ),
        "## Memory",
        f"Megabytes by which a process grows at its peak from a mesh and {MANY:,} random rays in memory, both in f32, to the tree, and on to the "
        "answers. raypencil keeps the mesh in f64 beside its tree, and answers in f64; Open3D's answers are in f32.",
        table(
            ["", *(f"{name}, {what}" for name in names for what in ("tree", "answers"))],
            [
                [title, *(cell for name in names for cell in [f"{size:.0f}" for size in sizes.get((title, name), [])] or ["-", "-"])]
                for title in GROWING
            ],
        ),
        "## Goals",
        "The ranges are over all grounds and kinds of rays.",
        goals(grounds, times, costs, sizes),
        "## A million rays beside Open3D",
        "[million.py](../../reference/speed/million.py) asks both on any mesh:",
        "```py\n" + (HERE / "million.py").read_text().strip() + "\n```",
    ]
    return "\n\n".join(parts) + "\n"


def goals(grounds: dict[str, int], times: Times, costs: Times, sizes: dict[tuple[str, str], list[float]]) -> str:
    """Each goal beside what was measured, and of what is missed what it would take."""
    names, columns = list(grounds), [f"{name}, {kind}" for name in grounds for kind in ("camera", "random")]

    def known(values: Iterable[float | None]) -> list[float]:
        return [value for value in values if value is not None]

    def ratio(what: str, title: str) -> list[float]:
        return known(times.ratio(f"{what}, {title}", f"{what}, Embree, robust", column) for column in columns)

    def costing(rows: Iterable[str]) -> list[float]:
        return known(costs.median(row, name) for row in rows for name in names)

    def share(of: float, a: str, b: str, column: str) -> float:
        return of * (times.median(a, column) or 0.0) / (times.median(b, column) or 1.0)

    walk = [share(100, "any, exact", "first, exact", column) for column in columns]
    def times_open3d(title: str) -> list[float]:
        pairs = [(sizes.get((title, name)), sizes.get(("Open3D", name))) for name in names]
        return [ours[1] / theirs[1] for ours, theirs in pairs if ours and theirs]

    trees = known(times.ratio("tree, exact", "tree, Embree, robust", name) for name in names)
    embree = "times Embree, robust"
    rows = [
        (
            "exact first hits: face and t",
            1.5,
            f"{{}} {embree}",
            ratio("first", "exact"),
            f"Asking for any hit alone takes {min(walk):.0f} to {max(walk):.0f} % of it: the walk through the boxes is the most. Tried: the same program "
            "compiled for AVX2 is no quicker, and to seek the nearest box instead of sorting all is slower. So it seems to be less "
            "the arithmetic of a step than what it decides, and that it waits. Fewer steps would help: a tree that is cut by surface area, where ours halves the faces by "
            "their number. Then t: its pairs of f64 are formed for one ray after the other, and could be for four in lanes.",
        ),
        (
            "`tracer`: face and t",
            1.0,
            f"{{}} {embree}",
            ratio("first", "`tracer`"),
            "Where a camera's rays meet a face several times, 64 of them walk as a packet, which halves the time. Where nearly each meets another "
            "face, a packet is slower than its rays in turns (tried: with 16, 32 and 64 rays); it would take packets whose leaves are asked in f32, too.",
        ),
        ("any hit, exact", 1.2, f"{{}} {embree}", ratio("any", "exact"), "The walk, as of first hits."),
        ("all hits, exact", 3.0, "{} times first hits", known(times.median("all, exact", name) for name in names), ""),
        (
            "a correctly rounded value on top",
            0.4,
            "{} microseconds",
            costing(("t", *VALUES)),
            "Its double-doubles are formed for one ray after the other: four rays in lanes.",
        ),
        (
            "margins a second, one thread",
            10_000,
            "{}",
            costing(["margins"]),
            "Each looks at the faces and edges around its ray, the nearest first, one at a time. Whole boxes of them would have to be let "
            "go, and rays that are neighbours to share what they look at.",
        ),
        ("one ray, face and t, tree kept", 20, "{} microseconds", costing(["one, face and t"]), ""),
        ("tree of the exact answers, one thread", 1.0, f"{{}} {embree}", trees, ""),
        ("memory, exact: face and t", 1.2, "{} times Open3D", times_open3d("exact, face and t"), "The leaves' numbers of vertices could be formed from the faces."),
        (
            "memory, exact: the arrays of Open3D",
            1.2,
            "{} times Open3D",
            times_open3d("exact, face, t, normal, weights"),
            "They are of f64, twice as wide; in f32 they would not be exact.",
        ),
        (
            "memory, `tracer`: face and t",
            1.2,
            "{} times Open3D",
            times_open3d("`tracer`, face and t"),
            "It has the corners of all faces in f64; numbers of vertices would take a quarter.",
        ),
    ]
    cells, left = [], []
    for what, goal, form, values, would_take in rows:
        is_most = what.startswith("margins")
        is_met = bool(values) and (min(values) >= goal if is_most else max(values) <= goal)
        measured = " to ".join(f"{value:,.0f}" if value >= 100 else f"{value:.3g}" for value in (min(values), max(values))) if values else "-"
        asked = f"{'at least' if is_most else 'at most'} {goal:,g}"
        cells.append([what, asked, form.format(measured), "met" if is_met else "missed"])
        if would_take and not is_met:
            left.append(f"* **{what}**: {would_take}")
    return "\n\n".join([table(["work", "goal", "measured", ""], cells), *(["What it would take; nothing of it was tried that is not called so:", "\n".join(left)] if left else [])])


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--mesh", action="append", default=[], help="a mesh of your own beside the generated grounds")
    parser.add_argument("--faces", type=int, nargs="*", default=[20_000, 660_000], help="sizes of generated grounds")
    parser.add_argument("--rays", type=int, default=250_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("-o", "--out", type=Path)
    parser.add_argument("--grown", nargs=2, metavar=("PROGRAM", "FOLDER"), help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.grown:
        grown(given.grown[0], Path(given.grown[1]))
        return
    meshes = {f"generated {faces // 1000} k": generated(faces) for faces in given.faces}
    for file in given.mesh:
        meshes[Path(file).stem] = raypencil.load_mesh(file)
    times, costs = Times(), Times()
    sizes: dict[tuple[str, str], list[float]] = {}
    grounds = {}
    for name, mesh in meshes.items():
        mesh = raypencil.Mesh(mesh.vertices.astype(np.float32), mesh.faces)
        grounds[name] = len(mesh.faces)
        measure(name, mesh, given.rays, given.rounds, times, costs)
        memory(name, mesh, sizes)
    text = page(given, grounds, times, costs, sizes)
    if given.out:
        beside = given.out.with_name(given.out.name + ".part")
        beside.write_text(text)
        beside.replace(given.out)
    else:
        print(text)


if __name__ == "__main__":
    main()
