#!/usr/bin/env python3
"""Planted faults for follow.py: one altered value of each kind must end it with code 1, bad input with code 2.

    python3 reference/rover/planted.py RECORDING [--frames 21]

The first frames of a recording that agrees are copied, images as links. The unaltered copy must end with code 0, or
else a code 1 would prove nothing. Exit code 0 if every fault is found, 1 if not, 2 for trouble.
"""

import argparse
import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

FOLLOW = Path(__file__).with_name("follow.py")


def run(folder):
    """Exit code and the first line that tells of a difference or of trouble."""
    done = subprocess.run([sys.executable, str(FOLLOW), str(folder)], capture_output=True, text=True)
    words = [line for line in (done.stdout + done.stderr).splitlines()
             if "recorded" in line or "trouble" in line or "nothing was compared" in line]
    return done.returncode, words[0] if words else ""


def copy(source, target, frames):
    """The first frames of a recording; images are linked."""
    target.mkdir()
    shutil.copy(source / "setup.json", target)
    (target / "images").symlink_to((source / "images").resolve())
    for name in ("poses.csv", "sectors.csv", "vectors.csv", "maps.csv"):
        with open(source / name, newline="") as file:
            rows = list(csv.reader(file))
        frame = rows[0].index("frame")
        keep = [rows[0]] + [row for row in rows[1:] if int(row[frame]) < frames]
        with open(target / name, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(keep)
    for name in ("stripes.npy", "points.npy"):
        array = np.load(source / name)
        np.save(target / name, array[array[:, 0] < frames])
    (target / "maps").mkdir()
    for path in sorted((source / "maps").glob("*.npy")):
        if int(path.name[:6]) < frames:
            shutil.copy(path, target / "maps")


def number(name, column, more=1e-6, row=-1):
    """Adds to a number of a CSV file, or replaces a word by a function."""
    def alter(folder):
        with open(folder / name, newline="") as file:
            rows = list(csv.reader(file))
        k = rows[0].index(column)
        old = rows[row][k]
        rows[row][k] = more(old) if callable(more) else repr(float(old or 0) + more)
        with open(folder / name, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    return alter


def cell(name, index, more):
    """Adds to a value of an NPY file; `index` may be a function of the array."""
    def alter(folder):
        path = sorted(folder.glob(name))[-1]
        array = np.load(path)
        array[index(array) if callable(index) else index] += more
        np.save(path, array)
    return alter


def shortened(name):
    def alter(folder):
        np.save(folder / name, np.load(folder / name)[:-1])
    return alter


def swapped(folder):
    array = np.load(folder / "stripes.npy")
    array[[0, 1]] = array[[1, 0]]
    np.save(folder / "stripes.npy", array)


def lines_gone(name, keep=1):
    def alter(folder):
        lines = (folder / name).read_text().splitlines(keepends=True)
        (folder / name).write_text("".join(lines[:keep]))
    return alter


def first_known(array):
    return tuple(np.argwhere(~np.isnan(array))[0]) if array.dtype.kind == "f" else tuple(np.argwhere(array > 0)[0])


other_label = lambda old: "unknown" if old == "obstacle" else "obstacle"
FAULTS = {
    "an edge's column": (1, cell("stripes.npy", (-1, 3), 1)),
    "an edge's row by 1e-6 pixels": (1, cell("stripes.npy", (-1, 4), 1e-6)),
    "an edge's beam": (1, cell("stripes.npy", (0, 2), 1)),
    "an edge left out": (1, shortened("stripes.npy")),
    "two edges in another order": (1, swapped),
    "a point in the vehicle's frame by 1 um": (1, cell("points.npy", (-1, 6), 1e-6)),
    "a point in the global frame by 1 um": (1, cell("points.npy", (-1, 10), 1e-6)),
    "a point left out": (1, shortened("points.npy")),
    "the believed elevation by 1 um": (1, number("poses.csv", "believed_z_m")),
    "the believed x by 1 um": (1, number("poses.csv", "believed_x_m")),
    "the believed attitude": (1, number("poses.csv", "believed_qy")),
    "the map's motion": (1, number("poses.csv", "moved_i", lambda old: str(int(old) + 1))),
    "a number of inconsistency": (1, number("poses.csv", "inconsistency_mean_m")),
    "columns left out": (1, number("poses.csv", "columns_left_out", lambda old: str(int(old) + 1))),
    "a map's elevation by 1 um": (1, cell("maps/*-elevation.npy", first_known, 1e-6)),
    "a map's source": (1, cell("maps/*-source.npy", first_known, 1)),
    "a map's corner": (1, number("maps.csv", "west_m", 0.1)),
    "a label": (1, number("sectors.csv", "label", other_label)),
    "a reason": (1, number("sectors.csv", "reason", lambda old: "belly" if old != "belly" else "front")),
    "a part": (1, number("sectors.csv", "part", lambda old: "belly" if old != "belly" else "front_wheel")),
    "a radius": (1, number("sectors.csv", "radius_m", 0.1)),
    "a sector's direction": (1, number("sectors.csv", "direction_rad")),
    "a missing place": (1, number("sectors.csv", "missing_x_m", 0.1)),
    "a vector's end": (1, number("vectors.csv", "to_x_m")),
    "a vector's label": (1, number("vectors.csv", "label", other_label)),
    "no sectors at all": (1, lines_gone("sectors.csv")),
    "maps.csv without its lines, and no maps": (1, lambda folder: (shutil.rmtree(folder / "maps"),
                                                                  (folder / "maps.csv").unlink())),
    "no stripes.npy": (1, lambda folder: (folder / "stripes.npy").unlink()),
    "no setup.json": (2, lambda folder: (folder / "setup.json").unlink()),
    "half of setup.json": (2, lambda folder: (folder / "setup.json").write_text('{"format_version": 1,')),
    "a detection that does not exist": (2, lambda folder: (folder / "setup.json").write_text(
        (folder / "setup.json").read_text().replace('"detection"', '"detection": "magic", "was"'))),
    "no images": (2, lambda folder: (folder / "images").unlink()),
    "a word for a number": (2, number("poses.csv", "sensed_x_m", lambda old: "here")),
    "half of stripes.npy": (2, lambda folder: (folder / "stripes.npy").write_bytes(
        (folder / "stripes.npy").read_bytes()[:1000])),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=Path)
    parser.add_argument("--frames", type=int, default=21)
    options = parser.parse_args()
    if not (options.recording / "setup.json").exists():
        print(f"trouble: {options.recording}: no setup.json", file=sys.stderr)
        return 2
    missed = 0
    with tempfile.TemporaryDirectory() as work:
        clean = Path(work) / "clean"
        copy(options.recording, clean, options.frames)
        code, words = run(clean)
        if code != 0:
            print(f"trouble: the unaltered copy ends with code {code}: {words}", file=sys.stderr)
            return 2
        print("found   code 0  nothing altered")
        for name, (expected, alter) in FAULTS.items():
            folder = Path(work) / "altered"
            shutil.copytree(clean, folder, symlinks=True)
            alter(folder)
            code, words = run(folder)
            print(f"{'found ' if code == expected else 'MISSED'}  code {code}  {name}: {words[:90]}")
            missed += code != expected
            shutil.rmtree(folder)
    print(f"{len(FAULTS) - missed} of {len(FAULTS)} planted faults found")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
