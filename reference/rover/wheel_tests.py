"""The mended obstacle tests, with whole wheels: rule `tests` of docs/theory/rover.md."""

from dataclasses import dataclass

import numpy as np

from elevation_map import MEASURED, PROXIMITY, UNKNOWN
from gaps import bend_between, highest_points, shifted
from obstacle_map import CLEAR, Verdict

# Axle, share of the wheelbase ahead of Q, side.
WHEELS = [("front", 0.0, 1), ("front", 0.0, -1), ("rear", -1.0, 1), ("rear", -1.0, -1)]
BORDER = 1e-11  # m; a place this far beyond a border lies on it
RISE = 1e-11  # m; a rise this much above a limit is at it
NEAR = 1e-9  # a decision nearer than this is one of rounding


@dataclass
class Support:
    """Where a wheel rests: height of its hub, the ground point, the mean variance of the points below it, and the mean sum
    of corrections by which stripes measured them (None: they did not)."""

    hub: float
    point: np.ndarray
    variance: float
    corrected: float = None


@dataclass
class Wheel:
    """By measured ground alone, by it and the ground that the vehicle stood on, by measured ground without the highest points
    of cells and bent down, by all that may be there; what is missing:
    None, or index j, i; and the first place where it stood and did not measure."""

    measured: Support
    supported: Support
    lowest: Support
    highest: Support
    missing: tuple
    stood: tuple


class WheelTests:
    """Wheels are upright discs over their width; the belly is a rectangle between them."""

    def __init__(self, elevation_map, setup, shadows, stands, way):
        m = self.map = elevation_map
        self.vehicle, self.limits = setup["vehicle"], setup["tests"]
        self.measured = (m.source == MEASURED) | (m.source == PROXIMITY)
        jj, ii = np.mgrid[0:m.points, 0:m.points]
        gx, gy = m.place(ii, jj)
        self.grid_x, self.grid_y = gx, gy
        # A measurement stands at its own place, all else at its grid point.
        own = m.source == MEASURED
        self.x, self.y = np.where(own, m.x, gx), np.where(own, m.y, gy)
        self.z = np.where(self.measured, m.elevation, np.nan)
        # The proximity sensor's cells count as without error.
        self.variance = np.where(own, m.variance_now(), 0.0)
        self.corrected = np.where(own, m.corrected, np.nan)
        self.high = highest_points(m, self.measured)
        tall = own & np.isfinite(m.top_z)
        self.top = [np.where(tall, values, np.nan) for values in (m.top_x, m.top_y, m.top_z, m.top_variance_now())]
        if shadows is None:
            # Without the rule a guess counts as ground.
            guess = np.where(m.source != UNKNOWN, m.elevation, np.nan)
            under_wheel, under_belly = guess, guess
        else:
            under_wheel = shadows.bridge
            under_belly = np.where(np.isnan(shadows.ceiling), shadows.bridge, shadows.ceiling)
        stood = self.stood(stands, gx, gy)
        known = ~np.isnan(stood)
        self.is_stood = known & ~self.measured
        self.wheel_top = np.where(self.measured, np.nan, np.where(known, stood, under_wheel))
        self.belly_top = np.where(self.measured, np.nan, np.where(known, stood, under_belly))

    def stood(self, stands, gx, gy):
        """The plane of the wheels over each grid point in the circle of a turn on the spot, the last one's."""
        v = self.vehicle
        reach = np.hypot(v["wheelbase"] / 2 + v["wheel_radius"], (v["track"] + v["wheel_width"]) / 2)
        out = np.full(gx.shape, np.nan)
        for x, y, z, slopes in stands:
            inside = np.hypot(gx - x, gy - y) <= reach
            out = np.where(inside, z + slopes[0] * (gx - x) + slopes[1] * (gy - y), out)
        return out

    def window(self, cx, cy, ahead, aside):
        i, j = self.map.grid(cx, cy)
        k = int(np.ceil(np.hypot(ahead, aside) / self.map.spacing)) + 2
        n = self.map.points
        return slice(max(0, j - k), min(n, j + k + 1)), slice(max(0, i - k), min(n, i + k + 1))

    def rest(self, cx, cy, ux, uy, axle):
        """A wheel whose hub is over (cx, cy) and rolls along u."""
        radius, half = self.vehicle["wheel_radius"], self.vehicle["wheel_width"] / 2
        w = self.window(cx, cy, radius, half)

        def axes(x, y):
            return (x - cx) * ux + (y - cy) * uy, (y - cy) * ux - (x - cx) * uy

        def inside(a, b):
            return (np.abs(a) <= radius + BORDER) & (np.abs(b) <= half + BORDER)

        x, y, z, variance = self.x[w], self.y[w], self.z[w], self.variance[w]
        a, b = axes(x, y)
        points = [(np.where(inside(a, b), z, np.nan), x, y, a, variance)]
        with np.errstate(invalid="ignore"):
            below = self.corrected[w][inside(a, b) & np.isfinite(z) & np.isfinite(self.corrected[w])]
        corrected = float(below.mean()) if len(below) else None
        tx, ty, tz, tv = (values[w] for values in self.top)
        ta, tb = axes(tx, ty)
        tops = []
        with np.errstate(invalid="ignore"):
            tops.append((np.where(inside(ta, tb), tz, np.nan), tx, ty, ta, tv))

        def on_lines(one, two, variance):
            """Where the straight lines between two points (x, y, z each) enter and leave the rectangle, and touch the wheel."""
            ends = [axes(one[0], one[1]), axes(two[0], two[1])]
            low, high = np.zeros(z.shape), np.ones(z.shape)
            for axis, limit in ((0, radius), (1, half)):
                p, q = ends[0][axis], ends[1][axis]
                with np.errstate(divide="ignore", invalid="ignore"):
                    t1, t2 = (-limit - p) / (q - p), (limit - p) / (q - p)
                level = q == p
                low = np.where(level, low, np.maximum(low, np.minimum(t1, t2)))
                high = np.where(level, np.where(np.abs(p) <= limit, high, -1.0), np.minimum(high, np.maximum(t1, t2)))
            ok = np.isfinite(one[2]) & np.isfinite(two[2]) & (low <= high)
            along = ends[1][0] - ends[0][0]
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = (two[2] - one[2]) / along
                touch = (radius * slope / np.sqrt(1 + slope * slope) - ends[0][0]) / along
            touches = ok & (touch >= low) & (touch <= high)
            for share, may in ((low, ok), (high, ok), (touch, touches)):
                t = np.where(may, share, 0.0)
                px, py, pz = (p + t * (q - p) for p, q in zip(one, two))
                yield np.where(may, pz, np.nan), px, py, axes(px, py)[0], variance

        # Between neighbouring measured points: the straight lines, and where the ground may bend up or down.
        straight, bent_up, bent_down = [], [], []
        for di, dj in ((1, 0), (0, 1), (1, 1), (1, -1)):
            def line_of(arrays):
                """Four cells in a row on this line of the grid: the second is the window's own."""
                return [[shifted(values, step * di, step * dj, np.nan)[w] for values in arrays] for step in (-1, 0, 1, 2)]

            quartet = line_of((self.x, self.y, self.z))
            near, far = quartet[1:3]
            larger = np.maximum(variance, shifted(self.variance, di, dj, np.nan)[w])
            straight += on_lines(near, far, larger)
            # Where it does not bend, the end takes the bend's place.
            bend = bend_between(*quartet, -1)
            middle = [np.where(np.isfinite(bend[2]), at_bend, at_end) for at_bend, at_end in zip(bend, far)]
            bent_down += [*on_lines(near, middle, larger), *on_lines(middle, far, larger)]
            if di * dj == 0:
                quartet = line_of(self.high)
                bend = bend_between(*quartet, 1)
                bent_up += [*on_lines(quartet[1], bend, larger), *on_lines(quartet[2], bend, larger)]
        offers, means = points + tops + straight, points + bent_down
        measured = self.highest_of(offers)
        gx, gy, top = self.grid_x[w], self.grid_y[w], self.wheel_top[w]
        a, b = axes(gx, gy)
        under = inside(a, b)
        highest = self.highest_of(offers + bent_up + [(np.where(under, top, np.nan), gx, gy, a, np.zeros(a.shape))])
        lacks = under & np.isnan(top) & ~self.measured[w]
        missing = None
        if lacks.any():
            j, i = np.argwhere(lacks)[0]
            missing = (j + w[0].start, i + w[1].start)
        if not self.is_on_map(cx, cy, ux, uy, radius, half):
            missing = missing or "beyond"
        on = np.where(under & self.is_stood[w], top, np.nan)
        on_stood = [(on, gx, gy, a, np.zeros(a.shape))]
        supported, lowest = self.highest_of(offers + on_stood), self.highest_of(means + on_stood)
        for support in (measured, supported, lowest, highest):
            if support is not None:
                support.corrected = corrected
        stood = np.argwhere(~np.isnan(on))
        stood = (stood[0][0] + w[0].start, stood[0][1] + w[1].start) if len(stood) else None
        return Wheel(measured, supported, lowest, highest, missing, stood)

    def is_on_map(self, cx, cy, ux, uy, ahead, aside):
        """Whether all of a rectangle lies on the map."""
        corners = [(cx + s * ahead * ux - t * aside * uy, cy + s * ahead * uy + t * aside * ux)
                   for s in (1, -1) for t in (1, -1)]
        return all(self.map.inside(*self.map.grid(x, y)) for x, y in corners)

    def highest_of(self, offers):
        """The ground point over which the hub is highest: z + sqrt(R^2 - a^2)."""
        radius, best = self.vehicle["wheel_radius"], None
        for z, x, y, a, variance in offers:
            if not np.isfinite(z).any():
                continue
            hub = np.where(np.isfinite(z), z + np.sqrt(np.maximum(0, radius ** 2 - a ** 2)), -np.inf)
            k = int(np.argmax(hub))
            if best is None or hub.flat[k] > best.hub:
                best = Support(float(hub.flat[k]), np.array([x.flat[k], y.flat[k], z.flat[k]]),
                               float(variance.flat[k]))
        # Rounding may decide which point carries the wheel, but not how well the ground below it is known.
        below = np.isfinite(offers[0][0])
        if below.any():
            best.variance = float(offers[0][4][below].mean())
        return best

    def __call__(self, qx, qy, ux, uy):
        v, slopes = self.vehicle, self.limits["slopes"]
        length, half_track = v["wheelbase"], v["track"] / 2
        u = np.array([ux, uy])
        hubs = [(qx + share * length * ux - side * half_track * uy, qy + share * length * uy + side * half_track * ux)
                for _, share, side in WHEELS]
        wheels = [self.rest(cx, cy, ux, uy, axle) for (cx, cy), (axle, _, _) in zip(hubs, WHEELS)]
        tie = False

        def compare(by, name, one, two, errors):
            """Whether the rise between the hubs, with so many of its standard errors, exceeds the limit; and the lower side."""
            supports = [[getattr(wheels[k], by) for k in side] for side in (one, two)]
            return compared(supports, name, one, two, errors)

        def compared(supports, name, one, two, errors, is_signed=False, is_tilted=False):
            nonlocal tie
            if any(support is None for side in supports for support in side):
                return None
            apart = float(np.mean([s.hub for s in supports[0]]) - np.mean([s.hub for s in supports[1]]))
            variance = sum(sum(s.variance for s in side) / len(side) ** 2 for side in supports)
            run = length if name == "length" else v["track"]
            rise = apart if is_signed else abs(apart)
            if is_tilted:
                rise += max(0.0, by_tilt(supports))
            over = rise + errors * float(np.sqrt(variance)) - slopes[name] * run
            tie |= abs(over) <= NEAR
            return over > RISE, two if apart > 0 else one

        def by_tilt(supports):
            """How much higher the first side would stand above the second by the vehicle's tilt alone."""
            sums = [[s.corrected for s in side] for side in supports]
            if any(one is None for side in sums for one in side):
                return 0.0
            return float(np.mean(sums[1]) - np.mean(sums[0]))

        pairs = [("front", [0], [1]), ("rear", [2], [3]), ("length", [0, 1], [2, 3])]

        def by_measured(name, one, two, errors):
            """Only if all ground below the lower side is known."""
            found = compare("measured", name, one, two, errors)
            return bool(found and found[0] and all(wheels[k].missing is None for k in found[1]))

        def by_certain(name, one, two, errors):
            """The same with the lower side also on the ground that the vehicle stood on."""
            found = compare("measured", name, one, two, errors)
            if not found or any(wheels[k].missing is not None for k in found[1]):
                return False
            low, high = (one, two) if found[1] == one else (two, one)
            supports = [[wheels[k].measured for k in high], [wheels[k].supported for k in low]]
            return compared(supports, name, high, low, errors, is_signed=True)[0]

        def exceeds_at_most(name, one, two, errors, is_tilted=False):
            """Either side with all that may stand under it, the other without: the larger rise counts, by the ground or by tilt."""
            rises = []
            for high, low in ((one, two), (two, one)):
                supports = [[wheels[k].highest for k in high], [wheels[k].lowest for k in low]]
                if all(support is not None for side in supports for support in side):
                    rise = sum(s.hub for s in supports[0]) / len(high) - sum(s.hub for s in supports[1]) / len(low)
                    rises.append((rise + max(0.0, by_tilt(supports)), supports, high, low))
            if not rises:
                found = compare("highest", name, one, two, errors)
                return bool(found and found[0])
            _, supports, high, low = max(rises, key=lambda rise: rise[0])
            return compared(supports, name, high, low, errors, is_signed=True, is_tilted=is_tilted)[0]

        margin = -self.limits["obstacle_margin"]
        for name, one, two in pairs:
            if by_certain(name, one, two, margin):
                return Verdict("obstacle", name, near_tie=tie)
        for wheel, (axle, _, _) in zip(wheels, WHEELS):
            if wheel.missing == "beyond":
                return Verdict("unknown", "beyond_map", f"{axle}_wheel", near_tie=tie)
            if wheel.missing is not None:
                return self.lacking("not_measured", f"{axle}_wheel", *wheel.missing, tie)
        for name, one, two in pairs:
            if by_measured(name, one, two, margin):
                # The lower side may be higher than it looks.
                for k in compare("measured", name, one, two, margin)[1]:
                    if wheels[k].stood is not None:
                        return self.lacking("not_measured", f"{WHEELS[k][0]}_wheel", *wheels[k].stood, tie)
        for name, one, two in pairs:
            # What may stand in gaps may be too high, or the errors may be too large.
            if exceeds_at_most(name, one, two, self.limits["clear_margin"], is_tilted=True):
                part = "rear_wheel" if name == "rear" else "front_wheel"
                hides = exceeds_at_most(name, one, two, 0) and not by_measured(name, one, two, 0)
                return Verdict("unknown", "may_hide" if hides else "near_limit", part, (float(qx), float(qy)), tie)
        return self.belly(qx, qy, ux, uy, wheels, tie)

    def lacking(self, reason, part, j, i, tie):
        return Verdict("unknown", reason, part, (float(self.grid_x[j, i]), float(self.grid_y[j, i])), tie)

    def belly(self, qx, qy, ux, uy, wheels, tie):
        """The ground against the underside, which is parallel to the plane through the hubs: as high and as low as these may be."""
        v = self.vehicle
        length, track = v["wheelbase"], v["track"]
        cx, cy = qx - length / 2 * ux, qy - length / 2 * uy
        ahead, aside = length / 2, max(0.0, (track - v["wheel_width"]) / 2)
        w = self.window(cx, cy, ahead, aside)

        def underside(by):
            """Its height at a place and the variance of that, by these hubs; of a wheel that lacks one, by the highest."""
            hubs = [getattr(wheel, by) or wheel.highest for wheel in wheels]
            h = [hub.hub for hub in hubs]
            along = (h[0] + h[1] - h[2] - h[3]) / (2 * length)
            across = (h[0] - h[1] + h[2] - h[3]) / (2 * track)
            below = (v["wheel_radius"] - v["clearance"]) * np.sqrt(1 + along ** 2 + across ** 2)

            def at(a, b):
                shares = [0.25 + front * a / (2 * length) + left * b / (2 * track)
                          for front, left in ((1, 1), (1, -1), (-1, 1), (-1, -1))]
                variance = sum(share ** 2 * hub.variance for share, hub in zip(shares, hubs))
                return np.mean(h) - below + along * a + across * b, variance
            return at

        by_highest, by_measured, by_lowest = (underside(by) for by in ("highest", "measured", "lowest"))

        def axes(x, y):
            """Place ahead and to the left of the belly's middle, and whether it is under the belly."""
            a, b = (x - cx) * ux + (y - cy) * uy, (y - cy) * ux - (x - cx) * uy
            with np.errstate(invalid="ignore"):
                return a, b, (np.abs(a) <= ahead + BORDER) & (np.abs(b) <= aside + BORDER)

        def over(plane, x, y, z, variance, errors):
            """Height above an underside with so many standard errors; NaN outside of it."""
            a, b, within = axes(x, y)
            height, own = plane(a, b)
            return np.where(within, z + errors * np.sqrt(variance + own) - height, np.nan)

        measured = [[values[w] for values in (self.x, self.y, self.z, self.variance)], [values[w] for values in self.top]]
        obstacle, clear = -self.limits["obstacle_margin"], self.limits["clear_margin"]
        near, hidden = np.zeros(measured[0][0].shape, bool), np.zeros(measured[0][0].shape, bool)
        with np.errstate(invalid="ignore"):
            for points in measured:
                hit = over(by_highest, *points, obstacle)
                tie |= bool((np.abs(hit) <= NEAR).any())
                if (hit >= 0).any():
                    return Verdict("obstacle", "belly", near_tie=tie)
            for points in measured:
                may = over(by_lowest, *points, clear)
                tie |= bool((np.abs(may) <= NEAR).any())
                # The cell's own point is asked first, then its highest.
                new = (may >= 0) & ~near
                hides = (over(by_lowest, *points, 0) >= 0) & ~(over(by_measured, *points, 0) >= 0)
                hidden, near = hidden | (new & hides), near | new
            a, b, within = axes(self.grid_x[w], self.grid_y[w])
            top = self.belly_top[w]
            may = np.where(within, top - by_lowest(a, b)[0], np.nan)
            tie |= bool((np.abs(may) <= NEAR).any())
            lacks = within & np.isnan(top) & ~self.measured[w]
            wrong = np.argwhere(near | (may >= 0) | lacks)
        if len(wrong):
            j, i = wrong[0]
            if near[j, i]:
                own = measured[0] if over(by_lowest, *measured[0], clear)[j, i] >= 0 else measured[1]
                place = (float(own[0][j, i]), float(own[1][j, i]))
                return Verdict("unknown", "may_hide" if hidden[j, i] else "near_limit", "belly", place, tie)
            reason = "not_measured" if lacks[j, i] else "may_hide"
            return self.lacking(reason, "belly", j + w[0].start, i + w[1].start, tie)
        return Verdict(CLEAR, near_tie=tie)
