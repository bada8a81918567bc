"""The tables of docs/designs.md, from the tables of its sweeps: found, passed, false and the clear way of each design.

    python3 reference/rover/designs.py H=out/designs/heights/table.csv S=out/designs/sun/table.csv -o out/designs/tables.md

Before each table stands the letter of its rows; a letter may come several times, as parts of one sweep. A row is a design on the
grounds of one kind; seeds from 11 on, on which a conclusion was tried again, have rows of their own. `--pair H1,H4` compares two
designs on the grounds that both have. It needs no package.
"""

import argparse
import csv
import pathlib
import re
import sys

from laser import SHEETS, energy_per_metre, laser_class
from resample import interval

# The first seed of the grounds on which a conclusion was tried again.
FIRST_OTHER_SEED = 11
# What data/designs/rover.toml has where a sweep says nothing else.
SEED, CAMERA = 4, "cmos"
HEADS = ["row", "ground", "seeds", "obstacles", "found", "exact eyes", "passed", "false", "clear way", "exact eyes: clear way",
         "light", "class"]
# What was changed, in few words: the words of a key's value, or nothing where another key says it.
WORDS = {
    "camera.position_m": lambda value: "",
    "beam.0.position_m": lambda value: f"{float(re.findall(r'[-.0-9]+', value)[-1]):g} m high",
    "beam.1.position_m": lambda value: "",
    "beam.0.pitch_down_deg": lambda value: f"{value}°",
    "beam.1.pitch_down_deg": lambda value: "",
    "drive.scan_from_deg": lambda value: f"scan from {value}°",
    "drive.scan_to_deg": lambda value: "",
    "drive.scan_steps": lambda value: f"{value} steps",
    "drive.sun": lambda value: "day" if value else "night",
    "drive.subtract_unlit": lambda value: "",
    "drive.threshold_dn": lambda value: "",
    "camera.filter": lambda value: "filter {} nm, {} wide".format(*re.findall(r"[-.0-9]+", value)) if value else "no filter",
    "beam.power_w": lambda value: f"{value or 1} W",
    "drive.attitude_noise_deg": lambda value: f"noise {value or 0}°",
    "drive.frames_per_s": lambda value: f"{value or 3} frames/s",
    "drive.obstacles_every_frames": lambda value: "",
    "drive.sensor": lambda value: value,
    "drive.heading_drift_deg_per_s": lambda value: "drift" if value else "",
    "drive.position_drift_m_per_s": lambda value: "",
    "drive.position_walk_m": lambda value: "",
    "drive.fix_every_frames": lambda value: f"fix each {value} frames" if value else "",
    "drive.fix_noise_m": lambda value: "",
    "drive.proximity_noise_m": lambda value: "",
}
# Where a key stands among the words: that of the scan last.
ORDER = lambda key: (key == "drive.scan_steps", list(WORDS).index(key) if key in WORDS else len(WORDS))
SHARED = ["run", "terrain.generate.preset", "terrain.generate.seed", "drive.scans"]


class Drive:
    """One run: its design, its ground, its counts."""

    def __init__(self, row, keys):
        self.row, self.keys = row, keys
        self.design = tuple(row[key] for key in keys)
        self.preset, self.seed = row["terrain.generate.preset"], int(row.get("terrain.generate.seed") or SEED)
        self.again = self.seed >= FIRST_OTHER_SEED

    def __getitem__(self, name):
        """A count of the truth, or of the drive."""
        return float(self.row["truth." + name] if "truth." + name in self.row else self.row[name])

    def clear_way(self, whose=""):
        """Mean clear way of its sectors [m]."""
        return self[whose + "clear_way_m"] / self["sectors"]

    def power(self):
        """Power of each sheet [W]."""
        return float(self.row.get("beam.power_w") or 1)

    def camera(self):
        """Preset of its camera."""
        return self.row.get("drive.sensor") or CAMERA

    def light(self):
        """Light of the laser for each metre [J/m]: a stripe of each sheet in a frame, and all steps in place of a frame's in a scan."""
        scans = self["vertical_scans"]
        frames = self["frames"] - scans + scans * float(self.row["drive.scan_steps"])
        return energy_per_metre(self.power(), self.camera(), SHEETS * frames, self["driven_m"])


def share(name):
    """Share of all sectors with an obstacle, over many drives."""

    def of(drives):
        whole = sum(drive["with_obstacle"] for drive in drives)
        return sum(drive[name] for drive in drives) / whole if whole else None

    return of


def mean(value):
    """Mean of a value over drives: each ground counts alike."""
    return lambda drives: sum(value(drive) for drive in drives) / len(drives)


def percent(result):
    """A share with its interval."""
    value, ends = result
    if value is None:
        return "none there"
    return f"{100 * value:.0f} %" + (f" [{100 * ends[0]:.0f}, {100 * ends[1]:.0f}]" if ends else "")


def metres(result, sign=""):
    """A length with its interval."""
    value, ends = result
    return f"{value:{sign}.2f} m" + (f" [{ends[0]:{sign}.2f}, {ends[1]:{sign}.2f}]" if ends else "")


def span(seeds):
    """The seeds, in words."""
    return f"{min(seeds)} to {max(seeds)}" if len(set(seeds)) > 1 else str(seeds[0])


def words(drive):
    """What the design is, in words."""
    texts = [WORDS.get(key, lambda value, key=key: f"{key} {value}")(drive.row[key]) for key in sorted(drive.keys, key=ORDER)]
    return ", ".join(text for text in texts if text)


def line(name, drives):
    """A line of a letter's table: one design on the grounds of one kind."""
    drives.sort(key=lambda drive: drive.seed)
    first = drives[0]
    count = {key: round(sum(drive[key] for drive in drives))
             for key in ["with_obstacle", "found", "passed", "false_obstacle", "upper_bound.found", "sectors"]}
    return [name, words(first), f"`{first.preset}`", span([drive.seed for drive in drives]),
            count["with_obstacle"], f"{count['found']}: {percent(interval(drives, share('found')))}",
            f"{count['upper_bound.found']}: {percent(interval(drives, share('upper_bound.found')))}",
            count["passed"], f"{count['false_obstacle']} ({100 * count['false_obstacle'] / count['sectors']:.1f} %)",
            metres(interval(drives, mean(Drive.clear_way))),
            metres(interval(drives, mean(lambda drive: drive.clear_way("upper_bound.")))),
            f"{1000 * sum(drive.light() for drive in drives) / len(drives):.0f} mJ/m", laser_class(first.power(), first.camera())]


def compared(names, pairs):
    """A line that compares two designs by their drives on the same grounds: the first less the second."""

    def difference(drawn):
        found = [share("found")([pair[side] for pair in drawn]) for side in (0, 1)]
        return None if None in found else found[0] - found[1]

    ways = [round(a.clear_way() - b.clear_way(), 9) for a, b in pairs]
    counts = [round(a["found"] - b["found"]) for a, b in pairs]
    order = lambda values: " / ".join(str(sum(1 for value in values if sign(value))) for sign in
                                      (lambda v: v > 0, lambda v: v == 0, lambda v: v < 0))
    found = interval(pairs, difference)
    totals = [round(sum(pair[side]["found"] for pair in pairs)) for side in (0, 1)]
    points = "none there" if found[0] is None else f"{100 * found[0]:+.0f}" + (
        f" [{100 * found[1][0]:+.0f}, {100 * found[1][1]:+.0f}]" if found[1] else "")
    way = interval(pairs, mean(lambda pair: pair[0].clear_way() - pair[1].clear_way()))
    return [*names, len(pairs), f"{totals[0]}, {totals[1]}", points, order(counts), metres(way, "+"), order(ways)]


def table(heads, lines):
    """A table of Markdown."""
    rows = [heads, ["---"] * len(heads), *lines]
    return "\n".join("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows)


def read(given):
    """The drives of each letter, with the designs in the order of their list."""
    letters = {}
    for one in given:
        letter, _, path = one.partition("=")
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        if not rows or "truth.found" not in rows[0]:
            sys.exit(f"{path}: no table of drives; expected a sweep's table.csv with the column truth.found")
        heads = list(rows[0])
        keys = [key for key in heads[:heads.index("columns_left_out")] if key not in SHARED]
        letters.setdefault(letter, []).extend(Drive(row, keys) for row in rows if not row.get("refused"))
    return letters


def numbered(drives):
    """The rows of a letter's drives: {(number of the design, kind of ground, whether tried again): drives}."""
    designs = list(dict.fromkeys(drive.design for drive in drives))
    rows = {}
    for drive in sorted(drives, key=lambda drive: (drive.preset != "pathfinder", drive.preset, drive.again)):
        rows.setdefault((designs.index(drive.design) + 1, drive.preset, drive.again), []).append(drive)
    return dict(sorted(rows.items(), key=lambda row: (row[0][1] != "pathfinder", row[0][1], row[0][2], row[0][0])))


def page(letters, pairs):
    """All tables, and the comparisons."""
    out, by_name = [], {}
    for letter, drives in letters.items():
        lines = []
        for (number, _, _), own in numbered(drives).items():
            by_name.setdefault(f"{letter}{number}", []).extend(own)
            lines.append(line(f"{letter}{number}", own))
        out.append(table([HEADS[0], "design", *HEADS[1:]], lines))
    lines = []
    for one, other in (pair.split(",") for pair in pairs):
        for again in (False, True):
            sides = [{(drive.preset, drive.seed): drive for drive in by_name.get(name, []) if drive.again == again}
                     for name in (one, other)]
            both = {ground: [side[ground] for side in sides] for ground in sides[0] if ground in sides[1]}
            kinds = list(dict.fromkeys(preset for preset, _ in both))
            for some in [[kind] for kind in kinds] + ([kinds] if len(kinds) > 1 else []):
                own = [pair for (preset, _), pair in sorted(both.items()) if preset in some]
                seeds = [drive.seed for drive, _ in own]
                where = f"`{some[0]}`" if len(some) == 1 else "all"
                lines.append(compared([f"{one} less {other}", where, span(seeds)], own))
    if lines:
        out.append(table(["rows", "ground", "seeds", "grounds", "found", "difference of shares, points", "grounds with more / as many / fewer",
                          "difference of clear ways", "grounds with longer / equal / shorter"], lines))
    return "\n\n".join(out) + "\n"


KEPT = ["sectors", "with_obstacle", "found", "passed", "missed.by_errors", "missed.by_spacing", "missed.by_rule", "false_obstacle",
        "clear_way_m", "unknown.not_measured", "unknown.may_hide", "unknown.near_limit", "upper_bound.found", "upper_bound.passed",
        "upper_bound.false_obstacle", "upper_bound.clear_way_m", "points_off_ground.rms_m", "vertical_scans", "frames"]


def write_drives(letters, path):
    """A line for each drive: what the tables were made of."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["row", "ground", "seed", "design", *KEPT])
        for letter, drives in letters.items():
            for (number, _, _), own in numbered(drives).items():
                for drive in own:
                    values = [f"{drive[name]:.6g}" for name in KEPT]
                    writer.writerow([f"{letter}{number}", drive.preset, drive.seed, words(drive), *values])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tables", nargs="+", metavar="LETTER=TABLE.csv")
    parser.add_argument("--pair", action="append", default=[], metavar="ROW,ROW")
    parser.add_argument("--drives", type=pathlib.Path, help="CSV file with a line for each drive")
    parser.add_argument("-o", type=pathlib.Path, required=True, help="Markdown file that is written")
    asked = parser.parse_args()
    letters = read(asked.tables)
    asked.o.write_text(page(letters, asked.pair), encoding="utf-8")
    if asked.drives:
        write_drives(letters, asked.drives)


if __name__ == "__main__":
    main()
