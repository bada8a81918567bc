#!/usr/bin/env python3
"""The second rover: follows a recording from its images to the navigator map, and compares every step.

    python3 reference/rover/follow.py RECORDING [--frames N] [--believed-elevation]

It reads setup.json, what the vehicle sensed, and the images; all else in the folder is only compared. The exit code
is 0 if all agree, 1 if something differs or nothing was compared, 2 if the recording cannot be followed.
"""

import argparse
import sys
import time

import numpy as np

from compare import Comparison
from geometry import quaternion_of_rotation
from recording import Recording
from rover import Rover
from trouble import Trouble


def follow(folder, frames=None, believed_elevation=False):
    """Returns whether all agree, after printing the table."""
    recording = Recording(folder)
    comparison = Comparison(recording)
    rover = Rover(recording, comparison.believed[:, 2] if believed_elevation else None)
    count = len(recording.poses) if frames is None else min(frames, len(recording.poses))
    start = time.time()
    for k in range(count):
        ours = rover.frame(k)
        ours.quaternion = quaternion_of_rotation(ours.rotation)
        comparison.frame(k, ours, rover.map.tied if ours.elevation is not None else None)
    if count == len(recording.poses):
        comparison.extra_frames()
    agree = comparison.report.print(comparison.empty())
    print(f"{count} of {len(recording.poses)} frames in {time.time() - start:.0f} s: "
          + ("all agree" if agree else "NOT all agree"))
    return agree


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", help="folder that `raypencil drive --record images,points,maps` wrote")
    parser.add_argument("--frames", type=int, help="only the first so many frames")
    parser.add_argument("--believed-elevation", action="store_true",
                        help="take the vehicle's elevation from the recording, to find the first rule that differs")
    options = parser.parse_args()
    np.seterr(invalid="ignore", divide="ignore")
    try:
        return 0 if follow(options.recording, options.frames, options.believed_elevation) else 1
    except Trouble as trouble:
        print(f"trouble: {trouble}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
