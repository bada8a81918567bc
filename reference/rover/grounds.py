#!/usr/bin/env python3
"""Writes twenty scenes of random ground for the two rovers to be compared on, and five drives for the laws of the sensor.

    python3 reference/rover/grounds.py FOLDER
    for scene in FOLDER/ground*.toml; do
        raypencil drive "$scene" --record npy,points,maps -o out/drive
        python3 reference/rover/follow.py out/drive/recording
    done

Six kinds of ground, random starts, headings and turns, and ten ways to see and to map: rules as printed and mended, alone and
together, each detection and place of a stripe, both lit together, noisy sensors, an unlit image subtracted, scans. The camera is
small, 160 x 160 pixels over the field of view of the default one, so that a drive takes seconds.

`sensor-ideal.toml` and the others of its name are one drive by several cameras, for `check_sensor.py`.
"""

import math
import random
import sys
from pathlib import Path

PRESETS = ["smooth", "viking1", "pathfinder", "crater_field", "crevassed", "worst"]
COUNT = 20

# Keys of [drive] of each variant, and of [drive.rules].
VARIANTS = [
    ("mended rules", {}, {}),
    ("edges by gradient, to parts of a pixel", {"detection": '"gradient"', "threshold_dn": 300, "place": '"sub_pixel"'}, {}),
    ("Otsu's threshold, whole pixels", {"detection": '"otsu"', "place": '"pixel"'}, {}),
    ("both beams together, whole pixels, points by table",
     {"exposures": '"together"', "place": '"pixel"', "lookup": '"table"'}, {}),
    ("noisy sensors", {"sensor": '"cmos"', "attitude_noise_deg": 0.5, "proximity_noise_m": 0.01,
                       "position_drift_m_per_s": [0.01, -0.01]}, {}),
    ("noisy camera, unlit image subtracted", {"sensor": '"ccd_1989"', "subtract_unlit": "true"}, {}),
    ("start, elevation and extrapolation as printed", {},
     {"start": "footprint", "elevation": "paper", "extrapolate": "paper"}),
    ("all rules as printed", {}, {"start": "paper", "elevation": "paper", "extrapolate": "paper", "several": "paper",
                                  "inconsistency": "paper", "gap": "paper", "tests": "paper"}),
    ("several and tests as printed", {}, {"several": "paper", "tests": "paper"}),
    ("tests as printed, gaps crossed", {}, {"tests": "paper", "gap": "mended"}),
]


def scene(k):
    """Text of scene k."""
    draw = random.Random(k)
    x, y = (round(draw.uniform(-3, 3), 2) for _ in range(2))
    heading = round(draw.uniform(-180, 180))
    turn = round(draw.uniform(-0.4, 0.4), 2)
    name, keys, rules = VARIANTS[k % len(VARIANTS)]
    keys = dict(keys)
    if k % 4 in (1, 2):
        keys.update({"scan_steps": 21, "scan_every_m": 0.7})
    else:
        keys["scans"] = "false"
    lines = [
        f"# Ground {k} of {COUNT}: {PRESETS[k % len(PRESETS)]}; {name}.",
        "version = 1",
        "[vehicle]",
        f"position_m = [{x}, {y}]",
        f"heading_deg = {heading}",
        "[camera]",
        "width_px = 160",
        "height_px = 160",
        "pixel_pitch_um = 57.6",
        "[[beam]]",
        "rows = 2",
        "[[beam]]",
        "rows = 2",
        "[terrain]",
        f'generate = {{ preset = "{PRESETS[k % len(PRESETS)]}", seed = {100 + k}, extent_m = 24 }}',
        "[drive]",
        f"waypoints_m = [[1.0, 0], [{1.0 + 0.6 * math.cos(turn):.2f}, {turn}]]",
        "frames_per_s = 5",
        "obstacles_every_frames = 4",
        *(f"{key} = {value}" for key, value in keys.items()),
    ]
    if rules:
        lines += ["[drive.rules]", *(f'{rule} = "{word}"' for rule, word in rules.items())]
    return "\n".join(lines) + "\n"


# Cameras without blur and dust. Their lens is so small that nothing is out of focus, and the laser as much brighter.
PLAIN = "optics = { blurs = [], dust = { transmission = 1, halo_share = 0 } }"
SENSORS = {
    "ideal": ['sensor = "ideal"'],
    "ccd_1989": ['sensor = "ccd_1989"', PLAIN],
    "cmos": ['sensor = "cmos"', PLAIN],
    # A stronger fixed pattern, and light beyond the full well and beyond the highest number.
    "cmos-full": ['sensor = "cmos"', PLAIN, "electronics = { prnu = 0.02, full_well_e = 4000 }"],
    "cmos-bright": ['sensor = "cmos"', PLAIN, "electronics = { prnu = 0.02, gain_dn_per_e = 1.2 }"],
}


def sensor_scene(keys):
    """Text of a drive over the facets with these keys of [drive]."""
    beam = ["[[beam]]", "power_w = 10000"]
    return "\n".join(["version = 1", "[vehicle]", "position_m = [-6, 0]", "[camera]", "aperture_mm = 0.02", *beam, *beam,
                      "[terrain]", 'builtin = "facets"', "[drive]", "waypoints_m = [[3, 0]]", "frames_per_s = 5",
                      "scans = false", *keys]) + "\n"


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for k in range(COUNT):
        (folder / f"ground{k:02}.toml").write_text(scene(k))
    for name, keys in SENSORS.items():
        (folder / f"sensor-{name}.toml").write_text(sensor_scene(keys))
    (folder / "cmos-full.json").write_text('{"prnu": 0.02, "well": 4000}')
    (folder / "cmos-bright.json").write_text('{"prnu": 0.02, "gain": 1.2}')
    return 0


if __name__ == "__main__":
    sys.exit(main())
