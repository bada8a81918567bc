#!/usr/bin/env python3
"""Small cases with known answers for each part of the second rover: planes, steps, planted pixels.

    python3 reference/rover/self_check.py

Prints one line for each check, and ends with 0 if all hold, else with 1. No recording is needed.
"""

import json
import struct
import sys
import tempfile
import zlib
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from elevation_map import EXTRAPOLATED, MEASURED, PROXIMITY, ElevationMap
from geometry import Pose, attitude, quaternion_of_rotation, rotation_of_quaternion, slopes_of_plane
from images import read_png
from navigator import label
from obstacle_map import PointTests, Sector, obstacle_map
from recording import Recording
from rover import Rover
from stripes import edges_of
from triangulate import Rig
from wheel_tests import WheelTests

LEVEL = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0.0]])  # camera and beam look ahead: z to x, x to -y, y to -z
FAILED = []


def check(name, holds):
    print(("holds  " if holds else "FAILS  ") + name)
    if not holds:
        FAILED.append(name)


def mounted(x, z, down):
    """vehicle_from_sensor of a sensor at (x, 0, z) that looks `down` radians below the horizontal."""
    pose = Pose((x, 0, z), LEVEL).panned(down)
    return {"position": list(pose.position), "quaternion": list(quaternion_of_rotation(pose.rotation))}


def setup(rules="mended", **changes):
    """A small rig: 200 x 160 pixels, two sheets 4 cm thick."""
    beam = {"thickness": 0.04, "grid_distance": 0.1, "half_width": 0.06, "max_range": 20.0}
    out = {
        "format_version": 1, "frame_rate": 10,
        "camera": {"width": 200, "height": 160, "pixel_pitch": [6e-5, 6e-5], "focal_length": 0.016,
                   "principal_point": [100, 80], "max_range": 20.0, "vehicle_from_sensor": mounted(0.5, 1.0, 0.3)},
        "beams": [beam | {"vehicle_from_sensor": mounted(0.5, 1.6, a)} for a in (0.5, 0.35)],
        "images": {"unit": "DN"},
        "extraction": {"detection": "fixed", "threshold": 400, "place": "centroid", "least_rows": 1,
                       "exposures": "in_turn", "lookup": "computed"},
        "vehicle": {"wheelbase": 1.2, "track": 1.0, "wheel_radius": 0.35, "wheel_width": 0.25, "clearance": 0.35},
        "known_noise": {"attitude": 0.0, "proximity": 0.0, "position_drift": 0.0, "position_walk": 0.0,
                        "heading_drift": 0.0, "fixes": None},
        "map": {"spacing": 0.1, "points": 201},
        "rules": {"start": "origin"} | {r: rules for r in ("elevation", "extrapolate", "several", "inconsistency",
                                                          "gap", "tests")},
        "tests": {"slopes": {"front": 0.35, "rear": 0.35, "length": 0.29, "closer": 0.58}, "closer_share": 0.5,
                  "obstacle_margin": 0.5, "clear_margin": 2.0, "rear_needed": True, "max_gap_width": 0.25},
        "grid": {"sectors": 31, "half_angle": 0.5235987755982988, "first": 0.7, "step": 0.1, "last": 4.8},
        "vectors": {"large": 1.25, "small": 0.625}, "obstacles_every": 10, "scan": None, "start_elevation": 0.0,
    }
    for path, value in changes.items():
        part, key = path.split("__")
        out[part][key] = value
    return out


def ground_image(tree, rotation, position, slopes):
    """The exact image of each beam on the plane z = slopes . (x, y): a pixel is lit if its middle sees light."""
    rig = Rig(tree)
    camera = tree["camera"]
    jj, ii = np.mgrid[0:camera["height"], 0:camera["width"]]
    pitch, centre, f = camera["pixel_pitch"], camera["principal_point"], camera["focal_length"]
    ray = np.stack([(ii + 0.5 - centre[0]) * pitch[0] / f, (jj + 0.5 - centre[1]) * pitch[1] / f,
                    np.ones(ii.shape)], axis=-1)
    outer = Pose(position, rotation)
    start = outer.apply(rig.camera_pose.position)
    way = ray @ rig.camera_pose.rotation.T @ rotation.T
    normal = np.array([-slopes[0], -slopes[1], 1.0])
    with np.errstate(divide="ignore"):
        depth = -(start @ normal) / (way @ normal)
    point = outer.undo(start + depth[..., None] * way)
    images = []
    for laser, pose in zip(tree["beams"], rig.beam_poses):
        at = pose.undo(point)
        lit = (depth > 0) & (np.abs(at[..., 1]) <= laser["thickness"] / 2) & (at[..., 2] > 0)
        lit &= np.abs(at[..., 0]) <= at[..., 2] * laser["half_width"] / laser["grid_distance"]
        images.append(np.where(lit, 1000, 0).astype(np.uint16))
    return images


def plane_recording(folder, tree, slopes, frames):
    """A drive of 3 cm a frame along x over a plane, on which the vehicle's origin stays."""
    (folder / "images").mkdir(parents=True)
    (folder / "setup.json").write_text(json.dumps(tree))
    normal = np.array([-slopes[0], -slopes[1], 1.0])
    pitch, roll = np.arctan(-slopes[0]), 0.0
    ahead = attitude(0, pitch, 0)
    roll = np.arctan2(-(ahead[:, 1] @ normal), ahead[:, 2] @ normal)
    rotation = attitude(0, pitch, -roll)
    if abs(rotation[:, 1] @ normal) > 1e-9:
        rotation, roll = attitude(0, pitch, roll), -roll
    lines = ["frame,time_s,driven_m,sensed_x_m,sensed_y_m,sensed_heading_rad,sensed_pitch_down_rad,"
             "sensed_roll_right_rad,proximity_m,scan"]
    for k in range(frames):
        x = 0.03 * k
        images = ground_image(tree, rotation, (x, 0, slopes[0] * x), slopes)
        for b, image in enumerate(images):
            np.save(folder / "images" / f"{k:06d}-beam{b}.npy", image)
        lines.append(f"{k},{k / 10},{x},{x},0,0,{float(pitch)!r},{float(-roll)!r},0,")
    (folder / "poses.csv").write_text("\n".join(lines) + "\n")


def check_geometry():
    r = attitude(0.3, -0.2, 0.1)
    check("a quaternion and its matrix go to and fro",
          np.allclose(rotation_of_quaternion(quaternion_of_rotation(r)), r, atol=1e-15))
    check("nose down: the plane of the wheels falls ahead", slopes_of_plane(attitude(0, 0.1, 0))[0] < 0)
    check("right side down: the plane rises to the left", slopes_of_plane(attitude(0, 0, 0.1))[1] > 0)
    check("a beam panned downwards looks lower", Pose((0, 0, 0), LEVEL).panned(0.2).rotation[2, 2] < 0)


def check_png(folder):
    """Each of the five filters gives the same image back."""
    rng = np.random.default_rng(1)
    image = rng.integers(0, 65536, (10, 7)).astype(np.uint16)
    image[3:5] = 0
    raw = image.astype(">u2").tobytes()
    lines = np.frombuffer(raw, np.uint8).reshape(10, 14).astype(int)
    body = b""
    for j, line in enumerate(lines):
        above = lines[j - 1] if j else np.zeros(14, int)
        left = np.concatenate([[0, 0], line[:-2]])
        corner = np.concatenate([[0, 0], above[:-2]])
        p = left + above - corner
        pa, pb, pc = abs(p - left), abs(p - above), abs(p - corner)
        paeth = np.where((pa <= pb) & (pa <= pc), left, np.where(pb <= pc, above, corner))
        guess = [0, left, above, (left + above) // 2, paeth][j % 5]
        body += bytes([j % 5]) + ((line - guess) % 256).astype(np.uint8).tobytes()
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    path = folder / "five.png"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 7, 10, 16, 0, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(body)) + chunk(b"IEND", b""))
    check("a PNG of 16 bits with all five filters", (read_png(path) == image).all())


def check_stripes():
    image = np.zeros((12, 3), np.uint16)
    image[2:5, 0] = [400, 1000, 600]
    image[7:9, 0] = 500
    image[10:12, 1] = 900  # cut off by the lower border
    rule = {"detection": "fixed", "threshold": 400, "place": "pixel", "least_rows": 1}
    (edges,), _ = edges_of(image, [0], rule)
    check("the lower end of each run, none at the border", edges.row.tolist() == [4.5, 8.5])
    (edges,), _ = edges_of(image, [0], rule | {"place": "centroid"})
    check("centroid", abs(edges.row[0] - (2.5 * 400 + 3.5 * 1000 + 4.5 * 600) / 2000) < 1e-12)
    (edges,), _ = edges_of(image, [0], rule | {"place": "sub_pixel"})
    check("crossing of the threshold", abs(edges.row[0] - (4.5 + 200 / 600)) < 1e-12)
    (edges,), _ = edges_of(image, [0], rule | {"least_rows": 3})
    check("least_rows", edges.row.tolist() == [4.5])
    rig = SimpleNamespace(points=lambda beam, column, row, middle: (None, row < (50 if beam else 100)))
    (near, far), out = edges_of(image, [0, 1], rule, rig)
    check("the lowest run is beam 0's", near.row.tolist() == [8.5] and far.row.tolist() == [4.5] and out == 0)
    image = np.zeros((120, 4), np.uint16)
    for column, rows in enumerate(((20, 70), (20, 70), (20,), (60, 80))):
        for row in rows:
            image[row:row + 2, column] = 900
    (near, far), out = edges_of(image, [0, 1], rule, rig)
    check("each run goes to the sheet on which it can lie", far.column.tolist() == [0, 1, 2]
          and near.column.tolist() == [3, 0, 1, 3] and out == 0)
    (near, far), out = edges_of(image[:, 2:3], [0, 1], rule, rig)
    check("what either sheet may have lit is left out", len(near.row) + len(far.row) == 0 and out == 1)
    image = np.zeros((12, 3), np.uint16)
    image[2:5, 0] = [400, 1000, 600]
    image[7:9, 0] = 500
    image[10:12, 1] = 900
    check("a share of the brightest pixel",
          edges_of(image, [0], rule | {"detection": "share", "threshold": 0.6})[0][0].row.tolist() == [4.5])
    check("Otsu's cut lies between dark and light",
          edges_of(image, [0], {"detection": "otsu", "place": "pixel", "least_rows": 1})[0][0].row.tolist()
          == [4.5, 8.5])
    check("gradient", edges_of(image, [0], rule | {"detection": "gradient", "threshold": 300})[0][0].row.tolist()
          == [4.5, 8.5])
    dark = edges_of(np.zeros((5, 5), np.uint16), [0], rule)[0][0]
    check("a dark image has no edge", len(dark.row) == 0)


def check_map():
    for rules, z in (("paper", 0.1), ("mended", 0.3)):
        tree = setup(rules)
        m = ElevationMap(tree, (0, 0))
        points = np.array([[1.0, 0, 0.3], [1.02, 0, 0.1], [2, 2, -1]])
        m.enter(points, np.full(3, 1e-6), 0.0, np.zeros((3, 3)))
        check(f"{rules}: several points of a cell", m.read(1.0, 0.0)[0] == z)
        check(f"{rules}: neighbours get a guess", m.read(1.1, 0.1) == (z, EXTRAPOLATED))
        old = m.elevation[100, 110]
        m.move(0.26, -0.14)
        check(f"{rules}: the map moves in whole steps and keeps its cells",
              m.centre.tolist() == [3, -1] and m.elevation[101, 107] == old)
        m.enter(np.array([[1.1, 0, 0.5]]), np.array([1e-6]), 0.1, np.zeros((1, 3)))
        source = m.read(1.0, 0.0)[1]
        check(f"{rules}: a guess over what was measured", source == (EXTRAPOLATED if rules == "paper" else MEASURED))
    m = ElevationMap(setup(), (0, 0))
    for way, z in ((0.0, 0.1), (1.0, 0.2), (2.0, 0.5)):
        found = m.enter(np.array([[1.0, 0, z]]), np.array([1e-6]), way, np.zeros((1, 3)))
    check("inconsistency: distance from the range of old elevations", abs(found[1] - 0.3) < 1e-12)


def flat_map(rules, height, everywhere=True):
    """A map that is measured everywhere: height(x, y) at each grid point."""
    tree = setup(rules)
    m = ElevationMap(tree, (0, 0))
    jj, ii = np.mgrid[0:201, 0:201]
    x, y = m.place(ii, jj)
    m.elevation[:], m.source[:] = height(x, y), MEASURED
    m.x[:], m.y[:], m.variance[:], m.way[:], m.frame[:] = x, y, 1e-6, 0, 0
    return tree, m


def check_tests():
    for rules in ("paper", "mended"):
        def sectors(height, change=lambda m: None):
            tree, m = flat_map(rules, height)
            change(m)
            test = PointTests(m, tree) if rules == "paper" else WheelTests(m, tree, None, [], 0.0)
            return obstacle_map(tree["grid"], 0, 0, 0, test)
        check(f"{rules}: level ground is clear to the limit",
              all(s.label == "visibility" and abs(s.radius - 4.8) < 1e-9 for s in sectors(lambda x, y: 0 * x)))
        step = sectors(lambda x, y: np.where(x > 2.95, 0.6, 0.0))[15]
        # The paper's points meet the step with the axle's midpoint. A wheel is lifted by
        # 0.6 - R + sqrt(R^2 - d^2) at d before it: by 0.348 m at d = 0.336 m.
        where = 3.0 if rules == "paper" else 2.7
        check(f"{rules}: a step of 0.6 m across the way ({step.label} {step.reason} at {step.radius:.1f})",
              step.label == "obstacle" and step.reason == "length" and abs(step.radius - where) < 0.101)
        def hole(m):
            m.source[:, 130:] = 0
            m.elevation[:, 130:] = np.nan
        gone = sectors(lambda x, y: 0 * x, hole)[15]
        check(f"{rules}: unmeasured ground ({gone.label} {gone.reason} {gone.part} at {gone.radius:.1f})",
              gone.label == "unknown" and gone.reason == "not_measured" and gone.part == "front_wheel")
    tree, m = flat_map("mended", lambda x, y: 0.2 * x)
    wheel = WheelTests(m, tree, None, [], 0.0).rest(0.03, 0.01, 1.0, 0.0, "front").measured
    # A circle of radius R on a line of slope m: the contact lies R m / sqrt(1 + m^2) ahead of its middle, and its
    # hub is R sqrt(1 + m^2) above the line.
    check("a wheel on a slope of 0.2", abs(wheel.hub - (0.2 * 0.03 + 0.35 * np.sqrt(1.04))) < 1e-12
          and abs(wheel.point[0] - 0.03 - 0.35 * 0.2 / np.sqrt(1.04)) < 1e-12)


def check_navigator():
    rules = {"large": 1.25, "small": 0.625}
    s = lambda name, r: Sector(0, r, 0, 0, name)
    check("vectors", [label(s(*a), s(*b), rules) for a, b in (
        (("unknown", 1), ("unknown", 4)), (("obstacle", 1), ("unknown", 2)), (("obstacle", 1), ("visibility", 4)),
        (("visibility", 4.8), ("unknown", 4.5)), (("visibility", 4.8), ("unknown", 3)))]
        == ["unknown", "obstacle", "unknown", "visibility", "unknown"])


def check_drives(folder):
    """The whole chain on planes: the map is the plane, and the vehicle's elevation stays on it."""
    for rules in ("paper", "mended"):
        for n, slopes in enumerate([(0.0, 0.0), (0.05, -0.03)]):
            tree = setup(rules)
            place = folder / f"{rules}{n}"
            plane_recording(place, tree, slopes, 90)
            rover = Rover(Recording(place))
            for k in range(90):
                frame = rover.frame(k)
            z = slopes[0] * 0.03 * 89
            off = abs(frame.position[2] - z)
            check(f"{rules}: elevation after 2.7 m on a plane of slopes {slopes}: off by {off * 1000:.2f} mm", off < 0.02)
            p = frame.points[:, 8:]
            off = np.abs(p[:, 2] - slopes[0] * p[:, 0] - slopes[1] * p[:, 1]).max()
            check(f"{rules}: {len(p)} points on it: off by at most {off * 1000:.1f} mm", len(p) > 50 and off < 0.03)


def main():
    np.seterr(invalid="ignore", divide="ignore")
    with tempfile.TemporaryDirectory() as folder:
        check_geometry()
        check_png(Path(folder))
        check_stripes()
        check_map()
        check_tests()
        check_navigator()
        check_drives(Path(folder))
    print("all hold" if not FAILED else f"{len(FAILED)} FAIL")
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
