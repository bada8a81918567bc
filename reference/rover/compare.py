"""Compares what the second rover made with the results that a recording holds.

Every quantity has a `Tally`: how much was compared, how much differs, how much differs only because a decision was a
tie within rounding, the largest difference, and the first few places.
"""

import numpy as np

from trouble import Trouble

# Both sides compute in double precision, with sums in another order. Lengths here are below 100 m, one rounding is
# 1e-14 m of them, and no sum has more than some thousands of terms: 1e-9 m is wide for rounding and narrow for a
# mistake, since a pixel is a millimetre on the ground.
METRES = 1e-9
ROWS = 1e-9  # pixels, of a centroid or a crossing; whole pixels are equal anyway
FIRST = 5  # places that are named


class Tally:
    def __init__(self, name, unit=""):
        self.name, self.unit = name, unit
        self.compared = self.differing = self.ties = 0
        self.largest = 0.0
        self.places = []

    def count(self, compared, differing=0, ties=0):
        self.compared, self.differing, self.ties = self.compared + compared, self.differing + differing, \
            self.ties + ties

    def place(self, text):
        if len(self.places) < FIRST:
            self.places.append(text)

    def numbers(self, ours, theirs, tolerance, where, tie=None):
        """Cell by cell; NaN is equal to NaN only. `where(k)` names the place of cell k."""
        ours, theirs = np.asarray(ours, float).reshape(-1), np.asarray(theirs, float).reshape(-1)
        if len(ours) != len(theirs):
            raise Trouble(f"{self.name}: {len(ours)} against {len(theirs)} numbers")
        both_nan = np.isnan(ours) & np.isnan(theirs)
        gap = np.where(both_nan, 0.0, np.abs(ours - theirs))
        bad = ~(gap <= tolerance)
        tied = bad & (np.zeros(len(bad), bool) if tie is None else np.asarray(tie).reshape(-1))
        bad &= ~tied
        self.count(len(ours), int(bad.sum()), int(tied.sum()))
        finite = gap[np.isfinite(gap) & ~tied]
        if len(finite):
            self.largest = max(self.largest, float(finite.max()))
        for k in np.flatnonzero(bad)[:FIRST - len(self.places)]:
            self.place(f"{where(k)}: ours {ours[k]!r}, recorded {theirs[k]!r}")

    def words(self, ours, theirs, where, tie=None):
        for k, (a, b) in enumerate(zip(ours, theirs)):
            differs = a != b
            tied = differs and tie is not None and bool(tie[k])
            self.count(1, int(differs and not tied), int(tied))
            if differs and not tied:
                self.place(f"{where(k)}: ours {a!r}, recorded {b!r}")


class Report:
    def __init__(self):
        self.tallies = {}

    def of(self, name, unit=""):
        return self.tallies.setdefault(name, Tally(name, unit))

    def print(self, empty):
        """The table; `empty` names what had to be compared and was not. Returns whether all agree."""
        print(f"{'quantity':<26}{'compared':>10}{'differing':>11}{'ties':>7}   largest difference")
        for t in self.tallies.values():
            largest = f"{t.largest:.2e} {t.unit}" if t.unit else ""
            print(f"{t.name:<26}{t.compared:>10}{t.differing:>11}{t.ties:>7}   {largest}".rstrip())
        for t in self.tallies.values():
            for place in t.places:
                print(f"{t.name}: {place}")
        for name in empty:
            print(f"{name}: nothing was compared")
        return not empty and all(t.differing == 0 for t in self.tallies.values())


def edge_keys(rows):
    """Frame, step, beam, column and pixel row: what names an edge, whatever the exact place within its pixel."""
    return [tuple(r) for r in np.column_stack([rows[:, :4], np.floor(rows[:, 4])]).astype(int)]


def edge_name(key):
    step = f", step {key[1]}" if key[1] >= 0 else ""
    return f"frame {key[0]}{step}, beam {key[2]}, column {key[3]}, pixel row {key[4]}"


def frame_slices(array, frames):
    """For each frame its rows of an array that is sorted by frame in column 0."""
    if array.ndim != 2 or (len(array) and (np.diff(array[:, 0]) < 0).any()):
        raise Trouble("stripes.npy or points.npy is not a table sorted by frame")
    cut = np.searchsorted(array[:, 0], np.arange(frames + 1))
    return [array[a:b] for a, b in zip(cut, cut[1:])]


class Comparison:
    """Holds the recorded results and takes the second rover's frames one by one."""

    def __init__(self, recording):
        self.recording, self.setup = recording, recording.setup
        self.report, self.frames = Report(), len(recording.poses)
        stripes, points = recording.array("stripes.npy", False), recording.array("points.npy", False)
        for name, array, width in (("stripes.npy", stripes, 5), ("points.npy", points, 11)):
            if array is not None and (array.ndim != 2 or array.shape[1] != width):
                raise Trouble(f"{name}: shape {array.shape}, expected n x {width}")
        self.stripes = None if stripes is None else frame_slices(stripes, self.frames)
        self.points = None if points is None else frame_slices(points, self.frames)
        self.maps = (recording.folder / "maps.csv").exists()
        self.corners = {}
        if self.maps:
            table = recording.table("maps.csv")
            self.corners = {int(f): (w, s) for f, w, s in zip(*map(table.numbers, ("frame", "west_m", "south_m")))}
        self.sectors = by_frame(recording.table("sectors.csv"))
        self.vectors = by_frame(recording.table("vectors.csv"))
        p = recording.poses
        self.believed = np.column_stack([p.numbers("believed_" + n) for n in ("x_m", "y_m", "z_m")])
        self.quaternion = np.column_stack([p.numbers("believed_" + n) for n in ("qx", "qy", "qz", "qw")])
        self.column = {n: p.numbers(n) for n in (
            "elevation_error_m", "moved_i", "moved_j", "inconsistency_points", "inconsistency_mean_m",
            "inconsistency_largest_m", "edges", "points", "columns_left_out")}
        self.read = p.words("elevation_read")

    def frame(self, k, ours, ties):
        """`ties`: a map of cells where a point's nearest grid point was a tie within rounding."""
        at = lambda _: f"frame {k}"
        of, column = self.report.of, self.column
        self.edges_and_points(k, ours)
        of("numbers of edges").numbers([len(ours.edges)], [column["edges"][k]], 0, at)
        of("numbers of points").numbers([len(ours.points)], [column["points"][k]], 0, at)
        of("columns left out").numbers([ours.left_out], [column["columns_left_out"][k]], 0, at)
        of("believed x, y", "m").numbers(ours.position[:2], self.believed[k, :2], METRES, at)
        of("believed elevation", "m").numbers(ours.position[2:], self.believed[k, 2:], METRES, at)
        q = ours.quaternion if ours.quaternion @ self.quaternion[k] > 0 else -ours.quaternion
        of("believed attitude", "").numbers(q, self.quaternion[k], 1e-12, at)
        of("elevation read").words([ours.elevation_read], [self.read[k].lower() in ("true", "1", "yes")], at)
        of("elevation error", "m").numbers([ours.elevation_error], [column["elevation_error_m"][k]], METRES, at)
        of("map moved").numbers(ours.moved, [column["moved_i"][k], column["moved_j"][k]], 0, at)
        of("inconsistency points").numbers([ours.inconsistency[0]], [column["inconsistency_points"][k]], 0, at)
        of("inconsistency", "m").numbers(ours.inconsistency[1:], [column["inconsistency_mean_m"][k],
                                                                column["inconsistency_largest_m"][k]], METRES, at)
        if ours.elevation is not None:
            if self.maps:
                self.map(k, ours, ties)
            self.sector_rows(k, ours)
            self.vector_rows(k, ours)

    def edges_and_points(self, k, ours):
        of = self.report.of
        for name, mine, recorded in (("edges", ours.edges, self.stripes), ("points", ours.points, self.points)):
            if recorded is None:
                continue
            theirs = recorded[k]
            a, b = edge_keys(mine), edge_keys(theirs)
            if a == b:
                of(name).count(len(b))
                i = j = slice(None)
            else:
                # The same edges in another order are a difference too: the order decides which point a cell keeps.
                position = {key: n for n, key in enumerate(a)}
                both = [(position[key], n) for n, key in enumerate(b) if key in position]
                i, j = (np.array([pair[s] for pair in both], int) for s in (0, 1))
                only_b, only_a = [key for key in b if key not in position], sorted(set(a) - set(b))
                for key in only_b:
                    of(name).place(f"{edge_name(key)}: recorded only")
                for key in only_a:
                    of(name).place(f"{edge_name(key)}: ours only")
                swapped = int((np.diff(i) < 0).sum()) if len(i) else 0
                if swapped:
                    first = int(np.flatnonzero(np.diff(i) < 0)[0])
                    of(name).place(f"{edge_name(b[j[first]])}: in another order than ours")
                of(name).count(len(b) + len(only_a), max(1, len(only_b) + len(only_a) + swapped))
            mine, theirs = mine[i], theirs[j]
            keys = edge_keys(theirs)
            if name == "edges":
                of("rows", "pixels").numbers(mine[:, 4], theirs[:, 4], ROWS, lambda n: edge_name(keys[n]))
            else:
                place = lambda n: f"{edge_name(keys[n // 3])}, {'xyz'[n % 3]}"
                of("points, vehicle", "m").numbers(mine[:, 5:8], theirs[:, 5:8], METRES, place)
                of("points, global", "m").numbers(mine[:, 8:], theirs[:, 8:], METRES, place)

    def map(self, k, ours, ties):
        of = self.report.of
        elevation = self.recording.array(f"maps/{k:06d}-elevation.npy")
        source = self.recording.array(f"maps/{k:06d}-source.npy")
        if elevation.shape != ours.elevation.shape or source.shape != ours.source.shape:
            raise Trouble(f"maps/{k:06d}: shape {elevation.shape}, expected {ours.elevation.shape}")
        if k not in self.corners:
            raise Trouble(f"maps.csv has no line for frame {k}")
        of("map corners", "m").numbers(ours.corner, self.corners[k], METRES, lambda _: f"frame {k}")
        columns = elevation.shape[1]
        cell = lambda n: f"frame {k}, row {n // columns}, column {n % columns}"
        of("map elevations", "m").numbers(ours.elevation, elevation, METRES, cell, ties)
        of("map sources").numbers(ours.source, source, 0, cell, ties)
        of("cells known").count(int((source > 0).sum()))

    def sector_rows(self, k, ours):
        rows = self.sectors.get(k, [])
        of, mine = self.report.of, ours.sectors
        if len(rows) != len(mine):
            of("labels").count(len(mine), len(mine))
            of("labels").place(f"frame {k}: ours {len(mine)} sectors, recorded {len(rows)}")
            return
        at = lambda n: f"frame {k}, sector {n}"
        tie = [s.near_tie for s in mine]
        of("labels").words([s.label for s in mine], [r["label"] for r in rows], at, tie)
        of("reasons").words([s.reason for s in mine], [r["reason"] for r in rows], at, tie)
        of("parts").words([s.part for s in mine], [r["part"] for r in rows], at, tie)
        number = lambda name: [float(r[name]) if r[name] else np.nan for r in rows]
        of("sector numbers").numbers(range(len(mine)), number("sector"), 0, at)
        of("directions", "rad").numbers([s.direction for s in mine], number("direction_rad"), 1e-12, at)
        of("radii", "m").numbers([s.radius for s in mine], number("radius_m"), METRES, at, tie)
        for name in ("x", "y"):
            of("sector ends", "m").numbers([getattr(s, name) for s in mine], number(f"{name}_m"), METRES, at, tie)
            of("missing places", "m").numbers([getattr(s, "missing_" + name) for s in mine],
                                              number(f"missing_{name}_m"), METRES, at, tie)

    def vector_rows(self, k, ours):
        rows, mine = self.vectors.get(k, []), ours.vectors
        of = self.report.of
        if len(rows) != len(mine):
            of("vector labels").count(len(mine), len(mine))
            of("vector labels").place(f"frame {k}: ours {len(mine)} vectors, recorded {len(rows)}")
            return
        tie = [a.near_tie or b.near_tie for a, b in zip(ours.sectors, ours.sectors[1:])]
        for n, name in enumerate(("from_x_m", "from_y_m", "to_x_m", "to_y_m")):
            of("vector ends", "m").numbers([v[n] for v in mine], [float(r[name]) for r in rows], METRES,
                                           lambda m: f"frame {k}, vector {m}", tie)
        of("vector labels").words([v[4] for v in mine], [r["label"] for r in rows],
                                  lambda m: f"frame {k}, vector {m}", tie)

    def extra_frames(self):
        """Obstacle maps that the recording has in frames in which the setup asks for none."""
        every = self.setup["obstacles_every"]
        due = set(range(0, self.frames, every))
        for name, frames in (("labels", set(self.sectors)), ("vector labels", set(self.vectors)),
                             ("map elevations", set(self.corners))):
            for k in sorted(frames - due):
                self.report.of(name).count(1, 1)
                self.report.of(name).place(f"frame {k}: recorded, but not due")

    def empty(self):
        """What the setup demands and nothing was compared of."""
        needed = ["believed elevation", "map moved", "labels", "radii"]
        if self.setup["grid"]["sectors"] > 1:
            needed.append("vector labels")
        if self.stripes is not None or any(self.column["edges"]):
            needed += ["edges", "rows"]
        if self.points is not None or any(self.column["points"]):
            needed += ["points", "points, vehicle", "points, global"]
        needed += ["map elevations", "map sources", "cells known"]
        have = self.report.tallies
        return [name for name in needed if name not in have or have[name].compared == 0]


def by_frame(table):
    """Rows of a CSV file as dictionaries, by frame."""
    out = {}
    frames = table.numbers("frame").astype(int)
    for frame, row in zip(frames, table.rows):
        out.setdefault(int(frame), []).append(dict(zip(table.names, row)))
    return out
