"""The command ``raypencil``, which is the same program as the one that Rust builds. Only ``--dask`` is Python's own."""

from __future__ import annotations

import argparse
import csv
import os
import signal
import sys

from . import _raypencil
from ._errors import RaypencilError, optional


def main() -> int:
    """Runs the command with the arguments of this process. Returns its exit code."""
    if any(word == "--dask" or word.startswith("--dask=") for word in sys.argv[1:]):
        return _on_cluster(sys.argv[1:])
    # Python would hear Ctrl-C after the command only.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _raypencil.command(["raypencil", *sys.argv[1:]])


def _parser() -> argparse.ArgumentParser:
    """The arguments of the two commands that run on a cluster."""
    parser = argparse.ArgumentParser(prog="raypencil", description="Commands on a Dask cluster.", allow_abbrev=False)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("campaign", "sweep"):
        command = commands.add_parser(name, allow_abbrev=False)
        command.add_argument("--dask", required=True, metavar="ADDRESS", help="address or file of the scheduler")
        command.add_argument("--shards", type=int, metavar="N", help="number of tasks")
        command.add_argument("--json", action="store_true")
        command.add_argument("--force", action="store_true")
        command.add_argument("-o", "--output", default=f"out/{name}", metavar="DIR")
        if name == "campaign":
            command.add_argument("--terrains", type=int, default=100)
            command.add_argument("--seed", type=int, default=1)
            command.add_argument("--scenes", metavar="DIR")
            command.add_argument("--rig", metavar="SCENE.toml")
            command.add_argument("--candidate-command")
            command.add_argument("--timeout", type=float, metavar="SECONDS")
            command.add_argument("--partial", action="store_true")
            command.add_argument("--arithmetic", choices=("f64", "f32"))
            command.add_argument("--parts", type=lambda words: words.split(","), metavar="PART,...")
            command.add_argument("--max-faces", type=int, metavar="N")
        else:
            command.add_argument("scene", nargs="?", default="pyramids")
            command.add_argument("--set", action="append", default=[], metavar="KEY=VALUES")
            command.add_argument("--list", metavar="FILE.csv")
            command.add_argument("--do", default="validate", choices=("validate", "render", "drive"))
            command.add_argument("--with", dest="with_")
            command.add_argument("--as-printed", action="store_true")
            command.add_argument("--chart", action="append", default=[])
    return parser


def _on_cluster(words: list[str]) -> int:
    """Runs a campaign or a sweep on a cluster. Exit codes are those of the command."""
    from ._campaign import campaign
    from ._sweep import sweep
    from ._validate import Outcome

    given = _parser().parse_args(words)
    found: Outcome
    try:
        Client = optional("distributed", "--dask", "dask").Client
        at = {"scheduler_file": given.dask} if os.path.isfile(given.dask) else {"address": given.dask}
        with Client(**at) as client:
            if given.command == "campaign":
                found = campaign(
                    given.terrains, given.seed, output=given.output, force=given.force, scenes=given.scenes, rig=given.rig,
                    candidate_command=given.candidate_command, timeout=given.timeout, partial=given.partial,
                    arithmetic=given.arithmetic, parts=given.parts, max_faces=given.max_faces, shards=given.shards,
                    client=client, progress=True,
                )  # fmt: skip
            else:
                runs = None
                if given.list is not None:
                    with open(given.list, encoding="utf-8", newline="") as file:
                        runs = [{k: v or None for k, v in row.items()} for row in csv.DictReader(file, skipinitialspace=True)]
                settings = dict(_raypencil.parse_axis(axis) for axis in given.set)
                found = sweep(
                    given.scene, settings, runs=runs, do=given.do, with_=given.with_, as_printed=given.as_printed,
                    charts=given.chart, output=given.output, force=given.force, shards=given.shards, client=client,
                    progress=True,
                )  # fmt: skip
    except (RaypencilError, OSError) as error:
        print(f"  × {error}", file=sys.stderr)
        return 2
    if given.json:
        import json

        print(json.dumps(found.summary, indent=2))
    else:
        print(found.text, end="")
    return 0 if found else 1
