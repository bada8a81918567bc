#!/usr/bin/env python3
"""Whether two recordings that make.py made of one pack agree: maps to the bit or to single precision, images to within
their own scatter.

    python reference/agree.py A B [--maps exact|single] [--pack PACK]

Where a ray meets two faces at one point, rounding decides which of them is named, and other instructions round
otherwise. With the pack at hand, either of two such faces is right; without it, faces must be the same.

Exit code 0: they agree; 1: they do not; 2: they cannot be compared. Images that were made from the same seeds are no
independent ones, and agree all the more.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np
from renderers import pack as packs

# Of |z| over the bright pixels, of their root mean square, and of the totals' z. With few images z has long tails; with few
# samples a pixel that a stripe just touches gets light in too few images to know its own error.
LARGEST, RMS, TOTAL = 12.0, 2.0, 5.0
# Relative difference of lengths and radiance in single precision: some 80 roundings.
SINGLE = 5e-6


def arrays(folder: Path) -> dict[str, np.ndarray]:
    return {str(path.relative_to(folder)): np.load(path) for path in sorted(folder.glob("*/*.npy"))}


def same_point(pack: packs.Pack, sensor: str, a: np.ndarray, b: np.ndarray) -> bool:
    """Whether each ray of the sensor whose faces differ meets both of them at one point, to single precision."""
    differs = a != b
    rays, faces = pack.rays[sensor][differs], np.stack([a[differs], b[differs]], axis=1)
    if (faces >= len(pack.faces)).any():
        return False
    origin, direction = rays[:, None, :3], rays[:, None, 3:]
    corners = pack.vertices.astype(float)[pack.faces[faces]]
    edges = np.roll(corners, -1, axis=2) - corners
    normals = np.cross(edges[:, :, 0], edges[:, :, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        t = ((corners[:, :, 0] - origin) * normals).sum(axis=2) / (direction * normals).sum(axis=2)
        points = origin + t[:, :, None] * direction
        inward = np.cross(normals[:, :, None], edges)
        inward /= np.linalg.norm(inward, axis=3, keepdims=True)
    # How far inside the nearest edge; negative: outside. In metres, as the range.
    inside = ((points[:, :, None] - corners) * inward).sum(axis=3).min(axis=2)
    ranges = t * np.linalg.norm(direction, axis=2)
    one_range = np.abs(ranges[:, 0] - ranges[:, 1]) <= SINGLE * np.abs(ranges[:, 0])
    return bool(one_range.all() and (inside >= -SINGLE * np.abs(ranges)).all())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a", type=Path)
    parser.add_argument("b", type=Path)
    parser.add_argument("--maps", choices=["exact", "single"], default="exact")
    parser.add_argument("--pack", type=Path, help="that both are of; only for --maps single")
    options = parser.parse_args()
    pack = packs.read(options.pack) if options.pack else None
    a, b = arrays(options.a), arrays(options.b)
    if not a or a.keys() != b.keys():
        print(f"error: {options.a} and {options.b} hold different files: {sorted(a.keys() ^ b.keys()) or 'none'}")
        return 2

    faults = []
    for name in a:
        if ".mean." in name or ".error." in name:
            continue
        same = np.array_equal(a[name], b[name], equal_nan=a[name].dtype.kind == "f")
        if not same and options.maps == "single" and a[name].dtype.kind == "f":
            same = np.allclose(a[name], b[name], rtol=SINGLE, atol=0, equal_nan=True)
        sensor, channel = name.split("/")
        if not same and options.maps == "single" and pack and channel == "face.I.npy":
            same = same_point(pack, sensor, a[name], b[name])
            if same:
                print(f"{name}: {(a[name] != b[name]).sum()} rays name another face that they meet at the same point")
        if not same:
            faults.append(f"{name}: differs")
    for name in (name for name in a if ".mean." in name):
        error = name.replace(".mean.", ".error.")
        combined = np.hypot(a[error].astype(float), b[error].astype(float))
        off = a[name].astype(float) - b[name].astype(float)
        bright = b[name] > 0.01 * b[name].max()
        z = off[bright] / combined[bright]
        total = off.sum() / np.sqrt((combined**2).sum())
        rms = np.sqrt((z**2).mean())
        print(f"{name}: {bright.sum()} pixels, z rms {rms:.2f}, largest {np.abs(z).max():.2f}; total z {total:+.2f}")
        if not (rms <= RMS and np.abs(z).max() <= LARGEST and abs(total) <= TOTAL):
            faults.append(f"{name}: not within its own scatter")
    notes = [json.loads((folder / "candidate.json").read_text()) for folder in (options.a, options.b)]
    if notes[0]["pack"] != notes[1]["pack"]:
        faults.append("candidate.json: of different packs")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
