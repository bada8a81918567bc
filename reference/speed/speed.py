"""Times raypencil and Embree on the very same triangles and rays, in turns, and writes docs/speed.md.

    speed.py PROGRAM [--mesh FILE] [--rounds N] [-o FILE]

PROGRAM is the example `speed` of the crate `raypencil`, built with optimisation. Embree is that of the Python package
`embreex` (reference/requirements.txt), called from C++ (embree.cpp); without it, or without a C++ compiler, the page says
so and has no column of it. `just speed` does all this.
"""

import argparse
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from tables import number, processor, table

HERE = Path(__file__).resolve().parent
SIZES = ["2000", "200000", "2000000"]
RUNS_A_ROUND = 5
MAP_ROWS = [f"{what}, {name}" for what in ("camera", "beams", "returns") for name in ("scanline", "tracer")]


def embree_program(folder: Path) -> Path | None:
    """The C++ program, linked to the library inside the package; None if that cannot be."""
    spec = importlib.util.find_spec("embreex")
    libraries = sorted(Path(spec.origin).parent.with_name("embreex.libs").glob("libembree4*")) if spec else []
    if not libraries:
        print("embreex is not installed: no times of Embree", file=sys.stderr)
        return None
    program = folder / "embree"
    command = ["c++", "-std=c++20", "-O2", "-march=native", str(HERE / "embree.cpp"), "-o", str(program)]
    command += [str(libraries[0]), f"-Wl,-rpath,{libraries[0].parent}"]
    try:
        subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"no C++ compiler that makes it: {error}: no times of Embree", file=sys.stderr)
        return None
    return program


class Runs:
    """Times of each row, as lists: one list a round."""

    def __init__(self):
        self.times: dict[str, list[list[float]]] = {}

    def add(self, measured: dict):
        for row, times in measured.items():
            times = times if isinstance(times, list) else [times]
            self.times.setdefault(row, []).append([time for time in times if time is not None])

    def median(self, row: str) -> float | None:
        times = [time for of_round in self.times.get(row, []) for time in of_round]
        return median(times) if times else None

    def ratio(self, other: "Runs", row: str, of_other: str) -> float | None:
        """How many times as fast this is as the other: the median over the rounds, each a pair."""
        pairs = zip(self.times.get(row, []), other.times.get(of_other, []))
        ratios = [median(theirs) / median(ours) for ours, theirs in pairs if ours and theirs]
        return median(ratios) if ratios else None


def run(command: list[str], threads: int) -> dict:
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout.splitlines()[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--mesh", type=Path, help="a mesh of your own beside the generated grounds")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--no-scaling", action="store_true", help="leave out the tables by size, which take minutes")
    parser.add_argument("-o", "--out", type=Path)
    given = parser.parse_args()
    ours_program = str(given.program.resolve())
    grounds = {size: f"{int(size):,} faces" for size in SIZES}
    if given.mesh:
        grounds[str(given.mesh)] = given.mesh.stem

    ours, theirs, two, theirs_two = ({ground: Runs() for ground in grounds} for _ in range(4))
    with tempfile.TemporaryDirectory() as temporary:
        embree = embree_program(Path(temporary))
        for index, ground in enumerate(grounds):
            print(f"{grounds[ground]}: writing rays", file=sys.stderr)
            folder = Path(temporary) / str(index)
            subprocess.run([ours_program, "write", ground, str(folder)], check=True)
            for k in range(given.rounds):
                print(f"{grounds[ground]}: round {k + 1} of {given.rounds}", file=sys.stderr)
                measure = [ours_program, "measure", ground, str(RUNS_A_ROUND)]
                ours[ground].add(run([*measure, *MAP_ROWS, "floor"], 1))
                if embree:
                    theirs[ground].add(run([str(embree), str(folder), str(RUNS_A_ROUND), "1"], 1))
                two[ground].add(run([*measure, "first frame, tracer", "first frame, scanline"], 2))
                if embree:
                    theirs_two[ground].add(run([str(embree), str(folder), str(RUNS_A_ROUND), "2"], 2))
                two[ground].add(run([*measure, "validate"], 2))
                two[ground].add(run([ours_program, "measure", ground, "1", "referee", "drive"], 2))
            two[ground].add(run([ours_program, "measure", ground, "1", "pack"], 2))
            memory = run([ours_program, "measure", ground, "1", "memory"], 2)
            two[ground].add({"validation, bytes": memory["peak memory, bytes"], "faces": memory["faces"]})
        scaling, peak = ([], None) if given.no_scaling else scaled(ours_program)
    text = page(given, grounds, ours, theirs, two, theirs_two, embree is not None, scaling, peak)
    if given.out:
        beside = given.out.with_name(given.out.name + ".part")
        beside.write_text(text)
        beside.replace(given.out)
    else:
        print(text)


def scaled(program: str) -> tuple[list[str], float | None]:
    """Tables of times by the number of faces and by that of pixels, and the peak bytes a face of the largest ground."""
    rows = ["camera, scanline", "camera, tracer", "beams, scanline", "beams, tracer"]
    head = ["", *[f"{row}, {threads}" for row in rows for threads in ("1 thread", "2 threads")]]
    parts, peak = [], None
    by_faces = [(f"{faces}", f"{faces:,} faces", 3) for faces in (2_000, 20_000, 200_000, 2_000_000, 16_000_000)]
    by_pixels = [(f"200000@{side}", f"{side} x {side} pixels", 3) for side in (550, 1024, 2048, 4096, 8192)]
    for title, cases in (("By the number of faces", by_faces), ("By the number of pixels", by_pixels)):
        lines, last = [], None
        for ground, name, rounds in cases:
            print(f"scaling: {name}", file=sys.stderr)
            wanted = rows if title.endswith("faces") else rows[:2]
            one, two = (run([program, "measure", ground, str(rounds), *wanted], threads) for threads in (1, 2))
            first = run([program, "measure", ground, "1", "first frame, scanline", "first frame, tracer"], 2)
            memory = one["peak memory, bytes"]
            cells = [number(median(times[row])) if row in times else "" for row in wanted for times in (one, two)]
            trees = [number(first[f"first frame, {name}"][0]) for name in ("scanline", "tracer")]
            # What a face more takes: nothing that every frame has is in it.
            more = one["faces"] - last[1] if last else 0
            growth = (memory - last[0]) / more if more else None
            peak = memory / one["faces"] if title.endswith("faces") else peak
            last = (memory, one["faces"])
            extra = [*trees, number(growth), f"{memory / one['faces']:,.0f}"] if title.endswith("faces") else []
            lines.append([name, *cells, *extra])
        wide = head if title.endswith("faces") else head[:5]
        tail = ["clusters, 2 threads", "tree, 2 threads", "bytes a further face", "peak bytes a face"] if title.endswith("faces") else []
        parts.append(f"## {title}\n\n" + table([*wide, *tail], lines))
    return parts, peak


#: What is asked of whom, whether as much at least or at most, and what it would take where it is missed.
TRACER = (
    "It asks faces in f64, in lanes of four; Embree's packets ask them in f32, sixteen rays at once. A test in f32 with a proven bound, "
    "as the exact answers of any rays have it, would leave few faces to f64."
)
GOALS = {
    "camera, `tracer` / Embree, packets": (1.0, True, TRACER),
    "beams, `tracer` / Embree, packets": (1.0, True, "As of the camera."),
    "returns, `tracer` / shadow rays alone, Embree, single": (
        1.0,
        True,
        "Ours are the whole returns, Embree's the shadow rays alone. View, geometry and flux are formed for one pencil after the other, and "
        "could be in lanes.",
    ),
    "camera, `scanline` / Embree, packets": (3.0, True, "Where its time goes on grounds of millions of faces was not looked at."),
    "beams, `scanline` / Embree, packets": (2.0, True, "As of the camera."),
    "a whole validation of the own mesh, ms": (
        80.0,
        False,
        "Both renderers form every quantity of every pixel, and both are compared; which of the three takes how much was not looked at.",
    ),
    "a whole pack of the own mesh, ms": (3000.0, False, "How much of it the margins take was not looked at; docs/evidence/speed.md has what quicker ones would take."),
    "peak memory at 16,000,000 faces, bytes a face": (100.0, False, "Which arrays make it up was not listed."),
}


def goals_of(names, own, ours, two, theirs, peak: float | None) -> str:
    """Each goal beside what was measured, over all grounds."""

    def ratio(row: str, of_embree: str) -> list[float]:
        cells = (ours[ground].ratio(theirs[ground], row, of_embree) for ground in names)
        return [cell for cell in cells if cell]

    measured = {
        "camera, `tracer` / Embree, packets": ratio("camera, tracer", "camera, packets"),
        "beams, `tracer` / Embree, packets": ratio("beams, tracer", "beams, packets"),
        "returns, `tracer` / shadow rays alone, Embree, single": ratio("returns, tracer", "shadow, single"),
        "camera, `scanline` / Embree, packets": ratio("camera, scanline", "camera, packets"),
        "beams, `scanline` / Embree, packets": ratio("beams, scanline", "beams, packets"),
        "a whole validation of the own mesh, ms": [two[ground].median("validate") for ground in own],
        "a whole pack of the own mesh, ms": [two[ground].median("pack") for ground in own],
        "peak memory at 16,000,000 faces, bytes a face": [peak],
    }
    lines, left = [], []
    for what, (goal, is_least, would_take) in GOALS.items():
        values = [value for value in measured[what] if value]
        if not values:
            continue
        is_met = min(values) >= goal if is_least else max(values) <= goal
        cells = [number(value) for value in sorted({min(values), max(values)})]
        lines.append([what, f"at {'least' if is_least else 'most'} {goal:,g}", " to ".join(cells), "met" if is_met else "missed"])
        if not is_met:
            left.append(f"* **{what}**: {would_take}")
    missed = ["What it would take; none of it was tried:", "\n".join(left)] if left else []
    return "\n\n".join([table(["work", "goal", "measured", ""], lines), *missed])


def page(given, grounds, ours, theirs, two, theirs_two, has_embree: bool, scaling: list[str], scaled_bytes: float | None) -> str:
    names = list(grounds)
    head = ["ms", *[grounds[ground] for ground in names]]

    def row(title: str, runs: dict, key: str) -> list[str]:
        return [title, *[number(runs[ground].median(key)) for ground in names]]

    def ratios(title: str, mine: dict, key: str, others: dict, of_other: str) -> list[str]:
        cells = [mine[ground].ratio(others[ground], key, of_other) for ground in names]
        return [title, *[f"{cell:.2f}" if cell else "-" for cell in cells]]

    lines = []
    for what, of_embree in (("camera", "camera"), ("beams", "beams"), ("returns", "shadow")):
        lines += [row(f"{what}, `{name}`", ours, f"{what}, {name}") for name in ("scanline", "tracer")]
        for kind in ("single", "packets") if has_embree else ():
            title = "shadow rays alone" if what == "returns" else what
            lines.append(row(f"{title}, Embree, {kind}", theirs, f"{of_embree}, {kind}"))
    lines.append(row("clusters of `scanline`, first frame, 2 threads", two, "first frame, scanline"))
    lines.append(row("tree of `tracer`, first frame, 2 threads", two, "first frame, tracer"))
    if has_embree:
        lines.append(row("tree of Embree, medium quality, 2 threads", theirs_two, "tree"))
    lines.append(row("a whole validation, tree and tables kept, 2 threads", two, "validate"))
    lines.append(row("a cycle of the rover with the noise of `cmos`, 2 threads", two, "drive"))
    lines.append(row("certified camera rays a second, 2 threads", two, "referee"))
    lines.append(row("a whole pack, 2 threads", two, "pack"))
    memory = [two[ground].median("validation, bytes") for ground in names]
    lines.append(["memory of a validation, MB", *[number(of and of / 1e6) for of in memory]])
    lines.append(row("floor: to read the mesh once", ours, "floor: the mesh read once"))
    lines.append(row("floor: to write the camera's map once", ours, "floor: the map written once"))

    def floors(title: str, runs: dict, key: str, *floor: str) -> list[str]:
        cells = []
        for ground in names:
            time, least = runs[ground].median(key), [ours[ground].median(f"floor: {name}") for name in floor]
            cells.append(f"{time / sum(least):.0f}" if time and all(least) else "-")
        return [title, *cells]

    both, mesh = ("the mesh read once", "the map written once"), ("the mesh read once",)
    above = [floors(f"camera, `{name}`", ours, f"camera, {name}", *both) for name in ("scanline", "tracer")]
    above.append(floors("tree of `tracer`", two, "first frame, tracer", *mesh))
    above.append(floors("clusters of `scanline`", two, "first frame, scanline", *mesh))
    # 120 bytes a face, and 150 a pixel or pencil for each of the two renderers.
    cells_of_rig = 1024 * 1024 + 2 * 1024 * 16
    faces = [two[ground].median("faces") for ground in names]
    share = [f"{of / (120 * n + 300 * cells_of_rig):.2f}" if of else "-" for of, n in zip(memory, faces)]

    goals = []
    if has_embree:
        for what, of_embree in (("camera", "camera"), ("beams", "beams"), ("returns", "shadow")):
            other = "shadow rays" if what == "returns" else what
            for kind in ("single", "packets"):
                title = f"{what}, `tracer` / {other}, Embree, {kind}"
                goals.append(ratios(title, ours, f"{what}, tracer", theirs, f"{of_embree}, {kind}"))
        for what in ("camera", "beams"):
            title = f"{what}, `scanline` / Embree, packets"
            goals.append(ratios(title, ours, f"{what}, scanline", theirs, f"{what}, packets"))
        goals.append(ratios("tree / Embree, 2 threads", two, "first frame, tracer", theirs_two, "tree"))

    own = [str(given.mesh)] if given.mesh else []
    asked = goals_of(names, own, ours, two, theirs, scaled_bytes) if has_embree else ""

    command = "just speed" + (" MESH" if given.mesh else "")
    parts = [
        "# How fast\n",
        f"Made by `{command}` (`reference/speed/speed.py`) on one {processor()}, {os.cpu_count()} threads of it. "
        f"Medians of {given.rounds} rounds of "
        f"{RUNS_A_ROUND} runs; in each round the programs take turns. One thread, unless a row says otherwise.\n",
        "The grounds are generated plains of 50 m x 50 m"
        + (", and a mesh of the user's own (the last column). " if given.mesh else ". ")
        + "The rig is the default one: a camera of 1024 x 1024 pixels, two beams of 1024 x 16 pencils. A map is the range "
        "and the face of every ray. *Returns* are what follows from the pencils' hits: line of sight to the camera, "
        "geometry and light.\n",
        table(head, lines) + "\n",
        "## Above the floor\n",
        "No camera map is made without the map's memory being written and the mesh being read, and no tree without the "
        "latter. How many times as long each takes:\n",
        table(["", *head[1:]], above) + "\n",
        "The memory of a validation (both renderers with every quantity, the comparison, the scene itself) as a part of 120 "
        "bytes a face and 150 bytes a pixel or pencil and renderer:\n",
        table(["", *head[1:]], [["memory", *share]]) + "\n",
    ]
    if has_embree:
        parts += [
            "## Beside Embree\n",
            "Embree 4.4 in robust mode gets the same triangles and the same rays in single precision, with the same nearest "
            "and farthest t: one at a time, and in packets of sixteen neighbours of a row, marked as coherent. It gives the "
            "range and the face of the nearest hit from either side. raypencil's answers are in double precision, to the bit "
            "the same on every machine, and of the fronts alone. Our times include the making of the rays and of the map; "
            "Embree's rays lie ready in memory. The trees are compared as each program builds its own.\n",
            "How many times as fast raypencil is (median of the ratios of all rounds):\n",
            table(["", *head[1:]], goals) + "\n",
            "## Goals\n",
            asked + "\n",
        ]
    else:
        parts.append("Embree could not be asked: the package `embreex` or a C++ compiler is missing.\n")
    parts += [part + "\n" for part in scaling]
    return "\n".join(parts)


if __name__ == "__main__":
    main()
