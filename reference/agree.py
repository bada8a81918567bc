#!/usr/bin/env python3
"""Whether two recordings that make.py made of one pack agree: maps to the bit or to single precision, images to within
their own scatter.

    python reference/agree.py A B [--maps exact|single]

Exit code 0: they agree; 1: they do not; 2: they cannot be compared. Images that were made from the same seeds are no
independent ones, and agree all the more.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

# Of |z| over the bright pixels, of their root mean square, and of the totals' z. With few images z has long tails; with few
# samples a pixel that a stripe just touches gets light in too few images to know its own error.
LARGEST, RMS, TOTAL = 12.0, 2.0, 5.0
# Relative difference of lengths and radiance in single precision: some 80 roundings.
SINGLE = 5e-6


def arrays(folder: Path) -> dict[str, np.ndarray]:
    return {str(path.relative_to(folder)): np.load(path) for path in sorted(folder.glob("*/*.npy"))}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a", type=Path)
    parser.add_argument("b", type=Path)
    parser.add_argument("--maps", choices=["exact", "single"], default="exact")
    options = parser.parse_args()
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
