"""Which unmeasured cells a wheel bridges, and how high their ground is at most: rule `gap` of docs/theory/rover.md."""

import numpy as np

from elevation_map import MEASURED, PROXIMITY

MAX_CONTINUED_SLOPE = 1.0  # rise over distance; what is steeper is an edge, and does not go on
SIGHT_LENGTH = 2.0  # m; a line of sight is followed back from its point no farther than this
LINES = [(1, 0), (0, 1), (1, 1), (1, -1)]  # row, column, and both diagonals: steps (di, dj)


class Shadows:
    """What stands in the unmeasured cells, at most; NaN where nothing is known.

    `bridge`: of cells in a run of unmeasured ones that is no wider than a wheel. `ceiling`: of cells below a line of sight.
    """

    def __init__(self, elevation_map, max_width):
        measured = (elevation_map.source == MEASURED) | (elevation_map.source == PROXIMITY)
        x, y, z = highest_points(elevation_map, measured)
        ends = np.full(z.shape, -np.inf)
        for di, dj in LINES:
            step = elevation_map.spacing * np.hypot(di, dj)
            longest = int(np.floor(max_width / step + 1e-9))
            before, first = run_to_measured(measured, z, -di, -dj, longest)
            behind, last = run_to_measured(measured, z, di, dj, longest)
            peak = np.full(z.shape, -np.inf)
            # Along rows and columns alone: a diagonal through the corner of a level stone falls on both sides, too.
            for k in range(1, longest + 1 if di * dj == 0 else 1):
                for n in range(1, longest + 1):
                    here = (before == k) & (behind == n)
                    quartet = [[shifted(values, step * di, step * dj, np.nan) for values in (x, y, z)]
                               for step in (-k - 1, -k, n, n + 1)]
                    peak = np.where(here, np.fmax(peak, bend_between(*quartet, 1)[2]), peak)
            bridged = ~measured & (before + behind - 1 <= longest)
            ends = np.where(bridged, np.maximum(ends, np.maximum(peak, np.maximum(first, last))), ends)
        hidden = lines_of_sight(elevation_map, measured)
        self.ceiling = np.where(np.isfinite(hidden), hidden, np.nan)
        # The higher end, or what can hide there if that is more.
        self.bridge = np.where(np.isfinite(ends), np.fmax(ends, self.ceiling), np.nan)


def highest_points(elevation_map, measured):
    """The highest point of each measured cell, at its own place; NaN elsewhere."""
    m = elevation_map
    jj, ii = np.mgrid[0:m.points, 0:m.points]
    gx, gy = m.place(ii, jj)
    own, tall = m.source == MEASURED, (m.source == MEASURED) & np.isfinite(m.top_z)
    x, y = (np.where(tall, top, np.where(own, value, grid))
            for top, value, grid in ((m.top_x, m.x, gx), (m.top_y, m.y, gy)))
    z = np.where(tall, m.top_z, m.elevation)
    return [np.where(measured, values, np.nan) for values in (x, y, z)]


def bend_between(before, near, far, after, sign):
    """Where the ground between `near` and `far` bends, above the straight line from one to the other (sign 1) or below it (-1):
    x, y, z; NaN where it does not. Each other argument is a list of x, y, z."""
    def slope(foot, end):
        away = np.hypot(end[0] - foot[0], end[1] - foot[1])
        steep = np.where(away > 0, (end[2] - foot[2]) / np.where(away > 0, away, 1), 0)
        return np.clip(steep, -MAX_CONTINUED_SLOPE, MAX_CONTINUED_SLOPE)

    up, down = slope(before, near), slope(after, far)
    length = np.hypot(far[0] - near[0], far[1] - near[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        way = (far[2] - near[2] + down * length) / (up + down)
        way = np.where((way > 0) & (way < length), way, np.nan)
        share = way / length
        bends = sign * (up * way - (far[2] - near[2]) * share) > 0
        meeting = [near[0] + (far[0] - near[0]) * share, near[1] + (far[1] - near[1]) * share, near[2] + up * way]
        # Where there is an edge, the side that is asked for goes on half way.
        edge = np.abs(far[2] - near[2]) > MAX_CONTINUED_SLOPE * length
        by_near, by_far = near[2] + up * length / 2, far[2] + down * length / 2
        half = np.maximum(by_near, by_far) if sign > 0 else np.minimum(by_near, by_far)
        at_edge = [(near[0] + far[0]) / 2, (near[1] + far[1]) / 2, half]
        bends = np.where(edge, True, bends)
        return [np.where(bends, np.where(edge, a, m), np.nan) for a, m in zip(at_edge, meeting)]


def run_to_measured(measured, z, di, dj, longest):
    """Steps from each cell to the first measured one along (di, dj), at most `longest`, and its elevation."""
    steps = np.full(measured.shape, 10 ** 6)
    height = np.full(measured.shape, np.nan)
    for k in range(1, longest + 1):
        target = shifted(measured, k * di, k * dj, False)
        value = shifted(z, k * di, k * dj, np.nan)
        new = target & (steps > longest)
        steps[new], height[new] = k, value[new]
    return steps, height


def shifted(array, di, dj, fill):
    """out[j, i] = array[j + dj, i + di], and `fill` beyond the border."""
    n = array.shape[0]
    out = np.full_like(array, fill)
    j0, j1, i0, i1 = max(0, -dj), min(n, n - dj), max(0, -di), min(n, n - di)
    if j0 < j1 and i0 < i1:
        out[j0:j1, i0:i1] = array[j0 + dj:j1 + dj, i0 + di:i1 + di]
    return out


def lines_of_sight(elevation_map, measured):
    """The lowest line of sight over each unmeasured cell, where it leaves the cell; infinite where there is none."""
    m = elevation_map
    ceiling = np.full(measured.shape, np.inf)
    j, i = np.nonzero((m.source == MEASURED) & np.isfinite(m.sight_slope))
    x, y, z = m.x[j, i], m.y[j, i], m.elevation[j, i]
    ux, uy, slope = m.sight_x[j, i], m.sight_y[j, i], np.maximum(m.sight_slope[j, i], 0)
    live = np.ones(len(j), bool)
    step = m.spacing / 2
    for k in range(1, int(round(SIGHT_LENGTH / step)) + 1):
        way = k * step
        ci, cj = m.grid(x + way * ux, y + way * uy)
        own = (ci == i) & (cj == j)
        inside = m.inside(ci, cj)
        live &= own | inside
        live[live] &= own[live] | ~measured[cj[live], ci[live]]
        over = live & ~own
        np.minimum.at(ceiling, (cj[over], ci[over]), (z + slope * (way + m.spacing))[over])
    return ceiling
