"""Obstacle map: the radial grid and the paper's seven points (§7), the section "Obstacle map" of rover.md.

The mended tests, with whole wheels, are in wheel_tests.py.
"""

from dataclasses import dataclass

import numpy as np

from elevation_map import UNKNOWN

OBSTACLE, UNKNOWN_LABEL, VISIBILITY = "obstacle", "unknown", "visibility"


@dataclass
class Sector:
    """Where testing of a sector stopped, and why. `part` and `missing` belong to unknown points."""

    direction: float
    radius: float
    x: float
    y: float
    label: str
    reason: str = ""
    part: str = ""
    missing_x: float = np.nan
    missing_y: float = np.nan
    near_tie: bool = False  # a decision was within rounding of the other one


@dataclass
class Verdict:
    """Of one point Q: label "clear", "obstacle" or "unknown"."""

    label: str
    reason: str = ""
    part: str = ""
    missing: tuple = (np.nan, np.nan)
    near_tie: bool = False


CLEAR = "clear"


def directions(grid, heading):
    """From right to left, over the fan around the heading."""
    n = grid["sectors"]
    if n == 1:
        return [heading]
    return [heading - grid["half_angle"] + 2 * grid["half_angle"] * k / (n - 1) for k in range(n)]


def radii(grid):
    """first, first + step, ... up to last; a billionth of a step beyond it is rounding."""
    count = int(np.floor((grid["last"] - grid["first"]) / grid["step"] + 1e-9)) + 1
    return [grid["first"] + k * grid["step"] for k in range(count)]


def obstacle_map(grid, x, y, heading, test):
    """All sectors. `test(qx, qy, ux, uy)` gives the verdict of a point Q for a vehicle that heads along u."""
    out = []
    for direction in directions(grid, heading):
        ux, uy = np.cos(direction), np.sin(direction)
        tie = False
        places = [(radius, x + radius * ux, y + radius * uy) for radius in radii(grid)]
        for k, (radius, qx, qy) in enumerate(places):
            verdict = test(qx, qy, ux, uy)
            tie |= verdict.near_tie
            if verdict.reason in ("near_limit", "may_hide") and k + 1 < len(places):
                # An obstacle begins at the point before it, if that one is too near a limit to tell.
                following = test(*places[k + 1][1:], ux, uy)
                tie |= following.near_tie
                if following.label == OBSTACLE:
                    verdict = Verdict(OBSTACLE, following.reason)
            if verdict.label != CLEAR:
                out.append(Sector(direction, radius, qx, qy, verdict.label, verdict.reason, verdict.part,
                                  *verdict.missing, tie))
                break
        else:
            out.append(Sector(direction, radius, qx, qy, VISIBILITY, near_tie=tie))
    return out


class PointTests:
    """The paper's tests on the grid points nearest to wheel centres and midpoints."""

    def __init__(self, elevation_map, setup):
        self.map, self.vehicle, self.limits = elevation_map, setup["vehicle"], setup["tests"]

    def __call__(self, qx, qy, ux, uy):
        length, half_track = self.vehicle["wheelbase"], self.vehicle["track"] / 2
        closer = self.limits["closer_share"] * length / 2
        # Ahead and to the left of Q.
        offsets = np.array([(0, half_track), (0, -half_track), (-length, half_track), (-length, -half_track),
                            (0, 0), (-length, 0), (-length / 2 + closer, 0), (-length / 2 - closer, 0),
                            (-length / 2, 0)])
        px = qx + offsets[:, 0] * ux - offsets[:, 1] * uy
        py = qy + offsets[:, 0] * uy + offsets[:, 1] * ux
        z, source = self.map.read(px, py)
        i, j = self.map.grid(px, py)
        gx, gy = self.map.place(i, j)
        known = source != UNKNOWN
        tie = bool(self.map.tie(px, py).any())
        rear_known = known[2] and known[3]
        slopes = self.limits["slopes"]
        pairs = [("front", 0, 1), ("rear", 2, 3), ("length", 4, 5) if rear_known else ("closer", 6, 7)]
        for name, a, b in pairs:
            if known[a] and known[b]:
                apart = np.hypot(gx[a] - gx[b], gy[a] - gy[b])
                rise = abs(z[a] - z[b])
                tie |= bool(abs(rise - slopes[name] * apart) <= 1e-9)
                if rise > slopes[name] * apart:
                    return Verdict("obstacle", name, near_tie=tie)
        if known[:4].all() and known[8]:
            room = z[:4].mean() + self.vehicle["clearance"] - z[8]
            tie |= bool(abs(room) <= 1e-9)
            if room <= 0:
                return Verdict("obstacle", "belly", near_tie=tie)
        needed = [("front_wheel", (0, 1)), ("rear_wheel", (2, 3) if self.limits["rear_needed"] else ()),
                  ("centre_line", pairs[2][1:]), ("belly", (8,))]
        for part, points in needed:
            for k in points:
                if not known[k]:
                    reason = "not_measured" if self.map.inside(i[k], j[k]) else "beyond_map"
                    return Verdict("unknown", reason, part, (float(gx[k]), float(gy[k])), tie)
        return Verdict(CLEAR, near_tie=tie)
