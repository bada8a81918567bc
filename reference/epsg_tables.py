"""Writes the tables of units by code in crates/world/mesh-io/src/dem/epsg, from the EPSG data set in the database of PROJ.

    python3 -m pip install pyproj==3.7.2
    python3 reference/epsg_tables.py && cargo fmt

The EPSG Geodetic Parameter Dataset is owned by IOGP (https://epsg.org/terms-of-use.html). The tables hold facts from it: which
unit and which direction the axes of a coordinate system have, and the names of vertical ones.
"""

import sqlite3
from collections import defaultdict
from pathlib import Path

from pyproj.datadir import get_data_dir

FOLDER = Path(__file__).parent.parent / "crates/world/mesh-io/src/dem/epsg"
HEAD = "//! {what} Written by `reference/epsg_tables.py` from EPSG {version}, as in the database of PROJ {proj}.\n\n"


def main():
    base = sqlite3.connect(Path(get_data_dir()) / "proj.db")
    told = dict(base.execute("select key, value from metadata"))
    words = {"version": told["EPSG.VERSION"], "proj": told["PROJ.VERSION"]}

    def write(name, what, lines):
        text = HEAD.format(what=what, **words) + "\n".join(lines) + "\n"
        (FOLDER / f"{name}.rs").write_text(text, encoding="utf-8")

    def axes(table):
        """Of each coordinate system: its name, and the unit and the direction of each axis."""
        query = (
            f"select crs.code, crs.name, axis.uom_code, axis.orientation from {table} crs join axis"
            " on axis.coordinate_system_auth_name = crs.coordinate_system_auth_name"
            " and axis.coordinate_system_code = crs.coordinate_system_code"
            " where crs.auth_name = 'EPSG' order by crs.code + 0, axis.coordinate_system_order"
        )
        found = {}
        for code, name, unit, direction in base.execute(query):
            # A GeoTIFF holds a code in 16 bits.
            if int(code) < 1 << 16:
                found.setdefault(int(code), (name.strip(), []))[1].append((int(unit), direction))
        return found

    projected, vertical = axes("projected_crs"), axes("vertical_crs")
    by_unit = defaultdict(list)
    reversed_axes = []
    for code, (_, axes_of) in projected.items():
        # A third axis, of heights, is of no interest: no GeoTIFF names such a system by this key.
        assert axes_of[0][0] == axes_of[1][0], code
        by_unit[axes_of[0][0]].append(code)
        if any(direction in ("west", "south") for _, direction in axes_of):
            reversed_axes.append(code)
    lines = [
        "/// Codes of projected coordinate systems by the EPSG code of their unit: first and last of each run of codes.",
        "pub(super) const UNITS: &[(u16, &[u16])] = &[",
    ]
    for unit, codes in sorted(by_unit.items()):
        lines.append(f"    ({unit}, &[{', '.join(str(end) for run in runs(codes) for end in run)}]),")
    lines += [
        "];",
        "",
        "/// Codes of those whose axes point west or south: first and last of each run.",
        f"pub(super) const REVERSED: &[u16] = &[{', '.join(str(end) for run in runs(reversed_axes) for end in run)}];",
    ]
    write("projected", "Units of projected coordinate systems.", lines)

    lines = [
        "/// Code, EPSG code of the unit, whether the axis points down, and name.",
        "pub(super) const VERTICAL: &[(u16, u16, bool, &str)] = &[",
    ]
    for code, (name, [(unit, direction)]) in vertical.items():
        assert direction in ("up", "down"), code
        lines.append(f'    ({code}, {unit}, {"true" if direction == "down" else "false"}, "{name}"),')
    write("vertical", "Vertical coordinate systems.", lines + ["];"])

    pairs = base.execute(
        "select code, horiz_crs_code, vertical_crs_code from compound_crs where auth_name = 'EPSG'"
        " and horiz_crs_auth_name = 'EPSG' and vertical_crs_auth_name = 'EPSG' order by code + 0"
    )
    lines = [
        "/// Code of a compound system, of its projected one and of its vertical one, one after the other.",
        "pub(super) const COMPOUND: &[u16] = &[",
    ]
    for code, horizontal, vertical_code in pairs:
        # The others are in degrees.
        if int(horizontal) in projected:
            lines.append(f"    {code}, {horizontal}, {vertical_code},")
    write("compound", "Compound coordinate systems.", lines + ["];"])


def runs(codes):
    """First and last of each run of codes without a gap."""
    found = []
    for code in sorted(codes):
        if found and found[-1][1] == code - 1:
            found[-1][1] = code
        else:
            found.append([code, code])
    return found


main()
