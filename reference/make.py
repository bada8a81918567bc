#!/usr/bin/env python3
"""Asks a renderer that others wrote the questions of a pack, and writes what it says, for `raypencil check`.

    python reference/make.py --pack PACK --with embree -o DIR
    python reference/make.py --pack PACK --with mitsuba -o DIR [--images 24] [--samples 1024] [--seed 1]

PACK is a folder that `raypencil pack` wrote, such as data/packs/pyramids. DIR gets one folder for each sensor with an
NPY file for each channel, and candidate.json, which says what made them and of which pack.
"""

import argparse
import hashlib
import json
import platform
import sys
from pathlib import Path

try:
    from renderers import pack as packs
except ImportError as missing:
    sys.exit(f"error: {missing}; expected what reference/requirements.txt lists")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pack", type=Path, required=True)
    parser.add_argument("--with", dest="renderer", choices=["embree", "mitsuba"], required=True)
    parser.add_argument("-o", dest="out", type=Path, required=True)
    parser.add_argument("--images", type=int, default=24, help="independent images, of which mean and error are taken")
    parser.add_argument("--samples", type=int, default=1024, help="samples of each pixel in each image")
    parser.add_argument("--seed", type=int, default=1, help="of the first image")
    options = parser.parse_args()
    if options.images < 2 or options.samples < 1 or options.seed < 0:
        parser.error("expected --images of at least 2, --samples of at least 1, --seed of at least 0")
    try:
        pack = packs.read(options.pack)
    except packs.PackError as error:
        sys.exit(f"error: {error}")

    try:
        if options.renderer == "embree":
            from renderers import embree

            made = embree.render(pack, options.out)
        else:
            from renderers import mitsuba

            made = mitsuba.render(pack, options.out, mitsuba.Effort(options.images, options.samples, options.seed))
    except ImportError as error:
        sys.exit(f"error: {error}; expected what reference/README.md lists for --with {options.renderer}")

    made["versions"]["python"] = platform.python_version()
    manifest = (options.pack / "manifest.json").read_bytes()
    scene = json.loads(manifest)["scene"]
    about = {"format": 1, **made, "arithmetic": "f32", "scene": scene, "pack": hashlib.sha256(manifest).hexdigest()}
    # Last: it says that all the rest is there.
    (options.out / "candidate.json").write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
