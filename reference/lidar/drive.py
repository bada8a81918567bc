"""Drives a VLP-16 over a mesh for a minute, measures that, and reads the files with programs of other people.

    python3 reference/lidar/drive.py target/release/raypencil MESH --up y -o out/lidar-drive

The sensor follows a circle, 1.2 m over the ground, by a TUM file of 10 poses in a second. One command casts its 600 turns and
writes a PCD for each and one bag of ROS 2. Its time, memory and sizes are printed as a table in Markdown. Then

* `rosbags` reads every cloud of the bag,
* Open3D and `pypcd4` read the PCD files (Open3D some of them),

and each has to have the same points, rings and times. Exit code: 0 if all agree, 1 if not, 2 for bad input.
"""

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import open3d
from pypcd4 import PointCloud
from rosbags.highlevel import AnyReader

SECONDS = 60
POSES_PER_SECOND = 10
SEQUENCES = 1808  # of one turn of a VLP-16 at 10 Hz
RADIUS_M = 8.0
HEIGHT_M = 1.2
SCANS_BY_OPEN3D = 20


class Trouble(Exception):
    """Something that does not agree."""


def heights(raypencil, mesh, up, places, folder):
    """The ground under each place, by rays from above."""
    rays = folder / "ground.csv"
    rays.write_text("".join(f"{x!r},{y!r},1000,0,0,-1\n" for x, y in places))
    out = folder / "ground"
    subprocess.run([raypencil, "cast", mesh, rays, *up, "--quiet", "-o", out], check=True, stdout=subprocess.DEVNULL)
    points = np.load(out / "point.npy")
    if np.isnan(points).any():
        raise Trouble(f"{int(np.isnan(points[:, 2]).sum())} places of the circle have no ground below them")
    return points[:, 2]


def write_drive(raypencil, mesh, up, centre, folder):
    """The trajectory and the pattern."""
    count = SECONDS * POSES_PER_SECOND + 1
    angles = [2 * math.pi * k / (count - 1) for k in range(count)]
    places = [(centre[0] + RADIUS_M * math.cos(a), centre[1] + RADIUS_M * math.sin(a)) for a in angles]
    ground = heights(raypencil, mesh, up, places, folder)
    # The wheels of a vehicle do not jump: a mean over a second.
    wide = POSES_PER_SECOND // 2
    smooth = [float(np.mean(ground[max(0, k - wide) : k + wide + 1])) for k in range(count)]
    lines = ["# timestamp tx ty tz qx qy qz qw"]
    for k, (angle, (x, y)) in enumerate(zip(angles, places)):
        half = (angle + math.pi / 2) / 2  # along the circle
        lines.append(f"{k / POSES_PER_SECOND} {x!r} {y!r} {smooth[k] + HEIGHT_M!r} 0 0 {math.sin(half)!r} {math.cos(half)!r}")
    (folder / "drive.tum").write_text("\n".join(lines) + "\n")
    steps = SECONDS * POSES_PER_SECOND * SEQUENCES
    (folder / "drive.toml").write_text(
        '[[rays]]\nname = "vlp16-drive"\n'
        f'spinning = {{ preset = "vlp-16", steps = {steps} }}\nposes_file = "drive.tum"\n'
    )


def measured(command):
    """Wall time and largest memory of a command."""
    begin = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    text = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        raise Trouble(f"{' '.join(map(str, command))} ended with {status}: {text}")
    return time.monotonic() - begin, usage.ru_maxrss * 1024, json.loads(text)["sets"][0]


def size(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def clouds_of_bag(folder):
    """Each PointCloud2 as a structured array, with its time, height and width."""
    kinds = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 8: "<f8"}
    with AnyReader([folder]) as reader:
        connections = [connection for connection in reader.connections if connection.topic == "/points"]
        for connection, stamp, raw in reader.messages(connections=connections):
            message = reader.deserialize(raw, connection.msgtype)
            dtype = np.dtype(
                {
                    "names": [field.name for field in message.fields],
                    "formats": [kinds[field.datatype] for field in message.fields],
                    "offsets": [field.offset for field in message.fields],
                    "itemsize": message.point_step,
                }
            )
            yield stamp, message, np.frombuffer(message.data.tobytes(), dtype).reshape(message.height, message.width)


def same(name, found, expected):
    if not np.array_equal(found, expected, equal_nan=found.dtype.kind == "f"):
        raise Trouble(f"{name}: another program reads other numbers")


def compare(folder):
    """The bag and the PCD files, by their readers. Returns counts of clouds and of points."""
    rows = list(csv.DictReader((folder / "scans.csv").open()))
    clouds = points = by_open3d = 0
    for row, (_, message, cloud) in zip(rows, clouds_of_bag(folder / "rosbag"), strict=True):
        pcd = PointCloud.from_path(folder / row["file"])
        fields = {name: pcd.pc_data[name].reshape(cloud.shape) for name in pcd.fields}
        # The PCD has channels in the order of the manual, the bag rings from below.
        order = np.argsort(fields["ring"][0], kind="stable")
        for name in ("x", "y", "z", "intensity", "ring", "time"):
            same(f"{row['file']}, {name}", cloud[name], fields[name][:, order])
        hits = int(np.isfinite(cloud["x"]).sum())
        if hits != int(row["hits"]):
            raise Trouble(f"{row['file']} has {hits} points, scans.csv says {row['hits']}")
        first = fields["timestamp"].min()
        stamp = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
        # Times of the bag are later by 1 s: 0 is no time in ROS.
        if abs(stamp - (first + 1)) > 1e-6:
            raise Trouble(f"{row['file']} begins at {first}, its message says {stamp}")
        if clouds % max(1, len(rows) // SCANS_BY_OPEN3D) == 0:
            read = np.asarray(open3d.io.read_point_cloud(str(folder / row["file"]), remove_nan_points=True).points)
            xyz = np.stack([fields[name] for name in "xyz"], -1).reshape(-1, 3)
            same(f"{row['file']}, Open3D", read, xyz[np.isfinite(xyz[:, 0])].astype(float))
            by_open3d += 1
        clouds, points = clouds + 1, points + hits
    return clouds, points, by_open3d


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("raypencil")
    parser.add_argument("mesh")
    parser.add_argument("--up", choices=["y", "z"])
    parser.add_argument("--centre", nargs=2, type=float, default=[0.0, 0.0], metavar=("X", "Y"))
    parser.add_argument("-o", "--output", type=Path, required=True)
    arguments = parser.parse_args()
    folder = arguments.output
    folder.mkdir(parents=True, exist_ok=True)
    up = ["--up", arguments.up] if arguments.up else []
    try:
        write_drive(arguments.raypencil, arguments.mesh, up, arguments.centre, folder)
        scans = folder / "scans-and-bag"
        command = [
            *(arguments.raypencil, "cast", arguments.mesh, folder / "drive.toml", *up),
            *("--scans", str(SEQUENCES), "--bag", "velodyne", "--json", "-o", scans),
        ]
        seconds, memory, told = measured(command)
        clouds, points, by_open3d = compare(scans)
    except Trouble as trouble:
        print(f"drive.py: {trouble}", file=sys.stderr)
        return 1
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"drive.py: {error}", file=sys.stderr)
        return 2
    print("| | |\n| --- | ---: |")
    print(f"| scans, rays, points | {told['scans']:,}, {told['rays']:,}, {points:,} |")
    print(f"| time of the command | {seconds:.0f} s |")
    print(f"| of it casting and writing | {told['seconds']:.0f} s, {told['rays'] / told['seconds']:,.0f} rays/s |")
    print(f"| largest memory | {memory / 1e9:.2f} GB |")
    print(f"| bag | {size(scans / 'rosbag') / 1e6:.0f} MB |")
    print(f"| PCD files | {size(scans / 'scans') / 1e6:.0f} MB |")
    print(f"\n`rosbags` and `pypcd4` read {clouds} clouds, Open3D {by_open3d}: the same points, rings and times.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
