"""The second rover: one frame after the other, in the order that docs/theory/rover.md gives at its beginning."""

from dataclasses import dataclass, field

import numpy as np

import images
from elevation_estimate import Elevation
from elevation_map import ElevationMap
from gaps import Shadows
from geometry import Pose, attitude, slopes_of_plane
from grid_estimate import elevations_at_grid_points
from navigator import navigator_map
from obstacle_map import PointTests, obstacle_map
from stripes import edges_of
from triangulate import Rig
from wheel_tests import WheelTests

CENTROID_ROWS, PIXEL_ROWS = 0.1, 1 / np.sqrt(12)  # standard deviation of an edge's row
ROW_ROUNDING = 1e-9  # pixels


@dataclass
class Exposure:
    """One image: of a beam, or of all; step of a scan or -1."""

    step: int
    beam: int  # -1: all
    stem: str


@dataclass
class Frame:
    """What the second rover made of a frame."""

    edges: np.ndarray  # frame, step, beam, column, row
    points: np.ndarray  # the same five, vehicle x y z, global x y z
    left_out: int
    position: np.ndarray
    rotation: np.ndarray
    elevation_read: bool
    elevation_error: float
    moved: tuple
    inconsistency: tuple  # points, mean, largest
    elevation: np.ndarray = None
    source: np.ndarray = None
    corner: tuple = None
    sectors: list = field(default_factory=list)
    vectors: list = field(default_factory=list)


class Rover:
    """Follows a recording. `believed_z`, if given, replaces its own elevation in each frame (to find a first fault)."""

    def __init__(self, recording, believed_z=None):
        self.recording, self.setup, self.sensed = recording, recording.setup, recording.sensed
        self.rig = Rig(self.setup)
        self.elevation = Elevation(self.setup)
        self.map = None
        self.way = 0.0
        self.believed_z = believed_z
        self.stands = []  # x, y, z and slopes of each frame, for the turning circles of the rule "circle"
        camera = self.setup["camera"]
        self.shape = (camera["height"], camera["width"])

    def exposures(self, frame):
        """The images of a frame, in the order in which their edges enter the map."""
        together = self.setup["extraction"]["exposures"] == "together"
        steps = range(self.setup["scan"]["steps"]) if self.sensed.scan[frame] else [-1]
        for step in steps:
            for beam in [-1] if together else range(len(self.setup["beams"])):
                yield Exposure(step, beam, images.name(frame, beam, step, together))

    def rig_at(self, step):
        if step < 0:
            return self.rig
        scan = self.setup["scan"]
        share = step / (scan["steps"] - 1) if scan["steps"] > 1 else 0.0
        return self.rig.panned(scan["from"] + (scan["to"] - scan["from"]) * share, scan["camera"])

    def look(self, frame, rotation):
        """Edges and points of a frame in the vehicle's frame, with what the map needs to know of each point."""
        extraction = self.setup["extraction"]
        centroid = extraction["place"] == "centroid"
        edges, points, errors, sights, left_out = [], [], [], [], 0
        for exposure in self.exposures(frame):
            image = images.load(self.recording.folder / "images", exposure.stem, self.shape)
            beams = list(range(len(self.setup["beams"]))) if exposure.beam < 0 else [exposure.beam]
            rig = self.rig_at(exposure.step)
            found, out = edges_of(image, beams, extraction, rig)
            left_out += out
            for e in found:
                n = len(e.column)
                edge = np.column_stack([np.full(n, frame), np.full(n, exposure.step), np.full(n, e.beam),
                                        e.column, e.row])
                row = e.pixel_row + 0.5 if extraction["lookup"] == "table" else e.row
                place, ok = rig.points(e.beam, e.column, row, centroid)
                edges.append(edge)
                points.append(np.column_stack([edge, place])[ok])
                # The centroid of one lit row is the middle of that pixel, wherever in it the light lies.
                one_row = centroid & (np.abs(e.row - (e.pixel_row + 0.5)) <= ROW_ROUNDING)
                rows = np.where(one_row | (extraction["place"] == "pixel"), PIXEL_ROWS, CENTROID_ROWS)
                error = rig.height_error(e.beam, e.column, e.row, rows, centroid)
                errors.append(error[ok])
                sights.append(sight(place[ok], rig, e.beam, rotation))
        return (np.vstack(edges), np.vstack(points), np.concatenate(errors), np.vstack(sights), left_out)

    def frame(self, k):
        setup, s = self.setup, self.sensed
        rotation = attitude(s.heading[k], s.pitch_down[k], s.roll_right[k])
        x, y, proximity = s.x[k], s.y[k], s.proximity[k]
        edges, seen, image_error, sight_slopes, left_out = self.look(k, rotation)
        if k > 0:
            self.way += float(np.hypot(x - s.x[k - 1], y - s.y[k - 1]))
        mended = setup["rules"]["elevation"] == "mended"
        away = seen[:, 5:8] @ rotation.T
        distance = np.hypot(away[:, 0], away[:, 1])
        own = image_error ** 2 + (setup["known_noise"]["attitude"] * distance) ** 2
        read = False
        if k == 0:
            self.map = ElevationMap(setup, (x, y))
            self.elevation.start(x, y, rotation)
            self.fill_at_start(x, y, rotation, proximity)
        self.map.frame_now, self.map.way_now = k, self.way
        self.map.drift.scans = [frame for frame in range(k) if s.scan[frame]]
        if k == 0 and mended:
            pass  # nothing is measured yet, and nothing was driven
        elif mended:
            self.elevation.predict(x, y, rotation)
            read = self.elevation.correct_by_ground(self.map, x, y, proximity, self.way)
        else:
            read = self.elevation.printed(self.map, x, y, rotation, proximity)
        if self.believed_z is not None:
            self.elevation.z = float(self.believed_z[k])
        moved = self.map.move(x, y)
        if s.scan[k] and setup["scan"]["clear_map"]:
            self.map.clear()
            self.stands.clear()  # the ground it stood on is forgotten with all other
            self.fill_at_start(x, y, rotation, proximity)
        if mended and k > 0:
            self.elevation.correct_by_stripes(self.map, away + [x, y, self.elevation.z], image_error.mean() if len(image_error) else 0, self.way)
        if self.believed_z is not None:
            self.elevation.z = float(self.believed_z[k])
        pose = Pose((x, y, self.elevation.z), rotation)
        placed = pose.apply(seen[:, 5:8])
        points = np.column_stack([seen, placed])
        if setup["rules"]["start"] == "circle":
            self.stands.append((x, y, self.elevation.z, slopes_of_plane(rotation)))
        self.map.corrected_now = self.elevation.corrected
        found = self.map.enter(placed, own + self.elevation.variance, self.way, sight_slopes)
        out = Frame(edges, points, left_out, pose.position, rotation, read, np.sqrt(self.elevation.variance),
                    tuple(int(m) for m in moved), found)
        if k % setup["obstacles_every"] == 0:
            self.obstacles(out, x, y, float(np.arctan2(rotation[1, 0], rotation[0, 0])))
        return out

    def fill_at_start(self, x, y, rotation, proximity):
        """What is known before the first stripe: the ground under the origin, or the rectangle around the wheels."""
        if not np.isfinite(proximity):
            return
        if self.setup["rules"]["start"] == "footprint":
            self.map.set_footprint(x, y, self.elevation.z - proximity, rotation, self.setup["vehicle"])
        else:
            self.map.set_proximity(x, y, self.elevation.z - proximity)

    def obstacles(self, out, x, y, heading):
        """Obstacle map and navigator map, with a copy of the map they were made from."""
        setup = self.setup
        out.elevation, out.source = elevations_at_grid_points(self.map), self.map.source.copy()
        out.corner = tuple(float(v) for v in self.map.place(0, 0))
        gap = setup["rules"]["gap"] == "mended" and setup["tests"]["max_gap_width"] is not None
        shadows = Shadows(self.map, setup["tests"]["max_gap_width"]) if gap else None
        if setup["rules"]["tests"] == "paper":
            test = PointTests(self.map, setup)
        else:
            test = WheelTests(self.map, setup, shadows, self.stands, self.way)
        out.sectors = obstacle_map(setup["grid"], x, y, heading, test)
        out.vectors = navigator_map(out.sectors, setup["vectors"])


def sight(place, rig, beam, rotation):
    """Of each point the flatter of the lines to camera and beam: unit vector in plan, and slope; of equal ones the camera's."""
    best = np.full((len(place), 3), np.nan)
    for origin in (rig.camera_pose.position, rig.beam_poses[beam].position):
        line = (origin - place) @ rotation.T
        flat = np.hypot(line[:, 0], line[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            this = np.column_stack([line[:, :2], line[:, 2]]) / flat[:, None]
        better = (flat > 0) & (np.isnan(best[:, 2]) | (this[:, 2] < best[:, 2]))
        best[better] = this[better]
    return best
