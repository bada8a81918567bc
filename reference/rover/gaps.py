"""Which unmeasured cells a wheel bridges, and how high their ground is at most: rule `gap` of docs/theory/rover.md."""

import numpy as np

from elevation_map import MEASURED, PROXIMITY

SIGHT_LENGTH = 2.0  # m; a line of sight is followed back from its point no farther than this
LINES = [(1, 0), (0, 1), (1, 1), (1, -1)]  # row, column, and both diagonals: steps (di, dj)


class Shadows:
    """What stands in the unmeasured cells, at most; NaN where nothing is known.

    `bridge`: of cells in a run of unmeasured ones that is no wider than a wheel. `ceiling`: of cells below a line of sight.
    """

    def __init__(self, elevation_map, max_width):
        measured = (elevation_map.source == MEASURED) | (elevation_map.source == PROXIMITY)
        z = np.where(measured, elevation_map.elevation, np.nan)
        ends = np.full(z.shape, -np.inf)
        for di, dj in LINES:
            step = elevation_map.spacing * np.hypot(di, dj)
            longest = int(np.floor(max_width / step + 1e-9))
            before, first = run_to_measured(measured, z, -di, -dj, longest)
            behind, last = run_to_measured(measured, z, di, dj, longest)
            bridged = ~measured & (before + behind - 1 <= longest)
            ends = np.where(bridged, np.maximum(ends, np.maximum(first, last)), ends)
        hidden = lines_of_sight(elevation_map, measured)
        self.ceiling = np.where(np.isfinite(hidden), hidden, np.nan)
        # The higher end, or what can hide there if that is more.
        self.bridge = np.where(np.isfinite(ends), np.fmax(ends, self.ceiling), np.nan)


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
