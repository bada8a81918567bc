"""The command `raypencil-peers`."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from .._errors import RaypencilError
from ._figures import laws_svg, speed_svg
from ._known import LEFT_OUT, every_peer, peer
from ._measure import Measured, Step, installed, measure, time_again
from ._page import LAWS_FIGURE, SPEED_FIGURE, cell, how_rounded, page, paragraph
from ._peer import Unavailable


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="raypencil-peers", description="Other programs that answer rays, asked the same questions.", allow_abbrev=False
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    commands.add_parser("list", help="all peers, and which are installed")
    ask = commands.add_parser("ask", help="ask one peer all hard rays, and find its thresholds")
    ask.add_argument("peer", metavar="PEER", help="as `list` names it")
    table = commands.add_parser("table", help="ask all peers, and write the page")
    table.add_argument("peers", nargs="*", metavar="PEER", help="only these")
    table.add_argument("-o", "--output", type=Path, metavar="FILE.md", help="the page; its pictures go to figures/ beside it")
    table.add_argument("--kept", type=Path, metavar="DIR", help="keeps the answers; a peer that is in it is not asked again")
    table.add_argument(
        "--elsewhere", type=Path, metavar="DIR", help="what `--kept` kept on another machine; its peers are not asked here"
    )
    table.add_argument(
        "--time-again", action="store_true", help="asks the speed of each peer that `--kept` has once more, and keeps the higher one"
    )
    hunt = commands.add_parser("hunt", help="find wrong rays of a peer on a mesh, and write reproducers")
    hunt.add_argument("peer", metavar="PEER")
    of = hunt.add_mutually_exclusive_group(required=True)
    of.add_argument("--mesh", metavar="FILE", help="a mesh: .stl, .obj, .ply, .glb, or a folder with .npy files")
    of.add_argument("--terrains", type=int, metavar="N", help="N generated grounds")
    hunt.add_argument("--seed", type=int, default=1, help="of the rays and the grounds [default: 1]")
    hunt.add_argument("--rays", type=int, default=4000, help="rays on each mesh [default: 4000]")
    hunt.add_argument("--most", type=int, default=3, help="reproducers at most [default: 3]")
    hunt.add_argument("-o", "--output", type=Path, default=Path("out/hunt"), metavar="DIR")
    return parser


def _list() -> int:
    for one in every_peer():
        try:
            version = one.version()
            one.device()
        except Unavailable as missing:
            version = f"not here: {missing}"
        print(f"{one.name:16} {one.title:26} {version:12} {how_rounded(one)}")
    print("\nNot asked:")
    for name, why in LEFT_OUT.items():
        print(f"  {name}: {why}")
    return 0


def _measured(
    names: Sequence[str], kept: Path | None, elsewhere: Path | None = None
) -> tuple[list[Measured], dict[str, str], list[Step]]:
    with tempfile.TemporaryDirectory() as folder:
        place = kept or Path(folder)
        measured, missing = measure(names, place, lambda line: print(f"asking {line}", file=sys.stderr, flush=True), elsewhere)
        return measured, missing, installed(place)


def _ask(name: str) -> int:
    peer(name)
    measured, missing, _ = _measured([name], None)
    if missing:
        raise RaypencilError(missing[name])
    (one,) = measured
    for family, counts in one.families.items():
        words = counts if isinstance(counts, str) else ""
        print(f"{family:18} {cell(counts).replace('*', '')} {words}".rstrip())
    print(f"\n{paragraph(one)}".replace("**", ""))
    return 0 if one.total.wrong == 0 else 1


def _table(names: Sequence[str], output: Path | None, kept: Path | None, elsewhere: Path | None, time: bool) -> int:
    for name in names:
        peer(name)
    if elsewhere is not None and not elsewhere.is_dir():
        raise RaypencilError(f"`--elsewhere {elsewhere}` is no folder")
    if time:
        if kept is None:
            raise RaypencilError("`--time-again` needs `--kept DIR`: it times what is kept")
        time_again(names or [one.name for one in every_peer()], kept, lambda line: print(f"timing {line}", file=sys.stderr, flush=True))
    measured, missing, steps = _measured(names or [one.name for one in every_peer()], kept, elsewhere)
    if not measured:
        raise RaypencilError("none of these peers could be asked: `raypencil-peers list` says why")
    text = page(measured, missing, steps)
    if output is None:
        print(text, end="")
        return 0
    for figure, drawn in ((LAWS_FIGURE, laws_svg(measured)), (SPEED_FIGURE, speed_svg(measured))):
        file = output.parent / figure
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(drawn, encoding="utf-8")
    output.write_text(text, encoding="utf-8")
    print(f"{output} is written")
    return 0


def main(words: Sequence[str] | None = None) -> int:
    """Runs the command. Returns its exit code: 1 where a peer is wrong, 2 where it could not be asked."""
    given = _parser().parse_args(words)
    try:
        if given.command == "list":
            return _list()
        if given.command == "ask":
            return _ask(given.peer)
        if given.command == "table":
            return _table(given.peers, given.output, given.kept, given.elsewhere, given.time_again)
        from ._hunt import hunt

        return hunt(given.peer, given.mesh, given.terrains, given.seed, given.rays, given.most, given.output)
    except (RaypencilError, Unavailable, OSError) as error:
        print(f"  × {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
