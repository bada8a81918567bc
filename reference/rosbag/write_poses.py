"""Writes the bags by which tests hold the reader of poses to another program's files.

    python3 reference/rosbag/write_poses.py crates/base/rosbag/tests/data

`rosbags` writes MCAP files with `/odom` (`nav_msgs/Odometry`), `/pose` (`geometry_msgs/PoseStamped`) and `/tf` (`tf2_msgs/TFMessage`,
of two pairs of frames), three messages each: `poses.mcap` without compression, `poses-zstd.mcap` with chunks in Zstandard. Pose k is at
1.7e9 s + 0.25 s k, k metres along x and -k/2 along y, turned to the left by 60 k degrees.
"""

import argparse
import math
import shutil
import tempfile
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

POSES = 3
BEGIN_S = 1_700_000_000


def write(folder, compressed):
    store = get_typestore(Stores.ROS2_HUMBLE)
    of = lambda name, **fields: store.types[name](**fields)  # noqa: E731
    bag = Writer(folder, version=8, storage_plugin=StoragePlugin.MCAP)
    if compressed:
        bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with bag:
        names = {"/odom": "nav_msgs/msg/Odometry", "/pose": "geometry_msgs/msg/PoseStamped", "/tf": "tf2_msgs/msg/TFMessage"}
        topics = {topic: bag.add_connection(topic, kind, typestore=store) for topic, kind in names.items()}
        for k in range(POSES):
            nanoseconds = 250_000_000 * k
            stamp = of("builtin_interfaces/msg/Time", sec=BEGIN_S + nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
            header = lambda frame: of("std_msgs/msg/Header", stamp=stamp, frame_id=frame)  # noqa: B023, E731
            half = math.radians(60 * k) / 2
            turn = of("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(half), w=math.cos(half))
            place = {"x": float(k), "y": -k / 2, "z": 1.5}
            pose = of("geometry_msgs/msg/Pose", position=of("geometry_msgs/msg/Point", **place), orientation=turn)
            none = of("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
            twist = of("geometry_msgs/msg/Twist", linear=none, angular=none)
            messages = {
                "/odom": of(
                    names["/odom"],
                    header=header("odom"),
                    child_frame_id="base_link",
                    pose=of("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=np.zeros(36)),
                    twist=of("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=np.zeros(36)),
                ),
                "/pose": of(names["/pose"], header=header("map"), pose=pose),
            }
            transforms = []
            for parent, child, scale in [("map", "lidar", 1), ("base_link", "wheel", 2)]:
                moved = of("geometry_msgs/msg/Vector3", x=scale * place["x"], y=place["y"], z=place["z"])
                transform = of("geometry_msgs/msg/Transform", translation=moved, rotation=turn)
                transforms.append(
                    of("geometry_msgs/msg/TransformStamped", header=header(parent), child_frame_id=child, transform=transform)
                )
            messages["/tf"] = of(names["/tf"], transforms=transforms)
            for topic, message in messages.items():
                data = store.serialize_cdr(message, names[topic])
                bag.write(topics[topic], BEGIN_S * 10**9 + nanoseconds, data)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=Path)
    output = parser.parse_args().output
    output.mkdir(parents=True, exist_ok=True)
    for name, compressed in [("poses", False), ("poses-zstd", True)]:
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch) / name
            write(folder, compressed)
            [file] = folder.glob("*.mcap")
            shutil.copy(file, output / f"{name}.mcap")


if __name__ == "__main__":
    main()
