"""The vehicle's own elevation, from the old map: rule `elevation` of docs/theory/rover.md, printed and mended."""

import numpy as np

from elevation_map import EXTRAPOLATED, MEASURED, PROXIMITY, UNKNOWN
from geometry import slopes_of_plane

# Numbers of the mended rule, each a CHOICE of docs/theory/rover.md.
TILT_DEVIATION = 0.02  # m; the variance grows by its square for each metre driven
GROUND_RADIUS = 0.3  # m around the origin, for the plane under it
HUBER = 1.345  # standard deviations
OTHER_LEVEL_DEVIATIONS = 3.0
OTHER_LEVEL_SLOPE = 0.35
MIN_AGE = 0.3  # m of way; younger cells share the present error of the elevation


class Elevation:
    """z of the vehicle's origin, with its variance. `predict`, `correct_by_ground`, `correct_by_stripes` in turn."""

    def __init__(self, setup):
        self.rule = setup["rules"]["elevation"]
        self.noise = setup["known_noise"]
        self.z = setup["start_elevation"]
        self.variance = 0.0
        self.before = None  # x, y and the slopes of the wheels' plane, one frame ago

    def start(self, x, y, rotation):
        self.before = (np.array([x, y]), slopes_of_plane(rotation))

    def printed(self, elevation_map, x, y, rotation, proximity):
        """Elevation of the cell under the origin plus the sensor's distance; unknown: along the wheels' plane."""
        ground, source = elevation_map.read(x, y)
        here, slopes = np.array([x, y]), slopes_of_plane(rotation)
        read = bool(source != UNKNOWN) and np.isfinite(proximity)
        if read:
            self.z = float(ground) + proximity
        else:
            self.z += float((here - self.before[0]) @ slopes)
        self.before = (here, slopes)
        return read

    def predict(self, x, y, rotation):
        """The plane of the wheels rises by the mean of its slopes before and now, times the displacement."""
        here, slopes = np.array([x, y]), slopes_of_plane(rotation)
        way = here - self.before[0]
        length = float(np.hypot(*way))
        self.z += float(way @ (self.before[1] + slopes)) / 2
        self.variance += TILT_DEVIATION ** 2 * length + (self.noise["attitude"] * length) ** 2
        self.before = (here, slopes)

    def correct_by_ground(self, elevation_map, x, y, proximity):
        """A plane through the measured points around the origin, at their own places."""
        if not np.isfinite(proximity):
            return False
        known = elevation_map.source == MEASURED
        dx, dy = elevation_map.x[known] - x, elevation_map.y[known] - y
        near = np.hypot(dx, dy) <= GROUND_RADIUS
        dx, dy = dx[near], dy[near]
        z, variance = elevation_map.elevation[known][near], elevation_map.variance[known][near]
        predicted = self.z - proximity
        limit = OTHER_LEVEL_DEVIATIONS * np.sqrt(self.variance + variance) + OTHER_LEVEL_SLOPE * np.hypot(dx, dy)
        same = np.abs(z - predicted) <= limit
        fit = huber_plane(dx[same], dy[same], z[same], variance[same])
        if fit is None:
            return False
        ground, ground_variance = fit
        measured = ground + proximity
        measured_variance = ground_variance + self.noise["proximity"] ** 2
        share = self.variance / (self.variance + measured_variance)
        self.z += share * (measured - self.z)
        self.variance *= 1 - share
        return True

    def correct_by_stripes(self, elevation_map, points, variance, way):
        """Median height of new points over the planes through the nine old cells around each."""
        heights = []
        for x, y, z in points:
            i, j = elevation_map.grid(x, y)
            if not (1 <= i < elevation_map.points - 1 and 1 <= j < elevation_map.points - 1):
                continue
            block = (slice(j - 1, j + 2), slice(i - 1, i + 2))
            old = (elevation_map.source[block] == MEASURED) & (way - elevation_map.way[block] >= MIN_AGE)
            if old.sum() < 3:
                continue
            dx, dy = elevation_map.x[block][old] - x, elevation_map.y[block][old] - y
            fit = plane(dx, dy, elevation_map.elevation[block][old], np.ones(old.sum()))
            if fit is not None:
                heights.append(z - fit[0])
        if not heights:
            return False
        error = float(np.median(heights))
        self.z -= error
        return True


def plane(dx, dy, z, weight):
    """Weighted least squares of z = a + b dx + c dy; None if the points lie on a line. Returns a, b, c, inverse."""
    matrix = np.column_stack([np.ones(len(dx)), dx, dy])
    normal = matrix.T @ (weight[:, None] * matrix)
    if len(dx) < 3 or np.linalg.matrix_rank(matrix) < 3:
        return None
    inverse = np.linalg.inv(normal)
    a, b, c = inverse @ (matrix.T @ (weight * z))
    return a, b, c, inverse


def huber_plane(dx, dy, z, variance, rounds=20):
    """Height of the plane at (0, 0) with Huber's weights, and its variance; None if there is no plane."""
    weight = 1 / variance
    for _ in range(rounds):
        fit = plane(dx, dy, z, weight)
        if fit is None:
            return None
        residual = np.abs(z - (fit[0] + fit[1] * dx + fit[2] * dy)) / np.sqrt(variance)
        weight = np.minimum(1, HUBER / np.maximum(residual, 1e-300)) / variance
    return fit[0], fit[3][0, 0]
