"""Hands a scan to engines on which people build LiDAR simulators, and holds the clouds that they make to the exact answers.

    python3 reference/lidar/simulators.py target/release/raypencil -o out/lidar-simulators

The ground is generated, the sensor a VLP-16 at rest, 1.5 m up, and the scan a pack of raypencil. Each engine gets the mesh and the rays
of the pack, as a simulator would give them to it, and nothing else. Its distances become a cloud as simulators write them: points in
single precision in the sensor's own frame, with `ring` and `time`, those without a hit left out. Then

    raypencil check PACK CLOUD.pcd --frame sensor --arithmetic f32

says how many rays are right, and once more with `--arithmetic f64`: whether the engine computed more exactly than it stored. Printed is a table in Markdown. Engines that are not installed are named. Needs raypencil's Python package
for the calls of the engines (`raypencil.peers`). Exit code: 0, or 2 for bad input.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from raypencil import Mesh
from raypencil.peers import Unavailable, peer

#: Engines, and who builds LiDARs on them.
ENGINES = [
    ("open3d", "virtual scans"),
    ("mujoco", "range finders"),
    ("pybullet", "`rayTestBatch`, the usual LiDAR of its examples"),
    ("warp", "the ray casters of Isaac Lab"),
]

PATTERN = """[[rays]]
name = "vlp16"
spinning = { preset = "vlp-16", rate_hz = 10 }
position_m = [0, 1.5, 0]
roll_right_deg = -90   # y is up in the file
"""


def in_sensor_frame(points, pose):
    """Points of the mesh's frame in that of a sensor at rest: (time, x, y, z, qx, qy, qz, qw)."""
    place, (x, y, z, w) = pose[1:4], pose[4:8] / np.linalg.norm(pose[4:8])
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    return (points - place) @ turn


def write_pcd(file, points, ring, time):
    """A cloud as the driver of the sensor writes it, but for its intensity."""
    cloud = np.empty(len(points), [("xyz", "<f4", 3), ("ring", "<u2"), ("time", "<f4")])
    cloud["xyz"], cloud["ring"], cloud["time"] = points, ring, time
    header = (
        "VERSION .7\nFIELDS x y z ring time\nSIZE 4 4 4 2 4\nTYPE F F F U F\nCOUNT 1 1 1 1 1\n"
        f"WIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA binary\n"
    )
    file.write_bytes(header.encode() + cloud.tobytes())


def cloud_of(engine, pack, file):
    """What a simulator on this engine writes for the scan of the pack."""
    array = {name: np.load(pack / f"{name}.npy") for name in ("vertices", "faces", "rays", "time", "elevation", "pose")}
    rays = array["rays"]
    found = engine.first(Mesh(array["vertices"], array["faces"]), rays.reshape(-1, 8))
    t = np.asarray(found.t, np.float64)
    hit = np.isfinite(t) & (t <= rays.reshape(-1, 8)[:, 7])
    flat = rays.reshape(-1, 8)[hit]
    points = in_sensor_frame(flat[:, 0:3] + t[hit, None] * flat[:, 3:6], array["pose"][0])
    rings = np.argsort(np.argsort(array["elevation"]))
    ring = np.broadcast_to(rings, rays.shape[:2]).reshape(-1)[hit]
    write_pcd(file, points, ring, array["time"].reshape(-1)[hit])
    return int(hit.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("raypencil", help="the program")
    parser.add_argument("-o", "--output", required=True, type=Path, help="folder for ground, pack and clouds")
    arguments = parser.parse_args()
    program, folder = Path(arguments.raypencil).resolve(), arguments.output
    folder.mkdir(parents=True, exist_ok=True)

    def run(*words):
        done = subprocess.run([program, *words, "--quiet"], cwd=folder, capture_output=True, text=True)
        if done.returncode == 2:
            sys.exit(done.stderr)
        return done

    (folder / "vlp16.toml").write_text(PATTERN, encoding="utf-8")
    ground = ("--preset", "pathfinder", "--seed", "7", "--extent", "20", "--post-spacing", "0.2", "--rock-smallest", "0.3")
    run("terrain", "generate", *ground, "-o", "ground.glb")
    run("pack", "ground.glb", "--rays", "vlp16.toml", "-o", "pack", "--force")
    print("| engine | its LiDARs | points | of 28,928 rays wrong, as `f32` | largest error, share of its bound | wrong, as `f64` |")
    print("| --- | --- | ---: | ---: | ---: | ---: |")
    for name, use in ENGINES:
        try:
            engine = peer(name)
            points = cloud_of(engine, folder / "pack", folder / f"{name}.pcd")
        except Unavailable as error:
            print(f"| {name} | {use} | not asked: {error} | | | |")
            continue
        told = {}
        for arithmetic in ("f32", "f64"):
            out = f"{name}-{arithmetic}"
            run("check", "pack", f"{name}.pcd", "--frame", "sensor", "--arithmetic", arithmetic, "-o", out, "--force")
            told[arithmetic] = json.loads((folder / out / "check.json").read_text(encoding="utf-8"))
        bundle = told["f32"]["bundles"][0]
        ratios = [one["worst_ratio"]["value"] for one in bundle["quantities"] if one["worst_ratio"]]
        wrong = {arithmetic: one["classes"]["defects"] for arithmetic, one in told.items()}
        cells = [f"{engine.title} {engine.version()}", use, f"{points:,}", wrong["f32"], f"{100 * max(ratios):.1f} %", wrong["f64"]]
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
