#!/usr/bin/env python3
"""Asks ray tracers the hard rays of data/rays/hard, and writes who answers how many wrongly.

    python3 reference/hard_rays.py RAYPENCIL -o docs/hard-rays.md

RAYPENCIL is the binary. Tracers that cannot be imported are left out, and the page says so: Embree (embreex), Mitsuba 3,
Open3D, trimesh (requirements-peers.txt), and the triangle test of obvhs, a program beside the binary:

    cargo build --release -p raypencil-cast --features examples --example obvhs_triangles

 Those that compute in single precision are asked the question that they can
read: mesh and rays are rounded to f32 first, and the answer is that of the rounded question. So what is counted is no
fault of the input. The bindings take no t_min; rays that have one are left out for all tracers.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
HARD = ROOT / "data" / "rays" / "hard"


def obj(path):
    vertices, faces = [], []
    for line in path.read_text().splitlines():
        kind, *words = line.split()
        (vertices if kind == "v" else faces).append([float(w) if kind == "v" else int(w) - 1 for w in words])
    return np.array(vertices), np.array(faces, dtype=np.int64)


class Question:
    """A mesh and rays as a pack of rays, which has the exact answers to them."""

    def __init__(self, binary, vertices, faces, rays):
        self.binary, self.vertices, self.faces, self.rays = binary, vertices, faces, rays
        self.kept = tempfile.TemporaryDirectory()
        self.folder = Path(self.kept.name)
        (self.folder / "mesh").mkdir()
        np.save(self.folder / "mesh" / "vertices.npy", vertices)
        np.save(self.folder / "mesh" / "faces.npy", faces.astype("<u4"))
        np.save(self.folder / "rays.npy", rays)
        self.run("pack", self.folder / "mesh", "--rays", self.folder / "rays.npy", "-o", self.folder / "pack")
        load = lambda name: np.load(self.folder / "pack" / f"{name}.npy")
        start, face, group = (load(f"all.{name}") for name in ("start", "face", "group"))
        self.nearest = [
            {int(f) for f, g in zip(face[a:b], group[a:b]) if g == 0} for a, b in zip(start[:-1], start[1:])
        ]

    def run(self, *words):
        done = subprocess.run([self.binary, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode not in (0, 1):
            sys.exit(done.stderr)
        return done.stdout

    def judge(self, said, double):
        """Missed, invented, of another face; and of all these how many the tracer's rounding does not excuse."""
        missed = sum(face is None and bool(nearest) for face, nearest in zip(said, self.nearest))
        invented = sum(face is not None and not nearest for face, nearest in zip(said, self.nearest))
        other = sum(face is not None and bool(near) and face not in near for face, near in zip(said, self.nearest))
        answers = self.folder / "said"
        answers.mkdir(exist_ok=True)
        np.save(answers / "face.npy", np.array([-1 if face is None else face for face in said], dtype="<i8"))
        precision = "f64" if double else "f32"
        checked = json.loads(self.run("check", self.folder / "pack", answers, "--arithmetic", precision, "--json"))
        return [missed, invented, other, checked["candidate"]["counts"]["wrong"]]


def embree(robust):
    def ask(question):
        from embreex import rtcore_scene
        from embreex.mesh_construction import TriangleMesh

        scene = rtcore_scene.EmbreeScene(robust=robust)
        TriangleMesh(scene, question.vertices.astype(np.float32), question.faces.astype(np.int32))
        rays = question.rays.astype(np.float32)
        found = scene.run(rays[:, :3].copy(), rays[:, 3:6].copy(), dists=rays[:, 7].copy(), output=1)
        return [int(face) if face >= 0 else None for face in found["primID"]]

    return ask


def mitsuba(variant):
    def ask(question):
        import mitsuba as mi

        mi.set_variant(variant)
        mesh = mi.Mesh("mesh", len(question.vertices), len(question.faces))
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = np.ravel(question.vertices.astype(np.float32))
        parameters["faces"] = np.ravel(question.faces.astype(np.uint32))
        parameters.update()
        scene = mi.load_dict({"type": "scene", "mesh": mesh})
        said = []
        rays = question.rays.astype(np.float32)
        if variant.startswith("scalar"):
            for row in rays:
                one = mi.Ray3f(o=row[:3].tolist(), d=row[3:6].tolist(), maxt=float(row[7]), time=0.0, wavelengths=[])
                found = scene.ray_intersect_preliminary(one)
                said.append(int(found.prim_index) if found.is_valid() else None)
            return said
        columns = [np.ascontiguousarray(rays[:, k]) for k in (0, 1, 2, 3, 4, 5, 7)]
        many = mi.Ray3f(o=mi.Point3f(*columns[:3]), d=mi.Vector3f(*columns[3:6]))
        many.maxt = mi.Float(columns[6])
        found = scene.ray_intersect_preliminary(many, coherent=False)
        index, valid = np.array(found.prim_index), np.array(found.is_valid())
        return [int(face) if is_hit else None for face, is_hit in zip(index, valid)]

    return ask


def open3d(question):
    import open3d as o3d

    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(question.vertices.astype(np.float32), question.faces.astype(np.uint32))
    rays = np.ascontiguousarray(question.rays[:, :6], dtype=np.float32)
    found = scene.cast_rays(o3d.core.Tensor(rays))
    index, t = found["primitive_ids"].numpy(), found["t_hit"].numpy()
    # It takes no end of a ray: what it finds beyond is no hit.
    is_hit = np.isfinite(t) & (t <= question.rays[:, 7])
    return [int(face) if hit else None for face, hit in zip(index, is_hit)]


def trimesh(question):
    import trimesh as tm
    from trimesh.ray.ray_triangle import RayMeshIntersector

    mesh = tm.Trimesh(question.vertices, question.faces, process=False, validate=False)
    said = [None] * len(question.rays)
    faces, rays, points = RayMeshIntersector(mesh).intersects_id(
        question.rays[:, :3], question.rays[:, 3:6], return_locations=True, multiple_hits=True
    )
    best = {}
    for face, k, point in zip(faces, rays, points):
        d = question.rays[k, 3:6]
        axis = int(np.argmax(np.abs(d)))
        t = (point[axis] - question.rays[k, axis]) / d[axis]
        if 0 <= t <= question.rays[k, 7] and (k not in best or t < best[k][0]):
            best[k] = (t, int(face))
    for k, (_, face) in best.items():
        said[k] = face
    return said


def obvhs(question):
    program = Path(question.binary).resolve().parent / "examples" / "obvhs_triangles"
    if not program.is_file():
        raise ImportError(f"no {program.name} beside the binary")
    answers = question.folder / "obvhs.npy"
    subprocess.run([program, question.folder / "mesh", question.folder / "rays.npy", answers], check=True)
    return [int(face) if face >= 0 else None for face in np.load(answers)]


def version_of(package):
    """Of a Python package, or of a crate in the lock file."""
    try:
        return version(package)
    except PackageNotFoundError:
        lines = (ROOT / "Cargo.lock").read_text().splitlines()
        at = lines.index(f'name = "{package}"') if f'name = "{package}"' in lines else -1
        return lines[at + 1].split('"')[1] if at >= 0 else "of unknown version"


# Name, package, whether it computes in f64, how it is asked.
PEERS = [
    ("Embree", "embreex", False, embree(False)),
    ("Embree, robust", "embreex", False, embree(True)),
    ("Mitsuba, scalar_rgb", "mitsuba", False, mitsuba("scalar_rgb")),
    ("Mitsuba, llvm_ad_rgb", "mitsuba", False, mitsuba("llvm_ad_rgb")),
    ("Open3D", "open3d", False, open3d),
    ("obvhs, own test", "obvhs", False, obvhs),
    ("trimesh", "trimesh", True, trimesh),
]


def tracer(binary, folder):
    """raypencil's own tracer on all rays, judged by `cast --with`: wrong and rounded."""
    command = [binary, "cast", folder / "mesh.obj", folder / "rays.npy", "--with", "tracer", "--json"]
    answer = json.loads(subprocess.run(command, stdout=subprocess.PIPE).stdout)
    return answer["compared"]["counts"]


# What was seen when the wrong answers were looked at, with the versions of requirements-peers.txt.
MISSES = [
    "**long-directions**: Embree and Open3D miss the rays whose directions are about 2^-66 long, Mitsuba also those that"
    " are about 2^66 long: in f32 their products vanish or overflow. trimesh misses all, also those of 2^30.",
    "**tiny**, **grazing**, **folds**: trimesh works in f64 and misses whole families all the same: its tests have"
    " thresholds that do not shrink with the mesh.",
    "**on-surface**, **just-before**, **far-origins**: in f32 the origin is rounded by more than the way to the surface;"
    " every such answer is right for a ray nearby, and Embree's robust mode gets those near the surface right.",
    "**axis-aligned**, **in-plane**: rays along the outline of a mesh, where a ray beside it misses.",
    "**edges**, **vertices**: nobody leaks at ordinary scale, distance and length of the direction.",
    "**tiny**, **huge** (Embree, Mitsuba: one answer each; obvhs: three in tiny, one in nearly-coincident), **far-origins**"
    " (trimesh: four): farther off than rounding excuses; the causes are not known.",
    "**on-surface**, **in-plane**, **grazing**: obvhs's own test (Möller and Trumbore's, in f32) takes a coordinate of -0 for"
    " outside and its quotient at n.d near 0 as it comes; within its rounding all the same. raypencil's tracer takes"
    " only the boxes of obvhs.",
    "Not asked: Mitsuba in double precision, which its packages do not have.",
    "**one-ulp-beside**, **nearly-coincident**: answers that f64 cannot tell apart. trimesh takes a farther layer on 60"
    " rays that it could.",
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("-o", "--output", type=Path, required=True)
    arguments = parser.parse_args()
    families = json.loads((HARD / "families.json").read_text())
    results, skipped, asked, own = {}, {}, {}, {}
    for family in families:
        folder = HARD / family["name"]
        vertices, faces = obj(folder / "mesh.obj")
        rays = np.load(folder / "rays.npy")
        rays = rays[rays[:, 6] == 0]
        own[family["name"]] = tracer(arguments.binary, folder)
        single = rays.astype(np.float32)
        fits = np.isfinite(single[:, :6]).all(axis=1) & (single[:, 3:6] != 0).any(axis=1)
        questions = {
            True: Question(arguments.binary, vertices, faces, rays),
            False: Question(
                arguments.binary, vertices.astype(np.float32).astype(float), faces, single[fits].astype(float)
            ),
        }
        asked[family["name"]] = {double: len(question.rays) for double, question in questions.items()}
        for name, package, double, ask in PEERS:
            if name in skipped:
                continue
            try:
                said = ask(questions[double])
            except ImportError as error:
                skipped[name] = str(error)
                continue
            results[family["name"], name] = questions[double].judge(said, double)
        print(family["name"], file=sys.stderr)
    arguments.output.write_text(page(families, results, skipped, asked, own))
    print(f"{arguments.output} is written")


def page(families, results, skipped, asked, own):
    peers = [peer for peer in PEERS if peer[0] not in skipped]
    lines = [
        "# Hard rays: who answers how many wrongly",
        "",
        "Made by `python3 reference/hard_rays.py RAYPENCIL -o docs/hard-rays.md` from the rays of `data/rays/hard`"
        " ([what they are](../data/rays/README.md)). The truth is `raypencil cast`, which agrees bit for bit with"
        " `reference/exact_cast.py`. [peers.md](peers.md) asks 30 packages, and finds from where on each loses rays.",
        "",
        "Tracers in single precision are asked what they can read: mesh and rays are rounded to f32 first, and the truth is"
        " that of the rounded question. trimesh and raypencil's tracer compute in f64. A cell counts wrong first hits:"
        " *missed* + *invented* + *other face* (none of those at the nearest t). In brackets: how many of these are wrong by"
        " the rule of `raypencil check`, which excuses an answer that is right for one ray moved sideways by 16 u S (u: the"
        " tracer's unit roundoff; S: the largest coordinate plus the origin's) and for ranges that are off by their rounding"
        " ([cast.md](guide/cast.md)).",
        "",
        "| family | rays | " + " | ".join(name for name, *_ in peers) + " | raypencil's tracer |",
        "| --- | ---: | " + " | ".join("---:" for _ in peers) + " | ---: |",
    ]
    totals = {name: np.zeros(4, dtype=int) for name, *_ in peers}
    rays = 0
    cell = lambda r: "0" if not sum(r[:3]) else f"{r[0]} + {r[1]} + {r[2]}" + (f" (**{r[3]}**)" if r[3] else " (0)")
    for family in families:
        name = family["name"]
        cells = []
        for peer, *_ in peers:
            totals[peer] += results[name, peer]
            cells.append(cell(results[name, peer]))
        rays += asked[name][True]
        counts = own[name]
        excused = f", {counts['rounding']} rounded" if counts["rounding"] else ""
        lines.append(f"| {name} | {asked[name][True]} | " + " | ".join(cells) + f" | {counts['wrong']}{excused} |")
    sums = " | ".join(cell(totals[name].tolist()) for name, *_ in peers)
    wrong, rounded = (sum(counts[key] for counts in own.values()) for key in ("wrong", "rounding"))
    lines.append(f"| all | {rays} | {sums} | {wrong}, {rounded} rounded |")
    lines += ["", "## What the families are", ""]
    lines += [f"* **{family['name']}**: {family['what']} {family['goesWrong']}" for family in families]
    lines += ["", "## What the misses are", ""] + [f"* {line}" for line in MISSES]
    lines += ["", "## Who was asked", ""]
    for name, package, double, _ in PEERS:
        if name in skipped:
            lines.append(f"* {name}: left out, {skipped[name]}.")
            continue
        lines.append(f"* {name}: {package} {version_of(package)}, in {'f64' if double else 'f32'}.")
    lines += [
        "* raypencil's tracer: in f64, all rays, also those with a t_min.",
        "",
        "Mitsuba's packages are built with Embree, in both variants. Where mesh and rays are rounded to f32, `far-mesh` has"
        " hardly a face with an area left, and `one-ulp-beside` is `edges`.",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
