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
MIN_AGE = 0.3 - 1e-9  # m of way; younger cells share the present error of the elevation. Frames of 6 cm meet it exactly
MIN_POINTS = 20  # fewest points that correct by the ground that stripes meet again
MAX_SLOPE = 1.0  # of that ground
MAX_ROUGHNESS = 0.35  # of cells off their plane, root mean square, in spacings: such cells are one surface
STEP_OF_A_SURFACE = MAX_ROUGHNESS * 9 / np.sqrt(8)  # so far may one of nine cells stand out of it, in spacings
MIN_SHARED_ERROR = 0.005  # m, of all points of a stripe
MIN_VARIANCE = 1e-8  # square metres


class Elevation:
    """z of the vehicle's origin, with its variance. `predict`, `correct_by_ground`, `correct_by_stripes` in turn."""

    def __init__(self, setup):
        self.rule = setup["rules"]["elevation"]
        self.noise = setup["known_noise"]
        self.z = setup["start_elevation"]
        self.variance = 0.0
        self.corrected = 0.0  # sum of all corrections of what the tilt predicted
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

    def correct_by_ground(self, elevation_map, x, y, proximity, way):
        """A plane through the measured points around the origin, at their own places."""
        if not np.isfinite(proximity):
            return False
        known = elevation_map.source == MEASURED
        dx, dy = elevation_map.x[known] - x, elevation_map.y[known] - y
        near = np.hypot(dx, dy) <= GROUND_RADIUS
        dx, dy = dx[near], dy[near]
        distance = np.hypot(dx, dy)
        variance = elevation_map.variance_now()[known][near]
        noise = self.noise["proximity"] ** 2
        slopes = self.before[1]
        residual = elevation_map.elevation[known][near] - (self.z - proximity) - slopes[0] * dx - slopes[1] * dy
        limit = OTHER_LEVEL_DEVIATIONS * np.sqrt(self.variance + noise + variance) + OTHER_LEVEL_SLOPE * distance
        same = np.abs(residual) <= limit
        share = np.maximum(1 - (distance / GROUND_RADIUS) ** 2, 1e-3)
        fit = huber_plane(dx[same], dy[same], residual[same], (variance / share)[same])
        if fit is None:
            return False
        height, height_variance = fit
        self.weigh(self.z + height, height_variance + noise)
        return True

    def correct_by_stripes(self, elevation_map, points, row_error, way):
        """Median height of new points over the planes through the old cells around each. `points` were placed by z."""
        heights, smooth = [], []
        n = elevation_map.points
        old = (elevation_map.source == MEASURED) & (way - elevation_map.way >= MIN_AGE)
        for x, y, z in points:
            i, j = elevation_map.grid(x, y)
            if not (0 <= i < n and 0 <= j < n and old[j, i]):
                continue
            block = (slice(max(0, j - 1), j + 2), slice(max(0, i - 1), i + 2))
            at = old[block]
            if at.sum() < 4:
                continue
            dx, dy, dz = elevation_map.x[block][at] - x, elevation_map.y[block][at] - y, elevation_map.elevation[block][at]
            fit = plane(dx, dy, dz, np.ones(at.sum()), 1e-2)
            if fit is not None and fit[1] ** 2 + fit[2] ** 2 <= MAX_SLOPE ** 2:
                off = dz - fit[0] - fit[1] * dx - fit[2] * dy
                heights.append(z - fit[0])
                smooth.append(np.sqrt((off ** 2).mean()) <= MAX_ROUGHNESS * elevation_map.spacing)
        shared = max(row_error, MIN_SHARED_ERROR)
        found = median(heights, shared)
        if found is None:
            return
        expected = OTHER_LEVEL_DEVIATIONS * np.sqrt(self.variance + found[1]) + STEP_OF_A_SURFACE * elevation_map.spacing
        if abs(found[0]) > expected:
            # Nobody expected that: only ground that is one surface may tell it.
            found = median([height for height, is_smooth in zip(heights, smooth) if is_smooth], shared)
        if found is not None:
            self.weigh(self.z - found[0], found[1])

    def weigh(self, z, variance):
        """Believes both what is believed and z, by their inverse variances."""
        own, other = max(self.variance, MIN_VARIANCE), max(variance, MIN_VARIANCE)
        share = own / (own + other)
        self.corrected += share * (z - self.z)
        self.z += share * (z - self.z)
        self.variance = share * other


def median(heights, shared):
    """The median with its variance, None of too few. All heights have the standard error `shared` in common."""
    if len(heights) < MIN_POINTS:
        return None
    heights = np.sort(heights)
    middle = heights[len(heights) // 2]
    deviation = 1.4826 * np.sort(np.abs(heights - middle))[len(heights) // 2]
    return middle, np.pi / 2 * deviation ** 2 / len(heights) + shared ** 2


def plane(dx, dy, z, weight, least_spread):
    """Weighted least squares of z = a + b dx + c dy: a, b, c and the variance of a; None for points on a line."""
    if len(dx) < 3:
        return None
    total = weight.sum()
    mx, my, mz = (weight * dx).sum() / total, (weight * dy).sum() / total, (weight * z).sum() / total
    u, v, w = dx - mx, dy - my, z - mz
    xx, xy, yy = (weight * u * u).sum(), (weight * u * v).sum(), (weight * v * v).sum()
    xz, yz = (weight * u * w).sum(), (weight * v * w).sum()
    det, trace = xx * yy - xy * xy, xx + yy
    if not det > least_spread * trace * trace:
        return None
    b, c = (yy * xz - xy * yz) / det, (xx * yz - xy * xz) / det
    a = mz - b * mx - c * my
    # The error of the mean, and that of the slope over the distance to the mean.
    variance = 1 / total + (yy * mx * mx - 2 * xy * mx * my + xx * my * my) / det
    if len(dx) > 3:
        # Ground that is no plane makes larger residuals than its errors do.
        variance *= max(1, (weight * (z - a - b * dx - c * dy) ** 2).sum() / (len(dx) - 3))
    return a, b, c, variance


def huber_plane(dx, dy, z, variance, rounds=3):
    """Height of the plane at (0, 0) with Huber's weights, and its variance; None if there is no plane."""
    huber = np.ones(len(z))
    fit = None
    for _ in range(rounds):
        fit = plane(dx, dy, z, huber / variance, 1e-3)
        if fit is None:
            return None
        off = np.abs(z - (fit[0] + fit[1] * dx + fit[2] * dy)) / np.sqrt(variance)
        huber = np.where(off > HUBER, HUBER / np.maximum(off, 1e-300), 1)
    return fit[0], fit[3]
