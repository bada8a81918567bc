"""Reads the bag of a recorded drive with two Python packages, and compares every message with the recording's files.

    raypencil drive SCENE --record all -o out/drive
    python3 reference/rosbag/check.py out/drive/recording

The packages are `rosbags` and `mcap-ros2-support`. Each decodes the bag by the definitions in it, and shares no code with
the other or with raypencil. Both must give the same messages, field by field; these must be what `poses.csv`, `points.npy`,
`images/*.npy` and `maps.csv` say. Exit code: 0 if all agree, 1 if not, 2 for bad input.
"""

import argparse
import csv
import json
import math
import sys
from pathlib import Path

import numpy as np
from mcap.reader import make_reader
from mcap_ros2.reader import read_ros2_messages
from rosbags.highlevel import AnyReader


class Trouble(Exception):
    """Something that does not agree."""


def plain(value):
    """A message of either package as numbers, texts, lists and dictionaries."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.ndarray):
        return value.tobytes() if value.dtype.itemsize == 1 else value.tolist()
    if isinstance(value, (bytes, bytearray, memoryview)):
        return bytes(value)
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    names = getattr(value, "__slots__", None) or getattr(value, "__dict__", {})
    names = [name for name in names if not name.startswith("_") and not name.isupper()]
    return {name: plain(getattr(value, name)) for name in names}


def by_rosbags(folder):
    """Topic -> list of (time, message), by `rosbags`."""
    messages = {}
    with AnyReader([folder]) as reader:
        for connection, time, raw in reader.messages():
            message = plain(reader.deserialize(raw, connection.msgtype))
            messages.setdefault(connection.topic, []).append((time, message))
        counts = {connection.topic: connection.msgcount for connection in reader.connections}
    if counts != {topic: len(found) for topic, found in messages.items()}:
        raise Trouble(f"metadata.yaml counts {counts}")
    return messages


def by_mcap(path):
    """Topic -> list of (time, message), by `mcap-ros2-support`."""
    messages = {}
    for message in read_ros2_messages(str(path)):
        found = messages.setdefault(message.channel.topic, [])
        found.append((message.log_time_ns, plain(message.ros_msg)))
    return messages


def same(a, b, where):
    """Whether two decoded messages are the same; `int8[]` comes as bytes from one and as numbers from the other."""
    if isinstance(a, dict) and isinstance(b, dict):
        if a.keys() != b.keys():
            raise Trouble(f"{where}: fields {sorted(a)} and {sorted(b)}")
        for name in a:
            same(a[name], b[name], f"{where}.{name}")
    elif isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            raise Trouble(f"{where}: {len(a)} and {len(b)} elements")
        for index, (one, other) in enumerate(zip(a, b)):
            same(one, other, f"{where}[{index}]")
    else:
        if isinstance(a, bytes) and isinstance(b, list):
            b = bytes(number & 255 for number in b)
        if a != b:
            raise Trouble(f"{where}: {str(a)[:60]} and {str(b)[:60]}")


class Comparison:
    """Counts what was compared, so that nothing passes for want of it."""

    def __init__(self):
        self.compared = {}

    def equal(self, what, found, expected, where):
        found, expected = np.asarray(found), np.asarray(expected)
        if found.shape != expected.shape:
            raise Trouble(f"{what}, {where}: shape {found.shape}, expected {expected.shape}")
        differ = ~((found == expected) | ((found != found) & (expected != expected)))
        if differ.any():
            place = np.argwhere(differ)[0].tolist()
            one, other = found[tuple(place)], expected[tuple(place)]
            raise Trouble(f"{what}, {where}: {one} at {place}, expected {other}")
        self.compared[what] = self.compared.get(what, 0) + found.size


def pose_numbers(position, rotation):
    return [position["x"], position["y"], position["z"]] + [rotation[axis] for axis in "xyzw"]


def check_poses(comparison, bag, table, setup):
    """Transforms and odometry against poses.csv."""
    names = ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"]
    wanted = {"base_link_true": "true", "base_link": "believed"}
    if not len(bag["/tf"]) == len(bag["/odometry"]) == len(bag["/ground_truth/odometry"]) == len(table):
        raise Trouble("not as many poses as frames")
    before = {}
    for (time, message), row in zip(bag["/tf"], table):
        expected_time = round((1.0 + float(row["time_s"])) * 1e9)
        comparison.equal("times, ns", [time], [expected_time], f"frame {row['frame']}")
        if {transform["child_frame_id"] for transform in message["transforms"]} != set(wanted):
            raise Trouble(f"/tf of frame {row['frame']} has other frames")
        for transform in message["transforms"]:
            side = wanted[transform["child_frame_id"]]
            numbers = pose_numbers(transform["transform"]["translation"], transform["transform"]["rotation"])
            expected = [float(row[f"{side}_{name}"]) for name in names]
            comparison.equal("transforms", numbers, expected, f"frame {row['frame']}")
    for topic, side in [("/ground_truth/odometry", "true"), ("/odometry", "believed")]:
        for (_, message), row in zip(bag[topic], table):
            where = f"{topic} of frame {row['frame']}"
            pose = message["pose"]["pose"]
            expected = [float(row[f"{side}_{name}"]) for name in names]
            comparison.equal("odometry", pose_numbers(pose["position"], pose["orientation"]), expected, where)
            variance = message["pose"]["covariance"]
            known = float(row["elevation_error_m"]) ** 2 if side == "believed" else 0.0
            if not math.isclose(variance[14], known, rel_tol=1e-15):
                raise Trouble(f"{where}: variance of z {variance[14]}, expected {known}")
            # The twist of the frame leads from the pose before to this one.
            if side in before and int(row["frame"]) > 0:
                check_twist(comparison, before[side], expected, message["twist"]["twist"], setup["frame_rate"], where)
            before[side] = expected
        before.clear()


def matrix(x, y, z, w):
    """Rotation of a unit quaternion."""
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def check_twist(comparison, before, now, twist, rate, where):
    linear = np.array([twist["linear"][axis] for axis in "xyz"])
    angular = np.array([twist["angular"][axis] for axis in "xyz"])
    turned, turned_before = matrix(*now[3:]), matrix(*before[3:])
    moved = turned @ linear / rate - (np.array(now[:3]) - np.array(before[:3]))
    # Rodrigues: the matrix of a rotation by the angular velocity for one frame.
    vector = angular / rate
    angle = np.linalg.norm(vector)
    cross = np.array([[0, -vector[2], vector[1]], [vector[2], 0, -vector[0]], [-vector[1], vector[0], 0]])
    sine, versine = (math.sin(angle) / angle, (1 - math.cos(angle)) / angle**2) if angle > 1e-9 else (1.0, 0.5)
    rotation = np.eye(3) + sine * cross + versine * cross @ cross
    worst = max(abs(moved).max(), abs(turned_before @ rotation - turned).max())
    # A few roundings of numbers of the size of the drive, some 10 m.
    if not worst < 1e-12:
        raise Trouble(f"{where}: its twist misses the pose by {worst}")
    comparison.compared["twists"] = comparison.compared.get("twists", 0) + 1


def check_points(comparison, bag, table, points):
    """Clouds against points.npy, in single precision."""
    for (_, message), row in zip(bag["/points"], table, strict=True):
        where = f"/points of frame {row['frame']}"
        expected = points[points[:, 0] == int(row["frame"])]
        fields = {field["name"]: field["offset"] for field in message["fields"]}
        step = message["point_step"]
        kinds = {1: "i1", 5: "<i4", 7: "<f4", 8: "<f8"}
        dtype = np.dtype({
            "names": list(fields),
            "formats": [kinds[field["datatype"]] for field in message["fields"]],
            "offsets": list(fields.values()),
            "itemsize": step,
        })
        cloud = np.frombuffer(message["data"], dtype=dtype)
        if not message["width"] * message["height"] == len(cloud) == int(row["points"]):
            raise Trouble(f"{where}: {len(cloud)} points, expected {row['points']}")
        for name, column in [("beam", 2), ("column", 3), ("row", 4), ("x", 5), ("y", 6), ("z", 7)]:
            kind = np.int32 if name in ("beam", "column") else np.float32
            comparison.equal("points", cloud[name], expected[:, column].astype(kind), f"{where}, {name}")


def check_images(comparison, bag, table, folder, setup):
    """Images against images/*.npy, and each image's camera_info."""
    kinds = {"mono16": "<u2", "32SC1": "<i4", "64FC1": "<f8"}
    times = {round((1.0 + float(row["time_s"])) * 1e9): int(row["frame"]) for row in table}
    seen = set()
    camera = setup["camera"]
    fx, fy = (camera["focal_length"] / pitch for pitch in camera["pixel_pitch"])
    cx, cy = (place - 0.5 for place in camera["principal_point"])
    for topic in [topic for topic in bag if topic.endswith("/image_raw")]:
        infos = bag[topic.replace("image_raw", "camera_info")]
        lit = topic.split("/")[-2]
        for (time, message), (info_time, info) in zip(bag[topic], infos, strict=True):
            frame_id = message["header"]["frame_id"]
            scan = frame_id.removeprefix("camera_optical").replace("_", "-")
            name = f"{times[time]:06}{scan}-{lit}.npy"
            expected = np.load(folder / name)
            data = np.frombuffer(message["data"], dtype=kinds[message["encoding"]])
            if message["step"] * message["height"] != len(message["data"]):
                raise Trouble(f"{topic}: step {message['step']}")
            data = data.reshape(message["height"], message["width"])
            comparison.equal("pixels", data, expected, f"{topic}, {name}")
            seen.add(name)
            if (info_time, info["header"]) != (time, message["header"]):
                raise Trouble(f"{topic}, {name}: camera_info of another image")
            size = [info["width"], info["height"]]
            comparison.equal("camera_info", size, [camera["width"], camera["height"]], name)
            comparison.equal("camera_info", info["k"], [fx, 0, cx, 0, fy, cy, 0, 0, 1], name)
            comparison.equal("camera_info", info["p"], [fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0], name)
    missing = {path.name for path in folder.glob("*.npy")} - seen
    if missing:
        raise Trouble(f"{len(missing)} images are not in the bag, such as {min(missing)}")


def check_static(comparison, bag, setup):
    """Fixed transforms against setup.json."""
    [(_, message)] = bag["/tf_static"]
    expected = {"camera_optical": setup["camera"]["vehicle_from_sensor"]}
    for index, beam in enumerate(setup["beams"]):
        expected[f"beam{index}_optical"] = beam["vehicle_from_sensor"]
    found = {}
    for transform in message["transforms"]:
        numbers = pose_numbers(transform["transform"]["translation"], transform["transform"]["rotation"])
        found[transform["child_frame_id"]] = numbers
    for name, pose in expected.items():
        comparison.equal("fixed transforms", found[name], pose["position"] + pose["quaternion"], name)
    scans = [name for name in found if name.startswith("camera_optical_scan")]
    if len(scans) != (setup["scan"]["steps"] if setup["scan"] else 0):
        raise Trouble(f"{len(scans)} positions of a scan")


def check_maps(comparison, bag, folder, setup):
    """Obstacle maps against maps.csv (place and size) and sectors.csv: what is free or occupied lies at the ends."""
    with open(folder / "maps.csv", newline="") as file:
        maps = list(csv.DictReader(file))
    with open(folder / "sectors.csv", newline="") as file:
        sectors = list(csv.DictReader(file))
    for (_, message), row in zip(bag["/obstacle_map"], maps, strict=True):
        where = f"/obstacle_map of frame {row['frame']}"
        info, spacing = message["info"], float(row["spacing_m"])
        comparison.equal("maps", [info["width"], info["height"]], [int(row["points"])] * 2, where)
        comparison.equal("maps", [info["resolution"]], [float(np.float32(spacing))], where)
        corner = info["origin"]["position"]
        expected = [float(row["west_m"]) - 0.5 * spacing, float(row["south_m"]) - 0.5 * spacing]
        comparison.equal("maps", [corner["x"], corner["y"]], expected, where)
        data = message["data"]
        data = data if isinstance(data, list) else np.frombuffer(data, np.int8).tolist()
        cells = np.array(data, np.int8).reshape(info["height"], info["width"])
        if not set(np.unique(cells)) <= {-1, 0, 100}:
            raise Trouble(f"{where}: values {np.unique(cells)}")
        ends = [sector for sector in sectors if sector["frame"] == row["frame"]]
        obstacles = [sector for sector in ends if sector["label"] == "obstacle"]
        for sector in obstacles:
            place = [float(sector["x_m"]) - corner["x"], float(sector["y_m"]) - corner["y"]]
            column, line = (int(math.floor(number / spacing)) for number in place)
            if 1 <= column < info["width"] - 1 and 1 <= line < info["height"] - 1:
                near = cells[line - 1:line + 2, column - 1:column + 2]
                comparison.equal("obstacles in maps", [(near == 100).any()], [True], where)
        comparison.equal("maps", [(cells == 100).any()], [bool(obstacles)], where)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("recording", type=Path, help="folder `recording` of a drive, made with --record all")
    folder = parser.parse_args().recording
    try:
        setup = json.loads((folder / "setup.json").read_text())
        with open(folder / "poses.csv", newline="") as file:
            table = list(csv.DictReader(file))
        points = np.load(folder / "points.npy")
        bag = by_rosbags(folder / "rosbag")
        other = by_mcap(folder / "rosbag" / "rosbag_0.mcap")
    except (OSError, ValueError) as error:
        print(f"{folder}: {error}", file=sys.stderr)
        return 2
    comparison = Comparison()
    try:
        if bag.keys() != other.keys():
            raise Trouble(f"topics {sorted(bag)} and {sorted(other)}")
        for topic in bag:
            if len(bag[topic]) != len(other[topic]):
                raise Trouble(f"{topic}: {len(bag[topic])} and {len(other[topic])} messages")
            for index, (one, two) in enumerate(zip(bag[topic], other[topic])):
                same(list(one), list(two), f"{topic}[{index}]")
        check_static(comparison, bag, setup)
        check_poses(comparison, bag, table, setup)
        check_points(comparison, bag, table, points)
        check_images(comparison, bag, table, folder / "images", setup)
        check_maps(comparison, bag, folder, setup)
        with open(folder / "rosbag" / "rosbag_0.mcap", "rb") as file:
            [attachment] = make_reader(file).iter_attachments()
        if json.loads(attachment.data) != setup:
            raise Trouble("the bag's setup.json is another")
        # An absent kind of message agrees with everything.
        for what in ["transforms", "odometry", "twists", "points", "pixels", "camera_info", "maps"]:
            if not comparison.compared.get(what):
                raise Trouble(f"no {what} were compared")
    except (Trouble, KeyError, ValueError) as error:
        print(f"DIFFERS: {error}")
        return 1
    for topic in sorted(bag):
        print(f"{len(bag[topic]):6} messages of {topic}")
    for what, count in sorted(comparison.compared.items()):
        print(f"{count:12} {what}")
    print("both packages read the same bag, and it is the recording")
    return 0


if __name__ == "__main__":
    sys.exit(main())
