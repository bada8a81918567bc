"""Which unmeasured cells a wheel bridges, and how high at most they are: rule `gap` of docs/theory/rover.md."""

import numpy as np

from elevation_map import MEASURED

SIGHT_LENGTH = 2.0  # m; a line of sight is followed back from its point no farther than this
LINES = [(1, 0), (0, 1), (1, 1), (1, -1)]  # row, column, and both diagonals: steps (di, dj)


class Shadows:
    """What stands in the unmeasured cells, at most.

    `bridged`: the run of unmeasured cells through a cell is no wider than a wheel, along one of the four lines.
    `ceiling`: no ground in the cell stands above it; infinite where nothing is known.
    """

    def __init__(self, elevation_map, max_width):
        self.measured = elevation_map.source == MEASURED
        z = np.where(self.measured, elevation_map.elevation, np.nan)
        n = elevation_map.points
        self.bridged = np.zeros((n, n), bool)
        ends = np.full((n, n), np.inf)
        for di, dj in LINES:
            step = elevation_map.spacing * np.hypot(di, dj)
            longest = int(np.floor(max_width / step + 1e-9))
            before, first = run_to_measured(self.measured, z, -di, -dj, longest)
            behind, last = run_to_measured(self.measured, z, di, dj, longest)
            run = before + behind - 1
            bridge = ~self.measured & (run <= longest)
            self.bridged |= bridge
            ends = np.where(bridge, np.minimum(ends, np.maximum(first, last)), ends)
        self.hidden = hidden(elevation_map, self.measured)
        self.ceiling = np.where(self.bridged, np.minimum(ends, self.hidden), self.hidden)
        self.ceiling = np.where(self.measured, z, self.ceiling)


def run_to_measured(measured, z, di, dj, longest):
    """Steps from each cell to the first measured one along (di, dj), at most `longest`, and its elevation."""
    n = measured.shape[0]
    steps = np.full((n, n), 10 ** 6)
    height = np.full((n, n), np.nan)
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


def hidden(elevation_map, measured):
    """The lowest of the lines of sight over each unmeasured cell; infinite where there is none.

    Each measured cell has the horizontal direction towards camera and beam, and the flatter line's slope, as the
    vector (slope_x, slope_y) with the length of the slope.
    """
    n = elevation_map.points
    ceiling = np.full((n, n), np.inf)
    j, i = np.nonzero(measured & np.isfinite(elevation_map.slope_x))
    sx, sy = elevation_map.slope_x[j, i], elevation_map.slope_y[j, i]
    slope = np.hypot(sx, sy)
    x, y, z = elevation_map.x[j, i], elevation_map.y[j, i], elevation_map.elevation[j, i]
    live = slope > 0
    ux, uy = np.where(live, sx / np.where(live, slope, 1), 0), np.where(live, sy / np.where(live, slope, 1), 0)
    step = elevation_map.spacing / 2
    for k in range(1, int(round(SIGHT_LENGTH / step)) + 1):
        way = k * step
        ci, cj = elevation_map.grid(x + way * ux, y + way * uy)
        ok = live & elevation_map.inside(ci, cj)
        blocked = np.zeros(len(ok), bool)
        blocked[ok] = measured[cj[ok], ci[ok]] & ((cj[ok] != j[ok]) | (ci[ok] != i[ok]))
        live &= ok & ~blocked
        np.minimum.at(ceiling, (cj[live], ci[live]), (z + slope * way)[live])
    return ceiling
