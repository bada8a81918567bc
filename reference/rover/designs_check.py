#!/usr/bin/env python3
"""Known answers for the tables of sweeps: intervals, the light of a sheet and its class, rows, comparisons and goals.

    python3 reference/rover/designs_check.py

Prints one line for each check, and ends with 0 if all hold, else with 1. It needs no package.
"""

import sys

from designs import Drive, numbered, page, percent, share
from laser import energy_per_metre, laser_class
from resample import interval, mixed
from seeds import COUNTS, line, verdict

FAILED = []


def check(name, holds):
    print(("holds  " if holds else "FAILS  ") + name)
    if not holds:
        FAILED.append(name)


def drive(preset, seed, power="", found=0, obstacles=10, way=2.0):
    """A drive of 100 sectors, 3 m long, with 31 frames of which one is a scan of 26 stripes."""
    row = {"terrain.generate.preset": preset, "terrain.generate.seed": str(seed), "beam.power_w": power, "drive.scan_steps": "26",
           "frames": "31", "vertical_scans": "1", "driven_m": "3", "truth.sectors": "100", "truth.with_obstacle": str(obstacles),
           "truth.found": str(found), "truth.passed": "0", "truth.false_obstacle": "0", "truth.clear_way_m": str(100 * way),
           "truth.upper_bound.found": str(obstacles), "truth.upper_bound.clear_way_m": "300"}
    return Drive(row, ["beam.power_w"])


def check_intervals():
    mean = lambda values: sum(values) / len(values)
    value, ends = interval([2.5] * 7, mean)
    check("grounds that are all alike have an interval of no width", value == 2.5 and ends == (2.5, 2.5))
    # Of two grounds with 0 and 1 a quarter of all draws has the mean 0 and a quarter the mean 1.
    check("of two unlike grounds the interval holds both", interval([0, 1], mean) == (0.5, (0, 1)))
    # 0 and 1 in equal shares: the mean of n draws has the standard deviation 1 / (2 sqrt(n)), for 100 grounds 0.05.
    _, (low, high) = interval([0, 1] * 50, mean)
    check(f"of a hundred grounds it is two standard errors to each side: {low:.3f} to {high:.3f}",
          abs(low - 0.402) < 0.012 and abs(high - 0.598) < 0.012)
    check("one ground alone has no interval", interval([1], mean) == (1, None))
    bits = [mixed(counter) % 10 for counter in range(10000)]
    check("each of ten places is drawn about as often", all(abs(bits.count(place) - 1000) < 120 for place in range(10)))
    # The first number of SplitMix64 with the seed 0, by its authors' program.
    check("the generator gives the number of its authors", mixed(0) == 0xE220A8397B1DCDAF)
    few = [drive("pathfinder", 1, found=1, obstacles=1), drive("pathfinder", 2, found=0, obstacles=9)]
    check("a share is that of all sectors, not the mean of shares", percent(interval(few, share("found"))) == "10 % [0, 100]")
    none = [drive("pathfinder", 1, obstacles=0), drive("pathfinder", 2, obstacles=0)]
    check("no obstacle, no share", percent(interval(none, share("found"))) == "none there")


def check_light():
    # 2 W for 0.4 ms in 56 images over 3 m: 2 x 0.4e-3 x 56 / 3 J/m.
    check("light of two sheets of 1 W", abs(drive("pathfinder", 1).light() - 0.0149333333) < 1e-9)
    check("half the power, half the light", abs(energy_per_metre(0.5, "cmos", 112, 3) - drive("pathfinder", 1).light() / 2) < 1e-12)
    # A pulse five times as long has five times the light, and 5^0.75 times the limit.
    check("the camera `ideal` exposes five times as long", abs(energy_per_metre(1, "ideal", 1, 1) - 2e-3) < 1e-15
          and [laser_class(power, "ideal") for power in (0.0906, 0.0907)] == ["1", "3R"])
    # By hand: 7 mm of a line of 115.5 mm are 0.0606; class 1 ends at 7e-4 x (4e-4)^0.75 x 1.660 = 3.29e-6 J, so at 0.1355 W; 3R at
    # 0.6776 W; 3B at 0.0498 J, so at 2053 W.
    powers = [0.135, 0.136, 0.677, 0.679, 2050, 2060]
    check("classes change at 0.1355, 0.678 and 2053 W", [laser_class(power, "cmos") for power in powers] == ["1", "3R", "3R", "3B", "3B", "4"])


def check_rows():
    drives = [drive("crevassed", 1), drive("pathfinder", 1, "3"), drive("pathfinder", 12), drive("pathfinder", 1)]
    names = list(numbered(drives))
    check("rows go by ground, by seeds and by the list's order", names == [
        (1, "pathfinder", False), (2, "pathfinder", False), (1, "pathfinder", True), (1, "crevassed", False)])
    one = [drive("pathfinder", seed, "1", found=4 + seed, way=2.0) for seed in (1, 2, 3)]
    other = [drive("pathfinder", seed, "3", found=6, way=2.5) for seed in (2, 3, 4)]
    last = page({"S": one + other}, ["S1,S2"]).splitlines()[-1]
    check(f"only grounds that both have are compared: {last}",
          last == "| S1 less S2 | `pathfinder` | 2 to 3 | 2 | 13, 12 | +5 [+0, +10] | 1 / 1 / 0 | -0.50 m [-0.50, -0.50] | 0 / 0 / 2 |")


def check_goals():
    row = {f"truth.{name}": "0" for name in COUNTS} | {
        "truth.sectors": "217", "truth.with_obstacle": "40", "truth.found": "18", "truth.passed": "2", "truth.missed.by_errors": "1",
        "truth.not_seen.hidden": "1", "truth.false_obstacle": "4", "truth.clear_way_m": "434", "truth.upper_bound.clear_way_m": "651"}
    said = verdict("camera", [row, row])
    # 2 of 20 are passed, and 4 of 217 sectors, 1.84 %, end at a false obstacle.
    check("a goal that is missed and one that is met", "4 of 40 " in said and "(10.00 %; goal: less than 2 %: not met)" in said
          and "1.84 % of the sectors end at a false one (less than 4 %: met)" in said)
    check("without noise the goals are half as large", "less than 1 %: not met" in verdict("none", [row])
          and "less than 2 %: met" in verdict("none", [row]))
    check("each passed sector has its cause", "| 434 | 80 | 36 | 4 = 2 + 0 + 0 + 2 | 8 (1.8 %) | 2.00 m |" in line("camera", "all", [row, row]))


def main():
    check_intervals()
    check_light()
    check_rows()
    check_goals()
    print("all hold" if not FAILED else f"{len(FAILED)} FAIL")
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
