"""The elevation map (the paper's local terrain map): sections "Elevation map" and "Mended rules" of rover.md."""

import numpy as np

from drift import Drift

UNKNOWN, PROXIMITY, EXTRAPOLATED, MEASURED = 0, 1, 2, 3

# Numbers of the mended rules, each a CHOICE of docs/theory/rover.md.
STEP_DEVIATIONS = 3.0  # two elevations differ by a step in the cell beyond this many standard deviations ...
STEP_SLOPE = 0.35  # ... and this slope between their places
EQUALLY_HIGH = 1e-9  # m; differences below it are rounding
MIN_VARIANCE = 0.0005 ** 2  # m^2, of any elevation

NEIGHBOURS = [(di, dj) for dj in (-1, 0, 1) for di in (-1, 0, 1) if (di, dj) != (0, 0)]


def nearest(number):
    """The whole number nearest to each; halves upwards."""
    return np.floor(np.asarray(number) + 0.5).astype(int)


class ElevationMap:
    """A square of grid points. Index (j, i): j counts northwards (y), i eastwards (x), both from 0.

    Grid points are counted from `origin`, the first central point, in whole numbers: the centre is `centre`.
    """

    # name: (type, value where nothing is known)
    FIELDS = {
        "elevation": (float, np.nan), "source": (np.uint8, UNKNOWN),
        "x": (float, np.nan), "y": (float, np.nan),  # place of the measurement, which is not the grid point
        "variance": (float, np.nan), "way": (float, np.nan),  # of the elevation, and way driven when measured
        "frame": (float, np.nan),  # in which it was measured
        "corrected": (float, np.nan),  # sum of the corrections of the vehicle's elevation until then
        # The highest point of all frames, at its own place.
        "top_x": (float, np.nan), "top_y": (float, np.nan), "top_z": (float, np.nan), "top_variance": (float, np.nan),
        "top_way": (float, np.nan), "top_frame": (float, np.nan),
        "lowest": (float, np.inf), "highest": (float, -np.inf),  # of all elevations since the map was cleared
        "tied": (bool, False),  # a point near here lay within rounding of the border between two cells
        # Flatter line of sight, towards its sensor: unit vector in plan, and rise over distance. See gaps.py
        "sight_x": (float, np.nan), "sight_y": (float, np.nan), "sight_slope": (float, np.nan),
    }

    def __init__(self, setup, origin):
        self.spacing, self.points = setup["map"]["spacing"], setup["map"]["points"]
        self.rules = setup["rules"]
        self.drift = Drift(setup)
        self.frame_now, self.way_now, self.corrected_now = 0, 0.0, 0.0
        self.origin = np.array(origin, float)
        self.centre = np.zeros(2, int)
        self.clear()

    def clear(self):
        shape = (self.points, self.points)
        for name, (kind, value) in self.FIELDS.items():
            setattr(self, name, np.full(shape, value, kind))

    # Places

    def grid(self, x, y):
        """Indices i, j in the map's array of the grid points nearest to places; may lie outside."""
        half = self.points // 2
        i = nearest((np.asarray(x) - self.origin[0]) / self.spacing) - self.centre[0] + half
        j = nearest((np.asarray(y) - self.origin[1]) / self.spacing) - self.centre[1] + half
        return i, j

    def inside(self, i, j):
        return (i >= 0) & (i < self.points) & (j >= 0) & (j < self.points)

    def place(self, i, j):
        """Global x and y of grid points."""
        half = self.points // 2
        return (self.origin[0] + (np.asarray(i) - half + self.centre[0]) * self.spacing,
                self.origin[1] + (np.asarray(j) - half + self.centre[1]) * self.spacing)

    def tie(self, x, y, width=1e-9):
        """Whether a place lies within `width` metres of the border between two cells."""
        out = np.zeros(np.shape(x), bool)
        for value, zero in ((x, self.origin[0]), (y, self.origin[1])):
            steps = (np.asarray(value) - zero) / self.spacing + 0.5
            out |= np.abs(steps - np.round(steps)) * self.spacing <= width
        return out

    def read(self, x, y):
        """Elevation and source at the grid points nearest to places; beyond the map nothing is known."""
        i, j = self.grid(x, y)
        ok = self.inside(i, j)
        i, j = np.where(ok, i, 0), np.where(ok, j, 0)
        return np.where(ok, self.elevation[j, i], np.nan), np.where(ok, self.source[j, i], UNKNOWN)

    def move(self, x, y):
        """Moves the central grid point to the one nearest to the vehicle; returns the steps."""
        target = np.array([nearest((x - self.origin[0]) / self.spacing),
                           nearest((y - self.origin[1]) / self.spacing)])
        steps = target - self.centre
        if steps.any():
            n = self.points
            for name, (kind, value) in self.FIELDS.items():
                old, new = getattr(self, name), np.full((n, n), value, kind)
                i0, j0 = max(0, -steps[0]), max(0, -steps[1])
                i1, j1 = min(n, n - steps[0]), min(n, n - steps[1])
                if i0 < i1 and j0 < j1:
                    new[j0:j1, i0:i1] = old[j0 + steps[1]:j1 + steps[1], i0 + steps[0]:i1 + steps[0]]
                setattr(self, name, new)
        self.centre = target
        return steps

    def variance_now(self):
        """Of each measured elevation, aged to the present frame."""
        half = self.points // 2
        x, y = self.place(half, half)
        away = np.hypot(self.x - x, self.y - y)
        return self.variance + self.drift.variance(self.frame, self.frame_now, self.way_now - self.way, away)

    def top_variance_now(self):
        """Of the highest point of each cell, aged to the present frame."""
        half = self.points // 2
        x, y = self.place(half, half)
        away = np.hypot(self.top_x - x, self.top_y - y)
        return self.top_variance + self.drift.variance(self.top_frame, self.frame_now, self.way_now - self.top_way, away)

    # Elevations

    def set_proximity(self, x, y, ground):
        """The grid point under the vehicle's origin, at the start and after the map was cleared."""
        i, j = self.grid(x, y)
        self.elevation[j, i], self.source[j, i] = ground, PROXIMITY
        self.x[j, i], self.y[j, i] = x, y

    def set_footprint(self, x, y, z, rotation, vehicle):
        """The whole rectangle around the wheels gets the elevation of the wheels' plane."""
        ahead = vehicle["wheelbase"] / 2 + vehicle["wheel_radius"]
        aside = (vehicle["track"] + vehicle["wheel_width"]) / 2
        jj, ii = np.mgrid[0:self.points, 0:self.points]
        px, py = self.place(ii, jj)
        slope = -rotation[:2, 2] / rotation[2, 2]
        dx, dy = px - x, py - y
        rise = slope[0] * dx + slope[1] * dy
        along = dx * rotation[0, 0] + dy * rotation[1, 0] + rise * rotation[2, 0]
        across = dx * rotation[0, 1] + dy * rotation[1, 1] + rise * rotation[2, 1]
        under = (np.abs(along) <= ahead) & (np.abs(across) <= aside)
        self.elevation[under], self.source[under] = (z + rise)[under], PROXIMITY

    def enter(self, points, variance, way, sight):
        """Enters the new data points of a frame, or of a scan, in their order.

        `points` are global, `variance` is that of each elevation, `sight` each point's flatter line of sight. Returns
        what `inconsistency` found: number of measured grid points met again, mean and largest distance from the range
        of their old elevations.
        """
        i, j = self.grid(points[:, 0], points[:, 1])
        ok = self.inside(i, j)
        i, j, points, variance, sight = i[ok], j[ok], points[ok], variance[ok], sight[ok]
        for k in np.flatnonzero(self.tie(points[:, 0], points[:, 1])):
            # Either cell may have got the point, and each hands elevations to its eight neighbours.
            self.tied[max(0, j[k] - 2):j[k] + 3, max(0, i[k] - 2):i[k] + 3] = True
        cell = j * self.points + i
        winner = np.full(self.points * self.points, -1)
        if self.rules["several"] == "paper":
            winner[cell] = np.arange(len(cell))  # numpy assigns in order: the last point of a cell stays
        else:
            # The highest of a cell stays; of equally high ones the first.
            for k, (c, z) in enumerate(zip(cell, points[:, 2])):
                if winner[c] < 0 or z > points[winner[c], 2] + EQUALLY_HIGH:
                    winner[c] = k
        cells = np.flatnonzero(winner >= 0)
        chosen = winner[cells]
        jj, ii = np.divmod(cells, self.points)
        found = self.contradiction(jj, ii, points[chosen, 2])
        # The range of a cell is that of all of its points, whichever it keeps.
        np.minimum.at(self.lowest, (j, i), points[:, 2])
        np.maximum.at(self.highest, (j, i), points[:, 2])
        means = points[chosen], variance[chosen], sight[chosen]
        if self.rules["several"] == "mended":
            means = self.means(cell, cells, chosen, points, variance, sight)
        self.settle(jj, ii, *means, way, points[chosen], variance[chosen])
        first = np.full(self.points * self.points, -1)
        first[cell[::-1]] = np.arange(len(cell))[::-1]  # numpy assigns in order: the first of each cell remains
        self.extrapolate(jj, ii, first[cells])
        return found

    def means(self, cell, cells, chosen, points, variance, sight):
        """Of each cell the mean of its new points that lie on one surface with the highest of them."""
        of = np.searchsorted(cells, cell)
        top = points[chosen][of]
        apart = np.hypot(points[:, 0] - top[:, 0], points[:, 1] - top[:, 1])
        limit = STEP_DEVIATIONS * np.sqrt(variance + variance[chosen][of]) + STEP_SLOPE * apart
        on = np.abs(top[:, 2] - points[:, 2]) <= limit
        count = np.bincount(of[on], minlength=len(cells))
        mean = np.column_stack([points[chosen][:, axis] + np.bincount(of[on], (points - top)[on, axis], len(cells)) / count
                                for axis in range(3)])
        flattest = sight[chosen].copy()
        for k in np.flatnonzero(on):
            if sight[k, 2] < flattest[of[k], 2] or np.isnan(flattest[of[k], 2]):
                flattest[of[k]] = sight[k]
        return mean, np.bincount(of[on], variance[on], len(cells)) / count, flattest

    def contradiction(self, j, i, z):
        """How far new elevations lie outside the range of all that were measured in their cells."""
        if self.rules["inconsistency"] == "paper":
            return 0, 0.0, 0.0
        again = self.lowest[j, i] <= self.highest[j, i]
        outside = np.maximum(0, np.maximum(self.lowest[j, i] - z, z - self.highest[j, i]))[again]
        if not again.any():
            return 0, 0.0, 0.0
        return int(again.sum()), float(outside.mean()), float(outside.max())

    def settle(self, j, i, points, variance, sight, way, tops, top_variance):
        """Writes one new point per cell; by the mended rule it is blended with what was measured there. `tops` are the
        highest new points."""
        new = {"x": points[:, 0], "y": points[:, 1], "elevation": points[:, 2],
               "variance": np.maximum(variance, MIN_VARIANCE), "way": np.full(len(i), way),
               "frame": np.full(len(i), float(self.frame_now)), "corrected": np.full(len(i), self.corrected_now),
               "sight_x": sight[:, 0], "sight_y": sight[:, 1], "sight_slope": sight[:, 2]}
        new = {name: values.copy() for name, values in new.items()}
        met = self.source[j, i] == MEASURED
        self.keep_tops(j, i, met, new | {"x": tops[:, 0], "y": tops[:, 1], "elevation": tops[:, 2],
                                         "variance": np.maximum(top_variance, MIN_VARIANCE)})
        if self.rules["several"] == "mended" and met.any():
            old = {name: getattr(self, name)[j[met], i[met]] for name in new}
            now = {name: values[met] for name, values in new.items()}
            aged = self.variance_now()[j[met], i[met]]
            apart = np.hypot(now["x"] - old["x"], now["y"] - old["y"])
            limit = STEP_DEVIATIONS * np.sqrt(aged + now["variance"]) + STEP_SLOPE * apart
            rise = now["elevation"] - old["elevation"]
            step = np.abs(rise) > limit
            share = aged / (aged + now["variance"])  # of the new one
            blend = {name: old[name] + share * (now[name] - old[name]) for name in ("x", "y", "elevation", "corrected")}
            blend["variance"] = np.maximum(share * now["variance"], MIN_VARIANCE)
            blend["way"], blend["frame"] = now["way"], now["frame"]
            # The flatter of both; of equal ones the new one.
            keep = (old["sight_slope"] < now["sight_slope"]) | np.isnan(now["sight_slope"])
            for name in ("sight_x", "sight_y", "sight_slope"):
                blend[name] = np.where(keep, old[name], now[name])
            for name in new:
                # A step: its top stays, with all that is known of it.
                top = np.where(rise > 0, now[name], old[name])
                new[name][met] = np.where(step, top, blend[name])
        for name, values in new.items():
            getattr(self, name)[j, i] = values
        self.source[j, i] = MEASURED

    def keep_tops(self, j, i, met, new):
        """The highest point of each cell over all frames, whatever the cell keeps."""
        if self.rules["several"] == "paper":
            self.top_z[j, i] = np.nan
            return
        higher = ~met | ~(self.top_z[j, i] >= new["elevation"] - EQUALLY_HIGH)
        j, i = j[higher], i[higher]
        for name, of in (("x", "x"), ("y", "y"), ("z", "elevation"), ("variance", "variance"), ("way", "way"),
                         ("frame", "frame")):
            getattr(self, "top_" + name)[j, i] = new[of][higher]

    def extrapolate(self, j, i, rank):
        """Each new data point is handed to its neighbours that are not themselves new data points."""
        n = self.points
        new = np.zeros((n, n), bool)
        new[j, i] = True
        elevation = self.elevation[j, i]
        if self.rules["extrapolate"] == "paper":
            order = np.argsort(rank, kind="stable")  # later data points win
            may = ~new
        else:
            order = np.argsort(elevation, kind="stable")  # the highest neighbour wins
            may = ~new & (self.source != MEASURED) & (self.source != PROXIMITY)
        # A neighbour takes the point of highest position in `order` among those next to it.
        best = np.full((n, n), -1)
        position = np.empty(len(order), int)
        position[order] = np.arange(len(order))
        for di, dj in NEIGHBOURS:
            tj, ti = j + dj, i + di
            ok = self.inside(ti, tj)
            np.maximum.at(best, (tj[ok], ti[ok]), position[ok])
        target = (best >= 0) & may
        self.elevation[target] = elevation[order[best[target]]]
        self.source[target] = EXTRAPOLATED
