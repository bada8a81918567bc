"""Reads a recording (docs/formats/recording.md): the setup, what the vehicle sensed, and what it made of it.

`Recording` keeps the two apart: `setup`, `sensed` and images are the input of the second rover; all else is only for
the comparison afterwards.
"""

import csv
import json
from pathlib import Path

import numpy as np

from trouble import Trouble

# Keys of setup.json that are used here; a missing one gives a message instead of a traceback in mid-drive.
NEEDED = {
    "": ["format_version", "frame_rate", "camera", "beams", "images", "extraction", "vehicle", "known_noise", "map",
         "rules", "tests", "grid", "vectors", "obstacles_every", "scan", "start_elevation"],
    "camera": ["width", "height", "pixel_pitch", "focal_length", "principal_point", "max_range",
               "vehicle_from_sensor"],
    "images": ["unit"],
    "extraction": ["detection", "place", "least_rows", "exposures", "lookup"],
    "vehicle": ["wheelbase", "track", "wheel_radius", "wheel_width", "clearance"],
    "known_noise": ["attitude", "proximity", "position_drift", "position_walk", "heading_drift", "fixes"],
    "map": ["spacing", "points"],
    "rules": ["start", "elevation", "extrapolate", "several", "inconsistency", "gap", "tests"],
    "tests": ["slopes", "closer_share", "obstacle_margin", "clear_margin", "rear_needed", "max_gap_width"],
    "grid": ["sectors", "half_angle", "first", "step", "last"],
    "vectors": ["large", "small"],
}
BEAM = ["thickness", "grid_distance", "half_width", "max_range", "vehicle_from_sensor"]
WORDS = {
    ("extraction", "detection"): ["fixed", "share", "otsu", "gradient"],
    ("extraction", "place"): ["pixel", "sub_pixel", "centroid"],
    ("extraction", "exposures"): ["in_turn", "together"],
    ("extraction", "lookup"): ["computed", "table"],
    ("images", "unit"): ["DN", "W/m"],
    ("rules", "start"): ["origin", "footprint", "circle"],
} | {("rules", rule): ["paper", "mended"]
     for rule in ("elevation", "extrapolate", "several", "inconsistency", "gap", "tests")}


def read_setup(path):
    """setup.json, checked for the keys and words that the second rover uses."""
    try:
        setup = json.loads(Path(path).read_text())
    except OSError as error:
        raise Trouble(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise Trouble(f"{path}: not JSON ({error})") from None
    for part, keys in NEEDED.items():
        table = setup if part == "" else setup[part]
        if not isinstance(table, dict):
            raise Trouble(f"{path}: {part or 'the whole'} is not a table")
        for key in keys:
            if key not in table:
                raise Trouble(f"{path}: {part + '.' if part else ''}{key} is missing")
    if setup["format_version"] != 1:
        raise Trouble(f"{path}: format_version {setup['format_version']}, expected 1")
    if not setup["beams"]:
        raise Trouble(f"{path}: no beams")
    for k, beam in enumerate(setup["beams"]):
        for key in BEAM:
            if key not in beam:
                raise Trouble(f"{path}: beams[{k}].{key} is missing")
    for (part, key), words in WORDS.items():
        if setup[part][key] not in words:
            raise Trouble(f"{path}: {part}.{key} is {setup[part][key]!r}, expected one of {', '.join(words)}")
    if setup["extraction"]["detection"] != "otsu" and setup["extraction"].get("threshold") is None:
        raise Trouble(f"{path}: extraction.threshold is missing, and detection is not otsu")
    return setup


class Table:
    """A CSV file with names in its first line: columns by name, "" as NaN in numbers."""

    def __init__(self, path):
        self.path = path
        try:
            with open(path, newline="") as file:
                rows = list(csv.reader(file))
        except OSError as error:
            raise Trouble(f"{path}: {error.strerror}") from None
        if not rows:
            raise Trouble(f"{path}: empty, expected a line of names")
        self.names, self.rows = rows[0], rows[1:]
        for k, row in enumerate(self.rows):
            if len(row) != len(self.names):
                raise Trouble(f"{path}: line {k + 2} has {len(row)} fields, expected {len(self.names)}")

    def __len__(self):
        return len(self.rows)

    def words(self, name):
        if name not in self.names:
            raise Trouble(f"{self.path}: no column {name}")
        k = self.names.index(name)
        return [row[k] for row in self.rows]

    def numbers(self, name):
        out = np.empty(len(self.rows))
        for k, word in enumerate(self.words(name)):
            try:
                out[k] = float(word) if word else np.nan
            except ValueError:
                raise Trouble(f"{self.path}: line {k + 2}, {name}: {word!r} is no number") from None
        return out


class Sensed:
    """What the vehicle's own algorithms start from: nothing of the true pose, nothing that was computed."""

    def __init__(self, table):
        self.frame = table.numbers("frame").astype(int)
        self.x, self.y = table.numbers("sensed_x_m"), table.numbers("sensed_y_m")
        self.heading = table.numbers("sensed_heading_rad")
        self.pitch_down = table.numbers("sensed_pitch_down_rad")
        self.roll_right = table.numbers("sensed_roll_right_rad")
        self.proximity = table.numbers("proximity_m")  # NaN: none
        self.scan = [word != "" for word in table.words("scan")]
        if not (self.frame == np.arange(len(table))).all():
            raise Trouble(f"{table.path}: frames are not counted from 0 without a gap")


class Recording:
    """The folder of a recording."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise Trouble(f"{folder}: no such folder")
        self.setup = read_setup(self.folder / "setup.json")
        self.poses = Table(self.folder / "poses.csv")
        if len(self.poses) == 0:
            raise Trouble(f"{self.poses.path}: no frames")
        self.sensed = Sensed(self.poses)

    def array(self, name, required=True):
        """An NPY file of results, or None if it need not be there."""
        path = self.folder / name
        if not path.exists():
            if required:
                raise Trouble(f"{path}: no such file")
            return None
        try:
            return np.load(path)
        except (ValueError, OSError, EOFError) as error:
            raise Trouble(f"{path}: not a readable NPY file ({error})") from None

    def table(self, name):
        return Table(self.folder / name)
