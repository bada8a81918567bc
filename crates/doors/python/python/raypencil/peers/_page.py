"""The page for the docs: tables, and a paragraph for each peer, all of it from what was measured."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from ..testing import hard_rays
from ._known import LEFT_OUT
from ._laws import LAWS, Threshold, explained, listed, sentence
from ._measure import Measured, Step
from ._peer import Peer
from ._question import Counts

#: The files of the pictures, beside which folder the page is.
LAWS_FIGURE, SPEED_FIGURE = "figures/peers-laws.svg", "figures/peers-speed.svg"

#: What helps against a threshold, by law and side.
_REMEDIES = {
    ("scale", "below"): "scale a small mesh, with its rays, to a width of about 1, and t back",
    ("scale", "above"): "scale a large mesh, with its rays, to a width of about 1, and t back",
    ("distance", "below"): "do not begin rays next to a surface; or begin them earlier, and drop the hits before",
    ("distance", "above"): "begin rays near the mesh: move the origin to where the ray enters its box",
    ("angle", "below"): "do not rely on grazing rays",
    ("aspect", "above"): "split long thin faces, or answer rays on them otherwise",
    ("length", "below"): "make directions 1 long, and scale t",
    ("length", "above"): "make directions 1 long, and scale t",
}


def how_rounded(peer: Peer) -> str:
    """How its question was rounded, in words."""
    types = {"f32": "single", "f64": "double"}
    mesh, rays = types[peer.mesh_type], types[peer.rays_type]
    said = f"reads mesh and rays in {mesh} precision" if mesh == rays else f"reads the mesh in {mesh}, rays in {rays} precision"
    if peer.is_unit:
        said += ", directions made 1 long"
    if peer.is_segment:
        said += ", segments for rays"
    return f"{said}; judged as {peer.arithmetic}"


def cell(counts: Counts | str) -> str:
    """A family of a peer: `wrong of differing`, and what is by convention."""
    if isinstance(counts, str):
        return "refused"
    parts = [] if not counts.differing else [f"**{counts.wrong}** of {counts.differing}" if counts.wrong else f"0 of {counts.differing}"]
    if counts.convention:
        parts.append(f"convention {counts.convention}")
    return ", ".join(parts) or "0"


def rate(speed: float | None) -> str:
    """Rays a second, in two digits."""
    return "-" if speed is None else f"{float(f'{speed:.2g}'):,.0f}"


def _table(measured: Sequence[Measured]) -> list[str]:
    lines = [
        "| program | version | rays | missed | invented | another face | wrong | t wrong | convention | rays/s |",
        "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for one in measured:
        total = one.total
        numbers = " | ".join(str(n) for n in (total.rays, total.missed, total.invented, total.other))
        lines.append(
            f"| {one.peer.title} | {one.version} | {numbers} | **{total.wrong}** | {total.ranges} | {total.convention} | {rate(one.speed)} |"
        )
    return lines


def _families(measured: Sequence[Measured]) -> list[str]:
    names = list(hard_rays())
    lines = ["| program | " + " | ".join(names) + " |", "| --- |" + " ---: |" * len(names)]
    for one in measured:
        cells = " | ".join(cell(one.families[name]) for name in names)
        lines.append(f"| {one.peer.title} | {cells} |")
    return lines


def remedies(peer: Peer | type[Peer], found: Sequence[Threshold]) -> list[str]:
    """What a user should do against the thresholds of a peer, each once."""
    known = {**_REMEDIES, **peer.remedies}
    said = [known[key] for one in found if (key := (one.law, one.side)) in known]
    return list(dict.fromkeys(said))


def paragraph(one: Measured) -> str:
    """A peer in plain words: what it loses, from where on, and what a user should do."""
    total, peer = one.total, one.peer
    said = [f"**{peer.title}** ({peer.package} {one.version}; {how_rounded(peer)})."]
    if total.wrong == 0:
        said.append(f"None of its {total.differing} first hits that differ is wrong: rounding excuses all." if total.differing else "It answers all rays exactly.")
    else:
        worst = sorted(
            ((name, counts.wrong) for name, counts in one.families.items() if isinstance(counts, Counts) and counts.wrong),
            key=lambda pair: -pair[1],
        )
        told = listed([f"{name} {wrong}" for name, wrong in worst[:4]])
        more = " and others" if len(worst) > 4 else ""
        said.append(f"{total.wrong} of {total.rays} first hits {_are(total.wrong)} wrong: {told}{more}.")
    through = [one.families.get(name) for name in ("edges", "vertices")]
    leaks = sum(counts.wrong for counts in through if isinstance(counts, Counts))
    if leaks:
        where = "it" if leaks == 1 else "they"
        said.append(f"Of 830 rays through edges and vertices of a closed mesh {leaks} {_are(leaks)} not stopped where {where} should be.")
    if one.thresholds:
        said.append(sentence(one.thresholds))
    if peer.causes:
        said += peer.causes
    elif why := explained(one.thresholds):
        said.append(why)
    if total.convention:
        which = "in whose plane the ray lies" if peer.meets_in_plane else "without an area"
        said.append(f"By its convention {total.convention} ray{'s' * (total.convention != 1)} {_meet(total.convention)} faces {which}.")
    if total.ranges:
        said.append(f"{total.ranges} range{'s' * (total.ranges != 1)} {_are(total.ranges)} off by more than rounding.")
    if one.refused:
        said.append(f"It refuses the mesh of {listed(list(one.refused))} ({_short(next(iter(one.refused.values())))}).")
    said += list(peer.conventions)
    advice = [*peer.advice, *remedies(peer, one.thresholds)]
    if leaks and not peer.advice:
        advice.append("do not count crossings of closed meshes by it")
    if advice := list(dict.fromkeys(advice)):
        said.append(f"What to do: {'; '.join(advice)}.")
    return " ".join(said) + f" `raypencil-peers ask {peer.name}`"


def _are(count: int) -> str:
    return "is" if count == 1 else "are"


def _meet(count: int) -> str:
    return "meets" if count == 1 else "meet"


def _short(words: str) -> str:
    line = words.splitlines()[0].replace("|", "/")
    return line if len(line) < 120 else line[:117] + "..."


def page(measured: Sequence[Measured], missing: Mapping[str, str], steps: Sequence[Step] = ()) -> str:
    """The page.

    Args:
        measured: what was asked, in the order of the page.
        missing: the peers that could not be asked, each with the reason.
        steps: of making the environment.
    """
    others = [one for one in measured if one.peer.registry != "here"]
    packages = {one.peer.package for one in others}
    ours = [one for one in measured if one.peer.registry == "here"]
    # That of most, so that what is kept gives the same page anywhere.
    here = Counter(one.machine for one in measured).most_common(1)[0][0]
    lines = [
        "# Other programs' answers to hard rays",
        "",
        # A test of the documents reads it.
        "<!-- stands on",
        'made_by = "raypencil-peers table -o docs/peers.md --elsewhere reference/peers/card"',
        'measured = "other people\'s programs at the versions of the table, asked on the machines that the page names"',
        'shows = ["docs/figures/peers-laws.svg", "docs/figures/peers-speed.svg"]',
        "-->",
        "",
        f"{len(others)} ways to ask {len(packages)} packages the rays of `data/rays/hard` ([what they are](hard-rays.md)). Made by"
        " `raypencil-peers table`, as the page's end has it; `raypencil-peers ask NAME` shows one of them, and"
        " [peers-hunts.md](peers-hunts.md) wrong rays on meshes of other people.",
        "",
        "Every program is asked what it can read: mesh and rays are rounded to its types first, and the truth is that of the rounded"
        " question, by `raypencil cast`, which is exact. So what is counted is no fault of the input. Rays with a t_min are left out,"
        " for most calls take none. A first hit *differs* if it is none of those at the nearest t: *missed*, *invented* (a hit"
        " where there is none) or of *another face*. It is **wrong** by the rule of `raypencil check`, which excuses an answer that is"
        " right for a ray moved sideways by 16 u S (u: the unit roundoff of the program's own arithmetic; S: the largest coordinate"
        " plus the origin's; [cast.md](guide/cast.md)). *t wrong*: the face is right, and t off by more than rounding. *Convention*:"
        " the program counts a face in whose plane the ray lies, or one without an area (rounded to single precision the mesh of"
        " *far-mesh* has no others); that is a choice, not a fault. A program that tells no face is judged by t, which is excused where it"
        " would be on some face. raypencil's own rows are by the same rule.",
        "",
        *_table(measured),
        "",
        f"Rays a second: on 8192 faces, on a machine of {here}, {_when(measured, here)}; threads as each program takes them by itself,"
        " and through Python or Node where that is how it is called; crates are asked from Rust, in one thread. It says what a call costs,"
        " not what an engine can do. The best of"
        " five runs or more; read the power of ten, for other work on the machine makes some rows slower." + _elsewhere(measured, here),
        "",
        f"![Wrong rays against rays a second]({SPEED_FIGURE})",
        "",
        "## What is lost as one number changes",
        "",
        "Rays at the middles of faces, far from edges, in general position; one number is changed at a time. White: all right."
        " Dark: all wrong. Grey: not asked, since the program refuses the mesh or its types do not have the numbers.",
        "",
        f"![Share of wrong rays against one number]({LAWS_FIGURE})",
        "",
        *[f"* **{law.name}**: {law.axis}, {law.values[0]:g} to {law.values[-1]:g}." for law in LAWS.values()],
        "",
        "## Each program",
        "",
        "Thresholds are where half of the rays become wrong, by bisection, on the meshes of the curves. A cause is named where it was"
        " found in the program's source, with its function and file, or where one number of a test of triangles explains several"
        " thresholds.",
        "",
    ]
    for one in measured:
        lines += [paragraph(one), ""]
    if ours:
        lines += _cost(ours, others)
    lines += [
        "## By family",
        "",
        "`**47** of 80`: 80 first hits differ, 47 of them are wrong. `0 of 80`: all are excused by rounding. `0`: none differs."
        " [hard-rays.md](hard-rays.md) says what each family is.",
        "",
        *_families(measured),
        "",
        "## Who is not asked",
        "",
        *[f"* {name}: {why}." for name, why in LEFT_OUT.items()],
        *[f"* {name}: not asked here ({why})." for name, why in missing.items()],
        "",
        "## Make it again",
        "",
        "```sh",
        "reference/peers/install.sh ENV                             # an environment, the packages of npm, the program for crates",
        "RAYPENCIL_PEERS_NODE=ENV/node ENV/bin/raypencil-peers table -o docs/peers.md --elsewhere reference/peers/card",
        "```",
        "",
        "With `--kept reference/peers/kept`, where the answers of this page are, those alone are asked whose file was removed.",
        *_made(measured, here, steps),
    ]
    return "\n".join(lines) + "\n"


def _asking(measured: Sequence[Measured], here: str) -> list[tuple[float, float | None]]:
    """Seconds and load of each program that was asked here; none, if nobody noted them of one."""
    noted = [(one.seconds, one.load) for one in measured if one.machine == here]
    return [(seconds, load) for seconds, load in noted if seconds is not None] if all(seconds is not None for seconds, _ in noted) else []


def _when(measured: Sequence[Measured], here: str) -> str:
    """In which hours the programs were asked, and what else the machine did."""
    loads = [load for _, load in _asking(measured, here) if load is not None]
    if not loads:
        return "not all in the same hour"
    told = f"one program after the other, beside other work (its load, when each began, was {min(loads):g} to {max(loads):g})"
    most = max(one.times for one in measured)
    return told if most == 1 else f"{told}, up to {most} times in other hours, of which the highest speed stands"


def _made(measured: Sequence[Measured], here: str, steps: Sequence[Step]) -> list[str]:
    """What the two commands took, in time and on the disk."""
    lines: list[str] = []
    if steps:
        lines += [
            "",
            "The first command notes what it took on that machine, downloads and builds with it, in `ENV/installed.tsv`:",
            "",
            "| step | seconds | MB |",
            "| --- | ---: | ---: |",
            *[f"| {step.name} | {step.seconds} | {step.megabytes:,} |" for step in steps],
            f"| all | {sum(step.seconds for step in steps)} | {sum(step.megabytes for step in steps):,} |",
        ]
    if asking := _asking(measured, here):
        slow = sorted((one for one in measured if one.machine == here), key=lambda one: -(one.seconds or 0))[:3]
        told = listed([f"{one.peer.title} {(one.seconds or 0) / 60:.0f}" for one in slow])
        lines += ["", f"The second takes {sum(seconds for seconds, _ in asking) / 60:.0f} minutes; the longest of them {told}."]
    return lines


def _elsewhere(measured: Sequence[Measured], here: str) -> str:
    """Which programs were asked on another machine, one sentence for each machine."""
    places: dict[str, list[str]] = {}
    for one in measured:
        if one.machine != here:
            places.setdefault(one.machine, []).append(one.peer.title)
    return "".join(f" On another machine ({place}) were asked: {'; '.join(titles)}." for place, titles in places.items())


def _cost(ours: Sequence[Measured], others: Sequence[Measured]) -> list[str]:
    """What being right costs in time."""
    # On the same machine only: a graphics card answers another question.
    fastest = max((one for one in others if one.speed and one.machine == ours[0].machine), key=lambda one: one.speed or 0, default=None)
    if fastest is None:
        return []
    said = [
        f"{one.peer.title} answers {rate(one.speed)} rays a second, {(fastest.speed or 0) / one.speed:.2g} times fewer than"
        f" {fastest.peer.title}, the fastest call here"
        for one in ours
        if one.speed
    ]
    return [f"What it costs: {'; '.join(said)}.", ""]
