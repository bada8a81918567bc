#!/usr/bin/env python3
"""Evaluates the vehicle's truth again ("The truth" of docs/theory/rover.md) and compares it with a recorded drive.

    raypencil drive GROUND.toml --record poses -o out/drive
    python3 reference/rover/truth.py GROUND.toml out/drive/recording

GROUND.toml is a scene whose `terrain.file` is an OBJ mesh of height posts, as `python3 reference/rover/truth.py --make FOLDER`
writes them: three scenes, of the rules as they are by default, with tip-over, and with steps.

Here the ground is a function of the place and a wheel is a comb of points, 2 mm apart along the wheel and 11 across it: no triangle is
clipped and no contact has a closed form. So a hub may be low by the ground's slope over 1 mm along and 12 mm across, and where a test is
within that of its limit a sector may end one radius apart. Exit code 1 if more than 5 % do, or one differs by more.
"""

import csv
import json
import math
import sys
import tomllib
from pathlib import Path

import numpy as np

KINDS = ["front_slope", "rear_slope", "length_slope", "tip_over", "belly", "step"]
SPACING = 0.1
HALF = 8.0
# Largest share of sectors that may end one radius apart or by another rule, for the comb of points. Tuned.
NEAR = 0.05


class Ground:
    """Heights between posts: each cell is two triangles, split from its first corner to the opposite one."""

    def __init__(self, heights):
        self.heights = heights

    def __call__(self, x, y):
        u, v = (x + HALF) / SPACING, (y + HALF) / SPACING
        i, j = np.floor(u).astype(int), np.floor(v).astype(int)
        n = len(self.heights) - 1
        outside = (u < 0) | (v < 0) | (u > n) | (v > n)
        i, j = np.clip(i, 0, n - 1), np.clip(j, 0, n - 1)
        s, t = u - i, v - j
        a, b = self.heights[i, j], self.heights[i + 1, j]
        c, d = self.heights[i + 1, j + 1], self.heights[i, j + 1]
        z = np.where(s >= t, a + (b - a) * s + (c - b) * t, a + (c - d) * s + (d - a) * t)
        return np.where(outside, np.nan, z)


class Vehicle:
    def __init__(self, keys):
        def key(name, default):
            return keys.get(name, default)

        self.base, self.track = key("wheelbase_m", 1.2), key("track_m", 1.0)
        self.radius, self.width = key("wheel_radius_m", 0.35), key("wheel_width_m", 0.25)
        self.clearance = key("true_clearance_m", key("clearance_m", 0.35))
        across, along = self.radius / self.track, self.radius / self.base
        self.limits = [key(f"true_slope_{name}", key(f"slope_{name}", own))
                       for name, own in (("front", across), ("rear", across), ("length", along))]
        self.step = key("true_step_m", None)
        self.mass = key("true_centre_of_mass_m", None)

    def wheel(self, ground, x, y, heading):
        """Height of a hub over (x, y), and that of the ground point that carries it. NaN off the ground."""
        a = np.arange(-self.radius, self.radius + 1e-3, 2e-3)
        b = np.linspace(-0.5 * self.width, 0.5 * self.width, 11)
        a, b = np.meshgrid(np.clip(a, -self.radius, self.radius), b)
        cos, sin = math.cos(heading), math.sin(heading)
        z = ground(x + a * cos - b * sin, y + a * sin + b * cos)
        if np.all(np.isnan(z)):
            return math.nan, math.nan
        hub = z + np.sqrt(np.maximum(self.radius**2 - a**2, 0))
        best = np.unravel_index(np.nanargmax(hub), hub.shape)
        return hub[best], z[best]

    def wheels(self, ground, x, y, heading):
        cos, sin = math.cos(heading), math.sin(heading)
        found = []
        for behind, left in ((0, 0.5), (0, -0.5), (self.base, 0.5), (self.base, -0.5)):
            left *= self.track
            found.append(self.wheel(ground, x - behind * cos - left * sin, y - behind * sin + left * cos, heading))
        return found

    def stopped(self, ground, x, y, heading, step):
        """The rule that stops it with its front axle over (x, y); "" for none, None off the ground."""
        wheels = self.wheels(ground, x, y, heading)
        hubs = [hub for hub, _ in wheels]
        if any(math.isnan(hub) for hub in hubs):
            return None
        fl, fr, rl, rr = hubs
        front, rear, length = self.limits
        p, q = (fl + fr - rl - rr) / 2 / self.base, (fl + rl - fr - rr) / 2 / self.track
        if abs(fl - fr) > front * self.track:
            return "front_slope"
        if abs(rl - rr) > rear * self.track:
            return "rear_slope"
        if abs(p) > length:
            return "length_slope"
        if self.mass and self.tips(p, q):
            return "tip_over"
        cos, sin = math.cos(heading), math.sin(heading)
        a = np.linspace(-0.5 * self.base, 0.5 * self.base, 241)
        b = np.linspace(-0.5, 0.5, 101) * (self.track - self.width)
        a, b = np.meshgrid(a, b)
        middle = a - 0.5 * self.base
        z = ground(x + middle * cos - b * sin, y + middle * sin + b * cos)
        under = sum(hubs) / 4 + p * a + q * b - (self.radius - self.clearance) * math.sqrt(1 + p * p + q * q)
        if np.any(z >= under):
            return "belly"
        if self.step and self.climbs(ground, x, y, heading, step):
            return "step"
        return ""

    def tips(self, p, q):
        """By turning gravity into the vehicle's own axes, as matrices: x pitched, then y rolled."""
        forward = np.array([1, 0, p]) / math.hypot(1, p)
        up = np.array([-p, -q, 1]) / math.sqrt(1 + p * p + q * q)
        axes = np.stack([forward, np.cross(up, forward), up])
        down = axes @ np.array([0.0, 0.0, -1.0])
        foot = np.array(self.mass) + down * (self.mass[2] / -down[2])
        return abs(foot[0]) > 0.5 * self.base or abs(foot[1]) > 0.5 * self.track

    def climbs(self, ground, x, y, heading, step):
        """Whether a carrying point rises by more than the limit within 5 mm of the last step of the way."""
        before = None
        for back in np.arange(step, -2.5e-3, -5e-3):
            now = [z for _, z in self.wheels(ground, x - back * math.cos(heading), y - back * math.sin(heading), heading)]
            if before and any(b - a > self.step for a, b in zip(before, now)):
                return True
            before = now
        return False


def make(folder):
    """Three scenes: random stones on a rolling ground."""
    folder.mkdir(parents=True, exist_ok=True)
    draw = np.random.default_rng(5)
    n = round(2 * HALF / SPACING)
    at = np.linspace(-HALF, HALF, n + 1)
    x, y = np.meshgrid(at, at, indexing="ij")
    z = 0.25 * np.sin(0.5 * x) * np.cos(0.4 * y)
    for _ in range(60):
        cx, cy, size = draw.uniform(-7, 7), draw.uniform(-7, 7), draw.uniform(0.1, 0.5)
        away = np.hypot(x - cx, y - cy)
        z = z + np.where((away < 0.4) & (math.hypot(cx, cy) > 1.8), size * draw.uniform(0.4, 1), 0)
    z = np.round(z, 3)
    lines = [f"v {x[i, j]:.3f} {y[i, j]:.3f} {z[i, j]:.3f}" for i in range(n + 1) for j in range(n + 1)]
    for i in range(n):
        for j in range(n):
            a, b = i * (n + 1) + j + 1, (i + 1) * (n + 1) + j + 1
            lines += [f"f {a} {b} {b + 1}", f"f {a} {b + 1} {a + 1}"]
    (folder / "ground.obj").write_text("\n".join(lines) + "\n")
    free = "true_slope_front = 9\ntrue_slope_rear = 9\ntrue_slope_length = 9\n"
    for name, keys in (("default", ""), ("tips", free + "true_centre_of_mass_m = [0.1, 0.05, 1.4]\n"),
                       ("steps", free + "true_step_m = 0.18\ntrue_clearance_m = 0.5\n")):
        text = ("version = 1\ncamera = { width_px = 96, height_px = 96, pixel_pitch_um = 96 }\n"
                'beam = [{ rows = 2 }, { rows = 2 }]\nterrain = { file = "ground.obj" }\n[drive]\n'
                "waypoints_m = [[0.6, 0]]\nframes_per_s = 2\nscans = false\nobstacles_every_frames = 4\n"
                f"grid_half_angle_deg = 170\n{keys}")
        (folder / f"{name}.toml").write_text(text)


def heights_of(path):
    rows = [line.split() for line in path.read_text().splitlines() if line.startswith("v ")]
    z = np.array([float(row[3]) for row in rows])
    side = math.isqrt(len(z))
    return z.reshape(side, side)


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    if sys.argv[1] == "--make":
        make(Path(sys.argv[2]))
        return 0
    scene, recording = Path(sys.argv[1]), Path(sys.argv[2])
    tables = tomllib.loads(scene.read_text())
    vehicle = Vehicle(tables["drive"])
    ground = Ground(heights_of(scene.parent / tables["terrain"]["file"]))
    grid = json.loads((recording / "setup.json").read_text())["grid"]
    poses = {row["frame"]: row for row in csv.DictReader(open(recording / "poses.csv", newline=""))}
    radii = np.arange(grid["first"], grid["last"] + 1e-9, grid["step"])
    equal, near, rules = 0, [], {}
    for row in csv.DictReader(open(recording / "sectors.csv", newline="")):
        x, y, heading = true_place(poses[row["frame"]])
        direction = heading + (2 * int(row["sector"]) / (grid["sectors"] - 1) - 1) * grid["half_angle"]
        theirs = (float(row["true_radius_m"] or "inf"), row["true_rule"])
        ours = (math.inf, "")
        for radius in radii:
            rule = vehicle.stopped(ground, x + radius * math.cos(direction), y + radius * math.sin(direction),
                                   direction, grid["step"])
            if rule is None:
                break
            if rule:
                ours = (radius, rule)
                break
        if abs(ours[0] - theirs[0]) < 1e-6 and ours[1] == theirs[1] or ours == theirs:
            equal += 1
        else:
            near.append((row["frame"], row["sector"], ours, theirs))
        rules[theirs[1]] = rules.get(theirs[1], 0) + 1
    total = equal + len(near)
    print(f"{equal} of {total} sectors are equal; by rule: {rules}")
    far = [one for one in near if not abs(one[2][0] - one[3][0]) < 1.5 * grid["step"]]
    for frame, sector, ours, theirs in near[:10]:
        print(f"  frame {frame}, sector {sector}: here {ours}, there {theirs}")
    return 0 if total and not far and len(near) <= NEAR * total else 1


def true_place(row):
    """Place and heading of the true pose."""
    x, y = float(row["true_x_m"]), float(row["true_y_m"])
    qx, qy, qz, qw = (float(row[f"true_q{axis}"]) for axis in "xyzw")
    forward = (1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw))
    return x, y, math.atan2(forward[1], forward[0])


if __name__ == "__main__":
    sys.exit(main())
