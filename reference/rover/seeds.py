"""The table of `just seeds`: the rover against the truth on many grounds, with and without noise, the upper bound beside it.

    python3 reference/rover/seeds.py out/seeds/table.csv -o out/seeds/seeds.md

Each line is a kind of ground at a level of noise; the last line of a level has all its grounds. It needs no package.
"""

import argparse
import csv
import pathlib
import sys

COUNTS = ["sectors", "with_obstacle", "found", "passed", "missed.by_errors", "missed.by_spacing", "missed.by_rule",
          "not_seen.hidden", "not_seen.in_part", "not_seen.not_swept", "not_seen.outside", "false_obstacle",
          "clear_way_m",
          "upper_bound.found", "upper_bound.passed", "upper_bound.false_obstacle", "upper_bound.clear_way_m"]
# Largest shares that were aimed at: passed, of the obstacles that were found or passed; false, of all sectors.
GOALS = {"none": (0.01, 0.02), "camera": (0.02, 0.04), "camera and sensors": (0.02, 0.04)}
HEAD = """| noise | ground | grounds | sectors | with an obstacle | found | \
passed = missed by errors + by spacing + by the rule + not seen | false | clear way | \
exact eyes: found, passed, false, clear way |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"""


def level(row):
    """Level of noise of a run."""
    if row["drive.sensor"] == "ideal":
        return "none"
    return "camera and sensors" if row["drive.attitude_noise_deg"] else "camera"


def sums(rows):
    """Sum of each count over these runs. Columns of the table begin with `truth.`."""
    return {name: sum(float(row[f"truth.{name}"]) for row in rows) for name in COUNTS}


def line(noise, ground, rows):
    """A line of the table."""
    total = sums(rows)
    whole = {name: f"{round(value):,}" for name, value in total.items()}
    missed = " + ".join(whole[name] for name in COUNTS if name.startswith("missed."))
    hidden = round(sum(total[name] for name in COUNTS if name.startswith("not_seen.")))
    sectors = max(1.0, total["sectors"])
    bound = (f"{whole['upper_bound.found']}, {whole['upper_bound.passed']}, {whole['upper_bound.false_obstacle']}, "
             f"{total['upper_bound.clear_way_m'] / sectors:.2f} m")
    cells = [noise, ground, len(rows), whole["sectors"], whole["with_obstacle"], whole["found"],
             f"{whole['passed']} = {missed} + {hidden}",
             f"{whole['false_obstacle']} ({100 * total['false_obstacle'] / sectors:.1f} %)",
             f"{total['clear_way_m'] / sectors:.2f} m", bound]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def verdict(noise, rows):
    """Whether a level of noise meets its goal, in a sentence."""
    total = sums(rows)
    seen = total["found"] + total["passed"]
    passed, wrong = total["passed"] / max(1.0, seen), total["false_obstacle"] / max(1.0, total["sectors"])
    goals = GOALS[noise]
    met = ["met" if share < goal else "not met" for share, goal in zip((passed, wrong), goals)]
    return (f"* *{noise}*: {round(total['passed'])} of {round(seen):,} obstacles that were found or passed are passed "
            f"({100 * passed:.2f} %; goal: less than {100 * goals[0]:.0f} %: {met[0]}), and {100 * wrong:.2f} % of the sectors end at a "
            f"false one (less than {100 * goals[1]:.0f} %: {met[1]}).")


def page(rows):
    """The tables of these runs, as Markdown."""
    lines, verdicts = [HEAD], []
    for noise in GOALS:
        own = [row for row in rows if level(row) == noise]
        if not own:
            continue
        for ground in dict.fromkeys(row["terrain.generate.preset"] for row in own):
            lines.append(line(noise, f"`{ground}`", [row for row in own if row["terrain.generate.preset"] == ground]))
        lines.append(line(noise, "all", own))
        verdicts.append(verdict(noise, own))
    return "\n".join([*lines, "", *verdicts, ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path, nargs="+", help="table.csv of the sweep, or of its parts")
    parser.add_argument("-o", type=pathlib.Path, required=True, help="Markdown file that is written")
    asked = parser.parse_args()
    rows = []
    for table in asked.table:
        with table.open(newline="", encoding="utf-8") as file:
            rows += csv.DictReader(file)
    missing = [name for name in ["drive.sensor", "truth.passed"] if rows and name not in rows[0]]
    if not rows or missing:
        sys.exit(f"{asked.table[0]}: no table of `just seeds` ({', '.join(missing) or 'no run'} is missing)")
    asked.o.write_text(page(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
