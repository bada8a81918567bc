#!/usr/bin/env python3
"""Every value of a reference pack once more, from the contract alone, and compared bit for bit.

    python reference/exact_values.py PACK [--pencils 1000] [--pixels 1000] [--seed 1] [--exr]

An evaluation that shares no code and no method with raypencil: whatever is rational is a Fraction, a single root is rounded
by squaring, the rest (exp, atan, pi, sums of roots) is computed to 60 digits. No filter, no tree: each ray is tried on
all faces. Formulas: docs/theory/radiometry.md (light), docs/formats/files.md (channels), docs/guide/for-implementers.md (rays, hits, view).

Exit code 0: all equal; 1: something differs, and the first ten cells are named; 2: no pack.
"""

import argparse
import json
import math
import random
import struct
import sys
import tomllib
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path

import numpy
from mpmath import mp

mp.dps = 60
NONE = 4294967295  # face, pixel: none
INF, NAN = math.inf, math.nan
Vector = tuple  # of three Fractions or three ints


# ---- Vectors and poses

def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def along(a, t, b):
    """a + t b"""
    return (a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2])


class Pose:
    """scene_from_sensor. Its rotation is exactly (q p q*)/(q.q): the quaternion need not be a unit."""

    def __init__(self, table):
        self.position = tuple(map(Fraction, table["position_m"]))
        x, y, z, w = map(Fraction, table["quaternion_xyzw"])
        norm = x * x + y * y + z * z + w * w
        rows = (
            (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
        )
        self.rows = [tuple(e / norm for e in row) for row in rows]

    def rotate(self, v):
        return tuple(dot(row, v) for row in self.rows)

    def unrotate(self, v):
        return tuple(sum(self.rows[k][i] * v[k] for k in range(3)) for i in range(3))


# ---- Correct rounding to the nearest, ties to even

@dataclass(frozen=True)
class Format:
    digits: int  # bits of the significand
    least: int  # exponent of the smallest subnormal
    code: str  # of struct

    def bits(self, x):
        return struct.pack(">" + self.code, x).hex()


F64 = Format(53, -1074, "d")
F32 = Format(24, -149, "f")


@dataclass(frozen=True)
class Root:
    """sign * sqrt(square), square a Fraction"""
    sign: int
    square: Fraction


class Undecided(Exception):
    """60 digits do not tell which of two neighbours is nearer."""


def two_to(e):
    return Fraction(2) ** e


def round_rational(x, to):
    """The float of the format nearest to a Fraction."""
    if x == 0:
        return 0.0
    size = abs(x)
    e = size.numerator.bit_length() - size.denominator.bit_length()
    if size < two_to(e):
        e -= 1  # now 2^e <= size < 2^(e+1)
    ulp = max(e - to.digits + 1, to.least)
    steps = round(size / two_to(ulp))  # Python rounds a Fraction to the nearest integer, ties to even
    return math.copysign(math.ldexp(steps, ulp), x)


def round_root(root, to):
    """The same for a root: an enclosure of 200 bits; where it holds a midpoint m, the sign of square - m^2 decides."""
    if root.sign == 0 or root.square == 0:
        return 0.0
    k = max(0, 200 - (root.square.numerator.bit_length() - root.square.denominator.bit_length()) // 2)
    whole = math.isqrt(root.square.numerator * 4**k // root.square.denominator)
    low, high = (round_rational(Fraction(whole + step, 2**k), to) for step in (0, 1))
    if low != high:
        midpoint = (Fraction(low) + Fraction(high)) / 2
        if root.square == midpoint**2:
            low = round_rational(midpoint, to)
        elif root.square > midpoint**2:
            low = high
    return root.sign * low


def round_number(x, to):
    """The same for a number of 60 digits, if 50 of them are enough."""
    sign, significand, exponent, _ = x._mpf_
    exact = Fraction(int(significand)) * two_to(int(exponent)) * (-1 if sign else 1)
    margin = Fraction(1, 10**50)
    low, high = round_rational(exact * (1 - margin), to), round_rational(exact * (1 + margin), to)
    if low != high:
        raise Undecided(mp.nstr(x, 60))
    return low


def nearest(value, to):
    if isinstance(value, float):  # INF and NAN
        return value
    if isinstance(value, Root):
        return round_root(value, to)
    if isinstance(value, (Fraction, int)):
        return round_rational(Fraction(value), to)
    return round_number(value, to)


def number(x):
    """A Fraction or Root with 60 digits."""
    if isinstance(x, Root):
        return x.sign * mp.sqrt(number(x.square))
    return mp.mpf(x.numerator) / mp.mpf(x.denominator)


# ---- The scene: what stands in scene.toml and terrain.glb, every number as it is

class Camera:
    def __init__(self, table):
        self.pose = Pose(table["scene_from_camera"])
        self.columns, self.rows = table["width_px"], table["height_px"]
        self.pitch = tuple(map(Fraction, table["pixel_pitch_m"]))  # p_x, p_y
        self.f_c = self.spp = Fraction(table["focal_length_m"])  # SPP: z = f_c
        self.middle = tuple(map(Fraction, table["principal_point_px"]))  # c_x, c_y
        self.D = Fraction(table["aperture_m"])
        self.C_loss = Fraction(table["transmission"])
        self.filter = {k: Fraction(v) for k, v in table.get("filter", {}).items()}
        self.reach = Fraction(table["max_range_m"])

    def direction(self, i, j):
        """q = ((i+1/2-c_x) p_x, (j+1/2-c_y) p_y, f_c), in the camera."""
        half = Fraction(1, 2)
        return ((i + half - self.middle[0]) * self.pitch[0], (j + half - self.middle[1]) * self.pitch[1], self.f_c)

    def ray(self, i, j):
        return self.pose.position, self.pose.rotate(self.direction(i, j))

    def F(self, cos2_phi, wavelength):
        """The interference filter (docs/theory/radiometry.md, "The filter"); None: there is none, F = 1."""
        if not self.filter:
            return None
        sin2 = 1 - cos2_phi
        centre = number(self.filter["centre_m"]) * mp.sqrt(number(1 - sin2 / self.filter["index"] ** 2))
        return mp.exp(-4 * mp.log(2) * ((number(wavelength) - centre) / number(self.filter["width_m"])) ** 2)


class Beam:
    def __init__(self, table):
        self.pose = Pose(table["scene_from_beam"])
        self.columns, self.rows = table["columns"], table["rows"]
        self.T, self.g, self.w = (Fraction(table[k]) for k in ("thickness_m", "grid_distance_m", "half_width_m"))
        self.spp = self.g  # SPP: z = g
        self.reach = Fraction(table["max_range_m"])
        self.I_b, self.wavelength = Fraction(table["power_w"]), Fraction(table["wavelength_m"])
        self.profile = table["profile"]
        self.gaussian = Fraction(table.get("gaussian_half_width_rad", 0))

    def x(self, i):
        """x_i = w (2i + 1 - columns) / columns"""
        return self.w * (2 * i + 1 - self.columns) / self.columns

    def y(self, j):
        """y_j = T (2j + 1 - rows) / (2 rows)"""
        return self.T * (2 * j + 1 - self.rows) / (2 * self.rows)

    def ray(self, i, j):
        """From (0, y_j, 0) on the focal axis along q = (x_i, 0, g)."""
        origin = along(self.pose.position, 1, self.pose.rotate((Fraction(0), self.y(j), Fraction(0))))
        return origin, self.pose.rotate((self.x(i), Fraction(0), self.g))

    def cos2_alpha(self, i):
        return self.g**2 / (self.x(i) ** 2 + self.g**2)

    def weight(self, i):
        """exp(-2 (alpha / w)^2), w the Gaussian's half width"""
        alpha = mp.atan(number(self.x(i) / self.g))
        return mp.exp(-2 * (alpha / number(self.gaussian)) ** 2)

    @cached_property
    def weights(self):
        """The discrete sum over all pencils."""
        each = self.weight if self.profile == "gaussian" else self.cos2_alpha
        return self.rows * sum(each(i) for i in range(self.columns))

    def share(self, i):
        """P_k as (square, factors): sqrt(square) times all factors (docs/theory/radiometry.md, "A pencil's share")."""
        if self.profile == "paper":  # I_b A_bp cos(alpha) / A_b, and A_b = columns rows A_bp
            return (self.I_b / (self.columns * self.rows)) ** 2 * self.cos2_alpha(i), []
        if self.profile == "uniform_angle":  # weight cos^2(alpha)
            return (self.I_b * self.cos2_alpha(i) / self.weights) ** 2, []
        if self.profile == "gaussian":
            return self.I_b**2, [self.weight(i) / self.weights]
        raise ValueError(f"profile {self.profile}")


class Mesh:
    """Vertices as integers in units of 1/scale metres, a power of two: f32 numbers are that, exactly."""

    def __init__(self, path):
        blob = path.read_bytes()
        length = struct.unpack("<I", blob[12:16])[0]
        tree, data = json.loads(blob[20 : 20 + length]), blob[28 + length :]
        primitives = [p for m in tree["meshes"] for p in m["primitives"]]

        def read(index, code, width):
            accessor = tree["accessors"][index]
            view = tree["bufferViews"][accessor["bufferView"]]
            start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            return struct.unpack_from(f"<{accessor['count'] * width}{code}", data, start)

        points, self.faces, self.r_d = [], [], []
        positions = {p["attributes"]["POSITION"] for p in primitives}
        if len(positions) != 1:
            raise ValueError("terrain.glb has more than one list of vertices")
        flat = read(positions.pop(), "f", 3)
        for g in zip(*[iter(flat)] * 3):
            points.append(tuple(map(Fraction, (g[0], -g[2], g[1]))))  # scene (x, y, z) = (gx, -gz, gy)
        for p in primitives:
            reflectivity = Fraction(tree["materials"][p["material"]]["extras"]["reflectivity"])
            for corners in zip(*[iter(read(p["indices"], "I", 1))] * 3):
                self.faces.append(corners)
                self.r_d.append(reflectivity)
        self.scale = max(c.denominator for p in points for c in p)
        self.vertices = [tuple(int(c * self.scale) for c in p) for p in points]
        v = self.vertices
        self.normals = [cross(sub(v[b], v[a]), sub(v[c], v[a])) for a, b, c in self.faces]  # n = (b-a) x (c-a)

    def crossings(self, origin, direction):
        """All (t, face, front) where the whole line origin + t direction meets a closed triangle, in integers.

        With a', b', c' the corners seen from the origin, the line passes within the closed triangle if the three
        direction.(a' x b') have the sign of n.direction or are 0, and it does so at t = n.a' / n.direction. A face
        parallel to the line or without area has n.direction = 0 and is never met.
        """
        s = math.lcm(*(c.denominator for c in origin))
        o = tuple(int(c * s) * self.scale for c in origin)
        sigma = math.lcm(*(c.denominator for c in direction))
        d = tuple(int(c * sigma) for c in direction)
        seen = [(s * v[0] - o[0], s * v[1] - o[1], s * v[2] - o[2]) for v in self.vertices]  # times s scale
        turned = [cross(d, p) for p in seen]  # direction.(a' x b') = (direction x a').b'
        found = []
        for face, (a, b, c) in enumerate(self.faces):
            n = self.normals[face]
            facing = dot(n, d)
            if facing == 0:
                continue
            sides = (dot(turned[a], seen[b]), dot(turned[b], seen[c]), dot(turned[c], seen[a]))
            if all(side <= 0 for side in sides) if facing < 0 else all(side >= 0 for side in sides):
                t = Fraction(dot(n, seen[a]) * sigma, s * self.scale * facing)
                found.append((t, face, facing < 0))
        return found


class Scene:
    def __init__(self, folder):
        table = tomllib.loads((folder / "scene.toml").read_text())
        if table.get("kind") != "resolved":
            raise ValueError("scene.toml is not a resolved scene")
        self.camera = Camera(table["camera"])
        self.beams = [Beam(b) for b in table.get("beam", [])]
        self.mesh = Mesh(folder / table["terrain"]["file"])
        self.sigma = Fraction(table["atmosphere"]["attenuation_per_m"])
        self.model = table["flux"]["model"]


# ---- Hits

@dataclass
class Hit:
    face: int  # the lowest of those tied
    tied: int  # how many faces are met at this very t
    t: Fraction
    q: Vector  # scene frame
    P: Vector
    n: Vector  # of the face, not a unit

    @cached_property
    def R2(self):
        return self.t**2 * dot(self.q, self.q)

    @cached_property
    def cos2_psi(self):
        return Fraction(dot(self.n, self.q) ** 2) / (dot(self.n, self.n) * dot(self.q, self.q))


def hit(scene, sensor, i, j):
    """The nearest front with t >= 1 and R <= reach, R = t |q|, decided by squares."""
    origin, q = sensor.ray(i, j)
    limit = sensor.reach**2 / dot(q, q)
    met = [(t, face) for t, face, front in scene.mesh.crossings(origin, q) if front and t >= 1 and t * t <= limit]
    if not met:
        return None
    t, face = min(met)
    tied = sum(other == t for other, _ in met)
    return Hit(face, tied, t, q, along(origin, t, q), scene.mesh.normals[face])


def common_values(sensor, h):
    """What camera and beams have alike."""
    if h is None:
        return {"range.T": INF, "depth.Z": INF, "face.I": NONE, "incidence.V": NAN} | {
            f"{name}.{axis}": NAN for name in "PN" for axis in "XYZ"
        }
    n2 = dot(h.n, h.n)
    values = {
        "range.T": Root(1, h.R2),  # along the ray
        "depth.Z": h.t * sensor.spp,  # along the normal axis: q ends on the SPP
        "face.I": h.face,
        "incidence.V": Root(1, h.cos2_psi),  # cos(psi) = -n.q / (|n| |q|)
    }
    for k, axis in enumerate("XYZ"):
        values[f"P.{axis}"] = h.P[k]
        values[f"N.{axis}"] = Root((h.n[k] > 0) - (h.n[k] < 0), Fraction(h.n[k] ** 2, n2))
    return values


# ---- What the camera sees of a pencil, and what it delivers

@dataclass
class View:
    r: Fraction  # depth in the camera
    d2: Fraction  # square of the distance
    emission: Fraction  # n.(c - P), the sign of cos(theta)
    pixel: tuple | None
    V: Vector  # P - c, scene frame


def view(scene, h):
    """Where the hit lands, seen or hidden, if it is beyond the image plane (docs/theory/radiometry.md)."""
    camera = scene.camera
    V = sub(h.P, camera.pose.position)
    x, y, r = camera.pose.unrotate(V)
    pixel = None
    if r > camera.f_c:
        i = math.floor(camera.middle[0] + x / r * camera.f_c / camera.pitch[0])
        j = math.floor(camera.middle[1] + y / r * camera.f_c / camera.pitch[1])
        if 0 <= i < camera.columns and 0 <= j < camera.rows:
            pixel = (i, j)
    return View(r, dot(V, V), -dot(h.n, V), pixel, V)


def visible(scene, v):
    """cos(theta) > 0, depth > f_c, on the image, and no face, front or back, between the hit and the image plane.

    On c + u V the hit is at u = 1 and the image plane at u = f_c / r. A face met at u = 1 contains the point and does
    not hide it (docs/theory/radiometry.md, "Pixel and visibility").
    """
    camera = scene.camera
    if v.emission <= 0 or v.pixel is None:
        return False
    least = camera.f_c / v.r
    return not any(least <= u < 1 for u, _, _ in scene.mesh.crossings(camera.pose.position, v.V))


def product(square, factors):
    """sqrt(square) times all factors: an exact root if there are none."""
    if not factors or square == 0:
        return Root(1, square)
    return mp.sqrt(number(square)) * mp.fprod(factors)


def flux(scene, beam, i, h, v, model):
    """I_k of a visible pencil (docs/theory/radiometry.md). What is algebraic is collected as its square."""
    camera, sigma = scene.camera, scene.sigma
    share2, factors = beam.share(i)
    factors = list(factors)
    r_d = scene.mesh.r_d[h.face]
    cos2_theta = v.emission**2 / (dot(h.n, h.n) * v.d2)
    if model == "radiometric":
        # I_k = P_k r_d C_loss F(phi) (D^2 / 4) cos(theta) cos^3(phi) / r^2 exp(-sigma (R + d)), phi the ray's own
        cos2_phi = v.r**2 / v.d2
        lens = r_d * camera.C_loss * camera.D**2 / 4
        square = share2 * lens**2 * cos2_theta * cos2_phi**3 / v.r**4
        way = number(Root(1, h.R2)) + number(Root(1, v.d2))
    else:
        # I_k = P_k r_d (pi / 4) (D / f_c)^2 C_loss F(phi) A_cp cos^4(phi) cos(theta) cos(psi) / (R r^2)
        #       exp(-sigma r) exp(-sigma R), phi of the centre of the pixel
        axis = camera.direction(*v.pixel)
        cos2_phi = camera.f_c**2 / dot(axis, axis)
        lens = r_d * (camera.D / camera.f_c) ** 2 / 4 * camera.C_loss * camera.pitch[0] * camera.pitch[1]
        square = share2 * lens**2 * cos2_phi**4 * cos2_theta * h.cos2_psi / (h.R2 * v.r**4)
        way = number(Root(1, h.R2)) + number(v.r)
        factors.append(mp.pi)
    if sigma:
        factors.append(mp.exp(-number(sigma) * way))
    F = camera.F(cos2_phi, beam.wavelength)
    if F is not None:
        factors.append(F)
    return product(square, factors)


def total(terms):
    """The sum of real numbers; of one it is that one, so that its root stays exact."""
    if not terms:
        return Fraction(0)
    return terms[0] if len(terms) == 1 else mp.fsum(number(t) if isinstance(t, (Root, Fraction)) else t for t in terms)


def other_model(scene):
    return "eq1" if scene.model == "radiometric" else "radiometric"


def names_of_flux(scene, last):
    """{channel: model}: `flux.V` is the scene's own model, the other has its name."""
    return {f"flux.{last}": scene.model, f"flux.{other_model(scene)}.{last}": other_model(scene)}


# ---- Comparison

class Table:
    def __init__(self, folder, exr):
        self.folder, self.rows, self.wrong, self.maps = folder, {}, [], {}
        self.exr = exr
        self.unread = {
            f"{sensor.name}/{file.name.removesuffix('.npy')}"
            for sensor in folder.iterdir() if sensor.is_dir()
            for file in sensor.glob("*.npy") if not file.name.startswith("margin.")
        }

    def load(self, sensor):
        """All channels of a sensor: {name: (array, Format or None for integers)}; `P` becomes P.X, P.Y, P.Z."""
        channels = {}
        for file in sorted((self.folder / sensor).glob("*.npy")):
            name, data = file.name.removesuffix(".npy"), numpy.load(file)
            split = {f"{name}.{a}": data[..., k] for k, a in enumerate("XYZ")} if data.ndim == 3 else {name: data}
            for key, part in split.items():
                channels[key] = (part, F64 if part.dtype.kind == "f" else None)
        if self.exr:
            import OpenEXR
            with OpenEXR.File(str(self.folder / f"{sensor}.exr"), separate_channels=True) as file:
                for key, channel in file.channels().items():
                    part = numpy.array(channel.pixels)
                    channels[f"{key} (EXR)"] = (part, F32 if part.dtype.kind == "f" else None)
        for i, j in ((0, "origin"), (3, "direction")):
            rays = numpy.load(self.folder / f"rays-{sensor}.npy")
            for k, axis in enumerate("XYZ"):
                channels[f"rays {j}.{axis}"] = (rays[..., i + k], F64)
        self.maps[sensor] = channels

    def compare(self, sensor, i, j, values):
        for name, value in values.items():
            for key in (name, f"{name} (EXR)") if self.exr and not name.startswith("rays") else (name,):
                self.compare_one(sensor, i, j, key, value)

    def compare_one(self, sensor, i, j, key, value):
        if key not in self.maps[sensor]:
            self.wrong.append(f"{sensor} {key}: not in the pack")
            return
        data, form = self.maps[sensor][key]
        stem = key.removesuffix(" (EXR)")
        group = stem[:-2] if stem[-2:] in (".X", ".Y", ".Z") and stem[:-2] in ("P", "N", "rays origin", "rays direction") else stem
        row = self.rows.setdefault((sensor, group + key[len(stem):]), [0, 0, 0])
        self.unread.discard(f"{sensor}/{group}")
        found = data[j, i]
        row[0] += 1
        if form is None:  # integers
            same, shown = int(found) == value, f"found {found}, expected {value}"
        else:
            try:
                expected = nearest(value, form)
                have, want = form.bits(found), form.bits(expected)
                same = have == want
                shown = f"found {float(found)!r} {have}, expected {expected!r} {want}"
            except Undecided as e:
                same, shown = False, f"undecided: {e}"
        row[1 if same else 2] += 1
        if not same:
            self.wrong.append(f"{sensor} {key} column {i} row {j}: {shown}")

    def print(self):
        print(f"{'sensor':<8} {'quantity':<30} {'compared':>9} {'equal bits':>11} {'differing':>10}")
        for (sensor, name), (compared, equal, differing) in self.rows.items():
            print(f"{sensor:<8} {name:<30} {compared:>9} {equal:>11} {differing:>10}")


def rays_of(sensor, i, j):
    origin, q = sensor.ray(i, j)
    return {f"rays {name}.{axis}": v[k] for name, v in (("origin", origin), ("direction", q)) for k, axis in enumerate("XYZ")}


def pick(rng, sensor, count):
    """At most `count` cells (i, j) of a sensor, without repetition, in row-major order."""
    cells = sensor.columns * sensor.rows
    return [(k % sensor.columns, k // sensor.columns) for k in sorted(rng.sample(range(cells), min(count, cells)))]


def pencil_values(scene, beam, i, h, v, seen):
    """Every channel of a pencil."""
    values, fluxes = common_values(beam, h), names_of_flux(scene, "V")
    if h is None:
        lands_not = {"visible.V": 0, "pixel.I": NONE, "pixel.J": NONE}
        return values | lands_not | {"view.Z": INF, "offAxis.V": NAN, "emission.V": NAN} | dict.fromkeys(fluxes, Fraction(0))
    column, row = v.pixel or (NONE, NONE)
    return values | {
        "visible.V": int(seen),
        "pixel.I": column,
        "pixel.J": row,
        "view.Z": v.r,
        "offAxis.V": Root((v.r > 0) - (v.r < 0), v.r**2 / v.d2),  # cos(phi) = r / d
        "emission.V": Root((v.emission > 0) - (v.emission < 0), v.emission**2 / (dot(h.n, h.n) * v.d2)),  # cos(theta)
    } | {name: flux(scene, beam, i, h, v, model) if seen else Fraction(0) for name, model in fluxes.items()}


class Examination:
    MOST = 20_000_000  # tries of a pencil on a face, some 3 us each: above that not all pencils are tried

    def __init__(self, scene, table, rng):
        self.scene, self.table, self.rng = scene, table, rng
        self.notes, self.pencils = {}, {}  # pencils: (beam, i, j) -> (hit, view, seen)

    def note(self, what, found=True):
        self.notes[what] = self.notes.get(what, 0) + bool(found)

    def camera(self, count):
        """The camera's own maps."""
        camera = self.scene.camera
        for i, j in pick(self.rng, camera, count):
            h = hit(self.scene, camera, i, j)
            self.note("pixels that miss", h is None)
            self.note("pixels with a tie", h is not None and h.tied > 1)
            self.table.compare("camera", i, j, rays_of(camera, i, j) | common_values(camera, h))

    def pencil(self, b, i, j):
        key = (b, i, j)
        if key not in self.pencils:
            h = hit(self.scene, self.scene.beams[b], i, j)
            v = view(self.scene, h) if h else None
            self.pencils[key] = (h, v, v is not None and visible(self.scene, v))
        return self.pencils[key]

    def beam(self, b, count):
        beam, camera = self.scene.beams[b], self.scene.camera
        for i, j in pick(self.rng, beam, count):
            h, v, seen = self.pencil(b, i, j)
            self.table.compare(f"beam-{b}", i, j, rays_of(beam, i, j) | pencil_values(self.scene, beam, i, h, v, seen))
            self.note("pencils that miss", h is None)
            if h:
                lands = v.pixel is not None
                self.note("pencils with a tie", h.tied > 1)
                self.note("pencils that the camera sees", seen)
                self.note("hidden ones that land on the image", lands and not seen)
                self.note("of these hidden by a face between", lands and not seen and v.emission > 0 and v.r > camera.f_c)
                self.note("of these before the image plane", lands and v.r <= camera.f_c)

    def sums(self):
        """The sums of the pixels in which a pencil of the sample is seen, and of 200 more."""
        scene, camera = self.scene, self.scene.camera
        chosen = {v.pixel for _, v, seen in self.pencils.values() if seen} | set(pick(self.rng, camera, 200))
        every = sum(beam.columns * beam.rows for beam in scene.beams)
        is_complete = every * len(scene.mesh.faces) <= self.MOST
        if is_complete:
            # All pencils are tried, so that those pixels can be added that only the pack holds to be lit.
            for name, (data, _) in self.table.maps["camera"].items():
                if name.startswith("flux."):
                    chosen |= {(int(i), int(j)) for j, i in numpy.argwhere(data != 0)}
        else:
            print("too many pencils to try all: those in a pixel beyond the sample are found by the pack's pixel.I and pixel.J")
        for b, beam in enumerate(scene.beams):
            columns, rows = (self.table.maps[f"beam-{b}"][f"pixel.{axis}"][0] for axis in "IJ")
            landing = {}
            for j in range(beam.rows):
                for i in range(beam.columns):
                    if is_complete or (b, i, j) in self.pencils or (int(columns[j, i]), int(rows[j, i])) in chosen:
                        h, v, seen = self.pencil(b, i, j)
                        if seen:
                            landing.setdefault(v.pixel, []).append((i, h, v))
            for pixel in sorted(chosen):
                pencils = landing.get(pixel, [])
                self.note(f"pixels lit by beam {b}", pencils)
                for name, model in names_of_flux(scene, f"beam{b}").items():
                    flow = total([flux(scene, beam, i, h, v, model) for i, h, v in pencils])
                    self.table.compare("camera", *pixel, {name: flow})


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("pack", type=Path)
    parser.add_argument("--pencils", type=int, default=1000, help="of each beam, at most")
    parser.add_argument("--pixels", type=int, default=1000, help="of the camera's own maps, at most")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--exr", action="store_true", help="also the single precision values of the .exr files")
    args = parser.parse_args()
    try:
        scene, table = Scene(args.pack), Table(args.pack, args.exr)
        for sensor in ["camera"] + [f"beam-{b}" for b in range(len(scene.beams))]:
            table.load(sensor)
    except (OSError, ValueError, KeyError, ImportError) as e:
        print(f"{args.pack}: {e}", file=sys.stderr)
        return 2
    examination = Examination(scene, table, random.Random(args.seed))
    examination.camera(args.pixels)
    for b in range(len(scene.beams)):
        examination.beam(b, args.pencils)
    examination.sums()

    table.print()
    print("; ".join(f"{what}: {count}" for what, count in examination.notes.items()))
    if table.unread:
        table.wrong.append(f"channels that nothing was compared with: {', '.join(sorted(table.unread))}")
    for line in table.wrong[:10]:
        print(line)
    if table.wrong:
        print(f"{len(table.wrong)} differences")
        return 1
    print("all equal")
    return 0


if __name__ == "__main__":
    sys.exit(main())
