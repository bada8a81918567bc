"""Elevations at the grid points themselves, from points measured beside them: "At the grid points" of docs/theory/rover.md."""

import numpy as np

from elevation_map import EXTRAPOLATED, MEASURED

MAX_SLOPE = 0.35
STEP_DEVIATIONS = 3.0
LEAST_SPREAD = 1e-2


def elevations_at_grid_points(m):
    """The map's elevations carried from their own places to the grid points; NaN where unknown."""
    out = m.elevation.copy()
    if m.rules["several"] == "paper":
        return out
    variance = m.variance_now()
    for j, i in np.argwhere(m.source == MEASURED):
        fit = slopes(m, on_surface(m, variance, (j, i), neighbours(m, j, i, 1)))
        if fit is not None:
            gx, gy = m.place(i, j)
            out[j, i] = m.elevation[j, i] + fit[1] * (gx - m.x[j, i]) + fit[2] * (gy - m.y[j, i])
    for j, i in np.argwhere(m.source == EXTRAPOLATED):
        beside = neighbours(m, j, i, 1)
        if not len(beside[0]):
            continue
        highest = int(np.argmax(m.elevation[beside]))  # of equally high ones the first
        here = (beside[0][highest], beside[1][highest])
        fit = slopes(m, on_surface(m, variance, here, neighbours(m, j, i, 2)))
        if fit is not None:
            (x, y, z), bx, by = fit
            gx, gy = m.place(i, j)
            out[j, i] = z + bx * (gx - x) + by * (gy - y)
    return out


def on_surface(m, variance, here, near):
    """Those of the cells `near` that no step separates from the cell `here`."""
    apart = np.hypot(m.x[near] - m.x[here], m.y[near] - m.y[here])
    gate = MAX_SLOPE * apart + STEP_DEVIATIONS * np.sqrt(variance[here] + variance[near])
    same = np.abs(m.elevation[near] - m.elevation[here]) <= gate
    return near[0][same], near[1][same]


def neighbours(m, j, i, reach):
    """Indices of the measured cells within `reach` rows and columns, the cell itself among them."""
    low = (max(0, j - reach), max(0, i - reach))
    block = m.source[low[0]:j + reach + 1, low[1]:i + reach + 1] == MEASURED
    jj, ii = np.nonzero(block)
    return jj + low[0], ii + low[1]


def slopes(m, at):
    """Mean place and the slopes of the plane of least squares; None with fewer than three points, for points on a line,
    and for a plane too steep for one surface."""
    x, y, z = m.x[at], m.y[at], m.elevation[at]
    if len(x) < 3:
        return None
    mean = (x.mean(), y.mean(), z.mean())
    u, v, w = x - mean[0], y - mean[1], z - mean[2]
    xx, xy, yy = (u * u).sum(), (u * v).sum(), (v * v).sum()
    det, trace = xx * yy - xy * xy, xx + yy
    if not det > LEAST_SPREAD * trace * trace:
        return None
    xz, yz = (u * w).sum(), (v * w).sum()
    slope = (yy * xz - xy * yz) / det, (xx * yz - xy * xz) / det
    return (mean, *slope) if np.hypot(*slope) <= MAX_SLOPE else None
