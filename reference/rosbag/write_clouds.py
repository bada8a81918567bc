"""Writes the bag by which tests hold the reader of point clouds to another program's file.

    python3 reference/rosbag/write_clouds.py crates/base/rosbag/tests/data

`rosbags` writes `clouds.mcap` with chunks in Zstandard. Topic `/lidar/points` has two `sensor_msgs/PointCloud2` of 3 x 2 points, point (column c,
row r) at (c + 0.5, -r, 10 c + r): the first in single precision and little endian, with `ring` r and `time` c/8, gaps in each point and 8 bytes behind each
row; the second in double precision and big endian, without gaps, 100 m higher, 0.1 s later. Topic `/map` has one cloud of a single point.
"""

import argparse
import shutil
import tempfile
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

BEGIN_S = 1_700_000_000
COLUMNS, ROWS = 3, 2
CLOUD = "sensor_msgs/msg/PointCloud2"


def rows_of(points, gap):
    return b"".join(row.tobytes() + b"\xee" * gap for row in points)


def clouds():
    """Topic, nanoseconds after the beginning, big endian, type of a point, points (rows, columns), bytes behind a row."""
    column, row = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    single = np.dtype(
        {"names": ["x", "y", "z", "ring", "time"], "formats": ["<f4"] * 3 + ["<u2", "<f4"], "offsets": [0, 4, 8, 16, 20], "itemsize": 28}
    )
    double = np.dtype([("z", ">f8"), ("x", ">f8"), ("y", ">f8"), ("ring", ">u2")])
    first, second = np.zeros((ROWS, COLUMNS), single), np.zeros((ROWS, COLUMNS), double)
    for points, lift in [(first, 0), (second, 100)]:
        points["x"], points["y"], points["z"], points["ring"] = column + 0.5, -row, 10 * column + row + lift, row
    first["time"] = column / 8
    yield "/lidar/points", 0, False, first, 8
    yield "/map", 50_000_000, False, first[1:, 2:], 0
    yield "/lidar/points", 100_000_000, True, second, 0


def write(folder):
    store = get_typestore(Stores.ROS2_HUMBLE)
    of = lambda kind, /, **fields: store.types[kind](**fields)  # noqa: E731
    types = {"u2": 4, "f4": 7, "f8": 8}
    bag = Writer(folder, version=8, storage_plugin=StoragePlugin.MCAP)
    bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with bag:
        topics = {topic: bag.add_connection(topic, CLOUD, typestore=store) for topic in ["/lidar/points", "/map"]}
        for topic, nanoseconds, is_bigendian, points, gap in clouds():
            stamp = of("builtin_interfaces/msg/Time", sec=BEGIN_S, nanosec=nanoseconds)
            fields = [
                of("sensor_msgs/msg/PointField", name=name, offset=offset, datatype=types[number.str[1:]], count=1)
                for name, (number, offset) in points.dtype.fields.items()
            ]
            step = points.dtype.itemsize
            message = of(
                CLOUD,
                header=of("std_msgs/msg/Header", stamp=stamp, frame_id="lidar"),
                height=points.shape[0],
                width=points.shape[1],
                fields=fields,
                is_bigendian=is_bigendian,
                point_step=step,
                row_step=step * points.shape[1] + gap,
                data=np.frombuffer(rows_of(points, gap), np.uint8),
                is_dense=True,
            )
            bag.write(topics[topic], BEGIN_S * 10**9 + nanoseconds, store.serialize_cdr(message, CLOUD))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=Path)
    output = parser.parse_args().output
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "clouds"
        write(folder)
        [file] = folder.glob("*.mcap")
        shutil.copy(file, output / "clouds.mcap")


if __name__ == "__main__":
    main()
