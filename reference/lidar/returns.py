"""Computes the returns of beams again, from the answers to their single rays, and compares.

    raypencil cast MESH wide.toml -o out/wide      # a set with `returns`
    python3 reference/lidar/returns.py out/wide

It follows docs/guide/lidar.md, "Returns", alone: gaps are compared as fractions, strengths are summed from the first ray to the last. Every
array `return.*.npy` must have the same bits. Exit code: 0 if all have, 1 if not, 2 for bad input.
"""

import argparse
import json
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np

NONE = 4294967295


def returns_of(ranges, light, separation):
    """The returns of a footprint by range: lists of rays, each in the order of the rays."""
    hits = sorted((ray for ray in range(len(ranges)) if np.isfinite(ranges[ray])), key=lambda ray: (ranges[ray], ray))
    groups = []
    for ray in hits:
        if not groups or Fraction(ranges[ray]) - Fraction(ranges[groups[-1][-1]]) > separation:
            groups.append([])
        groups[-1].append(ray)
    found = []
    for number, rays in enumerate(map(sorted, groups), 1):
        strength = weighted = 0.0
        for ray in rays:
            strength += light[ray]
            weighted += light[ray] * ranges[ray]
        found.append({"number": number, "rays": rays, "strength": strength, "mean": weighted / strength})
    return found


def told(found, keep):
    if keep == "first":
        return found[:1]
    if keep == "last":
        return found[-1:]
    most = 1 if keep == "strongest" else keep
    strongest = sorted(found, key=lambda one: (-one["strength"], one["number"]))[:most]
    return sorted(strongest, key=lambda one: one["number"])


def expected(folder, asked):
    """Every array again."""
    read = lambda name: np.load(folder / f"{name}.npy")  # noqa: E731
    ranges, cosines, weights = read("range"), read("cos_incidence"), read("weight")
    count = len(weights)
    beams = ranges.shape[:-1]
    places = asked["keep"] if isinstance(asked["keep"], int) else 1
    shape = (int(np.prod(beams)), places)
    arrays = {
        "of_ray": np.zeros((shape[0], count), "u4"),
        "count": np.zeros(shape[0], "u4"),
        "mixed": np.zeros(shape[0], "u1"),
        "share_missed": np.zeros(shape[0]),
        "number": np.zeros(shape, "u4"),
        "ray": np.full(shape, NONE, "u4"),
        "range": np.full(shape, np.inf),
        "mean_range": np.full(shape, np.inf),
        "strength": np.zeros(shape),
        "share": np.zeros(shape),
        "share_other": np.zeros(shape),
    }
    with np.errstate(invalid="ignore"):
        light = (np.abs(cosines) / (ranges * ranges)).reshape(-1, count) * weights
    separation = Fraction(asked["separationM"])
    for beam, of_beam in enumerate(ranges.reshape(-1, count)):
        found = returns_of([float(value) for value in of_beam], light[beam].tolist(), separation)
        hits = sum(len(one["rays"]) for one in found)
        for one in found:
            arrays["of_ray"][beam, one["rays"]] = one["number"]
        arrays["count"][beam], arrays["mixed"][beam] = len(found), len(found) > 1
        arrays["share_missed"][beam] = np.count_nonzero(np.isposinf(of_beam)) / count
        arrays["share_other"][beam] = hits / count
        for place, one in enumerate(told(found, asked["keep"])):
            leading, rays = one["rays"][0], len(one["rays"])
            at = (beam, place)
            arrays["number"][at], arrays["ray"][at] = one["number"], leading
            arrays["range"][at], arrays["mean_range"][at] = of_beam[leading], one["mean"]
            arrays["strength"][at] = one["strength"]
            arrays["share"][at], arrays["share_other"][at] = rays / count, (hits - rays) / count
    shapes = {"of_ray": ranges.shape, "count": beams, "mixed": beams, "share_missed": beams}
    return {name: array.reshape(shapes.get(name, (*beams, places))) for name, array in arrays.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="a set's folder, as `cast -o` writes it")
    folder = parser.parse_args().folder
    try:
        asked = json.loads((folder / "summary.json").read_text())["returns"]
        again = expected(folder, asked)
        theirs = {name: np.load(folder / f"return.{name}.npy") for name in again}
    except (OSError, KeyError, ValueError) as error:
        print(f"returns.py: {folder}: {error!r}; expected the folder of a set with returns", file=sys.stderr)
        return 2
    wrong = [name for name, array in again.items() if array.shape != theirs[name].shape or array.tobytes() != theirs[name].tobytes()]
    for name in wrong:
        print(f"returns.py: return.{name}.npy has other numbers", file=sys.stderr)
    counts = again["count"]
    print(f"{counts.size:,} footprints, {int(np.count_nonzero(counts > 1)):,} mixed, {int(counts.max(initial=0))} returns of one at most")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
