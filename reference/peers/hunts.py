"""Hunts on meshes of other people's packages, and the page that says what came of them.

    ENV/bin/python reference/peers/hunts.py -o docs/peers-hunts.md [--keep DIR]

ENV is what `install.sh` makes; its package pybullet has the meshes. Each reproducer that `raypencil-peers hunt` leaves is run once more,
as the file that it is.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

import pybullet_data

import raypencil
from raypencil import peers

#: Of the folder of the package pybullet_data, and what each is.
MESHES = {
    "bunny.obj": "a bunny",
    "duck.obj": "a duck",
    "kuka_iiwa/meshes/link_7.obj": "the seventh link of an arm of KUKA",
}

PROGRAMS = (
    "embree", "embree-robust", "open3d", "trimesh", "trimesh-embree", "libigl", "vtk-static", "vtk-obb-all", "warp", "fcpw", "meshlib",
    "mujoco", "pybullet", "three-mesh-bvh",
)  # fmt: skip

RAYS = 4000


def hunted(program: str, mesh: Path, folder: Path) -> tuple[int, int, list[tuple[Path, str]]]:
    """Wrong rays, rays asked, and the reproducers with what the command says of each."""
    words = ["hunt", program, "--mesh", str(mesh), "--rays", str(RAYS), "-o", str(folder)]
    done = subprocess.run([sys.executable, "-m", "raypencil.peers._command", *words], capture_output=True, text=True, timeout=1800)
    # Warp writes of itself before.
    told = re.search(r": (\d+) wrong of (\d+) rays", done.stdout)
    if done.returncode not in (0, 1) or told is None:
        raise SystemExit(f"{program} on {mesh}: {done.stderr.strip() or done.stdout.strip()}")
    lines = [re.fullmatch(r"  (\S+): (.+)", line) for line in done.stdout[told.end() :].splitlines()]
    return int(told[1]), int(told[2]), [(Path(line[1]), line[2]) for line in lines if line]


def again(file: Path) -> str:
    """What a reproducer prints."""
    if file.suffix == ".mjs":
        modules = Path(os.environ["RAYPENCIL_PEERS_NODE"]).resolve() / "node_modules"
        if not (file.parent / "node_modules").exists():
            (file.parent / "node_modules").symlink_to(modules)
    words = ["node" if file.suffix == ".mjs" else sys.executable, file.name]
    done = subprocess.run(words, cwd=file.parent, capture_output=True, text=True, timeout=300)
    told = [line for line in done.stdout.splitlines() if line.startswith("told: ")]
    if len(told) != 1:
        raise SystemExit(f"{file} does not run: {done.stderr.strip()}")
    return told[0]


def page(folder: Path) -> str:
    """The page, hunt by hunt."""
    rows, shown, ran = [], [], 0
    shortest: dict[str, tuple[int, Path]] = {}
    for name, what in MESHES.items():
        mesh = Path(pybullet_data.getDataPath(), name)
        loaded = raypencil.load_mesh(mesh)
        for program in PROGRAMS:
            one = peers.peer(program)
            print(f"{one.title} on {name}", file=sys.stderr, flush=True)
            wrong, count, left = hunted(program, mesh, folder / mesh.stem / program)
            sizes = []
            for file, said in left:
                again(file)
                ran += 1
                faces = int(re.search(r"(\d+) faces?", said)[1])  # type: ignore[index]
                sizes.append(f"{faces} ({said.split(',')[0]})")
                if program not in shortest or faces < shortest[program][0]:
                    shortest[program] = (faces, file)
            rows.append(f"| {what} | {len(loaded.faces)} | {one.title} {one.version()} | {count} | {wrong} | {', '.join(sizes) or '-'} |")
    for program in PROGRAMS:
        if program in shortest:
            file = shortest[program][1]
            language = {".py": "python", ".mjs": "js"}[file.suffix]
            shown += ["", f"**{peers.peer(program).title}**", "", f"```{language}", file.read_text(encoding="utf-8").rstrip(), "```"]
            shown += ["", f"It prints `{again(file)}`."]
    lines = [
        "# Hunts on other people's meshes",
        "",
        "<!-- stands on",
        'made_by = "ENV/bin/python reference/peers/hunts.py -o docs/peers-hunts.md"',
        'measured = "other people\'s programs on meshes of another package, each at the version that the page names"',
        "-->",
        "",
        f"`raypencil-peers hunt` on meshes that the package pybullet {version('pybullet')} brings (`pybullet_data`: {', '.join(f'`{n}`' for n in MESHES)}):"
        " rays at faces, edges and vertices, grazing, from far, and by directions of any length. *Wrong* is by the rule of"
        " [peers.md](peers.md). Up to three wrong rays of each hunt, of different aims first, are reduced to the fewest faces and the shortest"
        f" numbers at which the program is still wrong, and left as programs of their own; all {ran} were run once more as the files that they"
        " are, and tell what they told. Corners of these meshes have all digits of their type, so that more is rounded here than on the hard"
        " rays, whose corners are short numbers.",
        "",
        "| mesh | faces | program | rays | wrong | faces of each reproducer (what the ray aimed at) |",
        "| --- | ---: | --- | ---: | ---: | --- |",
        *rows,
        "",
        "## The shortest of each program",
        *shown,
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Reads the words, and writes the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--keep", type=Path, help="a folder for the reproducers")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as passing:
        given.output.write_text(page(given.keep or Path(passing)), encoding="utf-8")


if __name__ == "__main__":
    main()
