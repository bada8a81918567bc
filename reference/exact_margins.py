#!/usr/bin/env python3
"""The margins of `raypencil cast` once more, in fractions: the least displacement of a ray that changes its answer.

    python3 reference/exact_margins.py MESH.obj RAYS.npy FOLDER [--fronts-only] [--rays 200]

FOLDER is what `raypencil cast MESH.obj RAYS.npy --margins -o FOLDER` wrote; MESH may also be vertices.npy, with faces.npy beside it.
A ray that is moved by a u + b v (the two vectors of across.npy) sees each face as a convex polygon in the plane of (a, b), on which t
is linear. The ends of the ray cut this polygon. So both margins are exact, by geometry in that plane and without a search:

* face: the least size max(|a|, |b|) at which a nearest face is left, or another is entered at or before its t.
* surface: the least size at which the nearest t jumps. On a border of a polygon it can jump only between places where it crosses
  another border, or where two faces have one t; in the middle of each such piece the least t to its two sides is compared.

For each margin: whether lo is at most the exact size, hi at least that, and how far hi is above it where the
exact size is more than 2^-40 of the largest coordinate: below that, doubles hardly tell one ray from another. A ray with a polygon that is cut to
one point or line, and one with a shortest range, are left out, and counted.

Exit code 0: all are right; 1: some are not, or none was compared; 2: a file cannot be used.
"""

import argparse
import sys
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np

from exact_cast import Mesh as ObjMesh
from exact_cast import cross, dot, sub

ZERO = Fraction(0)


class Mesh:
    def __init__(self, path):
        if path.suffix == ".npy":
            self.vertices = np.load(path).astype(float).tolist()
            self.faces = np.load(path.with_name("faces.npy")).astype(int).tolist()
        else:
            mesh = ObjMesh(path)
            self.vertices, self.faces = mesh.vertices, mesh.faces
        self.exact = [tuple(Fraction(x) for x in vertex) for vertex in self.vertices]
        corners = np.array(self.vertices).reshape(-1, 3)
        used = corners[sorted({k for face in self.faces for k in face})] if self.faces else np.zeros((1, 3))
        self.diagonal = float(np.linalg.norm(used.max(axis=0) - used.min(axis=0)))


def size(point):
    return max(abs(point[0]), abs(point[1]))


def clipped(corners, value):
    """The part of a convex polygon of (a, b, t) where a linear function of its corners is at least 0."""
    kept = []
    for here, there in zip(corners, corners[1:] + corners[:1]):
        at, to = value(here), value(there)
        if at >= 0:
            kept.append(here)
        if at * to < 0:
            share = at / (at - to)
            kept.append(tuple(p + share * (q - p) for p, q in zip(here, there)))
    return kept


def side(p, q, point):
    """Positive if `point` is to the left of the line from p to q."""
    return (q[0] - p[0]) * (point[1] - p[1]) - (q[1] - p[1]) * (point[0] - p[0])


def nearest_size(p, q):
    """The least size on a segment: at an end, or where |a| = |b|."""
    sizes = [size(p), size(q)]
    for sign in (1, -1):
        at, to = p[0] - sign * p[1], q[0] - sign * q[1]
        if at * to < 0:
            share = at / (at - to)
            sizes.append(size([x + share * (y - x) for x, y in zip(p, q)]))
    return min(sizes)


class Polygon:
    """A face as moved rays see it, counter-clockwise, and its t as a linear function."""

    def __init__(self, index, corners):
        if sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(corners, corners[1:] + corners[:1])) < 0:
            corners = corners[::-1]
        self.index, self.corners = index, corners
        self.edges = list(zip(corners, corners[1:] + corners[:1]))
        self.low, self.high = ([pick(corner[k] for corner in corners) for k in (0, 1)] for pick in (min, max))
        p, q, r = corners[0], corners[1], corners[2]
        area = side(p, q, r)
        self.slope = [
            ((q[2] - p[2]) * (r[1] - p[1]) - (r[2] - p[2]) * (q[1] - p[1])) / area,
            ((r[2] - p[2]) * (q[0] - p[0]) - (q[2] - p[2]) * (r[0] - p[0])) / area,
        ]
        self.start = p[2] - self.slope[0] * p[0] - self.slope[1] * p[1]

    def t(self, point):
        return self.start + self.slope[0] * point[0] + self.slope[1] * point[1]

    def contains(self, point):
        is_in_box = all(self.low[k] <= point[k] <= self.high[k] for k in (0, 1))
        return is_in_box and all(side(p, q, point) >= 0 for p, q in self.edges)

    def is_coplanar(self, other):
        return self.start == other.start and self.slope == other.slope

    def nearest(self):
        return ZERO if self.contains((ZERO, ZERO)) else min(nearest_size(p, q) for p, q in self.edges)


class Ray:
    def __init__(self, mesh, numbers, across, fronts_only, within):
        exact = [Fraction(x) for x in numbers[:6]]
        self.o, self.d = exact[:3], exact[3:]
        self.u, self.v = ([Fraction(x) for x in vector] for vector in across)
        ends = (*numbers[6:], *(0.0, float("inf"))[len(numbers) - 6 :])
        self.t_min = Fraction(ends[0])
        self.t_max = None if ends[1] == float("inf") else Fraction(ends[1])
        self.is_doubtful = False
        self.polygons = []
        volume = dot(cross(self.u, self.v), self.d)
        across_u, across_v, along = cross(self.v, self.d), cross(self.d, self.u), cross(self.u, self.v)
        places = []
        for vertex in mesh.exact:
            # o + a u + b v + t d, by Cramer's rule.
            from_o = sub(vertex, self.o)
            places.append(tuple(dot(from_o, one) / volume for one in (across_u, across_v, along)))
        for index, face in enumerate(mesh.faces):
            corners = [places[k] for k in face]
            low, high = ([pick(c[k] for c in corners) for k in (0, 1)] for pick in (min, max))
            if any(low[k] > within or high[k] < -within for k in (0, 1)):
                continue
            a, b, c = (mesh.exact[k] for k in face)
            facing = dot(cross(sub(b, a), sub(c, a)), self.d)
            if facing == 0 or (fronts_only and facing > 0):
                continue
            corners = clipped(corners, lambda corner: corner[2] - self.t_min)
            if corners and self.t_max is not None:
                corners = clipped(corners, lambda corner: self.t_max - corner[2])
            distinct = [p for p, q in zip(corners, corners[1:] + corners[:1]) if p[:2] != q[:2]]
            if len(distinct) >= 3:
                self.polygons.append(Polygon(index, distinct))
            elif corners:
                self.is_doubtful = True

    def nearest_faces(self):
        met = [one for one in self.polygons if one.contains((ZERO, ZERO))]
        first = min((one.start for one in met), default=None)
        return [one for one in met if one.start == first]

    def face_margin(self):
        nearest = self.nearest_faces()
        sizes = []
        for one in nearest:
            if not one.is_coplanar(nearest[0]):
                return ZERO
            for p, q in one.edges:
                # The left side of the line is kept: c + x a + y b >= 0.
                sizes.append(side(p, q, (ZERO, ZERO)) / (abs(q[1] - p[1]) + abs(q[0] - p[0])))
        own = {one.index for one in nearest}
        for other in self.polygons:
            if other.index in own:
                continue
            corners = other.corners
            if nearest:
                corners = clipped(corners, lambda corner: nearest[0].t(corner) - corner[2])
            if not corners:
                continue
            if len(corners) < 3:
                sizes.append(min(nearest_size(p, q) for p, q in zip(corners, corners[1:] + corners[:1])))
            else:
                part = Polygon(other.index, corners) if is_wide(corners) else None
                edges = list(zip(corners, corners[1:] + corners[:1]))
                sizes.append(part.nearest() if part else min(nearest_size(p, q) for p, q in edges))
        return min(sizes, default=None)

    def surface_margin(self):
        if not self.nearest_faces():
            return self.face_margin()
        best = None
        edges = [(nearest_size(p, q), k, p, q) for k, own in enumerate(self.polygons) for p, q in own.edges]
        for least, k, p, q in sorted(edges, key=lambda edge: edge[0]):
            # No place of this edge, nor of those that follow, is nearer.
            if best is not None and least >= best:
                return best
            at = lambda share: [x + share * (y - x) for x, y in zip(p, q)]
            shares = pairwise(self.breaks(self.polygons[k], p, q))
            pieces = [(nearest_size(at(start), at(end)), (start + end) / 2) for start, end in shares]
            for piece, middle in sorted(pieces):
                if best is not None and piece >= best:
                    break
                if self.jumps(p, q, at(middle)):
                    best = piece
        return best

    def breaks(self, own, p, q):
        """The shares of an edge at which what is met beside it may change."""
        shares = {ZERO, Fraction(1)}

        def root(at, to):
            if at != to:
                share = at / (at - to)
                if 0 < share < 1:
                    shares.add(share)

        # The others whose box, in the plane of displacements, meets that of the edge.
        def is_near(one):
            return all(
                min(p[k], q[k]) <= one.high[k] and max(p[k], q[k]) >= one.low[k] for k in (0, 1)
            )

        near = [one for one in self.polygons if one.index != own.index and is_near(one)]
        for one in near:
            for r, s in one.edges:
                root(side(r, s, p), side(r, s, q))
        for k, one in enumerate([own, *near]):
            for other in near[k:]:
                root(one.t(p) - other.t(p), one.t(q) - other.t(q))
        return sorted(shares)

    def jumps(self, p, q, place):
        """Whether the least t to the left of an edge is another than to its right, at a place where no other border crosses it."""
        least = [None, None]
        for one in self.polygons:
            if not one.contains(place):
                continue
            covers = [True, True]
            for r, s in one.edges:
                if side(r, s, place) == 0:
                    # It ends here, along this very line: it covers its own left side of it.
                    forward = (s[0] - r[0]) * (q[0] - p[0]) + (s[1] - r[1]) * (q[1] - p[1]) > 0
                    covers[1 if forward else 0] = False
            t = one.t(place)
            for k in (0, 1):
                if covers[k] and (least[k] is None or t < least[k]):
                    least[k] = t
        return least[0] != least[1]


def is_wide(corners):
    return any(side(corners[0], corners[1], corner) for corner in corners[2:]) or corners[0][:2] == corners[1][:2]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("rays", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--fronts-only", action="store_true")
    parser.add_argument("--rays", type=int, default=200, dest="count")
    arguments = parser.parse_args()
    try:
        mesh = Mesh(arguments.mesh)
        rays = np.load(arguments.rays).astype(float)
        rays = rays.reshape(-1, rays.shape[-1]).tolist()
        across = np.load(arguments.folder / "across.npy").reshape(-1, 2, 3).tolist()
        bounds = {
            name: np.load(arguments.folder / f"margin.{name}.npy").reshape(-1, 2).tolist()
            for name in ("face", "surface")
        }
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    counts = {name: dict.fromkeys(("right", "capped", "lo too large", "hi too small"), 0) for name in bounds}
    widest = dict.fromkeys(bounds, 0.0)
    left_out = 0
    coordinates = [abs(x) for vertex in mesh.vertices for x in vertex]
    step = max(1, len(rays) // max(1, arguments.count))
    for k in range(0, len(rays), step):
        largest = max(bound[k][1] for bound in bounds.values())
        within = Fraction(largest) * Fraction(101, 100) + Fraction(2.0**-1000)
        ray = Ray(mesh, rays[k], across[k], arguments.fronts_only, within)
        if ray.is_doubtful or len(rays[k]) > 8:
            left_out += 1
            continue
        # A size at which f64 numbers hardly tell one ray from another: 2^-40 of the largest coordinate.
        least = Fraction(max([*coordinates, *(abs(x) for x in rays[k][:3])])) / 2**40
        for name, exact in (("face", ray.face_margin()), ("surface", ray.surface_margin())):
            lo, hi = bounds[name][k]
            if lo == hi and abs(hi / mesh.diagonal - 1) < 1e-15 and (exact is None or exact >= Fraction(lo)):
                counts[name]["capped"] += 1
                continue
            wrong = None
            if exact is not None and Fraction(lo) > exact:
                wrong = "lo too large"
            elif exact is None or Fraction(hi) < exact:
                wrong = "hi too small"
            counts[name][wrong or "right"] += 1
            if wrong:
                print(f"ray {k}: {name} {lo!r} to {hi!r}; exactly {None if exact is None else float(exact)!r}")
            elif exact > least:
                widest[name] = max(widest[name], float(Fraction(hi) / exact) - 1)
    for name, count in counts.items():
        print(f"{name:<8} " + ", ".join(f"{number} {what}" for what, number in count.items()), end="")
        print(f"; hi above the exact size by at most {widest[name]:.2g} of it")
    print(f"{left_out} rays left out")
    right = sum(count["right"] + count["capped"] for count in counts.values())
    wrong = sum(count["lo too large"] + count["hi too small"] for count in counts.values())
    sys.exit(0 if right and not wrong else 1)


if __name__ == "__main__":
    main()
