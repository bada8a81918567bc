#!/usr/bin/env python3
"""The contract of any rays (docs/guide/cast.md) once more, in whole numbers, and without a tree.

    python3 reference/exact_cast.py MESH.obj RAYS.npy FOLDER [--fronts-only] [--displaced 12]

FOLDER is what `raypencil cast MESH.obj RAYS.npy --any --all -o FOLDER` wrote. For each ray all faces are tried. Every array
is compared bit for bit. If FOLDER has margins, some rays (--displaced) are moved sideways by a little less than their
lower bounds, in eight directions: the nearest faces, or whether anything is hit, must not change, nor whether that is too near.
Upper bounds are not examined.

Exit code 0: all bits are equal; 1: some are not, or nothing was compared; 2: a file cannot be used.
"""

import argparse
import math
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np

NO_FACE = 2**32 - 1


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def sign(x):
    return (x > 0) - (x < 0)


def exponent_of(numbers):
    """The least e for which all numbers are whole multiples of 2^-e."""
    return max((Fraction(x).denominator.bit_length() - 1 for x in numbers), default=0)


def whole(x, exponent):
    return int(Fraction(x) * 2**exponent)


def nearest_root(square):
    """The double nearest to the root of a fraction: 100 bits of it, and a last bit that says whether there is more."""
    if square == 0:
        return 0.0
    p, q = square.numerator, square.denominator
    shift = max(0, 200 - (p.bit_length() - q.bit_length()))
    shift += shift % 2
    floor, rest = divmod(p << shift, q)
    root = math.isqrt(floor)
    more = 1 if rest or root * root != floor else 0
    return float(Fraction(2 * root + more, 2 ** (shift // 2 + 1)))


class Mesh:
    def __init__(self, path):
        self.vertices, self.faces = [], []
        for line in Path(path).read_text().splitlines():
            words = line.split()
            if words[:1] == ["v"]:
                self.vertices.append(tuple(float(word) for word in words[1:4]))
            elif words[:1] == ["f"]:
                corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
                self.faces += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
        self.exponent = exponent_of(x for vertex in self.vertices for x in vertex)


class Ray:
    """One ray on the whole-number lattice of its mesh: lengths in 2^-e, directions in 2^-f."""

    def __init__(self, mesh, numbers, origin=None):
        self.numbers = [float(x) for x in numbers]
        origin = [Fraction(x) for x in self.numbers[:3]] if origin is None else origin
        self.e = max(mesh.exponent, exponent_of(origin))
        self.f = exponent_of(self.numbers[3:6])
        self.o = tuple(whole(x, self.e) for x in origin)
        self.d = tuple(whole(x, self.f) for x in self.numbers[3:6])
        self.unit = Fraction(2) ** (self.f - self.e)
        self.vertices = [tuple(whole(x, self.e) for x in vertex) for vertex in mesh.vertices]
        t_min, t_max, t_blind = (*self.numbers[6:], *(0.0, math.inf, 0.0)[len(numbers) - 6 :])
        self.t_min, self.t_blind = Fraction(t_min), Fraction(t_blind)
        self.t_max = None if t_max == math.inf else Fraction(t_max)
        self.largest = max(range(3), key=lambda k: abs(self.d[k]))


class Hit:
    def __init__(self, ray, index, face):
        a, b, c = (sub(ray.vertices[k], ray.o) for k in face)
        self.index, self.corners = index, (a, b, c)
        self.n = cross(sub(b, a), sub(c, a))
        self.g = dot(self.n, ray.d)
        self.t = None
        if self.g == 0:
            return
        towards = -1 if self.g < 0 else 1
        self.edges = [dot(ray.d, cross(p, sub(q, p))) for p, q in ((a, b), (b, c), (c, a))]
        if any(sign(edge) == -towards for edge in self.edges):
            return
        self.front = self.g < 0
        t = Fraction(dot(self.n, a), self.g) * ray.unit
        if t >= ray.t_min and (ray.t_max is None or t <= ray.t_max):
            self.t = t

    def crossing(self, ray):
        """+1, -1 or 0: how the ray moved by an infinitely small vector passes the face."""
        inside = -1 if self.front else 1
        a, b, c = self.corners
        for edge, (p, q) in zip(self.edges, ((a, b), (b, c), (c, a))):
            across = cross(ray.d, sub(q, p))
            parts = (edge, across[(ray.largest + 1) % 3], across[(ray.largest + 2) % 3])
            if next((sign(part) for part in parts if part), 0) != inside:
                return 0
        return 1 if self.front else -1


def groups_of(mesh, ray):
    """All hits on both sides, in the order of t, with equal t together."""
    hits = (Hit(ray, index, face) for index, face in enumerate(mesh.faces))
    groups = []
    for hit in sorted((hit for hit in hits if hit.t is not None), key=lambda hit: (hit.t, hit.index)):
        if groups and groups[-1][0].t == hit.t:
            groups[-1].append(hit)
        else:
            groups.append([hit])
    return groups


def counted(group, fronts_only):
    return [hit for hit in group if hit.front or not fronts_only]


def nearest(mesh, ray, fronts_only):
    """The nearest faces, and whether they are too near."""
    for group in groups_of(mesh, ray):
        if faces := counted(group, fronts_only):
            return [hit.index for hit in faces], faces[0].t < ray.t_blind
    return [], False


def values(ray, hit):
    """Every value of a hit, each the nearest double."""
    length_squared = Fraction(dot(ray.d, ray.d), 4**ray.f)
    n_squared = dot(hit.n, hit.n)
    size = Fraction(1, 2**ray.e)
    t_of_lattice = Fraction(dot(hit.n, hit.corners[0]), hit.g)
    signed_root = lambda part, square: math.copysign(nearest_root(square), part) if part else 0.0
    direct = Fraction(hit.g * hit.g, n_squared * dot(ray.d, ray.d))
    return {
        "t": float(hit.t),
        "range": nearest_root(hit.t**2 * length_squared),
        "point": [float((o + d * t_of_lattice) * size) for o, d in zip(ray.o, ray.d)],
        "normal": [signed_root(part, Fraction(part * part, n_squared)) for part in hit.n],
        "barycentric": [float(Fraction(hit.edges[k], hit.g)) for k in (1, 2, 0)],
        "cos_incidence": signed_root(-hit.g, direct),
    }


class Table:
    def __init__(self):
        self.counts, self.shown = {}, 0

    def compare(self, name, place, expected, found):
        equal, differing = self.counts.setdefault(name, [0, 0])
        expected, found = np.asarray(expected), np.asarray(found)
        if expected.dtype.kind == "f":
            # -0 and 0 are one number here.
            same = np.array_equal(expected + 0.0, found + 0.0, equal_nan=True)
        else:
            same = np.array_equal(expected, found)
        self.counts[name] = [equal + same, differing + (not same)]
        if not same and self.shown < 10:
            self.shown += 1
            print(f"{name} at {place}: {found.tolist()!r}; exactly {expected.tolist()!r}")

    def end(self):
        print(f"{'array':<18}{'compared':>10}{'equal bits':>12}{'differing':>11}")
        for name, (equal, differing) in self.counts.items():
            print(f"{name:<18}{equal + differing:>10}{equal:>12}{differing:>11}")
        return sum(differing for _, differing in self.counts.values())


def moved(mesh, numbers, across, by):
    origin = [Fraction(o) + Fraction(by[0]) * Fraction(u) + Fraction(by[1]) * Fraction(v)
              for o, u, v in zip(numbers[:3], across[0], across[1])]
    return Ray(mesh, numbers, origin)


def displaced(table, mesh, rays, folder, fronts_only, count):
    """Rays that are moved by a little less than a lower bound keep their answers."""
    bounds = {name: np.load(folder / f"margin.{name}.npy").reshape(-1, 2) for name in ("face", "surface")}
    across = np.load(folder / "across.npy").reshape(-1, 2, 3).tolist()
    around = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]
    for name, bound in bounds.items():
        chosen = np.flatnonzero(bound[:, 0] > 0)
        for k in chosen[:: max(1, len(chosen) // max(1, count))][:count]:
            size = float(bound[k, 0]) * (1 - 2.0**-40)
            first = nearest(mesh, Ray(mesh, rays[k]), fronts_only)
            for x, y in around:
                there = nearest(mesh, moved(mesh, rays[k], across[k], (size * x, size * y)), fronts_only)
                if name == "surface":
                    there = [bool(part) for part in there]
                kept = [bool(part) for part in first] if name == "surface" else first
                for part, (of_ray, of_moved) in enumerate(zip(kept, there)):
                    table.compare(f"margin.{name}", f"ray {k}, {x},{y}, part {part}", of_ray, of_moved)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("rays", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--fronts-only", action="store_true")
    parser.add_argument("--displaced", type=int, default=12)
    arguments = parser.parse_args()
    folder = arguments.folder
    try:
        mesh = Mesh(arguments.mesh)
        rays = np.load(arguments.rays).astype(float)
        rays = rays.reshape(-1, rays.shape[-1]).tolist()
        names = ["face", "side", "ties", "t", "range", "point", "normal", "barycentric", "cos_incidence", "any"]
        arrays = {name: np.load(folder / f"{name}.npy") for name in names}
        arrays = {name: a.reshape(len(rays), 3) if a.size == 3 * len(rays) else a.reshape(-1) for name, a in arrays.items()}
        every = {name: np.load(folder / f"all.{name}.npy") for name in ("start", "face", "side", "t", "group", "crossing")}
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    table = Table()
    for k, numbers in enumerate(rays):
        ray = Ray(mesh, numbers)
        groups = [(group, counted(group, arguments.fronts_only)) for group in groups_of(mesh, ray)]
        groups = [(group, shown) for group, shown in groups if shown]
        first = groups[0][1] if groups else []
        expected = {"face": NO_FACE, "side": 0, "ties": 0, "t": math.inf, "range": math.inf, "cos_incidence": math.nan}
        expected |= {name: [math.nan] * 3 for name in ("point", "normal", "barycentric")}
        if first and first[0].t < ray.t_blind:
            expected |= {"t": -math.inf, "range": -math.inf}
        elif first:
            expected = {"face": first[0].index, "side": 1 if first[0].front else -1, "ties": len(first)}
            expected |= values(ray, first[0])
        expected["any"] = int(bool(first))
        for name, value in expected.items():
            table.compare(name, f"ray {k}", value, arrays[name][k])
        listed = {"face": [], "side": [], "t": [], "group": [], "crossing": []}
        for index, (group, shown) in enumerate(groups):
            crossing = sum(hit.crossing(ray) for hit in group)
            for hit in shown:
                listed["face"].append(hit.index)
                listed["side"].append(1 if hit.front else -1)
                listed["t"].append(float(hit.t))
                listed["group"].append(index)
                listed["crossing"].append(crossing)
        start, end = (int(every["start"][k + i]) for i in (0, 1))
        table.compare("all.start", f"ray {k}", len(listed["face"]), end - start)
        for name, value in listed.items():
            if value or end > start:
                table.compare(f"all.{name}", f"ray {k}", value, every[name][start:end])
    if (folder / "margin.face.npy").is_file() and arguments.displaced:
        displaced(table, mesh, rays, folder, arguments.fronts_only, arguments.displaced)
    differing = table.end()
    print("all equal" if rays and not differing else f"{differing} differ" if rays else "nothing was compared")
    sys.exit(0 if rays and not differing else 1)


if __name__ == "__main__":
    main()
