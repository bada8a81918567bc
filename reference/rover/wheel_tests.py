"""The mended obstacle tests, with whole wheels: rule `tests` of docs/theory/rover.md."""

import numpy as np

from elevation_map import MEASURED
from obstacle_map import CLEAR, Verdict

WHEELS = [("front", 0.0, 1), ("front", 0.0, -1), ("rear", -1.0, 1), ("rear", -1.0, -1)]  # axle, share of L, side


class WheelTests:
    """Wheels are upright discs over their width; the belly is a rectangle between them."""

    def __init__(self, elevation_map, setup, shadows, turning_circles):
        self.map, self.vehicle, self.limits = elevation_map, setup["vehicle"], setup["tests"]
        v = self.vehicle
        self.ground = np.where(elevation_map.source == MEASURED, elevation_map.elevation, np.nan)
        self.measured = elevation_map.source == MEASURED
        n = elevation_map.points
        jj, ii = np.mgrid[0:n, 0:n]
        gx, gy = elevation_map.place(ii, jj)
        reach = np.hypot(v["wheelbase"] / 2 + v["wheel_radius"], (v["track"] + v["wheel_width"]) / 2)
        # Ground that the vehicle has stood on, or could turn on: it counts as the plane of its wheels.
        for x, y, z, slopes in turning_circles:
            inside = ~self.measured & (np.hypot(gx - x, gy - y) <= reach)
            self.ground = np.where(inside, z + slopes[0] * (gx - x) + slopes[1] * (gy - y), self.ground)
        self.stood = ~self.measured & np.isfinite(self.ground)
        self.bridged = shadows.bridged if shadows is not None else np.zeros((n, n), bool)
        self.ceiling = shadows.ceiling if shadows is not None else np.full((n, n), np.inf)

    def window(self, cx, cy, reach):
        """Index ranges of the map around a place, and whether they are cut off by the map's border."""
        i, j = self.map.grid(cx, cy)
        k = int(np.ceil(reach / self.map.spacing)) + 2
        n = self.map.points
        return slice(max(0, j - k), min(n, j + k + 1)), slice(max(0, i - k), min(n, i + k + 1))

    def contact(self, cx, cy, ux, uy, known):
        """Where an upright wheel at (cx, cy) rests: height of its lowest point, and of the contact with its place.

        `known` are the elevations that count. None if there are none.
        """
        v = self.vehicle
        radius, half = v["wheel_radius"], v["wheel_width"] / 2
        js, is_ = self.window(cx, cy, np.hypot(radius, half))
        z = known[js, is_]
        jj, ii = np.mgrid[js, is_]
        gx, gy = self.map.place(ii, jj)
        a = (gx - cx) * ux + (gy - cy) * uy
        b = (gy - cy) * ux - (gx - cx) * uy
        best = (-np.inf, np.nan, np.nan)

        def offer(height, along, across):
            """The wheel's centre stands at z + sqrt(R^2 - a^2) over a contact; its lowest point R below that."""
            nonlocal best
            ok = np.isfinite(height) & (np.abs(along) <= radius)
            if not ok.any():
                return
            low = np.where(ok, height + np.sqrt(np.maximum(0, radius ** 2 - along ** 2)) - radius, -np.inf)
            k = np.argmax(low)
            if low.flat[k] > best[0]:
                best = (float(low.flat[k]), float(height.flat[k]), float(along.flat[k]))

        on = np.abs(b) <= half
        offer(np.where(on, z, np.nan), a, b)
        for di, dj in ((1, 0), (0, 1), (1, 1), (1, -1)):
            h, w = z.shape
            j0, j1 = max(0, -dj), h - max(0, dj)
            one = (slice(j0, j1), slice(0, w - di))
            two = (slice(j0 + dj, j1 + dj), slice(di, w))
            za, zb, aa, ab, ba, bb = z[one], z[two], a[one], a[two], b[one], b[two]
            # The part of the segment within the wheel's width and length, as shares from the first end.
            low, high = np.zeros(za.shape), np.ones(za.shape)
            for p, q, limit in ((ba, bb, half), (aa, ab, radius)):
                with np.errstate(divide="ignore", invalid="ignore"):
                    t1, t2 = (-limit - p) / (q - p), (limit - p) / (q - p)
                flat = q == p
                low = np.where(flat, np.where(np.abs(p) <= limit, low, 2.0), np.maximum(low, np.minimum(t1, t2)))
                high = np.where(flat, high, np.minimum(high, np.maximum(t1, t2)))
            ok = np.isfinite(za) & np.isfinite(zb) & (low <= high)
            if not ok.any():
                continue
            with np.errstate(divide="ignore", invalid="ignore"):
                m = (zb - za) / (ab - aa)
                t0 = (radius * m / np.sqrt(1 + m * m) - aa) / (ab - aa)
            for t in (low, high, np.clip(np.where(np.isfinite(t0), t0, low), low, high)):
                t = np.where(ok, t, 0)
                offer(np.where(ok, za + t * (zb - za), np.nan), aa + t * (ab - aa), ba + t * (bb - ba))
        return best if np.isfinite(best[0]) else None

    def under(self, cx, cy, ux, uy, ahead, aside):
        """Grid points within a rectangle: indices j, i of those on the map, and whether some lie beyond it."""
        js, is_ = self.window(cx, cy, np.hypot(ahead, aside))
        jj, ii = np.mgrid[js, is_]
        gx, gy = self.map.place(ii, jj)
        a = (gx - cx) * ux + (gy - cy) * uy
        b = (gy - cy) * ux - (gx - cx) * uy
        on = (np.abs(a) <= ahead) & (np.abs(b) <= aside)
        return jj[on], ii[on]

    def __call__(self, qx, qy, ux, uy):
        v, slopes = self.vehicle, self.limits["slopes"]
        length, half_track = v["wheelbase"], v["track"] / 2
        places, contacts, cells = [], [], []
        for _, share, side in WHEELS:
            cx = qx + share * length * ux - side * half_track * uy
            cy = qy + share * length * uy + side * half_track * ux
            places.append((cx, cy))
            contacts.append(self.contact(cx, cy, ux, uy, self.ground))
            cells.append(self.under(cx, cy, ux, uy, v["wheel_radius"], v["wheel_width"] / 2))
        whole = [c is not None and bool(np.isfinite(self.ground[jj, ii]).all())
                 for c, (jj, ii) in zip(contacts, cells)]

        def fails(name, high, low, distance):
            """Obstacle only if the ground under the lower support is all known."""
            if any(contacts[k] is None for k in high + low):
                return False
            top = np.mean([contacts[k][1] for k in high])
            bottom = np.mean([contacts[k][1] for k in low])
            if bottom > top:
                top, bottom, low = bottom, top, high
            apart = abs(distance)
            return top - bottom > slopes[name] * apart and all(whole[k] for k in low)

        if fails("front", [0], [1], 2 * half_track):
            return Verdict("obstacle", "front")
        if fails("rear", [2], [3], 2 * half_track):
            return Verdict("obstacle", "rear")
        along = length
        if all(c is not None for c in contacts):
            along = length + np.mean([contacts[0][2], contacts[1][2]]) - np.mean([contacts[2][2], contacts[3][2]])
        if fails("length", [0, 1], [2, 3], along):
            return Verdict("obstacle", "length")
        cx, cy = qx - length / 2 * ux, qy - length / 2 * uy
        bj, bi = self.under(cx, cy, ux, uy, length / 2, half_track - v["wheel_width"] / 2)
        if all(c is not None for c in contacts):
            low = np.array([c[0] for c in contacts])
            # The plane of least squares through the four lowest points.
            mean, rise, bank = low.mean(), (low[:2].mean() - low[2:].mean()) / length, \
                (low[[0, 2]].mean() - low[[1, 3]].mean()) / (2 * half_track)
            gx, gy = self.map.place(bi, bj)
            a, b = (gx - cx) * ux + (gy - cy) * uy, (gy - cy) * ux - (gx - cx) * uy
            floor = mean + rise * a + bank * b + v["clearance"]
            z = self.ground[bj, bi]
            if all(whole) and (z >= floor).any():
                return Verdict("obstacle", "belly")
        for k, (axle, _, _) in enumerate(WHEELS):
            jj, ii = cells[k]
            missing = ~np.isfinite(self.ground[jj, ii]) & ~self.bridged[jj, ii]
            if missing.any():
                m = int(np.argmax(missing))
                place = self.map.place(ii[m], jj[m])
                return Verdict("unknown", "not_measured", f"{axle}_wheel", (float(place[0]), float(place[1])))
        missing = ~np.isfinite(self.ground[bj, bi]) & ~(self.ceiling[bj, bi] < floor)
        if missing.any():
            m = int(np.argmax(missing))
            place = self.map.place(bi[m], bj[m])
            reason = "may_hide" if np.isfinite(self.ceiling[bj[m], bi[m]]) else "not_measured"
            return Verdict("unknown", reason, "belly", (float(place[0]), float(place[1])))
        return Verdict(CLEAR)
