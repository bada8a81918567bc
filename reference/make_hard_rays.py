#!/usr/bin/env python3
"""Rays at which ray tracers go wrong, on small meshes: writes data/rays/hard.

    python3 reference/make_hard_rays.py           writes mesh.obj, rays.npy of each family, and families.json
    python3 reference/make_hard_rays.py --check   exit code 1 if the files are not those that it would write

All numbers are multiples of powers of two with few bits, so that "through an edge" is exactly true. Nothing is drawn by
a library: the same bytes come out everywhere. The exact answers beside them are made by

    raypencil cast data/rays/hard/FAMILY/mesh.obj data/rays/hard/FAMILY/rays.npy --margins -o ...

and proven by exact_cast.py.
"""

import io
import json
import math
import sys
from pathlib import Path

import numpy as np

HARD = Path(__file__).resolve().parent.parent / "data" / "rays" / "hard"
INF = math.inf


class Draw:
    """SplitMix64 (Steele, Lea, Flood 2014): whole numbers from a counter."""

    def __init__(self, seed):
        self.state = seed

    def bits(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) % 2**64
        z = self.state
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB % 2**64
        return z ^ (z >> 31)

    def whole(self, low, high):
        return low + self.bits() % (high - low + 1)

    def dyadic(self, low, high, step=64):
        return self.whole(low * step, high * step) / step


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def times(a, s):
    return [x * s for x in a]


def rough_ball():
    """A closed mesh of 128 faces: an octahedron, split twice, each vertex pushed out or in by some 64ths."""
    vertices = [[1.0, 0, 0], [-1.0, 0, 0], [0, 1.0, 0], [0, -1.0, 0], [0, 0, 1.0], [0, 0, -1.0]]
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    for _ in range(2):
        middles, split = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(vertices)
                vertices.append(times(add(vertices[a], vertices[b]), 0.5))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            split += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        faces = split
    draw = Draw(1)
    return [times(vertex, 1 + draw.whole(-6, 12) / 64) for vertex in vertices], faces


def edges_of(faces):
    return sorted({(min(a, b), max(a, b)) for face in faces for a, b in zip(face, face[1:] + face[:1])})


def ray(origin, direction, t_min=0.0, t_max=INF):
    return [*origin, *direction, t_min, t_max]


def onto(point, origin, **ends):
    """The ray that is at the point at t = 1."""
    return ray(origin, sub(point, origin), **ends)


def outside(point, draw, near=1.25):
    """A place outside the ball, seen from which the point is in front."""
    return add(times(point, 1 + near), [draw.dyadic(-1, 1) * 0.5 for _ in range(3)])


def edge_rays(vertices, faces, draw, count):
    edges = edges_of(faces)
    rays = []
    for k in range(count):
        a, b = (vertices[i] for i in edges[k % len(edges)])
        share = draw.whole(1, 7) / 8
        point = add(times(a, 1 - share), times(b, share))
        rays.append(onto(point, outside(point, draw)))
    return rays


def families():
    ball = rough_ball()
    vertices, faces = ball

    def family(name, what, wrong, mesh, rays):
        return {"name": name, "what": what, "goesWrong": wrong, "mesh": mesh, "rays": rays}

    draw = Draw(2)
    yield family(
        "edges",
        "Rays exactly through edges that two faces of a closed mesh share.",
        "Tests that round each face's edge by themselves: both faces miss, and the ray leaks into the mesh.",
        ball,
        edge_rays(vertices, faces, draw, 500),
    )
    rays = [onto(vertex, outside(vertex, draw)) for vertex in vertices for _ in range(5)]
    yield family(
        "vertices",
        "Rays exactly through vertices at which four to eight faces meet.",
        "As for edges; also tests that leave out faces on one side of an edge by a rule for lines, not for points.",
        ball,
        rays,
    )
    rays = []
    for one in edge_rays(vertices, faces, draw, 300):
        k = draw.whole(3, 5)
        one[k] = math.nextafter(one[k], draw.whole(0, 1) * 8.0 - 4.0)
        rays.append(one)
    yield family(
        "one-ulp-beside",
        "Rays through edges, one part of the direction moved by one step of f64.",
        "Tests in f64 whose rounding is not bounded; in f32 the step is lost, and the ray is on the edge.",
        ball,
        rays,
    )

    grid = [[float(x), float(y), 0.0] for y in range(5) for x in range(5)]
    cells = [5 * y + x for y in range(4) for x in range(4)]
    floor = [face for k in cells for face in ([k, k + 1, k + 6], [k, k + 6, k + 5])]
    wall = ([*grid, [2.0, 0, 0], [2.0, 4.0, 0], [2.0, 4.0, 1.0], [2.0, 0, 1.0]], [*floor, [25, 26, 27], [25, 27, 28]])
    rays = []
    for y in range(17):
        rays.append(ray([-1.0, y / 4, 0.0], [1.0, 0.0, 0.0]))
        rays.append(ray([5.0, y / 4, 0.0], [-1.0, 0.0, 0.0]))
        rays.append(ray([y / 4, -1.0, 0.0], [0.0, 1.0, 0.0]))
        rays.append(ray([-1.0, y / 4 - 1, 0.0], [1.0, 1.0, 0.0]))
        rays.append(ray([y / 4, 1.0, 0.0], [draw.dyadic(-1, 1), draw.dyadic(-1, 1) + 2, 0.0]))
    yield family(
        "in-plane",
        "Rays in the plane of a floor, along its edges and through its vertices; a wall stands on it.",
        "Division by n.d = 0: NaN passes comparisons, or the wall behind is missed.",
        wall,
        rays,
    )

    rays = []
    for k in range(320):
        face = faces[k % len(faces)]
        a, b, c = (vertices[i] for i in face)
        point = [times(add(add(a, a), add(b, c)), 0.25), times(add(a, b), 0.5), a][k % 3]
        direction = [draw.dyadic(-1, 1, 8) or 0.125 for _ in range(3)]
        kind = k % 4
        if kind == 0:
            rays.append(ray(point, direction))
        elif kind == 1:
            rays.append(ray(sub(point, direction), direction, t_min=1.0))
        elif kind == 2:
            rays.append(ray(sub(point, direction), direction, t_max=1.0))
        else:
            rays.append(ray(sub(point, direction), direction, t_min=1.0, t_max=1.0))
    yield family(
        "on-surface",
        "Rays that start on faces, edges and vertices, or whose t_min or t_max is exactly at them.",
        "An epsilon at the ray's start (self-intersection bias) loses hits at t = t_min; half-open intervals lose an end.",
        ball,
        rays,
    )

    rays = []
    for k in range(160):
        a, b, c = (vertices[i] for i in faces[k % len(faces)])
        point = times(add(add(a, a), add(b, c)), 0.25) if k % 2 else times(add(a, b), 0.5)
        direction = times(point, -1.0) if k % 4 < 2 else point
        rays.append(ray(sub(point, times(direction, 2.0**-26)), direction))
    yield family(
        "just-before",
        "Rays that start a hundred-millionth before a face or an edge, outside and inside.",
        "An epsilon at the ray's start (self-intersection bias) loses the hit: the ray sees through the mesh.",
        ball,
        rays,
    )

    bumps = [[float(x), float(y), (1 + (x * 7 + y * 5) % 3) / 2**26] for y in range(5) for x in range(5)]
    rays = []
    for k in range(200):
        target = bumps[k % 25] if k % 2 else times(add(bumps[cells[k % 16]], bumps[cells[k % 16] + 6]), 0.5)
        direction = [draw.dyadic(-1, 1, 16) or 1.0, draw.dyadic(-1, 1, 16) or 0.5, -draw.whole(1, 15) / 2**27]
        rays.append(ray(sub(target, times(direction, 4)), direction))
    yield family(
        "grazing",
        "Rays at about 1e-7 radians to a floor with bumps of 1e-8.",
        "n.d and n.a' lose all their digits; thresholds such as |n.d| < 1e-6 drop faces that are met.",
        (bumps, floor),
        rays,
    )

    rays = []
    for k in range(300):
        a, b = (vertices[i] for i in edges_of(faces)[k % 192])
        point = times(add(a, b), 0.5) if k % 2 else a
        direction = add(times(point, -1.0), [draw.dyadic(-1, 1, 16) * 0.25 for _ in range(3)])
        rays.append(ray(sub(point, times(direction, 2.0 ** draw.whole(17, 27))), direction))
    yield family(
        "far-origins",
        "Rays through edges and vertices from 1e5 to 1e8 times the mesh's size away.",
        "Vertices seen from the origin lose their digits: the ray is off by more than the faces' size, in f32 by far more.",
        ball,
        rays,
    )

    fan = [[0.0, 0.0, 0.0]] + [[1024.0, (k - 24) / 1024, (k % 3) / 2048] for k in range(49)]
    rays = []
    for k in range(160):
        i = 1 + k % 48
        share = [1 / 64, 1 / 8, 1 / 2, 7 / 8][k % 4]
        point = times(fan[i] if k % 3 else times(add(fan[i], fan[i + 1]), 0.5), share)
        rays.append(onto(point, add(point, [draw.dyadic(-1, 1), draw.dyadic(-1, 1), draw.dyadic(1, 3)])))
    yield family(
        "needles",
        "Triangles a million times as long as wide, met on their edges and in their middles.",
        "A normal from two nearly parallel edges, and barycentric weights over a tiny area.",
        (fan, [[0, i, i + 1] for i in range(1, 49)]),
        rays,
    )

    thin = 2.0**-20
    fold = [[0.0, y / 4, 0.0] for y in range(9)] + [[2.0, y / 4, thin] for y in range(9)]
    fold += [[2.0, y / 4, -thin] for y in range(9)]
    strips = [f for y in range(8) for f in ([y, y + 9, y + 10], [y, y + 10, y + 1], [y, y + 19, y + 18], [y, y + 1, y + 19])]
    rays = []
    for k in range(160):
        point = [0.0, draw.dyadic(0, 2, 16), 0.0]
        if k % 4 == 3:
            point = [2.0**-draw.whole(1, 30), point[1], 0.0]
        from_place = [[-1.0, 0.0, 0.0], [draw.dyadic(-1, 1), draw.dyadic(-1, 1), 2.0], [-2.0, 0.5, 2.0**-22]][k % 3]
        rays.append(onto(point, add(point, from_place)))
    yield family(
        "folds",
        "Two sheets that meet at an angle of 2e-6 radians, met on the fold and close to it.",
        "Which sheet is nearer is decided by the last digits; at the fold both are.",
        (fold, strips),
        rays,
    )

    square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
    copies = [[0, 1, 2], [0, 2, 3], [0, 1, 2], [2, 1, 0], [1, 2, 0], [0, 3, 2], [0, 0, 1], [0, 2, 2]]
    rays = []
    for k in range(100):
        point = [draw.whole(0, 8) / 8, draw.whole(0, 8) / 8, 0.0]
        rays.append(onto(point, add(point, [draw.dyadic(-1, 1), draw.dyadic(-1, 1), (1.0 if k % 2 else -1.0)])))
    yield family(
        "duplicates",
        "The same faces twice and reversed, and faces of zero area.",
        "Ties are missed or counted twice; faces of zero area give NaN.",
        (square, copies),
        rays,
    )

    for name, exponent in (("tiny", -20), ("huge", 20)):
        scale = 2.0**exponent
        rays = [[*times(one[:6], scale), *one[6:]] for one in edge_rays(vertices, faces, draw, 160)]
        yield family(
            name,
            f"The rays through edges and their mesh, {'a millionth' if exponent < 0 else 'a million times'} the size.",
            "Thresholds with a length in them, such as 1e-6.",
            ([times(vertex, scale) for vertex in vertices], faces),
            rays,
        )

    place = [4999168.0, -2999872.0, 512.0]
    rays = []
    for one in edge_rays(vertices, faces, draw, 200):
        moved = [*add(times(one[:3], 2.0**-4), place), *times(one[3:6], 2.0**-4), *one[6:]]
        rays.append(moved)
    yield family(
        "far-mesh",
        "The rays through edges and their mesh, 0.1 wide, 5e6 away from the origin, as in coordinates of a map.",
        "f32 keeps half a metre there: the mesh collapses. In f64 products of coordinates lose all digits of the mesh.",
        ([add(times(vertex, 2.0**-4), place) for vertex in vertices], faces),
        rays,
    )

    heights = [1.0, math.nextafter(1.0, 2.0), math.nextafter(1.0, 0.0), 1.0 + 2.0**-50, 1.0 + 2.0**-40]
    stack = [[x, y, z] for z in heights for x, y in ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))]
    stack[4][2] = heights[2]
    layers = [f for k in range(5) for f in ([4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3])]
    rays = []
    for k in range(120):
        point = [draw.whole(-7, 7) / 8, draw.whole(-7, 7) / 8, 1.0]
        rays.append(onto(point, add(point, [draw.dyadic(-1, 1), draw.dyadic(-1, 1), (2.0 if k % 2 else -3.0)])))
    yield family(
        "nearly-coincident",
        "Layers one to a few steps of f64 apart, one of them tilted through another.",
        "The order of the hits is below the rounding of t.",
        (stack, layers),
        rays,
    )

    cross = [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]]
    cross += [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]]
    cross += [[0.0, -2.0, -2.0], [0.0, 2.0, -2.0], [0.0, 0.0, 2.0]]
    rays = []
    for k in range(120):
        x = draw.whole(-8, 8) / 8
        point = [[x, 0.0, 0.0], [0.0, x, x], [0.0, x, -x], [0.0, 0.0, 0.0]][k % 4]
        rays.append(onto(point, add(point, [draw.dyadic(-2, 2), draw.dyadic(-1, 1), (2.0 if k % 2 else -2.0)])))
    yield family(
        "crossing",
        "Three sheets that pass through each other, met on the lines where two or three of them cross.",
        "Which of the sheets is nearest changes there: all of them are.",
        (cross, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [8, 9, 10]]),
        rays,
    )

    boxes, sides = [], []
    for i in range(3):
        base = len(boxes)
        boxes += [[float(x + 2 * i), float(y), float(z)] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            sides += [[base + a, base + b, base + c], [base + a, base + c, base + d]]
    rays = []
    for k in range(180):
        axis, sign = k % 3, (1.0 if k // 3 % 2 else -1.0)
        direction = [(-0.0 if k % 5 == 0 else 0.0)] * 3
        direction[axis] = sign
        origin = [draw.whole(0, 10) / 2, draw.whole(0, 2) / 2, draw.whole(0, 2) / 2]
        origin[axis] = -3.0 * sign if sign > 0 else 9.0
        rays.append(ray(origin, direction))
    yield family(
        "axis-aligned",
        "Rays along the axes, with zeros of both signs, in the faces, edges and corners of boxes.",
        "Slab tests of bounding boxes: 0 times infinity is NaN, and -0 turns near and far.",
        (boxes, sides),
        rays,
    )

    rays = []
    for k, one in enumerate(edge_rays(vertices, faces, draw, 200)):
        scale = 2.0 ** [-66, -30, 30, 66][k % 4]
        rays.append([*one[:3], *times(one[3:6], scale), *one[6:]])
    yield family(
        "long-directions",
        "Rays through edges whose directions are 1e-20 to 1e20 long.",
        "Squares of lengths leave f32; thresholds on n.d or t have a length in them.",
        ball,
        rays,
    )


def files():
    listed = []
    for family in families():
        vertices, faces = family["mesh"]
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in ([float(c) for c in vertex] for vertex in vertices)]
        lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
        yield f"{family['name']}/mesh.obj", ("\n".join(lines) + "\n").encode()
        buffer = io.BytesIO()
        np.lib.format.write_array(buffer, np.array(family["rays"], dtype="<f8"), version=(1, 0))
        yield f"{family['name']}/rays.npy", buffer.getvalue()
        listed.append({key: family[key] for key in ("name", "what", "goesWrong")} | {"rays": len(family["rays"])})
    yield "families.json", (json.dumps(listed, indent=2) + "\n").encode()


def main():
    is_check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not is_check:
        sys.exit("expected no argument, or --check")
    different = []
    for name, contents in files():
        path = HARD / name
        if is_check:
            if not path.is_file() or path.read_bytes() != contents:
                different.append(name)
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(contents)
    if different:
        print("not as made: " + ", ".join(different))
        sys.exit(1)
    print(f"{sum(1 for _ in files()) // 2} families, as made" if is_check else f"{HARD} is written")


if __name__ == "__main__":
    main()
