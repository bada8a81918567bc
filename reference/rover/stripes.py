"""Lower edges of the stripes in an image: the section "Stripes" of docs/theory/rover.md.

Rows are counted downwards, so that the lower end of a run of lit pixels is the one with the highest row.
"""

from dataclasses import dataclass

import numpy as np

BINS = 256  # of Otsu's histogram


@dataclass
class Edges:
    """One image's edges of one beam, in row-major order; `row` is j + 1/2 for the middle of pixel row j."""

    beam: int
    column: np.ndarray
    row: np.ndarray
    pixel_row: np.ndarray  # the pixel that holds the edge; "lookup": "table" takes the point of its middle


def level_of(image, extraction):
    """The number at or above which a pixel is lit; infinite if the image has no light."""
    detection = extraction["detection"]
    if detection == "fixed":
        return float(extraction["threshold"])
    brightest = float(image.max())
    if detection == "share":
        return extraction["threshold"] * brightest if brightest > 0 else np.inf
    return otsu(image)


def otsu(image):
    """Otsu's cut of a histogram of 256 bins from the lowest to the highest number; of equal cuts the middle one."""
    low, high = float(image.min()), float(image.max())
    if not high > low:
        return np.inf
    bins = np.minimum(((image - low) * (BINS / (high - low))).astype(int), BINS - 1)
    count = np.bincount(bins.reshape(-1), minlength=BINS).astype(float)
    below = np.cumsum(count)[:-1]  # pixels in bins 0..k, for a cut above bin k
    moment = np.cumsum(count * np.arange(BINS))
    above = count.sum() - below
    with np.errstate(divide="ignore", invalid="ignore"):
        spread = below * above * (moment[:-1] / below - (moment[-1] - moment[:-1]) / above) ** 2
    best = np.flatnonzero(spread == np.nanmax(spread))
    cut = best[len(best) // 2]
    return low + (cut + 1) * (high - low) / BINS


def runs(image, extraction):
    """First and last row of each run of lit pixels that does not reach the lower border, with its column.

    Also the level, for the crossing between the last lit pixel and the next. Sorted by (last row, column).
    """
    height = image.shape[0]
    if extraction["detection"] == "gradient":
        first, last, column = steep_runs(image, float(extraction["threshold"]))
        level = None
    else:
        level = level_of(image, extraction)
        lit = image >= level
        # One dark row above and below turns both ends of a run into differences.
        padded = np.zeros((height + 2, image.shape[1]), np.int8)
        padded[1:-1] = lit
        change = np.diff(padded, axis=0)
        # Transposed: np.nonzero then walks down each column, so that starts and ends pair up.
        column, first = np.nonzero(change.T > 0)
        _, after = np.nonzero(change.T < 0)
        last = after - 1
    keep = (last < height - 1) & (last - first + 1 >= extraction["least_rows"])
    first, last, column = first[keep], last[keep], column[keep]
    order = np.lexsort((column, last))
    return first[order], last[order], column[order], level


def steep_runs(image, least):
    """Runs between a steepest rise and the next steepest fall of a column, each at least `least` strong.

    Light without a rise begins at the upper border, or below the fall before it.
    """
    step = steps_down(image)  # step[j] is from row j to row j + 1; one row of zeros above and below them

    def peaks(s):
        """Of equal differences the first is the steepest."""
        return (s[1:-1] >= least) & (s[1:-1] > s[:-2]) & (s[1:-1] >= s[2:])

    rise, fall = peaks(step), peaks(-step)
    first, last, column = [], [], []
    for i in np.flatnonzero(fall.any(axis=0)):
        start = 0
        for j in np.flatnonzero(rise[:, i] | fall[:, i]):
            if rise[j, i]:
                start = j + 1
            else:
                first.append(start), last.append(j), column.append(i)
                start = j + 1
    return np.array(first, int), np.array(last, int), np.array(column, int)


def steps_down(image):
    """Differences from each row to the next; beyond the image they are 0."""
    step = np.zeros((image.shape[0] + 1, image.shape[1]))
    step[1:-1] = np.diff(image.astype(float), axis=0)
    return step


def places(image, first, last, column, level, place):
    """Row of each edge, by the setup's "place"."""
    if place == "pixel" or len(last) == 0:
        return last + 0.5
    if place == "sub_pixel":
        here, below = image[last, column].astype(float), image[last + 1, column].astype(float)
        if level is None:
            # The vertex of the parabola through the fall and the differences above and below it.
            step = steps_down(image)
            above, fall, under = (step[last + k, column] for k in (0, 1, 2))
            bend = above - 2 * fall + under
            shift = np.where(bend > 0, 0.5 * (above - under) / np.where(bend > 0, bend, 1), 0.0)
            return last + 1.0 + shift
        return last + 0.5 + (here - level) / (here - below)
    weight, moment = np.zeros(len(last)), np.zeros(len(last))
    for k in range(int((last - first).max()) + 1):
        inside = first + k <= last
        row = np.where(inside, first + k, last)
        value = np.where(inside, image[row, column].astype(float), 0.0)
        weight += value
        moment += value * (row + 0.5)
    return moment / weight


def edges_of(image, beams, extraction, rig=None):
    """Edges by beam and the number of columns left out. `beams` lists the beams that light the image; of several the rig
    tells which one can have lit a run."""
    first, last, column, level = runs(image, extraction)
    row = places(image, first, last, column, level, extraction["place"])
    pixel_row = np.floor(row).astype(int) if extraction["place"] == "centroid" else last
    order = np.lexsort((column, pixel_row))
    column, row, pixel_row = column[order], row[order], pixel_row[order]
    first, last = first[order], last[order]
    if len(beams) == 1:
        return [Edges(beams[0], column, row, pixel_row)], 0
    owner = beams_of_runs(first, last, column, can_light(rig, beams, column, row, extraction), len(beams))
    left_out = len(np.unique(column[owner < 0]))
    return [Edges(beam, column[owner == k], row[owner == k], pixel_row[owner == k])
            for k, beam in enumerate(beams)], left_out


def can_light(rig, beams, column, row, extraction):
    """Whether each run's edge can lie on the plane of each beam: an array of runs by beams."""
    centroid = extraction["place"] == "centroid"
    return np.column_stack([rig.points(beam, column, row, centroid)[1] for beam in beams])


def beams_of_runs(first, last, column, possible, beams):
    """The beam of each run, or -1 where more than one beam may have lit it: plane, continuity, order."""
    n = len(column)
    by_column = {}
    for k in sorted(range(n), key=lambda k: (column[k], last[k])):
        by_column.setdefault(int(column[k]), []).append(k)
    piece = list(range(n))  # each run is a piece, unless it continues one of the column before

    def touching(k, others):
        return [o for o in others if first[k] <= last[o] + 1 and first[o] <= last[k] + 1]

    for c, runs in sorted(by_column.items()):
        before = by_column.get(c - 1, [])
        for k in runs:
            met = touching(k, before)
            if len(met) == 1 and len(touching(met[0], runs)) == 1:
                piece[k] = piece[met[0]]
    allowed = {}
    for k in range(n):
        mine = set(np.flatnonzero(possible[k]).tolist())
        allowed[piece[k]] = allowed.get(piece[k], mine) & mine
    votes = {p: [0] * beams for p in allowed}
    for runs in by_column.values():
        if len(runs) == beams and all(possible[k][rank] for rank, k in enumerate(reversed(runs))):
            for rank, k in enumerate(reversed(runs)):
                votes[piece[k]][rank] += 1
    for p, sheets in allowed.items():
        count = {b: votes[p][b] for b in sheets}
        best = max(count, key=count.get, default=None)
        if best is not None and 2 * count[best] > sum(count.values()):
            allowed[p] = {best}
    changed = True
    while changed:
        changed = False
        for runs in by_column.values():
            for at, k in enumerate(runs):
                if len(allowed[piece[k]]) != 1:
                    continue
                (sure,) = allowed[piece[k]]
                for place, other in enumerate(runs):
                    sheets = allowed[piece[other]]
                    rest = {b for b in sheets if (b >= sure if place < at else b <= sure)}
                    if place != at and len(sheets) > 1 and rest and rest != sheets:
                        allowed[piece[other]], changed = rest, True
    owner = np.full(n, -1)
    for k in range(n):
        sheets = allowed[piece[k]] or set(np.flatnonzero(possible[k]).tolist())
        if len(sheets) == 1:
            (owner[k],) = sheets
    return owner
